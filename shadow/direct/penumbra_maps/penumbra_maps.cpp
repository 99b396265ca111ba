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
#include "shadow/frame/map_memory.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/placement/place.h"

namespace gn::parts::penumbra_maps {
namespace {

constexpr const char* penumbra_text = R"(
    bool lamp = u.light_ws.w > 0.0;
    float eye = lamp ? dot(views[index].depth_from_ws, u.light_ws) : 0.0;
    float surface = texelFetch(depth_map, texel, 0).r;
    result = gn_penumbra_maps_light(off, (edge_depth - eye) * views[index].metres_per_depth,
                                    (surface - eye) * views[index].metres_per_depth, lamp);
)";

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
    add_fins(input, add_all_silhouettes(input), views,
             {.name = "penumbra-maps: cones and sheets",
              .includes = "#include \"shadow/direct/penumbra_maps/penumbra_maps.glsl\"\n",
              .fragment = penumbra_text,
              .extra = surfaces},
             penumbrae, {.color = vec4(1)});
    // Beside the hard shadow, which is the umbra, the penumbra map says how much light there is.
    return add_fin_resolve(input, recipe, views, depth, penumbrae, {"penumbra-maps: resolve", "fin.r"});
}

}  // namespace
}  // namespace gn::parts::penumbra_maps

namespace gn::parts {

const Part& direct_penumbra_maps() {
    using namespace penumbra_maps;
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

}  // namespace gn::parts
