// SPDX-License-Identifier: MIT
// Exponential shadow maps: exp(c z) in one 32-bit float, and a pyramid of depths beside it for the fallback.
//
// Based on: Annen, Mertens, Seidel, Flerackers, Kautz. Exponential Shadow Maps. GI 2008. [AMS+08]
#include "shadow/map/esm/esm.glsl"

#include "shadow/map/derived.h"
#include "shadow/map/prefilter.h"
#include "shadow/recipe/prepared.h"

namespace gn::parts::esm {
namespace {

/// One texel a sample: a map of twice the side, the samples where they lie in their texel.
TextureHandle add_spread(const FrameInput& input, TextureHandle samples) {
    static constexpr const char* text = R"(
layout(push_constant) uniform Push { int push_layer; };
layout(location = 0) out vec4 out_depth;
void main() {
    // The standard places of four samples are one in each quarter, row by row.
    ivec2 cell = ivec2(gl_FragCoord.xy);
    out_depth = vec4(texelFetch(samples, ivec3(cell >> 1, push_layer), (cell.x & 1) + 2 * (cell.y & 1)).r);
}
)";
    TextureDesc desc = input.graph.desc(samples);
    desc.name = "map depths of samples";
    desc.format = VK_FORMAT_R32_SFLOAT;
    desc.width *= 2;
    desc.height *= 2;
    desc.samples = 1;
    desc.usage = 0;
    const TextureHandle target = input.graph.create(desc);
    ShaderInputs inputs;
    inputs.texture("sampler2DMSArray", "samples", samples);
    const auto shader = made_once(input.prepared, "spread samples", 0, [&] {
        return sealed(fullscreen({ShaderKind::fragment, "spread samples", inputs.text() + text}));
    });
    for (std::uint32_t layer = 0; layer < desc.layers; ++layer) {
        input.graph.add_pass(
            "spread samples",
            [&](PassBuilder& pass) {
                inputs.declare(pass);
                pass.color(target, Load::discard, {}, one_layer(layer));
            },
            [=](Recorder& r) {
                r.bind(*shader);
                inputs.set(r);
                r.push_value(static_cast<std::int32_t>(layer));
                r.draw(3);
            });
    }
    return target;
}

ShadowMap add_esm(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    const auto params = recipe.of<GnEsmParams>("esm");

    // Rasterize exponentials; a texel without caster stores that of the far plane.
    MomentMap moments;
    moments.format = VK_FORMAT_R32_SFLOAT;
    moments.samples = params.samples;
    moments.clear = {.color = vec4(glsl::gn_esm_encode(1, params.exponent), 0, 0, 0)};
    moments.mips = drawn_mips(params.prefilter, views.resolution);
    moments.fragment.includes = R"(
#include "shadow/map/esm/esm.glsl"
layout(location = 0) out vec4 out_moments;
)";
    moments.fragment.body = "out_moments = vec4(gn_esm_encode(depth, u.params.exponent), 0, 0, 0);";
    moments.fragment.inputs.constant("GnEsmParams", "params", params);
    moments.depth = create_depth(input, views, moments);
    const TextureHandle raw = add_moments(input, recipe, views, moments);

    // Blur and mipmap; the fallback compares depths, and skips what a pyramid of their ranges decides.
    ShadowMap map = filtered_map(input, views, "exponentials", raw, params.prefilter);
    if (params.fallback != 0) {
        const TextureHandle depths = params.samples > 1 ? add_spread(input, moments.depth) : moments.depth;
        map.offers.push_back({"ranges", add_min_max_pyramid(input.graph, depths), nearest()});
    }
    return map;
}

Guard guard(const Recipe& recipe, const Light&, const Box&) {
    return blur_guard(recipe.of<GnEsmParams>("esm").prefilter);
}

std::string refuses(const Scene&, const Light&, const Recipe& recipe) {
    return refuse_samples("esm.samples", recipe.of<GnEsmParams>("esm").samples);
}

}  // namespace
}  // namespace gn::parts::esm

namespace gn::parts {

const Part& map_esm() {
    using namespace esm;
    static const Part part = [] {
        Part p;
        p.id = "esm";
        p.stage = Stage::map;
        p.title = "Exponential shadow maps";
        p.citation = "AMS+08";
        p.filterable = true;
        p.gives = {"exponentials", "ranges"};
        p.textures = {"exponentials", "ranges"};
        p.features = {Feature::float32_filter};
        p.params = param_table<GnEsmParams>(with_prefilter(
            {
                GN_PARAM(GnEsmParams, exponent, real, 1, 85, "",
                         "Steepness of exp(c z), z in [0,1]: less light just behind casters, more failing receivers."),
                GN_PARAM(GnEsmParams, fallback, boolean, 0, 1, "",
                         "Compares texel by texel where the exponential fails: right there, and slow there."),
                GN_CHOICE(
                    GnEsmParams, classifier,
                    "What tells that it fails: the filtered value itself, fast, or the greatest depth of the kernel, "
                    "safe and slow.",
                    "product", "maximum"),
                GN_PARAM(GnEsmParams, epsilon, real, 0, 1, "",
                         "How far that value may exceed one before the fallback is taken: faster, less exact."),
                samples_row(offsetof(GnEsmParams, samples)),
            },
            offsetof(GnEsmParams, prefilter)));
        p.params_type = "GnEsmParams";
        p.glsl = "shadow/map/esm/esm.glsl";
        p.add_map = add_esm;
        p.guard = guard;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
