// SPDX-License-Identifier: MIT
// A penumbra around the hard shadow, from one ray: how near to an edge it passes on its way to the light's centre.
//
// Based on: Parker, Shirley, Smits. Single Sample Soft Shadows. University of Utah, UUCS-98-019, 1998. [PSS98]
// Departs from it: edges are the silhouettes of the casters, not hulls around spheres and triangles.
#include "shadow/direct/single_sample/single_sample.h"

#include "shadow/geometry/edge_regions.h"

namespace gn::parts::single_sample {
namespace {

Visibility add_single_sample(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnSingleSampleParams>("single-sample");
    HardShadow hard = add_hard_shadow(input, params.closed != 0);
    if (!has_extent(input.light().shape)) {
        add_edge_sides(input, hard.buffers, 2, hard.visibility);
        return hard.visibility;
    }
    EdgeRegionPass pass{.name = "single-sample: edges",
                        .includes = "#include \"shadow/direct/single_sample/single_sample.glsl\"\n",
                        .fragment = "    result = gn_single_sample_tau(u.light, p_ws, a_ws, b_ws);\n",
                        .blend = Blend::min,
                        .growth = 2};
    pass.extra.constant("GnLight", "light", input.light().shape);
    const TextureHandle tau = input.graph.create(TextureDesc{.name = "single-sample tau",
                                                             .format = VK_FORMAT_R32_SFLOAT,
                                                             .width = input.samples.width,
                                                             .height = input.samples.height});
    add_edge_regions(input, hard.buffers, pass, tau, {.color = vec4(1)});
    Visibility result = add_edge_resolve(
        input, hard.visibility.image, tau,
        {.name = "single-sample: resolve",
         .includes = "#include \"shadow/direct/single_sample/single_sample.glsl\"\n",
         .expression = params.profile == GN_SINGLE_SAMPLE_SINE ? "hard * gn_single_sample_light(soft, 0)"
                                                               : "hard * gn_single_sample_light(soft, 1)"});
    add_edge_sides(input, hard.buffers, 2, result);
    return result;
}

}  // namespace
}  // namespace gn::parts::single_sample

namespace gn::parts {

const Part& direct_single_sample() {
    using namespace single_sample;
    static const Part part = [] {
        Part p;
        p.id = "single-sample";
        p.stage = Stage::direct;
        p.title = "Single sample soft shadows";
        p.citation = "PSS98";
        p.features = {Feature::float32_blend};
        p.needs_scene = true;
        p.sides = edge_sides();
        p.params = param_table<GnSingleSampleParams>({
            GN_CHOICE(GnSingleSampleParams, profile, "How light rises across the penumbra; both are nearly a disc's.",
                      "sine", "cubic"),
            GN_PARAM(GnSingleSampleParams, closed, boolean, 0, 1, "",
                     "Solids cast with the half of their surface that light meets first; off counts every triangle."),
        });
        p.params_type = "GnSingleSampleParams";
        p.glsl = "shadow/direct/single_sample/single_sample.glsl";
        p.add_direct = add_single_sample;
        p.remark = [](const Scene& scene, const Recipe&) { return remark_silhouettes(scene, "single-sample"); };
        return p;
    }();
    return part;
}

}  // namespace gn::parts
