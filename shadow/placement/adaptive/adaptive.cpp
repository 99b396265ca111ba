// SPDX-License-Identifier: MIT
// Tiles at the resolution that the picture asks for: a quadtree over the light's map, of which the GPU finds every frame which
// tiles the view samples need, and packs them into an atlas.
// Also here: tree.h, tree_passes.h, tree_passes.cpp (which tiles there are), refine.h, refine.cpp (rounds of looking at them),
// kept_tiles.h, kept_tiles.cpp (what outlives a frame), its passes tree_nodes.glsl, tree_requests.glsl, tree_weights.glsl, tree_grid.glsl,
// tree_needed.glsl, tree_cut.glsl, tree_rank.glsl, tree_counts.glsl, tree_sums.glsl, tree_tiles.glsl, tree_view.glsl; of kept tiles
// tree_places.glsl, tree_hold.glsl, tree_order.glsl, tree_describe.glsl.
//
// Based on: Lefohn, Sengupta, Owens. Resolution-Matched Shadow Maps. ACM Transactions on Graphics 26(4), 2007. [LSO07]
// Stands on: shadow/placement/jittered (where in a texel the tiles of a frame lie)
// Departs from it: demands are counted in place where the paper sorts them; tiles have a border for kernels; and over the budget
// those tiles go first that sharpen the picture least.
#include "shadow/placement/adaptive/adaptive.h"

#include "shadow/frame/history.h"
#include "shadow/geometry/potential_receivers.h"
#include "shadow/placement/adaptive/adaptive.glsl"
#include "shadow/placement/adaptive/kept_tiles.h"
#include "shadow/placement/adaptive/refine.h"
#include "shadow/placement/jittered/jittered.glsl"
#include "shadow/placement/light_views.h"
#include "shadow/recipe/guard.h"

#include <bit>
#include <cstring>

