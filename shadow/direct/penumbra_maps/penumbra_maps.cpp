// SPDX-License-Identifier: MIT
// A shadow map, and beside it a map of penumbrae: how much light the surface in each texel has beside a hard edge.
//
// Based on: Wyman, Hansen. Penumbra Maps: Approximate Soft Shadows in Real-Time. EGSR 2003. [WH03]
// Departs from it: cones and sheets are evaluated on fins around the silhouettes, not drawn as triangles.
//
// Stands on: shadow/placement/place (its map is placed as those of lookups are)
#include "shadow/direct/penumbra_maps/penumbra_maps.glsl"

#include "shadow/casters/fins.h"
#include "shadow/casters/raster.h"
#include "shadow/frame/frame.h"
#include "shadow/frame/map_memory.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/placement/place.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {
namespace {

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
            // The hard shadow is the umbra; beside it the penumbra map says how much light there is.
            ivec2 texel = ivec2(floor(p.uv_ts / p.texel_ts));
            vec2 centre_ts = (vec2(texel) + 0.5) * p.texel_ts;
            float occluder = texelFetch(depth_map, ivec3(texel, view.layer), 0).r;
            v = gn_depth_at(p, centre_ts, u.bias) > occluder
                    ? 0.0
                    : texelFetch(penumbrae, ivec3(texel, view.layer), 0).r;
        }
    }
    imageStore(visibility, pixel, vec4(v));
}
)";

constexpr const char* penumbra_text = R"(
    bool lamp = u.light_ws.w > 0.0;
    float eye = lamp ? dot(views[index].depth_from_ws, u.light_ws) : 0.0;
    float surface = texelFetch(depth_map, texel, 0).r;
    result = gn_penumbra_maps_light(off, (edge_depth - eye) * views[index].metres_per_depth,
                                    (surface - eye) * views[index].metres_per_depth, lamp);
)";

Visibility add_resolve_fins(const FrameInput& input, const Recipe& recipe, const LightViews& views, TextureHandle depth,
                            TextureHandle penumbrae) {
    Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs = sample_inputs(input, recipe, views);
    inputs.texture("sampler2DArray", "depth_map", depth)
        .texture("sampler2DArray", "penumbrae", penumbrae)
        .image("r32f", "writeonly", "image2D", "visibility", result.image);
    const std::string defines = receiver_defines(recipe, views);
    const std::string functions = sample_functions(input, recipe, views);
    const Hasher key = hashed(inputs).text(defines).text(functions).text(views.part->id);
    const auto shader = compute_once(input.prepared, "penumbra-maps.comp", key, [&] {
        return defines + include_line("shadow/view/view.glsl") + placement_text(*views.part, recipe) +
               include_line("shadow/direct/penumbra_maps/penumbra_maps.glsl") + inputs.text() + functions + text;
    });
    input.graph.add_pass(
        "penumbra-maps: resolve", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, width = input.samples.width, height = input.samples.height](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch_pixels(width, height);
        });
    return result;
}

Visibility add_penumbra_maps(const FrameInput& input, const Recipe& recipe) {
    const LightViews views = place_views(input, recipe);
    if (views.tiles) {
        refuse("penumbra-maps draws fins into whole views, and placement '{}' has tiles; use auto or cascades",
               views.part->id);
    }
    TextureDesc desc{.name = "map",
                     .format = VK_FORMAT_D32_SFLOAT,
                     .width = views.resolution,
                     .height = views.resolution,
                     .layers = views.layers};
    const TextureHandle depth = input.graph.create(desc);
    desc.name = "penumbra-maps";
    desc.format = VK_FORMAT_R32_SFLOAT;
    const TextureHandle penumbrae = input.graph.create(desc);
    check_map_memory(input, recipe, depth);
    add_caster_passes(input, recipe, views, {.depth = depth});
    ShaderInputs surfaces;
    surfaces.texture("sampler2DArray", "depth_map", depth);
    add_fins(input, add_fin_edges(input), views,
             {.name = "penumbra-maps: cones and sheets",
              .includes = "#include \"shadow/direct/penumbra_maps/penumbra_maps.glsl\"\n",
              .fragment = penumbra_text,
              .extra = surfaces},
             penumbrae, {.color = vec4(1)});
    return add_resolve_fins(input, recipe, views, depth, penumbrae);
}

}  // namespace

namespace parts {

const Part& direct_penumbra_maps() {
    static const Part part = [] {
        Part p;
        p.id = "penumbra-maps";
        p.stage = Stage::direct;
        p.title = "Penumbra maps";
        p.citation = "WH03";
        p.features = {Feature::float32_blend};
        p.needs_scene = true;
        p.glsl = "shadow/direct/penumbra_maps/penumbra_maps.glsl";
        p.reads = {"placement", "resolution"};
        p.add_direct = add_penumbra_maps;
        p.refuses = [](const Scene&, const Light&, const Recipe& recipe) {
            return refuses_fins("penumbra-maps", recipe);
        };
        return p;
    }();
    return part;
}

}  // namespace parts
}  // namespace gn
