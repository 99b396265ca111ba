// SPDX-License-Identifier: MIT
// Six perspective views around a light, layers of one array: any lookup works on them unchanged.
//
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09]
// Departs from it: a 2D array whose faces overlap by the kernels' reach, where hardware cubes would filter across faces.
#include "shadow/placement/receivers.h"

namespace gn {

namespace {

LightViews place_cube(const FrameInput& input, const Recipe& recipe) {
    LightViews views;
    views.resolution = static_cast<std::uint32_t>(recipe.resolution);
    add_cube_views(views, input, recipe);
    return views;
}

}  // namespace

namespace parts {

const Part& placement_cube() {
    static const Part part = [] {
        Part p;
        p.id = "cube";
        p.stage = Stage::placement;
        p.title = "Six faces around the light";
        p.citation = "EASW09";
        p.lights = {.spot = true, .point = true, .rectangle = true};
        p.glsl = "shadow/placement/cube/cube.glsl";
        p.place = place_cube;
        return p;
    }();
    return part;
}

}  // namespace parts
}  // namespace gn