namespace gn::adaptive {
namespace {

/// How the atlas is cut into tiles.
struct Atlas {
    int tile = 0, border = 0;  ///< texels
    int reach = 0;             ///< texels of the border for what kernels reach in metres
    int across = 0;            ///< tiles along a side of a layer
    int tiles = 0;
    [[nodiscard]] int texels() const { return tile - 2 * border; }
};

constexpr int usual_tile = 128;
constexpr int wide_tile = 256;  ///< of kernels with a radius in metres
constexpr int enough_tiles = 64;
constexpr int fewest_views = 128;

/// Tiles of `tile` texels. A radius in metres gets a quarter of the tile's side, and levels are held to what fits it.
Atlas atlas_of(const Recipe& recipe, const GnAdaptiveParams& params, const Guard& guard, int tile) {
    Atlas atlas;
    atlas.tile = std::min(tile, recipe.resolution);
    atlas.reach = guard.metres > 0 ? atlas.tile / 8 : 0;
    atlas.border = static_cast<int>(std::ceil(guard.texels)) + 1 + atlas.reach + (params.jitter > 0 ? 1 : 0);
    atlas.across = recipe.resolution / atlas.tile;
    atlas.tiles = params.maps * atlas.across * atlas.across;
    return atlas;
}

/// What the parameters say, or of powers of two up to the usual one the greatest that leaves tiles enough, as long as borders
/// are a quarter of a side at most.
Atlas choose_atlas(const Recipe& recipe, const GnAdaptiveParams& params, const Guard& guard) {
    if (params.tile > 0) {
        return atlas_of(recipe, params, guard, params.tile);
    }
    Atlas atlas = atlas_of(recipe, params, guard, guard.metres > 0 ? wide_tile : usual_tile);
    while (atlas.border * 4 > atlas.tile && atlas.tile * 2 <= recipe.resolution) {
        atlas = atlas_of(recipe, params, guard, atlas.tile * 2);
    }
    while (atlas.tiles < enough_tiles) {
        const Atlas smaller = atlas_of(recipe, params, guard, atlas.tile / 2);
        if (smaller.border * 4 > smaller.tile) {
            break;
        }
        atlas = smaller;
    }
    return atlas;
}

/// A view whose texels are square: its shorter side is lengthened. No tile is spent on what that adds.
GnLightView squared(GnLightView view) {
    const dmat4 rows = glm::transpose(dmat4(view.cs_from_ws));
    const dvec3 axis = dvec3(rows[3]);
    const auto across = [&](int row) {
        const double along = glm::dot(axis, axis) > 0 ? glm::dot(dvec3(rows[row]), axis) / glm::dot(axis, axis) : 0;
        return glm::length(dvec3(rows[row]) - along * axis);
    };
    const dvec2 sizes(across(0), across(1));
    for (int row = 0; row < 2; ++row) {
        const auto scale = static_cast<float>(std::min(sizes.x, sizes.y) / sizes[row]);
        for (int column = 0; column < 4; ++column) {
            view.cs_from_ws[column][row] *= scale;
        }
        view.ws_from_cs[row] /= scale;
    }
    return view;
}

/// The views of whole maps: around all that may receive, or six faces where this surrounds the light.
LightViews maps_around(ConvexBody body, const FrameInput& input, const Guard& guard, const Atlas& atlas) {
    const GnLight& light = input.light().shape;
    if (body.empty()) {
        // Nothing can receive: any view will do.
        body = body_of(Box{vec3(-1), vec3(1)});
    }

    // Tiles have borders of their own, so that kernels in texels widen no map; the room before it is the coarsest level's.
    Guard bare = guard;
    bare.texels = 0;
    const int texels = std::max(1, static_cast<int>(atlas.texels() * room_of(bare) / room_of(guard)));
    LightViews maps;
    if (light.kind == GN_LIGHT_DIRECTIONAL) {
        maps.kind = ViewKind::affine;
        maps.views = {fit_orthographic(body, light, texels, bare)};
        return maps;
    }
    const Fitted fitted = fit_perspective(body, light, texels, bare);
    if (fitted.valid) {
        maps.views = {fitted.view};
        return maps;
    }
    bare.metres = 0;
    add_cube_views(maps, input, bare, texels);
    return maps;
}

void square(LightViews& maps) {
    for (GnLightView& view : maps.views) {
        view = squared(view);
    }
}

/// Maps around what the camera sees. Those of the frame before stay while they show as much; where they do not, maps around
/// all that the light reaches follow, so that they then can stay.
LightViews whole_maps(const FrameInput& input, const Guard& guard, const Atlas& atlas,
                      const adaptive::KeptTree* before) {
    LightViews maps = maps_around(potential_receivers(input), input, guard, atlas);
    if (before != nullptr) {
        if (adaptive::serves(*before, maps)) {
            maps.views = before->maps;
            maps.kind = before->kind;
            return maps;
        }
        maps = maps_around(lit_bounds(input), input, guard, atlas);
    }
    square(maps);
    return maps;
}

/// Whose demands count, and for what: each pixel's, twice as much for every level that it lacks, since its error doubles; some
/// pixels', for all that lies at their place; or the number of pixels in a tile of a grid.
void set_demands(GnTreeConstants& t, const GnAdaptiveParams& params, uvec2 size) {
    t.growth = params.mode == GN_ADAPTIVE_TILED ? 1.0F : 2.0F;
    t.data.leaves = params.mode == GN_ADAPTIVE_FVSM || params.mode == GN_ADAPTIVE_TILED ? 1 : 0;
    t.spare = std::max(0, static_cast<int>(std::floor(std::log2(params.density))));
    t.start = std::min(params.start, t.data.levels);
    t.limit = std::min(params.start + params.rounds, t.data.levels);
    if (params.mode == GN_ADAPTIVE_QVSM) {
        // What changes nothing is fine enough, however large its texels are.
        t.data.density = 1e30F;
        t.threshold = static_cast<int>(std::floor(params.threshold * static_cast<float>(size.x * size.y)));
    }
    t.grid = params.mode == GN_ADAPTIVE_TILED ? std::min(params.grid, t.data.levels) : -1;
    const auto most = static_cast<int>(std::max(size.x, size.y));
    t.step = params.mode == GN_ADAPTIVE_FVSM ? (most + params.prepass - 1) / params.prepass : 1;
    const uint step = static_cast<uint>(t.step);
    t.size = (size + (step - step / 2 - 1)) / step;
}

GnTreeConstants constants_of(const FrameInput& input, const Recipe& recipe, const LightViews& maps, const Guard& guard,
                             const Atlas& atlas) {
    const auto params = recipe.of<GnAdaptiveParams>("adaptive");
    GnTreeConstants t{};
    t.light = input.whole_light().shape;
    t.count = static_cast<int>(maps.views.size());
    t.data.eye_ws = t.count > 1 ? vec4(vec3(input.light().shape.position_ws), 1) : vec4(0);
    t.data.levels = t.count > 1 ? params.levels - 1 : params.levels;
    t.data.texels = static_cast<float>(atlas.texels());
    t.data.density = params.density;
    t.data.reach_ws = guard.metres;
    t.data.reach_texels = static_cast<float>(atlas.reach);
    std::copy(maps.views.begin(), maps.views.end(), std::begin(t.maps));
    t.nodes = t.count * glsl::gn_adaptive_before(t.data.levels + 1);
    t.blocks = (t.nodes + GN_TREE_BLOCK - 1) / GN_TREE_BLOCK;
    t.tiles = atlas.tiles;
    t.tile = atlas.tile;
    t.across = atlas.across;
    t.resolution = recipe.resolution;
    if (input.history != nullptr) {
        t.jitter = params.jitter * glsl::gn_jitter(static_cast<std::uint32_t>(input.history->frame()));
    }
    set_demands(t, params, uvec2(input.samples.width, input.samples.height));
    return t;
}

/// Says, when the frame's answer comes, whose texels are larger than they should be.
void tell_coarser(const FrameInput& input, const GnTreeConstants& t, BufferHandle counts) {
    input.graph.answer(counts, [t, name = input.light().name,
                                remarks = input.late_remarks](std::span<const std::byte> bytes) {
        GnTreeCounts c;
        std::memcpy(&c, bytes.data(), sizeof c);
        if (remarks == nullptr) {
            return;
        }
        if (c.coarser > 0) {
            remarks->insert(fmt::format(
                "placement 'adaptive' has {} tiles of {} x {} texels for light '{}', too few for {:.2g} % of its view "
                "samples, whose texels are larger than a pixel; more adaptive.maps or a larger resolution make them "
                "finer",
                t.tiles, t.tile, t.tile, name, 100.0 * c.coarser / c.samples));
        }
        // A few in each picture are always grazed.
        if (c.steep > c.samples / 256) {
            remarks->insert(
                fmt::format("the finest tiles of placement 'adaptive' have texels larger than a pixel for {:.2g} % of "
                            "the view samples "
                            "of light '{}'; more adaptive.levels or a larger adaptive.tile make them finer",
                            100.0 * c.steep / c.samples, name));
        }
    });
}

/// The atlas, and what is known of its views.
LightViews atlas_views(const FrameInput& input, const Recipe& recipe, const GnTreeConstants& constants,
                       const LightViews& maps) {
    LightViews views;
    views.part = &recipe.placement_for(input.whole_light().shape);
    views.kind = maps.kind;
    views.resolution = static_cast<std::uint32_t>(recipe.resolution);
    views.layers = static_cast<std::uint32_t>(recipe.of<GnAdaptiveParams>("adaptive").maps);
    views.tiles = true;
    GnLightView unknown;
    unknown.resolution = static_cast<float>(recipe.resolution);
    // Shaders are composed for lists of views that are short, and whether a kernel has a radius in metres is a scene's affair: none
    // is that short.
    views.views.assign(static_cast<std::size_t>(std::max(constants.tiles, fewest_views)), unknown);
    views.set_data(constants.data);
    return views;
}

/// What the GPU makes of them.
void lend(LightViews& views, const adaptive::TreeTiles& made, const LightViews& maps) {
    views.buffer = made.views;
    views.count = made.count;
    views.tables = {{.name = "pages", .type = "uint", .buffer = made.pages, .bytes = {}},
                    {.name = "rows", .type = "vec4", .buffer = {}, .bytes = bytes_of(clip_rows(maps.views))}};
}

LightViews place_adaptive(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnAdaptiveParams>("adaptive");
    const Guard guard = guard_of(input, recipe);
    const Atlas atlas = choose_atlas(recipe, params, guard);
    if (atlas.texels() < atlas.tile / 4 || atlas.texels() < 1 || params.tile > recipe.resolution) {
        refuse(
            "placement 'adaptive' needs {} texels on each side of a tile of {} for what kernels reach; use an "
            "adaptive.tile "
            "of at least {}, or 0, which chooses one, and a resolution not below it",
            atlas.border, atlas.tile, std::bit_ceil(static_cast<unsigned>(4 * atlas.border)));
    }
    adaptive::KeptTree tree = adaptive::tree_of(input);
    tree.tile = atlas.tile;
    tree.border = atlas.border;
    tree.tiles = atlas.tiles;
    tree.levels = params.levels;
    const bool keeps = adaptive::keeps_tiles(recipe);
    const LightViews maps =
        whole_maps(input, guard, atlas, keeps ? adaptive::tree_before(input, recipe, tree) : nullptr);
    if (static_cast<std::size_t>(atlas.tiles) < maps.views.size()) {
        refuse(
            "placement 'adaptive' looks at light '{}' by {} maps, and its budget holds {} tiles; use more "
            "adaptive.maps, a "
            "smaller adaptive.tile or a larger resolution",
            input.light().name, maps.views.size(), atlas.tiles);
    }
    const GnTreeConstants constants = constants_of(input, recipe, maps, guard, atlas);
    tree.maps = maps.views;
    tree.kind = maps.kind;
    const adaptive::Keeping keeping = keeps ? adaptive::keep_tree(input, recipe, std::move(tree)) : adaptive::Keeping{};
    BufferHandle counts;
    const adaptive::TilesOf tiles_of = [&](const GnTreeConstants& t, BufferHandle changed, int round) {
        LightViews views = atlas_views(input, recipe, t, maps);
        const std::optional<adaptive::KeptTiles> kept =
            keeps ? std::optional(adaptive::kept_tiles(input, keeping, views, round)) : std::nullopt;
        const adaptive::TreeTiles made = adaptive::add_tree(input, t, changed, kept ? &*kept : nullptr);
        lend(views, made, maps);
        if (keeps) {
            adaptive::keep_views(input, keeping, made, round, views);
        }
        counts = made.counts;
        return views;
    };
    const bool refines = params.mode == GN_ADAPTIVE_ASM || params.mode == GN_ADAPTIVE_QVSM;
    const BufferHandle changed =
        refines ? adaptive::add_refinement(input, recipe, constants, constants.limit - constants.start,
                                           params.mode == GN_ADAPTIVE_ASM, tiles_of)
                : BufferHandle{};
    LightViews views = tiles_of(constants, changed, -1);
    if (input.parent == nullptr) {
        tell_coarser(input, constants, counts);
    }
    return views;
}

ParamTable rows() {
    return param_table<GnAdaptiveParams>({
        GN_CHOICE(
            GnAdaptiveParams, mode,
            "What tiles follow: what each pixel asks for (rmsm), what a small picture's pixels ask for around them "
            "(fvsm), how many pixels lie in each tile of a grid (tiled), edges that the samples see in coarser tiles "
            "(asm), or whether finer tiles change what they see (qvsm).",
            "rmsm", "fvsm", "tiled", "asm", "qvsm"),
        GN_PARAM(GnAdaptiveParams, maps, integer, 1, 64, "maps",
                 "The budget: so many maps of the recipe's resolution hold all tiles. Over it tiles become coarser "
                 "where that shows least."),
        GN_PARAM(GnAdaptiveParams, tile, integer, 0, 8192, "texels",
                 "Side of a tile with its border: smaller ones follow the picture closer and spend more on borders and "
                 "draws; 0 takes 128, 256 for kernels with a radius in metres, and less where the budget holds few."),
        GN_PARAM(GnAdaptiveParams, levels, integer, 0, 10, "",
                 "How often tiles may be halved, one less around a light that receivers surround: more serve pixels "
                 "that see a sliver of a large map, at four times the nodes."),
        GN_PARAM(GnAdaptiveParams, density, real, 0.01, 64, "texels",
                 "How many texels a pixel asks for along its side: fewer need less of the budget, and steps show."),
        GN_PARAM(GnAdaptiveParams, prepass, integer, 16, 8192, "pixels",
                 "With fvsm: the longer side of the picture whose pixels are asked; what lies between them is missed."),
        GN_PARAM(GnAdaptiveParams, grid, integer, 0, 8, "",
                 "With tiled: the map is cut into two to this power tiles along each side, each of one resolution."),
        GN_PARAM(GnAdaptiveParams, start, integer, 0, 8, "",
                 "With asm and qvsm: the level that every sample gets; what its tiles miss nothing finds."),
        GN_PARAM(GnAdaptiveParams, rounds, integer, 0, 8, "",
                 "With asm and qvsm: levels that are drawn and looked at, one after the other, each at a map's cost."),
        GN_PARAM(GnAdaptiveParams, threshold, real, -1, 1, "of the picture",
                 "With qvsm: pixels that the last refinement must have changed in a tile for the next one; -1 refines "
                 "always."),
        GN_CHOICE(
            GnAdaptiveParams, kept,
            "What outlives a frame of a sequence: nothing; tiles that are still asked for and in which no caster "
            "moved, which are not drawn again; or only their places in the atlas, all drawn anew, as a measure for "
            "the former.",
            "none", "tiles", "places"),
        GN_PARAM(
            GnAdaptiveParams, jitter, real, 0, 1, "texels",
            "Moves all tiles from frame to frame of a sequence within so many of their texels: visibility=temporal "
            "gathers what lies between texels, without it edges tremble; no tile is kept."),
    });
}

std::string remark(const Scene&, const Recipe& recipe) {
    return adaptive::why_not_kept(recipe);
}

}  // namespace
}  // namespace gn::adaptive

namespace gn::parts {

const Part& placement_adaptive() {
    using namespace gn::adaptive;
    static const Part part = [] {
        Part p;
        p.id = "adaptive";
        p.stage = Stage::placement;
        p.title = "Tiles at the resolution that the picture asks for";
        p.citation = "LSO07";
        p.params = rows();
        p.params_type = "GnAdaptiveParams";
        p.data_type = "GnAdaptiveData";
        p.glsl = "shadow/placement/adaptive/adaptive.glsl";
        p.place = place_adaptive;
        p.remark = remark;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
