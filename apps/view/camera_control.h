// SPDX-License-Identifier: MIT
// How mouse and keyboard move cameras and lights.
#pragma once

#include "shadow/scene/scene.h"

namespace gn {

struct CameraInput {
    vec2 look{0};     ///< radians: to the right, upwards; the eye stays
    vec2 orbit{0};    ///< radians: around a point before the eye
    vec3 move{0};     ///< metres: right, up, forward
    float focus = 1;  ///< metres to the point that orbits go around
};
/// Whether anything moved. The far plane goes on to hold `bounds_ws`.
bool move_camera(Camera& camera, const CameraInput& input, const Box& bounds_ws);

/// A sun turns with all its axes, by radians to the camera's right and upwards; other lights move, by metres.
void drag_light(GnLight& light, const Camera& camera, vec2 radians, vec2 metres);
/// Turns a light with all its axes until it shines along a direction.
void point_light(GnLight& light, vec3 direction_ws);

}  // namespace gn
