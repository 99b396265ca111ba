// SPDX-License-Identifier: MIT
// Six perspective views around a light, layers of one array: any lookup works on them unchanged.
//
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09]
// Departs from it: a 2D array whose faces overlap by the kernels' reach, where hardware cubes would filter across faces.
#include "shadow/placement/cube/cube.h"

namespace gn {

void add_cube_views(LightViews& views, const FrameInput& input, const Recipe& recipe) {
    const vec3 eye_ws(input.light().shape.position_ws);
    const double far = 1.001 * farthest(input.scene.bounds_ws, eye_ws) + 1e-3;
    const double share = std::min(0.4, static_cast<double>(guard_of(recipe).texels) / recipe.resolution);

    // A world radius is widest in angle where receivers are nearest; it is held to a tenth of the face.
    const double tangent = 1 / (1 - 2 * share) + (guard_of(recipe).metres > 0 ? 0.1 : 0.0);
    const std::array<std::pair<vec3, vec3>, 6> faces{{{vec3(1, 0, 0), vec3(0, 1, 0)},
                                                      {vec3(-1, 0, 0), vec3(0, 1, 0)},
                                                      {vec3(0, 1, 0), vec3(0, 0, 1)},
                                                      {vec3(0, -1, 0), vec3(0, 0, 1)},
                                                      {vec3(0, 0, 1), vec3(0, 1, 0)},
                                                      {vec3(0, 0, -1), vec3(0, 1, 0)}}};
    views.views.clear();
    for (const auto& [axis_ws, up_ws] : faces) {
        views.views.push_back(
            square_perspective(eye_ws, axis_ws, up_ws, tangent, near_plane(far), far, recipe.resolution));
        views.views.back().layer = static_cast<int>(views.views.size()) - 1;
    }
    views.layers = 6;
    views.data[0] = vec4(eye_ws, 1);
}

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
