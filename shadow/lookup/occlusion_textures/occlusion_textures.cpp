// SPDX-License-Identifier: MIT
// Occlusion textures: slices of the scene, flattened and prefiltered, whose soft shadows are multiplied.
//
// Based on: Eisemann, Decoret. Plausible Image Based Soft Shadows Using Occlusion Textures. SIBGRAPI 2006. [ED06]
// Stands on: shadow/receiver/light_extent.glsl (the light as a receiver sees it),
// shadow/lookup/pcss (a texel of the map as its kernels read it)
#include "shadow/lookup/occlusion_textures/occlusion_textures.h"

#include "shadow/recipe/light_guard.h"
#include "shadow/recipe/recipe.h"

#include <array>

namespace gn::parts::occlusion_textures {
namespace {

constexpr int least_slices = 4;
constexpr int most_slices = 16;

Guard guard(const Recipe&, const Light& light, const Box& bounds_ws) {
    return light_guard(light, bounds_ws, 0);
}

/// "slice-n-buffers-8" and so on.
std::string_view slices_name(const GnOcclusionTexturesParams& params) {
    static constexpr std::array<std::string_view, 3> filters{"slice-n-buffers", "summed-slices", "mip-slices"};
    static const std::array<std::array<std::string, most_slices + 1>, 3> names = [] {
        std::array<std::array<std::string, most_slices + 1>, 3> made;
        for (std::size_t f = 0; f < made.size(); ++f) {
            for (std::size_t i = 0; i < made.at(f).size(); ++i) {
                made.at(f).at(i) = fmt::format("{}-{}", filters.at(f), i);
            }
        }
        return made;
    }();
    return names.at(static_cast<std::size_t>(params.filter_by)).at(static_cast<std::size_t>(params.slices));
}

std::vector<std::string_view> needs_for(const Recipe& recipe) {
    return {"depth", slices_name(recipe.of<GnOcclusionTexturesParams>("occlusion-textures"))};
}

ParamTable rows() {
    return param_table<GnOcclusionTexturesParams>({
        GN_PARAM(GnOcclusionTexturesParams, slices, integer, least_slices, most_slices, "",
                 "Slices between the light and the farthest receiver: truer widths and shadows that begin nearer to "
                 "what casts "
                 "them, cost and memory in proportion."),
        GN_CHOICE(GnOcclusionTexturesParams, filter_by,
                  "What gives the mean over a rectangle: squares of 2^l texels anywhere, which overlap in between; "
                  "tables of sums, "
                  "which are exact and four times as dear to read; or mips, which are blocky.",
                  "n-buffers", "sums", "mips"),
        GN_PARAM(GnOcclusionTexturesParams, cells, integer, 1, 8, "",
                 "Cells along the light's sides, each a rectangle of the map: discs, and rectangles that the map sees "
                 "askew, take the shape of their cells; cost grows with the square."),
        GN_CHOICE(GnOcclusionTexturesParams, fusion,
                  "What slices hide together: the sum of what each hides, the greatest, the middle of these two, "
                  "between which "
                  "the truth lies, or the product of what they leave.",
                  "sum", "max", "mean", "product"),
    });
}

}  // namespace
}  // namespace gn::parts::occlusion_textures

namespace gn::parts {

const Part& lookup_occlusion_textures() {
    using namespace occlusion_textures;
    static const Part part = [] {
        Part p;
        p.id = "occlusion-textures";
        p.stage = Stage::lookup;
        p.title = "Occlusion textures";
        p.citation = "ED06";
        p.needs = {"depth", "slice-n-buffers-8"};
        p.needs_for = needs_for;
        p.params = rows();
        p.params_type = "GnOcclusionTexturesParams";
        p.glsl = "shadow/lookup/occlusion_textures/occlusion_textures.glsl";
        p.guard = guard;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
