// SPDX-License-Identifier: MIT
// Based on: Fernando, Fernandez, Bala, Greenberg. Adaptive Shadow Maps. SIGGRAPH 2001. [FFBG01]
// Departs from it: tiles in which a caster moved are drawn in the frame that shows them.
#include "shadow/placement/adaptive/kept_tiles.h"

#include "shadow/casters/kept_map.h"
#include "shadow/casters/moved.h"
#include "shadow/casters/pages.h"
#include "shadow/frame/history.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace gn::adaptive {
namespace {

/// Boxes that are told one by one; of more the one around all.
constexpr std::size_t most_boxes = 64;

/// What is made of a map's depths as an image; whatever else is drawn of all views, which kept ones are not.
constexpr std::array<std::string_view, 6> images{"depth",        "min-max",   "block-min-max",
                                                 "lower-planes", "n-buffers", "coarse-n-buffers"};

std::string tree_name(const FrameInput& input, const Recipe& recipe) {
    return fmt::format("tiles of light {} {}{}", input.light_id, recipe.name, input.translucent ? " translucent" : "");
}

std::string atlas_name(const Keeping& keeping, int round) {
    return round < 0 ? keeping.name : fmt::format("{} round {}", keeping.name, round);
}

bool same_maps(const std::vector<GnLightView>& a, const std::vector<GnLightView>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(GnLightView)) == 0;
}

/// Whether a view shows all that another does, but for what rounding moves.
bool shows(const GnLightView& view, const GnLightView& other) {
    constexpr float slack = 1e-4F;
    for (int corner = 0; corner < 8; ++corner) {
        const vec4 seen_cs((corner & 1) * 2 - 1, (corner & 2) - 1, corner / 4, 1);
        vec4 p_ws = other.ws_from_cs * seen_cs;
        p_ws /= p_ws.w;
        const vec4 p_cs = view.cs_from_ws * p_ws;
        const float depth = glm::dot(view.depth_from_ws, p_ws);
        if (!(p_cs.w > 0) || std::max(std::abs(p_cs.x), std::abs(p_cs.y)) > (1 + slack) * p_cs.w || depth < -slack ||
            depth > 1 + slack) {
            return false;
        }
    }
    return true;
}

}  // namespace

std::string why_not_kept(const Recipe& recipe) {
    if (recipe.of<GnAdaptiveParams>("adaptive").kept == GN_ADAPTIVE_NONE || recipe.map == nullptr) {
        return {};
    }
    if (recipe.of<GnAdaptiveParams>("adaptive").jitter > 0) {
        return "adaptive.jitter moves all tiles of placement 'adaptive' in every frame, and all are drawn in every "
               "frame; adaptive.jitter=0 keeps them";
    }
    if (recipe.map->id != "depth") {
        return fmt::format(
            "placement 'adaptive' keeps tiles of depths, and map '{}' stores other things: all tiles are drawn in "
            "every "
            "frame; map = depth keeps them",
            recipe.map->id);
    }
    if (recipe.casters == Casters::midpoint || recipe.casters == Casters::dual || recipe.casters == Casters::ids) {
        return fmt::format(
            "placement 'adaptive' keeps one depth a texel, and casters = {} draws more: all tiles are drawn in every "
            "frame; casters = auto, all, front or back keeps them",
            name_of(recipe.casters));
    }
    for (const std::string_view need : recipe.lookup != nullptr ? needs_of(recipe) : std::vector<std::string_view>()) {
        if (!holds(images, need)) {
            return fmt::format(
                "placement 'adaptive' keeps depths, and lookup '{}' reads '{}': all tiles are drawn in every frame",
                recipe.lookup->id, need);
        }
    }
    return {};
}

bool keeps_tiles(const Recipe& recipe) {
    return recipe.of<GnAdaptiveParams>("adaptive").kept != GN_ADAPTIVE_NONE && recipe.map != nullptr &&
           why_not_kept(recipe).empty();
}

