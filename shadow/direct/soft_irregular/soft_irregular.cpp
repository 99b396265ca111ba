// SPDX-License-Identifier: MIT
// View samples in lists of a light view's texels: triangles say from which the light's centre is hidden, and silhouette edges what
// they hide of the light beyond.
//
// Based on: Johnson, Hunt, Hux, Mark, Burns, Junkins. Soft Irregular Shadow Mapping: Fast, High-Quality, and Robust Soft Shadows.
// I3D 2009. [JHHM09]
// Departs from it: the grid of samples has no depth; what an edge hides is that of soft-volumes, of any kind of light.
//
// Stands on: shadow/direct/irregular_z (lists of view samples, and what hides the light's centre), shadow/direct/soft_volumes
// (what an edge hides), shadow/placement/place (the lists are placed as maps are)
#include "shadow/direct/soft_irregular/soft_irregular.h"

#include "gpu/zeros_pass.h"
#include "shadow/casters/touched_texels.h"
#include "shadow/direct/irregular_z/irregular_z_pairs.h"
#include "shadow/frame/frame.h"
#include "shadow/geometry/edge_regions.h"
#include "shadow/placement/place.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn::parts::soft_irregular {
namespace {

constexpr const char* includes_text = R"(
#include "shadow/direct/soft_volumes/soft_volumes.glsl"
#include "shadow/direct/soft_irregular/soft_irregular.glsl"
)";

// In each texel that may hold samples which the edge hides part of the light from.
constexpr const char* edge_text = R"(
    uint node = gn_list_first(texel);
    result = 0.0;
    for (; node != 0u; node = gn_list_next(node)) {
        uint sample_index = gn_list_value(node);
        ivec2 pixel = ivec2(sample_index % u.width, sample_index / u.width);
        vec2 a;
        vec2 b;
        float side = gn_soft_volumes_edge(u.light, gbuffer_position_texel(pixel).xyz, a_ws, b_ws, a, b);
        float hidden = side != 0.0 ? side * gn_beyond(u.light.kind == uint(GN_LIGHT_RECTANGLE), a, b) : 0.0;
        int steps = gn_soft_irregular_steps(hidden, u.params.penumbra);
        if (steps != 0) {
            atomicAdd(edge_sums[2u * sample_index], steps);
        }
        atomicAdd(edge_sums[2u * sample_index + 1u], 1);
        result += 1.0;
    }
    if (node != 0u) {
        atomicOr(edges_cut, 1u);
    }
)";

constexpr const char* resolve_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(visibility)))) {
        return;
    }
    uint sample_index = uint(pixel.y * imageSize(visibility).x + pixel.x);
    vec4 p_ws = gbuffer_position_texel(pixel);
    bool counted = p_ws.w > 0.5 && gn_counted(u.whole, p_ws.xyz, gbuffer_normal_texel(pixel).xyz);
    float v = counted ? gn_soft_irregular_light(gn_hidden(hidden[sample_index]), edge_sums[2u * sample_index]) : 0.0;
    imageStore(visibility, pixel, vec4(v));
    GN_TELL
}
)";

/// What edges hide of each sample's light, in steps, and how many were asked; and whether a driver ended a loop early.
struct EdgeSums {
    BufferHandle sums, cut;
};

EdgeSums add_edge_sums(const FrameInput& input, const LightViews& views, const TexelLists& lists,
                       const GnSoftIrregularParams& params) {
    // Find the silhouettes; samples that face the light are on no other side of them than the volumes'.
    const VolumeBuffers buffers = add_all_silhouettes(input, params.closed != 0);

    // Nothing is hidden yet.
    const VkDeviceSize samples = VkDeviceSize{input.samples.width} * input.samples.height;
    const EdgeSums made{input.graph.create(BufferDesc{.name = "soft-irregular sums", .bytes = samples * 8}),
                        input.graph.create(BufferDesc{.name = "soft-irregular cut", .bytes = sizeof(std::uint32_t)})};
    add_zeros(input.graph, "soft-irregular: light", {made.sums, made.cut});

    // Draw what each edge may hide light from, over the texels.
    const std::string functions = list_functions(ListAccess::read);
    EdgeRegionPass pass{.name = "soft-irregular: edges",
                        .includes = includes_text,
                        .functions = functions,
                        .fragment = edge_text,
                        .result = "float",
                        .extra = {}};
    pass.extra.buffer("buffer", "EdgeSums", "int edge_sums[];", made.sums)
        .buffer("buffer", "EdgesCut", "uint edges_cut;", made.cut)
        .constant("GnLight", "light", input.light().shape)
        .constant("GnSoftIrregularParams", "params", params)
        .constant("uint", "width", input.samples.width);
    add_lists(pass.extra, lists, ListAccess::read);
    const TextureHandle asked = input.graph.create(TextureDesc{.name = "soft-irregular asked",
                                                               .format = VK_FORMAT_R32_SFLOAT,
                                                               .width = views.resolution,
                                                               .height = views.resolution,
                                                               .layers = views.layers});
    add_edge_texels(input, buffers, views, pass, asked);
    tell_cut(input, "soft-irregular: edges", made.cut);
    return made;
}

