// SPDX-License-Identifier: MIT
// Forward shadow mapping: what the light sees is carried into the view and splatted, instead of the view asking the map.
//
// Based on: Zhang. Forward Shadow Mapping. Eurographics Workshop on Rendering 1998. [Zha98]
// Departs from it: splats are added up in one compute pass, and the camera's visibility is settled by the depth of each
// sample in the map, not by a second depth buffer.
//
// Stands on: shadow/placement/place (its map is placed as those of lookups are)
// Also here: forward_passes.h, forward_passes.cpp, forward_splat.glsl.
#include "shadow/direct/forward/forward_passes.h"

#include "shadow/casters/raster.h"
#include "shadow/frame/map_memory.h"
#include "shadow/placement/place.h"
#include "shadow/scene/casting.h"

namespace gn::parts::forward {
namespace {

Visibility add_forward(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnForwardParams>("forward");

    // See the scene from the light.
    const LightViews views = place_views(input, recipe);
    const TextureHandle depth = input.graph.create(TextureDesc{.name = "map",
                                                               .format = VK_FORMAT_D32_SFLOAT,
                                                               .width = views.resolution,
                                                               .height = views.resolution,
                                                               .layers = views.layers});
    check_map_memory(input, recipe, depth);
    add_caster_passes(input, recipe, views, {.depth = depth});

    // Carry every lit texel into the view.
    const BufferHandle samples = add_forward_samples(input, recipe, views, params);
    const BufferHandle light = add_forward_splats(input, recipe, views, depth, samples, params);
    return add_forward_resolve(input, samples, light);
}

std::string refuses(const Scene& scene, const Light& light, const Recipe& recipe) {
    // What is not in the map is lit by none of its texels.
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        if (scene.objects[i].receives && !casts(scene, i, &light)) {
            return fmt::format(
                "direct 'forward' lights what its map holds, and '{}' casts nothing for light '{}': it would stay "
                "dark; take hard or pcf, or tell it to cast or not to receive",
                scene.objects[i].name, light.name);
        }
    }
    return recipe.placement != nullptr && recipe.placement->bends
               ? fmt::format(
                     "direct 'forward' follows straight rays through its map and placement '{}' bends them; "
                     "use auto or cube",
                     recipe.placement->id)
               : "";
}

}  // namespace
}  // namespace gn::parts::forward

namespace gn::parts {

const Part& direct_forward() {
    using namespace forward;
    static const Part part = [] {
        Part p;
        p.id = "forward";
        p.stage = Stage::direct;
        p.title = "Forward shadow mapping";
        p.citation = "Zha98";
        p.params = param_table<GnForwardParams>({
            GN_PARAM(GnForwardParams, radius, integer, 0, 8, "texels",
                     "Reach of a splat: softer edges and wider dark rims, cost grows with its square; 0 is one texel."),
            GN_PARAM(GnForwardParams, tolerance, real, 0, 64, "texels",
                     "How far a splat may lie off a sample's plane and still light it: fewer dark rims, more leaks."),
            GN_PARAM(
                GnForwardParams, max_pixels, integer, 1, 512, "pixels",
                "Limit of a splat's reach on screen: magnified maps tear where it is too small, and cost more where "
                "it is large."),
        });
        p.params_type = "GnForwardParams";
        p.glsl = "shadow/direct/forward/forward.glsl";
        p.reads = {"placement", "resolution"};
        p.add_direct = add_forward;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
