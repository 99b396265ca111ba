// SPDX-License-Identifier: MIT
// Soft shadows by projecting what a map holds back onto the light.
//
// Based on: Guennebaud, Barthe, Paulin. Real-time Soft Shadow Mapping by Backprojection. EGSR 2006. [GBP06]
//
// Also here: area.glsl, bitmask.glsl, contours.glsl, cover.glsl, light_plane.glsl, patches.glsl, quads.glsl, search.glsl.
// Also here: texels.glsl, sparse.h, sparse.cpp, sparse.glsl, emission.h, emission.cpp, emission.glsl,
// Also here: emission_test.cpp, packets.h, packets.cpp, packets.glsl,
// Also here: packet_pass.glsl, packets_test.cpp, occluders_test.cpp.
#include "shadow/lookup/backprojection/backprojection.h"
#include "shadow/lookup/backprojection/emission.h"
#include "shadow/lookup/backprojection/light_plane.glsl"
#include "shadow/lookup/backprojection/packets.h"
#include "shadow/lookup/backprojection/sparse.h"

#include "shadow/frame/frame.h"
#include "shadow/recipe/part.h"
#include "shadow/recipe/recipe.h"
#include "shadow/scene/emission.h"

#include <array>
#include <cmath>
#include <limits>

namespace gn::parts::backprojection {
namespace {

/// A caster's distance matters up to the light itself. How far penumbrae reach is known of suns: what the scene's height
/// allows. Under lamps views are widened by the light's own size.
Guard guard(const Recipe& recipe, const Light& light, const Box& bounds_ws) {
    const auto params = recipe.of<GnBackprojectionParams>("backprojection");
    const GnLight& shape = light.shape;
    if (!glsl::gn_back_has_size(shape) && params.least == 0) {
        return {};
    }
    if (shape.kind != GN_LIGHT_DIRECTIONAL) {
        const float size =
            shape.kind == GN_LIGHT_RECTANGLE ? std::max(shape.half_size.x, shape.half_size.y) : shape.radius;
        return {.texels = params.least + 2, .metres = size, .before = std::numeric_limits<float>::infinity()};
    }
    const float height = glm::dot(bounds_ws.extent(), glm::abs(vec3(shape.direction_ws)));
    return {.texels = params.least + 2, .metres = std::tan(shape.angular_radius) * height, .before = height};
}

std::vector<std::string_view> needs_for(const Recipe& recipe) {
    static constexpr std::array<std::string_view, 8> peeled{"depth",    "depth",    "peeled-2", "peeled-3",
                                                            "peeled-4", "peeled-5", "peeled-6", "peeled-7"};
    const auto params = recipe.of<GnBackprojectionParams>("backprojection");
    const bool levels = params.pyramid == GN_BACK_HSM || params.pyramid == GN_BACK_YSM;
    return {"depth", levels ? "min-max" : "depth",
            params.pyramid == GN_BACK_MSSM  ? "n-buffers"
            : params.pyramid == GN_BACK_YSM ? "coarse-n-buffers"
                                            : "depth",
            peeled.at(static_cast<std::size_t>(params.layers))};
}

std::string prologue(const Recipe& recipe) {
    const auto params = recipe.of<GnBackprojectionParams>("backprojection");
    return fmt::format(
        "#define GN_BACK_OCCLUDER {}\n#define GN_BACK_COMBINE {}\n#define GN_BACK_PYRAMID {}\n"
        "#define GN_BACK_LAYERS {}\n#define GN_BACK_FUSION {}\n#define GN_BACK_CORNERS {}\n",
        params.occluder, params.combine, params.pyramid, params.layers, params.fusion, params.corners);
}

std::string footprint_prologue(const Recipe& recipe) {
    return prologue(recipe) + "#define GN_BACK_FOOTPRINT\n";
}

std::string emission_prologue(const Recipe& recipe) {
    return prologue(recipe) + "#define GN_BACK_EMISSION\n";
}

std::vector<std::string_view> needs_emission(const Recipe& recipe) {
    std::vector<std::string_view> needs = needs_for(recipe);
    needs.emplace_back("emission");
    return needs;
}

/// The part as the shared resolve pass runs it.
Part pass_of(const Part& part, std::string (*with)(const Recipe&)) {
    Part pass = part;
    pass.add_lookup = nullptr;
    pass.prologue = with;
    return pass;
}

/// V with three channels: of what the light's picture sends in each colour the share that arrives.
Visibility add_coloured(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map) {
    static const Part coloured = [&] {
        Part pass = pass_of(*recipe.lookup, emission_prologue);
        pass.needs_for = needs_emission;
        pass.channels = 3;
        return pass;
    }();
    ShadowMap with_emission = map;
    with_emission.offers.push_back({"emission", add_emission(input), nearest()});
    Recipe told = recipe;
    told.lookup = &coloured;
    return add_resolve(input, told, views, with_emission);
}

Visibility add_lookup(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map) {
    static const Part footprint = pass_of(*recipe.lookup, footprint_prologue);
    static const Part lookup = pass_of(*recipe.lookup, prologue);
    // What is told beside V, and objects, are of every sample; a light without size has no penumbrae.
    const auto params = recipe.of<GnBackprojectionParams>("backprojection");
    const bool sized = glsl::gn_back_has_size(input.light().shape) || params.least > 0;
    if (shows_picture(input) && params.combine == GN_BACK_BITMASK) {
        return add_coloured(input, recipe, views, map);
    }
    if (params.packet > 1 && params.occluder == GN_BACK_CONTOUR && params.layers == 1 && params.sparse == 0 &&
        params.least == 0 && sized && input.sides.empty() && recipe.casters != Casters::ids) {
        return add_packets(input, recipe, views, map, needs_for(recipe), prologue(recipe));
    }
    if (params.sparse == 0 || !sized || !input.sides.empty() || recipe.casters == Casters::ids) {
        return add_resolve(input, recipe, views, map);
    }
    return add_sparse(input, recipe, views, map, footprint, lookup);
}

/// Searches that nothing limits may be longer than a driver lets loops run, which it does not tell.
std::string remark(const Scene&, const Recipe& recipe) {
    const auto params = recipe.of<GnBackprojectionParams>("backprojection");
    const bool unlimited = params.budget == 0 || params.layers > 1 || params.pyramid == GN_BACK_NONE;
    if (!unlimited || recipe.resolution <= 256) {
        return {};
    }
    return fmt::format(
        "lookup 'backprojection' reads every texel between a receiver and the light where {}; software drivers end "
        "such a loop "
        "after 65,536 texels and do not say so, and V is wrong there: resolution=256 stays below",
        params.layers > 1    ? "layers are peeled"
        : params.budget == 0 ? "budget is 0"
                             : "pyramid is none");
}

std::string refuses(const Scene&, const Light& light, const Recipe& recipe) {
    const auto params = recipe.of<GnBackprojectionParams>("backprojection");
    const Part& placement = recipe.placement_for(light.shape);
    if (placement.bends) {
        return fmt::format(
            "lookup 'backprojection' projects straight edges and placement '{}' bends them; take placement=cube or "
            "placement=fit",
            placement.id);
    }
    if (params.layers > 1 && params.fusion == GN_BACK_UNION && params.combine == GN_BACK_AREA) {
        return "areas of several layers cannot be united; backprojection.fusion=sum adds them, "
               "backprojection.combine=bitmask unites them";
    }
    const bool united = params.layers == 1 || params.fusion == GN_BACK_UNION || params.fusion == GN_BACK_FARTHEST;
    if (gn_emission_texture(light.shape) >= 0 && params.combine == GN_BACK_BITMASK && !united) {
        return fmt::format(
            "shares of several layers do not say which part of the picture of light '{}' they hide; "
            "backprojection.fusion=union or farthest does",
            light.name);
    }
    if (params.pyramid == GN_BACK_MSSM && recipe.resolution > 1024) {
        return fmt::format(
            "backprojection.pyramid=mssm keeps every level at full size and takes maps of up to 1024 texels, not {}; "
            "backprojection.pyramid=ysm takes any",
            recipe.resolution);
    }
    return {};
}

ParamTable rows() {
    return param_table<GnBackprojectionParams>({
        GN_CHOICE(GnBackprojectionParams, occluder,
                  "What stands for texels: patches across the view, quads between the centres of four texels that all "
                  "hide the light, triangles of three besides, patches fitted to finer texels, or outlines of all that "
                  "touch.",
                  "micropatch", "microquad", "microtri", "microrect", "contour"),
        GN_CHOICE(GnBackprojectionParams, combine,
                  "How occluders are united: by the areas that they hide, which add up to too much where they overlap, "
                  "or by 256 points of the light, each hidden or not.",
                  "area", "bitmask"),
        GN_CHOICE(GnBackprojectionParams, pyramid,
                  "What narrows the search: nothing, so that all of the map before the receiver's pyramid is read; a "
                  "pyramid of least and greatest depths; these of squares anywhere, at the cost of memory; or both.",
                  "none", "hsm", "mssm", "ysm"),
        GN_PARAM(GnBackprojectionParams, refine, integer, 0, 8, "",
                 "How often the searched area is narrowed by the nearest depth found in it."),
        GN_PARAM(GnBackprojectionParams, early_out, boolean, 0, 1, "",
                 "Ends the search where least and greatest depth say that all of the light is seen, or none: V stays "
                 "the same where occluders leave no gaps."),
        GN_PARAM(
            GnBackprojectionParams, budget, integer, 0, 65536, "texels",
            "Texels that a receiver reads at most: beyond them it takes a coarser level of the pyramid; 0 is no limit. "
            "With `blend` the finer of two levels has up to four times as many."),
        GN_PARAM(GnBackprojectionParams, blend, boolean, 0, 1, "",
                 "Blends two levels, so that no step shows where the level changes; costs both."),
        GN_PARAM(
            GnBackprojectionParams, corners, boolean, 0, 1, "",
            "Quads stand between the corners of texels and not between their centres: casters are not half a texel "
            "too narrow, and what is one texel thin is not lost."),
        GN_PARAM(GnBackprojectionParams, level_bias, real, 0, 16, "texels",
                 "Texels of the coarser level over which the receiver's plane is lowered: less leaves acne, more loses "
                 "contacts."),
        GN_PARAM(GnBackprojectionParams, least, real, 0, 16, "texels",
                 "Half width of the narrowest penumbra: below one the map's texels show at contacts."),
        GN_PARAM(GnBackprojectionParams, gaps, boolean, 0, 1, "",
                 "Closes gaps between patches of different depth; without it light leaks through slanted casters."),
        GN_PARAM(GnBackprojectionParams, gap_limit, real, 0, 1000, "m",
                 "Only gaps of up to so much depth are closed, by walls and by quads; 0 closes all."),
        GN_PARAM(
            GnBackprojectionParams, layers, integer, 1, 7, "",
            "Surfaces one behind the other that the map holds: more catch casters that others hide from the light's "
            "centre; cost grows with them."),
        GN_CHOICE(GnBackprojectionParams, fusion,
                  "What several layers hide together: the union of their points; of each texel the farthest before the "
                  "receiver alone; or the sum of what each hides, the greatest, the middle between both, or the "
                  "product of what they leave.",
                  "union", "farthest", "sum", "max", "mean", "product"),
        GN_PARAM(GnBackprojectionParams, sparse, integer, 0, 4, "",
                 "Looks up samples of wide penumbrae only so many doublings of a pixel apart, and interpolates the "
                 "others: faster, "
                 "steps and patterns where the guess of the width is wrong; 0 looks up all."),
        GN_PARAM(GnBackprojectionParams, sparse_samples, real, 1, 64, "",
                 "Samples across a penumbra, along a row of the picture, that are kept with `sparse`."),
        GN_PARAM(
            GnBackprojectionParams, packet, integer, 1, 2, "pixels",
            "Side of the squares of pixels that search the map together and find outlines (`contour`) together where "
            "all "
            "find the same: fewer fetches, less that runs side by side. Rests with other occluders, with `layers`, "
            "`sparse` and `least`."),
    });
}

}  // namespace
}  // namespace gn::parts::backprojection

namespace gn::parts {

const Part& lookup_backprojection() {
    using namespace backprojection;
    static const Part part = [] {
        Part p;
        p.id = "backprojection";
        p.stage = Stage::lookup;
        p.title = "Backprojection of a map's texels onto the light";
        p.citation = "GBP06";
        p.needs = {"depth", "min-max"};
        p.needs_for = needs_for;
        p.sides = {
            {"visited-texels", "texels", "How many texels of the map are read for a sample."},
            {"search-class", "", "Why a search ended: 1 all of the light is seen, 2 none of it, 3 texels were read."},
            {"level", "", "How many levels coarser than the map what is read is."}};
        p.params = rows();
        p.params_type = "GnBackprojectionParams";
        p.glsl = "shadow/lookup/backprojection/backprojection.glsl";
        p.add_lookup = add_lookup;
        p.guard = guard;
        p.prologue = prologue;
        p.refuses = refuses;
        p.remark = remark;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
