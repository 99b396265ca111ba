// SPDX-License-Identifier: MIT
// The hard shadow of the light's centre, and for each silhouette edge what it hides of the light beyond, or shows.
//
// Based on: Assarsson, Akenine-Moller. A Geometry-Based Soft Shadow Volume Algorithm Using Graphics Hardware. TOG 2003. [AA03]
// Based on: Forest, Barthe, Paulin. Realistic Soft Shadows by Penumbra-Wedges Blending. Graphics Hardware 2006. [FBP06]
// Departs from it: coverage has a closed form for squares and discs, which the table is made of; wedges are bounded on the
// screen by one rectangle each.
//
// Also here: soft_volumes_table.h, soft_volumes_table.cpp.
#include "shadow/direct/soft_volumes/soft_volumes.h"

#include "gpu/upload.h"
#include "shadow/direct/soft_volumes/soft_volumes_table.h"
#include "shadow/geometry/edge_regions.h"
#include "shadow/recipe/prepared.h"

namespace gn::parts::soft_volumes {
namespace {

constexpr const char* exact_text = R"(
float gn_coverage(vec2 a, vec2 b) { return gn_beyond(u.light.kind == uint(GN_LIGHT_RECTANGLE), a, b); }
)";

constexpr const char* whole_text = R"(
    vec2 a;
    vec2 b;
    float side = gn_soft_volumes_edge(u.light, p_ws, a_ws, b_ws, a, b);
    result = side != 0.0 ? side * gn_coverage(a, b) : 0.0;
)";

constexpr const char* box_text = R"(
    vec2 a;
    vec2 b;
    float side = gn_soft_volumes_edge(u.light, p_ws, a_ws, b_ws, a, b);
    result = side != 0.0 ? gn_soft_volumes_box(u.light.kind == uint(GN_LIGHT_RECTANGLE), a, b) : vec4(1.0);
)";

constexpr const char* quarters_text = R"(
    vec2 a;
    vec2 b;
    float side = gn_soft_volumes_edge(u.light, p_ws, a_ws, b_ws, a, b);
    result = vec4(0.0);
    for (int i = 0; side != 0.0 && i < 4; ++i) {
        vec2 c = a;
        vec2 d = b;
        vec2 signs = vec2((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0);
        result[i] = gn_soft_volumes_quarter(signs, c, d) ? side * gn_coverage(c, d) : 0.0;
    }
)";

/// How the sums become V: GLSL.
std::string expression_of(const GnLight& light, bool quarters, bool bounded) {
    if (bounded) {
        return fmt::format("gn_soft_volumes_bounded(hard, soft, gn_soft_volumes_box_share({}, more))",
                           light.kind == GN_LIGHT_RECTANGLE);
    }
    return quarters ? "gn_soft_volumes_light4(hard, soft)" : "gn_soft_volumes_light(hard, soft)";
}

/// The box around all that edges bound, on the light, a sample.
TextureHandle add_boxes(const FrameInput& input, const VolumeBuffers& buffers) {
    EdgeRegionPass pass{.name = "soft-volumes: boxes",
                        .includes = "#include \"shadow/direct/soft_volumes/soft_volumes.glsl\"\n",
                        .functions = "",
                        .fragment = box_text,
                        .result = "vec4",
                        .extra = {},
                        .blend = Blend::min};
    pass.extra.constant("GnLight", "light", input.light().shape);
    const TextureHandle boxes = input.graph.create(TextureDesc{.name = "soft-volumes boxes",
                                                               .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                               .width = input.samples.width,
                                                               .height = input.samples.height});
    add_edge_regions(input, buffers, pass, boxes, {.color = vec4(1)});
    return boxes;
}

