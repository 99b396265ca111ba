// SPDX-License-Identifier: MIT
// Moment shadow maps: four moments of depth, in 16 bits each after the optimized quantization or in 32-bit floats.
//
// Based on: Peters, Klein. Moment Shadow Mapping. I3D 2015. [PK15]
#include "shadow/map/msm/msm.glsl"

#include "shadow/map/prefilter.h"

namespace gn::parts::msm {
namespace {

ShadowMap add_msm(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    const auto params = recipe.of<GnMsmParams>("msm");

    // Rasterize moments; a texel without caster stores those of the far plane.
    MomentMap moments;
    moments.format = params.format == GN_MSM_UNORM16 ? VK_FORMAT_R16G16B16A16_UNORM : VK_FORMAT_R32G32B32A32_SFLOAT;
    moments.samples = params.samples;
    moments.clear = {.color = glsl::gn_msm_encode(1, params.format)};
    moments.mips = drawn_mips(params.prefilter, views.resolution);
    moments.fragment.includes = R"(
#include "shadow/map/msm/msm.glsl"
layout(location = 0) out vec4 out_moments;
)";
    moments.fragment.body = "out_moments = gn_msm_encode(depth, u.params.format);";
    moments.fragment.inputs.constant("GnMsmParams", "params", params);
    moments.depth = create_depth(input, views, moments);
    const TextureHandle raw = add_moments(input, recipe, views, moments);

    // Blur and mipmap.
    ShadowMap map = filtered_map(input, views, "moments", raw, params.prefilter);
    offer_ranges(input, recipe, moments.depth, map);
    return map;
}

std::vector<Feature> features_for(const Recipe& recipe) {
    return filtering_features(recipe.of<GnMsmParams>("msm").format == GN_MSM_FLOAT32);
}

Guard guard(const Recipe& recipe, const Light&, const Box&) {
    return blur_guard(recipe.of<GnMsmParams>("msm").prefilter);
}

std::string refuses(const Scene&, const Light&, const Recipe& recipe) {
    return refuse_samples("msm.samples", recipe.of<GnMsmParams>("msm").samples);
}

ParamTable rows() {
    return param_table<GnMsmParams>(with_prefilter(
        {
            GN_CHOICE(
                GnMsmParams, problem,
                "Which distributions are thought of: on the whole line, or in [0,1] only (a little darker, slower).",
                "hamburger", "hausdorff"),
            GN_CHOICE(GnMsmParams, format, "8 bytes a texel, rotated to make the most of 16 bits, or 16 bytes.",
                      "unorm16", "float32"),
            GN_PARAM(GnMsmParams, moment_bias, real, 0, 0.1, "",
                     "Share of a broad distribution mixed in against rounding: less noise, more bleeding."),
            samples_row(offsetof(GnMsmParams, samples)),
            GN_PARAM(GnMsmParams, ramp, real, 0, 2, "",
                     "Moves receivers towards the light by this share of what their plane rises under half the kernel: "
                     "less acne on slopes, softer contacts there."),
            GN_PARAM(GnMsmParams, depth_bias, real, 0, 10, "m",
                     "Moves receivers towards the light: less acne, which rounding causes, and softer contacts."),
            bleeding_row(offsetof(GnMsmParams, bleeding)),
        },
        offsetof(GnMsmParams, prefilter)));
}

}  // namespace
}  // namespace gn::parts::msm

namespace gn::parts {

const Part& map_msm() {
    using namespace msm;
    static const Part part = [] {
        Part p;
        p.id = "msm";
        p.stage = Stage::map;
        p.title = "Moment shadow maps";
        p.citation = "PK15";
        p.filterable = true;
        p.gives = {"moments", "min-max"};
        p.textures = {"moments"};
        p.features_for = features_for;
        p.params = rows();
        p.params_type = "GnMsmParams";
        p.glsl = "shadow/map/msm/msm.glsl";
        p.add_map = add_msm;
        p.guard = guard;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
