// SPDX-License-Identifier: MIT
// A shadow map, and beside it fins on the silhouettes that say how far off an edge a texel is.
//
// Based on: Chan, Durand. Rendering Fake Soft Shadows with Smoothies. EGSR 2003. [CD03]
// Departs from it: fins are as wide as the light, so that penumbrae have its width.
//
// Stands on: shadow/placement/place (its map is placed as those of lookups are)
#include "shadow/direct/smoothies/smoothies.h"

#include "shadow/casters/fins.h"
#include "shadow/casters/raster.h"
#include "shadow/frame/frame.h"
#include "shadow/frame/map_memory.h"
#include "shadow/placement/place.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {
namespace {

// [CD03] section 3.3: the darkest fin counts, and the nearest edge of those that darken anything. An edge may stand before the near plane.
constexpr const char* fin_text = R"(
    bool lamp = u.light_ws.w > 0.0;
    float eye = lamp ? dot(views[index].depth_from_ws, u.light_ws) : 0.0;
    float surface = texelFetch(depth_map, texel, 0).r;
    float light = gn_smoothies_light(off, (edge_depth - eye) * views[index].metres_per_depth,
                                     (surface - eye) * views[index].metres_per_depth, lamp, u.params);
    result = vec2(light, light < 1.0 ? edge_depth : 1.0);
)";

constexpr const char* text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    float v = 0.0;
    GnReceiver receiver;
    if (read_sample(pixel, receiver)) {
        v = 1.0;
        int index = GN_CHOOSE(receiver, placement).first;
        GnLightView view = views[index];
        GnProjected p = gn_project(receiver, view, u.bias);
        if (p.inside) {
            // The hard shadow is the umbra; beside it the fin in the texel decides.
            ivec2 texel = ivec2(floor(p.uv_ts / p.texel_ts));
            vec2 centre_ts = (vec2(texel) + 0.5) * p.texel_ts;
            float occluder = texelFetch(depth_map, ivec3(texel, view.layer), 0).r;
            vec2 fin = texelFetch(fins, ivec3(texel, view.layer), 0).rg;
            bool behind = dot(view.depth_from_ws, vec4(receiver.p_ws, 1.0)) > fin.g;
            v = gn_depth_at(p, centre_ts, u.bias) > occluder ? 0.0 : behind ? fin.r : 1.0;
        }
    }
    imageStore(visibility, pixel, vec4(v));
}
)";

Visibility add_resolve_fins(const FrameInput& input, const Recipe& recipe, const LightViews& views, TextureHandle depth,
                            TextureHandle fins) {
    Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs = sample_inputs(input, recipe, views);
    inputs.texture("sampler2DArray", "depth_map", depth)
        .texture("sampler2DArray", "fins", fins)
        .image("r32f", "writeonly", "image2D", "visibility", result.image);
    const std::string defines = receiver_defines(recipe, views);
    const std::string functions = sample_functions(input, recipe, views);
    const Hasher key = hashed(inputs).text(defines).text(functions).text(views.part->id);
    const auto shader = compute_once(input.prepared, "smoothies.comp", key, [&] {
        return defines + include_line("shadow/view/view.glsl") + placement_text(*views.part, recipe) +
               include_line("shadow/direct/smoothies/smoothies.glsl") + inputs.text() + functions + text;
    });
    input.graph.add_pass(
        "smoothies: resolve", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, width = input.samples.width, height = input.samples.height](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch_pixels(width, height);
        });
    return result;
}

Visibility add_smoothies(const FrameInput& input, const Recipe& recipe) {
    const LightViews views = place_views(input, recipe);
    if (views.tiles) {
        refuse("smoothies draws fins into whole views, and placement '{}' has tiles; use auto or cascades",
               views.part->id);
    }
    TextureDesc desc{.name = "map",
                     .format = VK_FORMAT_D32_SFLOAT,
                     .width = views.resolution,
                     .height = views.resolution,
                     .layers = views.layers};
    const TextureHandle depth = input.graph.create(desc);
    desc.name = "smoothies";
    desc.format = VK_FORMAT_R32G32_SFLOAT;
    const TextureHandle fins = input.graph.create(desc);
    check_map_memory(input, recipe, depth);
    add_caster_passes(input, recipe, views, {.depth = depth});
    ShaderInputs extra;
    extra.texture("sampler2DArray", "depth_map", depth)
        .constant("GnSmoothiesParams", "params", recipe.of<GnSmoothiesParams>("smoothies"));
    add_fins(input, add_fin_edges(input), views,
             {.name = "smoothies: fins",
              .includes = "#include \"shadow/direct/smoothies/smoothies.glsl\"\n",
              .fragment = fin_text,
              .result = "vec2",
              .extra = extra},
             fins, {.color = vec4(1, 1, 0, 0)});
    return add_resolve_fins(input, recipe, views, depth, fins);
}

}  // namespace

namespace parts {

const Part& direct_smoothies() {
    static const Part part = [] {
        Part p;
        p.id = "smoothies";
        p.stage = Stage::direct;
        p.title = "Smoothies";
        p.citation = "CD03";
        p.features = {Feature::float32_blend};
        p.needs_scene = true;
        p.params = param_table<GnSmoothiesParams>({
            GN_PARAM(GnSmoothiesParams, width, real, 0.01, 1, "of the light's penumbra",
                     "Wider penumbrae, up to the outer half of what the light has."),
        });
        p.params_type = "GnSmoothiesParams";
        p.glsl = "shadow/direct/smoothies/smoothies.glsl";
        p.reads = {"placement", "resolution"};
        p.add_direct = add_smoothies;
        p.refuses = [](const Scene&, const Light&, const Recipe& recipe) { return refuses_fins("smoothies", recipe); };
        return p;
    }();
    return part;
}

}  // namespace parts
}  // namespace gn