Visibility add_soft_volumes(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnSoftVolumesParams>("soft-volumes");
    const GnLight& light = input.light().shape;
    HardShadow hard = add_hard_shadow(input, params.closed != 0);
    if (!has_extent(light)) {
        add_edge_sides(input, hard.buffers, 1, hard.visibility);
        return hard.visibility;
    }

    // Sum what the edges hide.
    const bool quarters = params.regions == GN_SOFT_VOLUMES_FOUR, table = params.coverage == GN_SOFT_VOLUMES_TABLE;
    EdgeRegionPass pass{.name = "soft-volumes: wedges",
                        .includes = "#include \"shadow/direct/soft_volumes/soft_volumes.glsl\"\n",
                        .functions = table ? soft_volumes_table_text : exact_text,
                        .fragment = quarters ? quarters_text : whole_text,
                        .result = quarters ? "vec4" : "float"};
    pass.extra.constant("GnLight", "light", light);
    if (table) {
        const bool square = light.kind == GN_LIGHT_RECTANGLE;
        const auto buffer = made_once(
            input.prepared, "soft-volumes coverage", static_cast<std::uint64_t>(params.table) * 2 + (square ? 1 : 0),
            [&] { return upload(input.device, "soft-volumes coverage", soft_volumes_table(square, params.table)); });
        input.graph.hold(buffer);
        pass.extra.constant("int", "side", params.table)
            .buffer("readonly buffer", "Coverage", "float coverage[];", input.graph.import(*buffer));
    }
    const TextureHandle hidden =
        input.graph.create(TextureDesc{.name = "soft-volumes hidden",
                                       .format = quarters ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R32_SFLOAT,
                                       .width = input.samples.width,
                                       .height = input.samples.height});
    add_edge_regions(input, hard.buffers, pass, hidden, {});
    const std::string expression = expression_of(light, quarters, params.bounded != 0);
    Visibility result =
        add_edge_resolve(input, hard.visibility.image, hidden,
                         {.name = "soft-volumes: resolve",
                          .includes = "#include \"shadow/direct/soft_volumes/soft_volumes.glsl\"\n",
                          .expression = expression,
                          .channels = quarters ? 4U : 1U,
                          .more = params.bounded != 0 ? add_boxes(input, hard.buffers) : TextureHandle{}});
    add_edge_sides(input, hard.buffers, 1, result);
    return result;
}

std::string refuses(const Scene&, const Light&, const Recipe& recipe) {
    const auto params = recipe.of<GnSoftVolumesParams>("soft-volumes");
    return params.bounded != 0 && params.regions == GN_SOFT_VOLUMES_FOUR
               ? "soft-volumes.bounded=true holds what is hidden to one box on the whole light; take it with "
                 "soft-volumes.regions=one"
               : "";
}

}  // namespace
}  // namespace gn::parts::soft_volumes

namespace gn::parts {

const Part& direct_soft_volumes() {
    using namespace soft_volumes;
    static const Part part = [] {
        Part p;
        p.id = "soft-volumes";
        p.stage = Stage::direct;
        p.title = "Soft shadow volumes";
        p.citation = "AA03";
        p.features = {Feature::float32_blend};
        p.needs_scene = true;
        p.sides = edge_sides();
        p.params = param_table<GnSoftVolumesParams>({
            GN_CHOICE(
                GnSoftVolumesParams, coverage,
                "exact works out what an edge hides; table looks it up by both ends, as graphics hardware had to.",
                "exact", "table"),
            GN_PARAM(GnSoftVolumesParams, table, integer, 4, 48, "entries",
                     "Finer tables along each of four axes: less error, bytes by the fourth power."),
            GN_CHOICE(GnSoftVolumesParams, regions,
                      "four sums by quarters of the light, so that casters one before the other darken less.", "one",
                      "four"),
            GN_PARAM(GnSoftVolumesParams, bounded, boolean, 0, 1, "",
                     "No more is hidden or shown than the box around it on the light holds: casters one before the "
                     "other count less often twice, for a second drawing of the wedges."),
            GN_PARAM(GnSoftVolumesParams, closed, boolean, 0, 1, "",
                     "Solids cast with the half of their surface that light meets first; off counts every triangle."),
        });
        p.params_type = "GnSoftVolumesParams";
        p.glsl = "shadow/direct/soft_volumes/soft_volumes.glsl";
        p.add_direct = add_soft_volumes;
        p.refuses = refuses;
        p.remark = [](const Scene& scene, const Recipe&) { return remark_silhouettes(scene, "soft-volumes"); };
        return p;
    }();
    return part;
}

}  // namespace gn::parts
