// SPDX-License-Identifier: MIT
// The plain shadow map: the linear depth of the nearest caster, D32_SFLOAT.
//
// Based on: Williams. Casting Curved Shadows on Curved Surfaces. SIGGRAPH 1978. [Wil78]
// Departs from it: depth is linear in distance under every projection, so one bias means the same everywhere.
#include "shadow/map/raster.h"

namespace gn {
namespace {

ShadowMap add_depth(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    ShadowMap map;
    map.texture = input.graph.create({.name = "map",
                                      .format = VK_FORMAT_D32_SFLOAT,
                                      .width = views.resolution,
                                      .height = views.resolution,
                                      .layers = views.layers});
    map.sampler = nearest();
    add_caster_passes(input, recipe, views, {.depth = map.texture});
    return map;
}

}  // namespace

namespace parts {

const Part& map_depth() {
    static const Part part = [] {
        Part p;
        p.id = "depth";
        p.stage = Stage::map;
        p.title = "Linear depth of the nearest caster";
        p.citation = "Wil78";
        p.gives = "depth";
        p.add_map = add_depth;
        return p;
    }();
    return part;
}

}  // namespace parts
}  // namespace gn
