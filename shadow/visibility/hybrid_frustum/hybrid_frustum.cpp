// SPDX-License-Identifier: MIT
// Where a penumbra is narrow the exact hard shadow, where it is wide the lookup's soft one, by how far the occluder is.
//
// Based on: Story, Wyman. HFTS: Hybrid Frustum-Traced Shadows in "The Division". SIGGRAPH Talks 2016. [SW16]
//
// Stands on: shadow/direct/irregular_z (its hard shadow)
#include "shadow/visibility/hybrid_frustum/hybrid_frustum.h"

#include "shadow/frame/frame.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"

namespace gn::parts {
const Part& direct_irregular_z();
}

namespace gn::parts::hybrid_frustum {
namespace {

constexpr const char* blend_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    // The penumbra's width in widths of a pixel at the sample.
    float pixel_ws = gn_pixel_growth(u.view, gbuffer_normal_texel(pixel).w) * length(u.view.right_ws.xyz);
    float pixels = texelFetch(penumbra, pixel, 0).r / max(pixel_ws, 1.0e-30);
    float weight = gn_hybrid_frustum_weight(pixels, u.params);
    GN_V exact = GN_V(texelFetch(hard, pixel, 0).r);
    GN_V wide = GN_V_OF(texelFetch(soft, pixel, 0));
    imageStore(blended, pixel, GN_V_TEXEL(weight <= 0.0 ? exact : weight >= 1.0 ? wide : mix(exact, wide, weight)));
}
)";

Visibility add_hybrid_frustum(const FrameInput& input, const Recipe& recipe, const Visibility& soft) {
    const ViewSamples& samples = input.samples;
    const Visibility hard = parts::direct_irregular_z().add_direct(input, recipe);
    const Offer* penumbra = soft.find("penumbra-width");
    GN_CHECK(penumbra != nullptr);
    const uint channels = channels_of(input.graph, soft.image);
    const TextureHandle blended = create_visibility(input.graph, samples, channels);
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, samples);
    inputs.texture("sampler2D", "soft", soft.image);
    inputs.texture("sampler2D", "hard", hard.image);
    inputs.texture("sampler2D", "penumbra", penumbra->texture);
    inputs.image(image_format(visibility_format(channels)), "writeonly", "image2D", "blended", blended);
    inputs.constant("GnViewConstants", "view", samples.constants)
        .constant("GnHybridFrustumParams", "params", recipe.of<GnHybridFrustumParams>("hybrid-frustum"));
    const auto shader = compute_once(input.prepared, "hybrid-frustum", hashed(inputs).value(channels), [&] {
        return channels_text(channels) + include_line("shadow/view/view.glsl") +
               include_line("shadow/visibility/hybrid_frustum/hybrid_frustum.glsl") + inputs.text() + blend_text;
    });
    add_pixel_pass(input.graph, "hybrid-frustum", inputs, shader, samples.width, samples.height);
    return {blended};
}

std::string refuses(const Scene& scene, const Light& light, const Recipe& recipe) {
    return parts::direct_irregular_z().refuses(scene, light, recipe);
}

}  // namespace
}  // namespace gn::parts::hybrid_frustum

namespace gn::parts {

const Part& visibility_hybrid_frustum() {
    using namespace hybrid_frustum;
    static const Part part = [] {
        Part p;
        p.id = "hybrid-frustum";
        p.stage = Stage::visibility;
        p.title = "Hybrid frustum-traced shadows";
        p.citation = "SW16";
        p.needs = {"penumbra-width"};
        p.needs_scene = true;
        p.params = param_table<GnHybridFrustumParams>({
            GN_CHOICE(
                GnHybridFrustumParams, by,
                "What the soft shadow weighs: by the distance of what hides the light, nothing (hard), or all (soft).",
                "distance", "hard", "soft"),
            GN_PARAM(GnHybridFrustumParams, narrow, real, 0, 1000, "pixels",
                     "Width of a penumbra up to which the hard shadow is taken: crisper contacts, steps in penumbrae."),
            GN_PARAM(GnHybridFrustumParams, wide, real, 0, 1000, "pixels",
                     "Width of a penumbra from which on the soft shadow is taken: a longer way from one to the other."),
        });
        p.params_type = "GnHybridFrustumParams";
        p.glsl = "shadow/visibility/hybrid_frustum/hybrid_frustum.glsl";
        p.add_visibility = add_hybrid_frustum;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