Visibility add_soft_irregular(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnSoftIrregularParams>("soft-irregular");
    const LightViews views = place_views(input, recipe);
    if (views.tiles) {
        refuse(
            "direct 'soft-irregular' draws edges into views that are known when it is declared, and placement '{}' has "
            "none such; auto, fit, single, cube and cascades have",
            views.part->id);
    }
    const HiddenSamples found = add_hidden_samples(input, recipe, views, false);
    const EdgeSums edges = add_edge_sums(input, views, found.lists, params);

    Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, input.samples);
    inputs.buffer("readonly buffer", "Hidden", "uint hidden[];", found.hidden)
        .buffer("readonly buffer", "EdgeSums", "int edge_sums[];", edges.sums)
        .image("r32f", "writeonly", "image2D", "visibility", result.image)
        .constant("GnLight", "whole", input.whole_light().shape);
    const bool told = holds(input.sides, "wedge-overdraw");
    if (told) {
        const TextureHandle asked = create_visibility(input.graph, input.samples);
        inputs.image("r32f", "writeonly", "image2D", "asked", asked);
        result.sides.push_back({"wedge-overdraw", asked, {}});
    }
    const auto shader = compute_once(input.prepared, "soft-irregular: resolve", hashed(inputs), [&] {
        return fmt::format("#define GN_TELL {}\n",
                           told ? "imageStore(asked, pixel, vec4(float(edge_sums[2u * sample_index + 1u])));" : "") +
               include_line("shadow/scene/light.h") + include_line("shadow/geometry/occluder.glsl") + includes_text +
               inputs.text() + resolve_text;
    });
    add_pixel_pass(input.graph, "soft-irregular: resolve", inputs, shader, input.samples.width, input.samples.height);
    return result;
}

std::string refuses(const Scene& /*scene*/, const Light& light, const Recipe& recipe) {
    return refuses_bent(
        light, recipe,
        "direct 'soft-irregular' follows straight edges through its views and placement '{}' bends them");
}

}  // namespace
}  // namespace gn::parts::soft_irregular

namespace gn::parts {

const Part& direct_soft_irregular() {
    using namespace soft_irregular;
    static const Part part = [] {
        Part p;
        p.id = "soft-irregular";
        p.stage = Stage::direct;
        p.title = "Soft irregular shadow mapping";
        p.citation = "JHHM09";
        p.features = {Feature::float32_blend};
        p.needs_scene = true;
        p.sides = edge_sides();
        p.params = param_table<GnSoftIrregularParams>({
            GN_CHOICE(GnSoftIrregularParams, penumbra,
                      "both: edges take light and give it; outer: they take it alone, and what the light's centre does "
                      "not see stays dark.",
                      "both", "outer"),
            GN_PARAM(GnSoftIrregularParams, closed, boolean, 0, 1, "",
                     "Solids have the silhouettes of the half of their surface that light meets first; off takes every "
                     "triangle."),
        });
        p.params_type = "GnSoftIrregularParams";
        p.glsl = "shadow/direct/soft_irregular/soft_irregular.glsl";
        p.reads = {"placement", "resolution"};
        p.add_direct = add_soft_irregular;
        p.refuses = refuses;
        p.remark = [](const Scene& scene, const Recipe&) { return remark_silhouettes(scene, "soft-irregular"); };
        return p;
    }();
    return part;
}

}  // namespace gn::parts
