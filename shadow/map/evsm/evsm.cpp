// SPDX-License-Identifier: MIT
// Exponential variance shadow maps: moments of warped depth in two or four floats.
//
// Based on: Lauritzen. Rendering Antialiased Shadows using Warped Variance Shadow Maps. Waterloo 2008. [Lau08]
// Stands on: shadow/map/vsm (Chebyshev's bound and the reduction of bleeding)
#include "shadow/map/evsm/evsm.glsl"

#include "shadow/map/prefilter.h"

#include <array>

namespace gn::parts::evsm {
namespace {

VkFormat format_of(const GnEvsmParams& params) {
    constexpr std::array<std::array<VkFormat, 2>, 2> formats{
        {{VK_FORMAT_R16G16_SFLOAT, VK_FORMAT_R32G32_SFLOAT},
         {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT}}};
    return formats.at(static_cast<std::size_t>(params.components)).at(static_cast<std::size_t>(params.format));
}

ShadowMap add_evsm(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    const auto params = recipe.of<GnEvsmParams>("evsm");

    // Rasterize warped moments; a texel without caster stores those of the far plane.
    MomentMap moments;
    moments.format = format_of(params);
    moments.samples = params.samples;
    moments.clear = {.color = glsl::gn_evsm_encode(1, vec2(0), params)};
    moments.mips = drawn_mips(params.prefilter, views.resolution);
    moments.fragment.includes = R"(
#include "shadow/map/evsm/evsm.glsl"
layout(location = 0) out vec4 out_moments;
)";
    moments.fragment.body = R"(
    out_moments = gn_evsm_encode(depth, u.params.slope_moment != 0 ? slope : vec2(0.0), u.params);
)";
    moments.fragment.reads_slope = params.slope_moment != 0;
    moments.fragment.inputs.constant("GnEvsmParams", "params", params);
    moments.depth = create_depth(input, views, moments);
    const TextureHandle raw = add_moments(input, recipe, views, moments);

    // Blur and mipmap.
    ShadowMap map = filtered_map(input, views, "moments", raw, params.prefilter);
    offer_ranges(input, recipe, moments.depth, map);
    return map;
}

std::vector<Feature> features_for(const Recipe& recipe) {
    return filtering_features(recipe.of<GnEvsmParams>("evsm").format == GN_EVSM_FLOAT32);
}

Guard guard(const Recipe& recipe, const Light&, const Box&) {
    return blur_guard(recipe.of<GnEvsmParams>("evsm").prefilter);
}

/// The sentence that refuses an exponent whose moments the format cannot hold, or "".
std::string refuse_exponent(std::string_view parameter, float exponent, int format) {
    const float limit = glsl::gn_evsm_limit(format);
    return exponent <= limit
               ? ""
               : fmt::format(
                     "{} = {} is more than evsm.format = {} can hold; at most {} fits, and 0 takes what is usual",
                     parameter, exponent, format == GN_EVSM_FLOAT16 ? "float16" : "float32", limit);
}

std::string refuses(const Scene&, const Light&, const Recipe& recipe) {
    const auto params = recipe.of<GnEvsmParams>("evsm");
    std::string sentence = refuse_samples("evsm.samples", params.samples);
    if (sentence.empty()) {
        sentence = refuse_exponent("evsm.exponent", params.exponent, params.format);
    }
    if (sentence.empty() && params.components == GN_EVSM_FOUR) {
        sentence = refuse_exponent("evsm.exponent_negative", params.exponent_negative, params.format);
    }
    return sentence;
}

ParamTable rows() {
    return param_table<GnEvsmParams>(with_prefilter(
        {
            GN_CHOICE(
                GnEvsmParams, components,
                "2 keeps the moments of exp(c z) only, 4 also those of -exp(-c z): less bleeding, twice the memory.",
                "2", "4"),
            GN_CHOICE(GnEvsmParams, format,
                      "Floats of 16 bits hold exponents up to 5 and halve the memory, those of 32 bits up to 42.",
                      "float16", "float32"),
            GN_PARAM(GnEvsmParams, exponent, real, 0, 42, "",
                     "Steepness of exp(c z), z in [-1,1]: less bleeding, harder rims where receivers are uneven; 0 "
                     "takes 20, "
                     "and 5 in 16 bits."),
            GN_PARAM(
                GnEvsmParams, exponent_negative, real, 0, 42, "",
                "Steepness of -exp(-c z): fewer of those hard rims, more bleeding behind the first caster; 0 takes 10, "
                "and 5 in 16 bits."),
            samples_row(offsetof(GnEvsmParams, samples)),
            slope_moment_row(offsetof(GnEvsmParams, slope_moment)),
            min_deviation_row(offsetof(GnEvsmParams, min_deviation)),
            bleeding_row(offsetof(GnEvsmParams, bleeding)),
        },
        offsetof(GnEvsmParams, prefilter)));
}

}  // namespace
}  // namespace gn::parts::evsm

namespace gn::parts {

const Part& map_evsm() {
    using namespace evsm;
    static const Part part = [] {
        Part p;
        p.id = "evsm";
        p.stage = Stage::map;
        p.title = "Exponential variance shadow maps";
        p.citation = "Lau08";
        p.filterable = true;
        p.gives = {"moments", "min-max"};
        p.textures = {"moments"};
        p.features_for = features_for;
        p.params = rows();
        p.params_type = "GnEvsmParams";
        p.glsl = "shadow/map/evsm/evsm.glsl";
        p.add_map = add_evsm;
        p.guard = guard;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
