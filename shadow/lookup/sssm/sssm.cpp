// SPDX-License-Identifier: MIT
// Separable soft shadows: rows of the kernel from the map, and its columns from the neighbours in the picture.
//
// Based on: Buades, Gumbau, Chover. Separable Soft Shadow Mapping. The Visual Computer 2016. [BGC16]
// Stands on: shadow/receiver/light_extent.glsl (the light as a receiver sees it, and where what hides it can lie),
// shadow/lookup/pcss (a texel of the map as its kernels read it)
#include "shadow/lookup/sssm/sssm.h"

#include "shadow/frame/frame.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/expect.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/light_guard.h"
#include "shadow/recipe/recipe.h"

#include <array>

namespace gn::parts::sssm {
namespace {

// The neighbours along the light's other axis, and what they have read: take(texel, weight).
constexpr const char* columns_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
// Where the row through point y of the kernel is in the picture, in pixels; z = 0 where it is not seen.
vec3 row_ss(vec3 p_ws, vec3 n_ws, vec3 up_ws, float spread, float y) {
    vec4 beside = gn_sssm_neighbour(u.light, p_ws, n_ws, spread * y * up_ws);
    vec3 seen = gn_reproject(u.view.cs_from_ws, mat4(1.0), beside.xyz);
    return vec3(seen.xy * vec2(u.view.size.xy), beside.w == 0.0 ? 0.0 : seen.z);
}
// Whether rows lie closer than pixels do.
bool rows_close(vec3 p_ws, vec3 n_ws, float spread) {
    vec3 up_ws = gn_extent_light(u.light, p_ws).up_ws;
    vec3 low = row_ss(p_ws, n_ws, up_ws, spread, -1.0);
    vec3 high = row_ss(p_ws, n_ws, up_ws, spread, 1.0);
    return low.z != 0.0 && high.z != 0.0 && distance(low.xy, high.xy) < float(u.params.side);
}
void columns(ivec2 pixel, vec3 p_ws, vec4 normal, float spread, inout GnSssmColumn sum) {
    GnExtentLight half_light = gn_extent_light(u.light, p_ws);
    ivec2 size = ivec2(u.view.size.xy);
    float pixel_ws = gn_pixel_growth(u.view, normal.w) * length(u.view.right_ws.xyz);
    for (int j = 0; j < u.params.side; ++j) {
        float y = gn_sssm_point(j, u.params.side, 0.5, 0);
        vec3 seen = row_ss(p_ws, normal.xyz, half_light.up_ws, spread, y);
        if (seen.z == 0.0) {
            continue;
        }
        // Mix the four pixels around that place, or what they hand on would change by whole pixels as the camera moves.
        vec2 place = seen.xy - 0.5;
        ivec2 low = ivec2(floor(place));
        vec2 share = place - vec2(low);
        for (int k = 0; k < 4; ++k) {
            ivec2 other = low + ivec2(k & 1, k >> 1);
            float mixed = (other.x > low.x ? share.x : 1.0 - share.x) * (other.y > low.y ? share.y : 1.0 - share.y);
            if (mixed < 1.0e-3 || any(lessThan(other, ivec2(0))) || any(greaterThanEqual(other, size))) {
                continue;
            }
            vec4 q = gbuffer_position_texel(other);
            vec3 q_n = gbuffer_normal_texel(other).xyz;
            // A neighbour is of use where it lies on the receiver's plane.
            if (q.w < 0.5 || !gn_counted(u.whole, q.xyz, q_n) || dot(normal.xyz, q_n) < 0.9 ||
                abs(dot(normal.xyz, q.xyz - p_ws)) > u.params.plane * pixel_ws) {
                continue;
            }
            gn_sssm_take(sum, other, spread, mixed * gn_sssm_weight(half_light.square, y));
        }
    }
}
)";

constexpr const char* search_text = R"(
struct GnSssmColumn { float weight; float hidden; float before; };
void gn_sssm_take(inout GnSssmColumn sum, ivec2 other, float spread, float weight) {
    vec3 row = texelFetch(rows, other, 0).xyz;
    sum.weight += weight;
    sum.hidden += weight * row.x;
    sum.before += weight * row.x * gn_sssm_unpack(row.y);
}
)";

