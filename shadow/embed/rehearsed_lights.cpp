// SPDX-License-Identifier: MIT
#include "shadow/embed/rehearsed_lights.h"

namespace gn::embed {

mat4 rehearsed_camera(bool orthographic, bool reversed) {
    Camera camera{.position_ws = vec3(0, 5, 7), .forward_ws = glm::normalize(vec3(0, -5, -7)), .far = 30};
    camera.half_height = orthographic ? 5.0F : 0.0F;
    mat4 turned(1);
    if (!reversed) {
        turned[2][2] = -1;
        turned[3][2] = 1;
    }
    return turned * cs_from_vs(camera, 1) * vs_from_ws(camera);
}

std::array<GnLight, rehearsed_kinds> rehearsed_lights(std::size_t situation) {
    const std::array from_ws{vec3(3, 6, 4), vec3(0, 5, 7), vec3(0, 4, -6), vec3(0.5F, 1, 0.5F), vec3(0, 400, 0)};
    const vec3 p_ws = from_ws.at(situation / 2);
    const float size = situation % 2 == 0 ? 0.0F : 0.3F;
    const vec3 d_ws = glm::normalize(-p_ws);
    const vec3 right_ws = glm::normalize(glm::cross(d_ws, vec3(0.1F, 0.2F, 1)));
    GnLight light;
    light.position_ws = vec4(p_ws, 1);
    light.direction_ws = vec4(d_ws, 0);
    light.right_ws = vec4(right_ws, 0);
    light.up_ws = vec4(glm::cross(right_ws, d_ws), 0);
    light.half_size = vec2(std::max(size, 0.01F));
    light.radius = size;
    light.angular_radius = 0.1F * size;
    light.cos_inner = std::cos(0.3F);
    light.cos_outer = std::cos(0.6F);
    light.range = 20;
    std::array<GnLight, rehearsed_kinds> lights;
    for (uint kind = 0; kind < rehearsed_kinds; ++kind) {
        lights[kind] = light;
        lights[kind].kind = kind;
    }
    return lights;
}

}  // namespace gn::embed
