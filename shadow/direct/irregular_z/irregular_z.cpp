// SPDX-License-Identifier: MIT
// Based on: Johnson, Lee, Burns, Mark. The Irregular Z-Buffer: Hardware Acceleration for Irregular Data Structures. ACM TOG 2005.
// [JLBM05]
// Departs from it: hidden is what the truth calls hidden, by planes through the view sample, with no depth compared; and
// texels may list triangles instead.
//
// Stands on: shadow/placement/place (its lists are placed as maps are)
// Also here: irregular_z_pairs.h, irregular_z_pairs.cpp.
#include "shadow/direct/irregular_z/irregular_z.h"

#include "shadow/direct/irregular_z/irregular_z_pairs.h"
#include "shadow/frame/frame.h"
#include "shadow/placement/place.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn::parts::irregular_z {
namespace {

constexpr const char* resolve_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(visibility)))) {
        return;
    }
    vec4 p_ws = gbuffer_position_texel(pixel);
    bool counted = p_ws.w > 0.0 && gn_counted(u.whole, p_ws.xyz, gbuffer_normal_texel(pixel).xyz);
    bool lit = !gn_hidden(hidden[pixel.y * imageSize(visibility).x + pixel.x]);
    imageStore(visibility, pixel, vec4(counted && lit ? 1.0 : 0.0));
}
)";

Visibility add_resolve_hidden(const FrameInput& input, BufferHandle hidden) {
    Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, input.samples);
    inputs.buffer("readonly buffer", "Hidden", "uint hidden[];", hidden);
    inputs.image("r32f", "writeonly", "image2D", "visibility", result.image);
    inputs.constant("GnLight", "whole", input.whole_light().shape);
    const auto shader = compute_once(input.prepared, "irregular-z.comp", hashed(inputs), [&] {
        return include_line("shadow/scene/light.h") + include_line("shadow/geometry/occluder.glsl") + inputs.text() +
               resolve_text;
    });
    add_pixel_pass(input.graph, "irregular-z: resolve", inputs, shader, input.samples.width, input.samples.height);
    return result;
}

Visibility add_irregular_z(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnIrregularZParams>("irregular-z");
    const LightViews views = place_views(input, recipe);

    const HiddenSamples found = add_hidden_samples(input, recipe, views, params.lists == GN_IRREGULAR_TRIANGLES);
    Visibility result = add_resolve_hidden(input, found.hidden);
    if (holds(input.sides, "list-length")) {
        result.sides.push_back({"list-length", add_list_lengths(input, recipe, views, found.lists, "irregular-z"), {}});
    }
    return result;
}

std::string refuses(const Scene& /*scene*/, const Light& light, const Recipe& recipe) {
    return refuses_bent(light, recipe,
                        "direct 'irregular-z' follows straight edges through its views and placement '{}' bends them");
}

}  // namespace
}  // namespace gn::parts::irregular_z

namespace gn::parts {

const Part& direct_irregular_z() {
    using namespace irregular_z;
    static const Part part = [] {
        Part p;
        p.id = "irregular-z";
        p.stage = Stage::direct;
        p.title = "Irregular z-buffer";
        p.citation = "JLBM05";
        p.needs_scene = true;
        p.params = param_table<GnIrregularZParams>({
            GN_CHOICE(
                GnIrregularZParams, lists,
                "What a texel lists: samples, which each triangle asks, or triangles, which each sample asks; the "
                "picture is the same, triangles take more memory.",
                "samples", "triangles"),
        });
        p.params_type = "GnIrregularZParams";
        p.glsl = "shadow/direct/irregular_z/irregular_z.glsl";
        p.reads = {"placement", "resolution"};
        p.sides = {
            {"list-length", "", "View samples, or triangles, in the list of the texel that a sample falls into."}};
        p.add_direct = add_irregular_z;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