constexpr const char* search_main = R"(
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    vec4 position = gbuffer_position_texel(pixel);
    vec4 normal = gbuffer_normal_texel(pixel);
    vec3 own = texelFetch(rows, pixel, 0).xyz;
    float spread = -1.0;
    bool hides = false;
    float before = 0.0;
    if (position.w > 0.5 && gn_counted(u.whole, position.xyz, normal.xyz) && own.z > 0.0) {
        GnSssmColumn sum = GnSssmColumn(0.0, 0.0, 0.0);
        if (own.z < 1.0) {
            columns(pixel, position.xyz, normal, gn_sssm_unpack(own.z), sum);
        }
        // Where no neighbour is of use a row must do.
        if (sum.weight == 0.0) {
            gn_sssm_take(sum, pixel, 0.0, 1.0);
        }
        hides = sum.hidden > 0.0;
        before = hides ? sum.before / sum.hidden : 0.0;
        spread = own.z >= 1.0 ? gn_sssm_all() : hides ? gn_sssm_spread(u.light, position.xyz, before) : -1.0;
        if (hides && own.z < 1.0) {
            spread = gn_sssm_marked(spread, rows_close(position.xyz, normal.xyz, spread));
        }
    }
    imageStore(result, pixel, vec4(min(spread, gn_sssm_all())));
    GN_SSSM_TELL
}
)";

/// What the search tells of a pixel whose light something hides; where extremes decided that all of it is hidden, of the nearest.
struct Told {
    std::string_view side;
    const char* name;
    const char* value;
};
constexpr std::array<Told, 2> told{
    {{"blocker-distance", "blocker_distance", "before"},
     {"penumbra-width", "penumbra_width",
      "gn_extent_width(gn_extent_light(u.light, position.xyz), gn_sssm_spread(u.light, position.xyz, before))"}}};

/// An image for each side that is asked for; its line of the search's GLSL is added to `text`.
std::vector<Offer> add_told(const FrameInput& input, ShaderInputs& inputs, std::string& text) {
    std::vector<Offer> sides;
    text = "#define GN_SSSM_TELL ";
    for (const Told& each : told) {
        if (holds(input.sides, each.side)) {
            sides.push_back({std::string(each.side), create_visibility(input.graph, input.samples), nearest()});
            inputs.image(image_format(visibility_format(1)), "writeonly", "image2D", each.name, sides.back().texture);
            text += fmt::format("imageStore({}, pixel, vec4(hides ? {} : 0.0)); ", each.name, each.value);
        }
    }
    text += "\n";
    return sides;
}

constexpr const char* filter_text = R"(
struct GnSssmColumn { float weight; float lit; };
void gn_sssm_take(inout GnSssmColumn sum, ivec2 other, float spread, float weight) {
    // Of one that has searched and found another penumbra the row is of no use.
    float theirs = texelFetch(spreads, other, 0).r;
    bool alike = theirs < 0.0 || theirs >= gn_sssm_all() || max(theirs, spread) <= u.params.widths * min(theirs, spread);
    if (alike) {
        sum.weight += weight;
        sum.lit += weight * texelFetch(rows, other, 0).r;
    }
}
)";

constexpr const char* filter_main = R"(
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    vec4 position = gbuffer_position_texel(pixel);
    vec4 normal = gbuffer_normal_texel(pixel);
    float v = texelFetch(rows, pixel, 0).r;
    float spread = texelFetch(spreads, pixel, 0).r;
    if (position.w > 0.5 && gn_counted(u.whole, position.xyz, normal.xyz) && spread > 0.0 && spread < gn_sssm_all() &&
        !gn_sssm_close(spread)) {
        GnSssmColumn sum = GnSssmColumn(0.0, 0.0);
        columns(pixel, position.xyz, normal, spread, sum);
        v = sum.weight > 0.0 ? sum.lit / sum.weight : v;
    }
    imageStore(result, pixel, vec4(gn_unit(v)));
}
)";

/// One pass over the picture that gathers rows. `spreads`: invalid in the search, which makes them, and tells what it is asked.
Visibility add_columns(const FrameInput& input, const Recipe& recipe, TextureHandle rows, TextureHandle spreads) {
    const bool filters = spreads.valid();
    Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, input.samples);
    inputs.texture("sampler2D", "rows", rows);
    if (filters) {
        inputs.texture("sampler2D", "spreads", spreads);
    }
    inputs.image(image_format(visibility_format(1)), "writeonly", "image2D", "result", result.image);
    std::string tell;
    if (!filters) {
        result.sides = add_told(input, inputs, tell);
    }
    inputs.constant("GnViewConstants", "view", input.samples.constants)
        .constant("GnLight", "light", input.light().shape)
        .constant("GnLight", "whole", input.whole_light().shape)
        .constant("GnSssmParams", "params", recipe.of<GnSssmParams>("sssm"));
    const char* const name = filters ? "filter columns" : "search columns";
    const auto shader = compute_once(input.prepared, name, hashed(inputs), [&] {
        return tell + expect_text(input.device) + channels_text(1) + include_line("shadow/view/view.glsl") +
               include_line("shadow/receiver/reprojection.glsl") + include_line("shadow/lookup/sssm/sssm.glsl") +
               inputs.text() + (filters ? filter_text : search_text) + columns_text +
               (filters ? filter_main : search_main);
    });
    add_pixel_pass(input.graph, name, inputs, shader, input.samples.width, input.samples.height);
    return result;
}