KeptTree tree_of(const FrameInput& input) {
    KeptTree tree;
    tree.shape = shadow_shape(input.light());
    const Fingerprint casting = casting_of(input.scene, input.light());
    tree.casting = Hasher().value(casting.low).value(casting.high).finish().low;
    tree.version = input.handles.version;
    return tree;
}

const KeptTree* tree_before(const FrameInput& input, const Recipe& recipe, const KeptTree& now) {
    if (input.history == nullptr || input.parent != nullptr) {
        return nullptr;
    }
    const KeptTree* const before = input.history->before<KeptTree>(tree_name(input, recipe));
    const bool alike = before != nullptr && same_shape(before->shape, now.shape) && before->tile == now.tile &&
                       before->border == now.border && before->tiles == now.tiles && before->levels == now.levels;
    return alike ? before : nullptr;
}

bool serves(const KeptTree& before, const LightViews& fitted) {
    bool all = before.maps.size() == fitted.views.size();
    for (std::size_t i = 0; all && i < before.maps.size(); ++i) {
        all = shows(before.maps[i], fitted.views[i]);
    }
    return all;
}

Keeping keep_tree(const FrameInput& input, const Recipe& recipe, KeptTree now) {
    Keeping keeping;
    keeping.name = tree_name(input, recipe);
    keeping.redrawn = recipe.of<GnAdaptiveParams>("adaptive").kept == GN_ADAPTIVE_PLACES;
    if (input.history == nullptr || input.parent != nullptr) {
        return keeping;
    }
    keeping.history = input.history;
    const KeptTree* const before = tree_before(input, recipe, now);
    if (before != nullptr && before->casting == now.casting && same_maps(before->maps, now.maps)) {
        const std::optional<std::vector<Box>> moved = moved_since(input.handles, before->version, most_boxes);
        keeping.follows = moved.has_value();
        for (const Box& box : moved.value_or(std::vector<Box>())) {
            keeping.boxes_ws.emplace_back(box.centre(), 0);
            keeping.boxes_ws.emplace_back(0.5F * box.extent(), 0);
        }
    }
    input.history->leave(keeping.name, std::move(now));
    return keeping;
}

KeptTiles kept_tiles(const FrameInput& input, const Keeping& keeping, const LightViews& atlas, int round) {
    const std::string name = atlas_name(keeping, round);
    const auto tiles = static_cast<std::uint32_t>(atlas.views.size());
    const TextureDesc desc{.name = name + ", squares",
                           .format = VK_FORMAT_R32_UINT,
                           .width = std::min<std::uint32_t>(tiles, GN_TREE_ROW),
                           .height = 2 * ((tiles + GN_TREE_ROW - 1) / GN_TREE_ROW),
                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT};
    KeptTiles kept;
    kept.redrawn = keeping.redrawn;
    if (keeping.history == nullptr) {
        kept.now =
            input.graph.create({.name = desc.name, .format = desc.format, .width = desc.width, .height = desc.height});
        return kept;
    }
    const History::Pair pair = keeping.history->pair(desc);
    bool fresh_atlas = false;
    static_cast<void>(keeping.history->texture(page_pool(name, atlas.resolution, atlas.layers), fresh_atlas));
    kept.now = input.graph.import(*pair.now);
    if (pair.before != nullptr) {
        kept.before = input.graph.import(*pair.before);
    }
    kept.fresh = !keeping.follows || pair.before == nullptr || fresh_atlas;
    kept.boxes_ws = keeping.boxes_ws;
    return kept;
}

void keep_views(const FrameInput& input, const Keeping& keeping, const TreeTiles& made, int round, LightViews& views) {
    const std::string name = atlas_name(keeping, round);
    views.kept = KeptViews{.history = keeping.history, .name = name, .layers = {}};
    views.tables.push_back(
        {.name = std::string(drawn_pages_table), .type = "GnLightView", .buffer = made.drawn, .bytes = {}});
    if (keeping.history != nullptr) {
        const std::shared_ptr<std::uint32_t> drawn = keeping.history->answered(name + ", drawn");
        input.graph.answer(made.count,
                           [drawn](std::span<const std::byte> bytes) { std::memcpy(drawn.get(), bytes.data(), 4); });
    }
}

}  // namespace gn::adaptive
