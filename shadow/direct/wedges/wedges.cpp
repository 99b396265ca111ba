// SPDX-License-Identifier: MIT
// The hard shadow of the light's centre, and a wedge of penumbra around each silhouette edge.
//
// Based on: Akenine-Moller, Assarsson. Approximate Soft Shadows on Arbitrary Surfaces Using Penumbra Wedges. EGWR 2002. [AA02]
// Departs from it: the sample itself is asked, so that nothing is counted at the wedges' front and back planes.
#include "shadow/direct/wedges/wedges.h"

#include "shadow/geometry/edge_regions.h"

namespace gn::parts::wedges {
namespace {

Visibility add_wedges(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnWedgesParams>("wedges");
    HardShadow hard = add_hard_shadow(input, params.closed != 0);
    if (!has_extent(input.light().shape)) {
        add_edge_sides(input, hard.buffers, 1.5F, hard.visibility);
        return hard.visibility;
    }
    EdgeRegionPass pass{
        .name = "wedges: wedges",
        .includes = "#include \"shadow/direct/wedges/wedges.glsl\"\n",
        .fragment = "    result = gn_wedge_hidden(gn_wedge(u.light, a_ws, b_ws, u.params.turn), p_ws);\n",
        .growth = 1.5F};
    pass.extra.constant("GnLight", "light", input.light().shape).constant("GnWedgesParams", "params", params);
    // 16 bits hold what is summed, as [AA02] section 4 does: every step is at most a half.
    const TextureHandle hidden = input.graph.create(TextureDesc{.name = "wedges hidden",
                                                                .format = VK_FORMAT_R16_SFLOAT,
                                                                .width = input.samples.width,
                                                                .height = input.samples.height});
    add_edge_regions(input, hard.buffers, pass, hidden, {});
    Visibility result = add_edge_resolve(input, hard.visibility.image, hidden,
                                         {.name = "wedges: resolve", .includes = "", .expression = "hard - soft"});
    add_edge_sides(input, hard.buffers, 1.5F, result);
    return result;
}

}  // namespace
}  // namespace gn::parts::wedges

namespace gn::parts {

const Part& direct_wedges() {
    using namespace wedges;
    static const Part part = [] {
        Part p;
        p.id = "wedges";
        p.stage = Stage::direct;
        p.title = "Penumbra wedges";
        p.citation = "AA02";
        p.features = {Feature::float32_blend};
        p.needs_scene = true;
        p.sides = edge_sides();
        p.params = param_table<GnWedgesParams>({
            GN_CHOICE(GnWedgesParams, turn,
                      "asin touches the sphere around the light; atan is exact for a rectangle above a parallel edge.",
                      "asin", "atan"),
            GN_PARAM(GnWedgesParams, closed, boolean, 0, 1, "",
                     "Solids cast with the half of their surface that light meets first; off counts every triangle."),
        });
        p.params_type = "GnWedgesParams";
        p.glsl = "shadow/direct/wedges/wedges.glsl";
        p.add_direct = add_wedges;
        p.remark = [](const Scene& scene, const Recipe&) { return remark_silhouettes(scene, "wedges"); };
        return p;
    }();
    return part;
}

}  // namespace gn::parts