std::string search_prologue(const Recipe&) {
    return "#define GN_SSSM_SEARCH\n";
}
std::string filter_prologue(const Recipe&) {
    return "#define GN_SSSM_FILTER\n";
}
std::string grid_prologue(const Recipe&) {
    return "#define GN_SSSM_GRID\n";
}

/// The part as the shared resolve pass runs it, in one of its passes.
Part pass_of(const Part& part, std::string (*prologue)(const Recipe&)) {
    Part pass = part;
    pass.add_lookup = nullptr;
    pass.prologue = prologue;
    return pass;
}

Visibility resolve_with(const FrameInput& input, Recipe recipe, const Part& pass, const LightViews& views,
                        const ShadowMap& map) {
    recipe.lookup = &pass;
    return add_resolve(input, recipe, views, map);
}

Visibility add_sssm(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map) {
    static const Part grid = pass_of(*recipe.lookup, grid_prologue);
    if (recipe.of<GnSssmParams>("sssm").separable == 0) {
        return resolve_with(input, recipe, grid, views, map);
    }
    static const Part search = [](const Part& part) {
        Part pass = pass_of(part, search_prologue);
        pass.channels = 3;
        return pass;
    }(*recipe.lookup);
    static const Part filter = [](const Part& part) {
        Part pass = pass_of(part, filter_prologue);
        pass.needs.emplace_back("spreads");
        return pass;
    }(*recipe.lookup);

    // Search: rows from the map, columns from the picture, which tell what is asked.
    FrameInput unasked = input;
    unasked.sides.clear();
    const TextureHandle blockers = resolve_with(unasked, recipe, search, views, map).image;
    const Visibility spreads = add_columns(input, recipe, blockers, {});

    // Filter likewise, as wide as the penumbra.
    ShadowMap with_spreads = map;
    with_spreads.offers.push_back({"spreads", spreads.image, nearest()});
    const TextureHandle rows = resolve_with(unasked, recipe, filter, views, with_spreads).image;
    return {add_columns(input, recipe, rows, spreads.image).image, spreads.sides};
}

Guard guard(const Recipe& recipe, const Light& light, const Box& bounds_ws) {
    return light_guard(light, bounds_ws, recipe.of<GnSssmParams>("sssm").least);
}

ParamTable rows() {
    return param_table<GnSssmParams>({
        GN_PARAM(GnSssmParams, separable, boolean, 0, 1, "",
                 "Reads a row of each kernel and takes the others from neighbours; else the whole grid, `side` times "
                 "as dear."),
        GN_PARAM(GnSssmParams, side, integer, 1, 64, "",
                 "Points of a row, and rows: smoother penumbrae, cost in proportion."),
        GN_PARAM(GnSssmParams, jitter, boolean, 0, 1, "", "Moves a pixel's row by noise: grain instead of steps."),
        GN_PARAM(GnSssmParams, least, real, 0, 16, "texels",
                 "Half width of the narrowest kernel: below one the map's texels show at contacts."),
        GN_PARAM(GnSssmParams, plane, real, 0.1, 1000, "pixels",
                 "How far off the receiver's plane a neighbour may lie, in widths of a pixel: smoother curved "
                 "surfaces, bleeding over steps."),
        GN_PARAM(GnSssmParams, widths, real, 1, 1000, "",
                 "How many times wider a neighbour's penumbra may be: fewer rows where it is small, blurred contacts "
                 "where large."),
        GN_PARAM(GnSssmParams, early_out, boolean, 0, 1, "",
                 "Skips rows where the least and greatest depth of their region say that all of the light is seen, or "
                 "none."),
    });
}

}  // namespace
}  // namespace gn::parts::sssm

namespace gn::parts {

const Part& lookup_sssm() {
    using namespace sssm;
    static const Part part = [] {
        Part p;
        p.id = "sssm";
        p.stage = Stage::lookup;
        p.title = "Separable soft shadow mapping";
        p.citation = "BGC16";
        p.needs = {"depth", "min-max"};
        p.sides = {{"blocker-distance", "m",
                    "How far along the light's depth what hides a sample lies before it, on average."},
                   {"penumbra-width", "m", "How wide the penumbra is at a sample, across the rays."}};
        p.params = rows();
        p.params_type = "GnSssmParams";
        p.glsl = "shadow/lookup/sssm/sssm.glsl";
        p.add_lookup = add_sssm;
        p.guard = guard;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
