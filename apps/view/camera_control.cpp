// SPDX-License-Identifier: MIT
#include "apps/view/camera_control.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/gtx/quaternion.hpp>

#include <algorithm>

namespace gn {
namespace {

struct Axes {
    vec3 right, up;
};
Axes axes_of(const Camera& camera) {
    const vec3 right = glm::normalize(glm::cross(camera.forward_ws, camera.up_ws));
    return {right, glm::cross(right, camera.forward_ws)};
}

/// Turns about the camera's up axis of the world, then about its own right one; never over the pole.
glm::quat turn_of(const Camera& camera, vec2 angles) {
    const vec3 up = glm::normalize(camera.up_ws);
    const float height = std::asin(std::clamp(glm::dot(camera.forward_ws, up), -1.0F, 1.0F));
    const float pitch = std::clamp(angles.y, -1.55F - height, 1.55F - height);
    return glm::angleAxis(-angles.x, up) * glm::angleAxis(pitch, axes_of(camera).right);
}

}  // namespace

bool move_camera(Camera& camera, const CameraInput& input, const Box& bounds_ws) {
    if (input.look == vec2(0) && input.orbit == vec2(0) && input.move == vec3(0)) {
        return false;
    }
    if (input.orbit != vec2(0)) {
        const vec3 focus_ws = camera.position_ws + input.focus * camera.forward_ws;
        camera.forward_ws = glm::normalize(turn_of(camera, input.orbit) * camera.forward_ws);
        camera.position_ws = focus_ws - input.focus * camera.forward_ws;
    }
    if (input.look != vec2(0)) {
        camera.forward_ws = glm::normalize(turn_of(camera, input.look) * camera.forward_ws);
    }
    const Axes axes = axes_of(camera);
    camera.position_ws += input.move.x * axes.right + input.move.y * axes.up + input.move.z * camera.forward_ws;
    for (const vec3 corner : bounds_ws.corners()) {
        camera.far = std::max(camera.far, 1.05F * glm::distance(corner, camera.position_ws));
    }
    return true;
}

void point_light(GnLight& light, vec3 direction_ws) {
    const glm::quat turn = glm::rotation(vec3(light.direction_ws), glm::normalize(direction_ws));
    for (vec4* axis : {&light.direction_ws, &light.right_ws, &light.up_ws}) {
        *axis = vec4(glm::normalize(turn * vec3(*axis)), 0.0F);
    }
}

void drag_light(GnLight& light, const Camera& camera, vec2 radians, vec2 metres) {
    const Axes axes = axes_of(camera);
    if (light.kind == GN_LIGHT_DIRECTIONAL) {
        const glm::quat turn = glm::angleAxis(radians.x, vec3(0, 1, 0)) * glm::angleAxis(-radians.y, axes.right);
        point_light(light, turn * vec3(light.direction_ws));
    } else {
        light.position_ws += vec4(metres.x * axes.right + metres.y * axes.up, 0.0F);
    }
}

}  // namespace gn
