// SPDX-License-Identifier: MIT
#include "shadow/recipe/light_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gn {

Guard light_guard(const Light& light, const Box& bounds_ws, float least) {
    const GnLight& shape = light.shape;
    if (least == 0 && shape.radius == 0 && shape.angular_radius == 0 && shape.half_size == vec2(0)) {
        return {};
    }
    if (shape.kind != GN_LIGHT_DIRECTIONAL) {
        const float size =
            shape.kind == GN_LIGHT_RECTANGLE ? std::max(shape.half_size.x, shape.half_size.y) : shape.radius;
        return {.texels = least + 1, .metres = size, .before = std::numeric_limits<float>::infinity()};
    }
    const float height = glm::dot(bounds_ws.extent(), glm::abs(vec3(shape.direction_ws)));
    return {.texels = least + 1, .metres = std::tan(shape.angular_radius) * height, .before = height};
}

}  // namespace gn
