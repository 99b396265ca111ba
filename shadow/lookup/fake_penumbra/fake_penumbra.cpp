// SPDX-License-Identifier: MIT
// Penumbrae drawn around the edges of hard shadows, by what one map tells of the nearest edge.
//
// Based on: Brabec, Seidel. Single Sample Soft Shadows using Depth Maps. Graphics Interface 2002. [BS02]
// Based on: Kirsch, Doellner. Real-Time Soft Shadows Using a Single Light Sample. WSCG 2003. [KD03]
// Based on: Arvo, Hirvikorpi, Tyystjaervi. Approximate Soft Shadows with an Image-Space Flood-Fill Algorithm. Eurographics 2004.
// [AHT04]
//
// Stands on: shadow/receiver/light_extent.glsl (the light as a receiver sees it, and where what hides it can lie),
// shadow/lookup/pcss (a texel of the map as its kernels read it)
// Stands on: shadow/lookup/sssm (the spread of what lies before a receiver, and its place in an image)
// Also here: fake_edge.glsl (V beside an edge), fake_flood.h, fake_flood.cpp (edges that grow over the picture)
#include "shadow/lookup/fake_penumbra/fake_penumbra.h"

#include "shadow/frame/frame.h"
#include "shadow/lookup/fake_penumbra/fake_edge.glsl"
#include "shadow/lookup/fake_penumbra/fake_flood.h"
#include "shadow/recipe/light_guard.h"

#include <algorithm>
#include <array>

namespace gn::parts::fake_penumbra {
namespace {

constexpr int most_radius = 128;

GnFakePenumbraParams params_of(const Recipe& recipe) {
    return recipe.of<GnFakePenumbraParams>("fake-penumbra");
}

bool floods(const Recipe& recipe) {
    return params_of(recipe).form >= GN_FAKE_FLOOD;
}

/// Kernels end at the radius, however large the light is; a flood reads one texel.
Guard guard(const Recipe& recipe, const Light& light, const Box& bounds_ws) {
    const GnFakePenumbraParams params = params_of(recipe);
    if (!glsl::gn_fake_spreads(light.shape, params)) {
        return {};
    }
    return {.texels = floods(recipe) ? 2 : static_cast<float>(params.radius) + 2,
            .before = light_guard(light, bounds_ws, params.least).before};
}

/// "steps-1" and so on, by the radius.
std::string_view steps_name(int radius) {
    static const std::array<std::string, most_radius + 1> names = [] {
        std::array<std::string, most_radius + 1> made;
        for (std::size_t i = 0; i < made.size(); ++i) {
            made.at(i) = fmt::format("steps-{}", i);
        }
        return made;
    }();
    return names.at(static_cast<std::size_t>(radius));
}

std::vector<std::string_view> needs_for(const Recipe& recipe) {
    const GnFakePenumbraParams params = params_of(recipe);
    return {"depth", params.form == GN_FAKE_RADIAL ? "min-max" : "depth",
            params.form == GN_FAKE_WIDTH_MAP ? steps_name(params.radius) : "depth"};
}

std::string define_of(const Recipe& recipe) {
    return params_of(recipe).form == GN_FAKE_RADIAL ? "#define GN_FAKE_SEARCH\n" : "#define GN_FAKE_WIDTHS\n";
}
std::string shadows_define(const Recipe&) {
    return "#define GN_FAKE_SHADOWS\n";
}

/// The part as the shared resolve pass runs it.
Part pass_of(const Part& part, std::string (*prologue)(const Recipe&), uint channels) {
    Part pass = part;
    pass.add_lookup = nullptr;
    pass.prologue = prologue;
    pass.channels = channels;
    return pass;
}

Visibility resolve_with(const FrameInput& input, Recipe recipe, const Part& pass, const LightViews& views,
                        const ShadowMap& map) {
    recipe.lookup = &pass;
    return add_resolve(input, recipe, views, map);
}

Visibility add_lookup(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map) {
    static const Part shadows = pass_of(*recipe.lookup, shadows_define, 3);
    if (!floods(recipe)) {
        return add_resolve(input, recipe, views, map);
    }
    return add_fake_flood(input, params_of(recipe), resolve_with(input, recipe, shadows, views, map).image);
}

ParamTable rows() {
    return param_table<GnFakePenumbraParams>({
        GN_CHOICE(GnFakePenumbraParams, form,
                  "How the nearest edge is found: by a search of the map around the receiver, on both sides of the "
                  "edge; on a map of how far each blocked texel's region goes on, which lightens its inside alone; or "
                  "on the picture, where edges grow by a pixel a pass, or by halved jumps in a few passes.",
                  "radial", "width-map", "flood", "jump-flood"),
        GN_PARAM(
            GnFakePenumbraParams, radius, integer, 1, most_radius, "texels",
            "How far from an edge its penumbra reaches at most, with the floods in pixels: cost grows with it, and "
            "what is wider is cut to it."),
        GN_PARAM(GnFakePenumbraParams, least, real, 0, 16, "texels",
                 "Half width of the narrowest penumbra, with the floods in pixels: below one the map's texels show at "
                 "contacts."),
    });
}

}  // namespace
}  // namespace gn::parts::fake_penumbra

namespace gn::parts {

const Part& lookup_fake_penumbra() {
    using namespace fake_penumbra;
    static const Part part = [] {
        Part p;
        p.id = "fake-penumbra";
        p.stage = Stage::lookup;
        p.title = "Penumbrae around hard shadows";
        p.citation = "BS02";
        p.needs = {"depth", "min-max"};
        p.needs_for = needs_for;
        p.params = rows();
        p.params_type = "GnFakePenumbraParams";
        p.glsl = "shadow/lookup/fake_penumbra/fake_penumbra.glsl";
        p.add_lookup = add_lookup;
        p.guard = guard;
        p.prologue = define_of;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
