// SPDX-License-Identifier: MIT
// The host's camera: Vulkan's clip space, y downwards, depth reversed, the far plane infinitely far away.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

struct HostCamera {
    glm::vec3 eye_ws{0};
    glm::vec3 target_ws{0};
    float yfov = 0.62F;  ///< full vertical angle, radians
    float near = 0.1F;   ///< metres

    [[nodiscard]] glm::mat4 cs_from_ws(float aspect) const {
        const float scale = 1 / std::tan(0.5F * yfov);
        glm::mat4 cs_from_vs(0);
        cs_from_vs[0][0] = scale / aspect;
        cs_from_vs[1][1] = -scale;
        cs_from_vs[2][3] = -1;
        cs_from_vs[3][2] = near;
        return cs_from_vs * glm::lookAt(eye_ws, target_ws, glm::vec3(0, 1, 0));
    }

    /// Around the clearing; `along` goes from 0 to 1.
    static HostCamera on_path(float along) {
        const float angle = 0.15F + 0.5F * along;
        return {.eye_ws = {20.0F * std::sin(angle), 11.0F, 20.0F * std::cos(angle)}, .target_ws = {0.3F, 0.4F, 0.4F}};
    }
};
