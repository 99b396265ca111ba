// SPDX-License-Identifier: MIT
#include "shadow/scene/light_samples.h"

#include "base/disc.h"
#include "base/error.h"
#include "base/sobol.h"

#include <algorithm>

namespace gn {
namespace {

bool has_extent(const GnLight& light) {
    switch (light.kind) {
        case GN_LIGHT_DIRECTIONAL: return light.angular_radius > 0;
        case GN_LIGHT_RECTANGLE: return light.half_size.x > 0 || light.half_size.y > 0;
        default: return light.radius > 0;
    }
}

/// A point of the light's surface from a point of the unit square; a sun's cone is about its direction.
vec3 on_surface(const GnLight& light, vec2 u) {
    const vec3 centre_ws(light.position_ws);
    vec3 x;
    vec3 y;
    switch (light.kind) {
        case GN_LIGHT_DIRECTIONAL: {
            const vec3 axis_ws(light.direction_ws);
            complete_frame(axis_ws, x, y);
            return direction_in_cone(disc_from_square(u), cone_height(light.angular_radius), x, y, axis_ws);
        }
        case GN_LIGHT_SPOT: {
            complete_frame(vec3(light.direction_ws), x, y);
            const vec2 d = light.radius * disc_from_square(u);
            return centre_ws + d.x * x + d.y * y;
        }
        case GN_LIGHT_RECTANGLE: {
            const vec2 s = (2.0F * u - 1.0F) * light.half_size;
            return centre_ws + s.x * vec3(light.right_ws) + s.y * vec3(light.up_ws);
        }
        default: {
            // All directions are a cone of 180 degrees.
            return centre_ws + light.radius * direction_in_cone(disc_from_square(u), 2.0F, vec3(1, 0, 0), vec3(0, 1, 0),
                                                                vec3(0, 0, 1));
        }
    }
}

/// The light without its extent, a point or a sun; what a spot or a rectangle does not shine on is the whole light's affair.
GnLight bare(const GnLight& light, vec3 at_ws) {
    GnLight one = light;
    one.radius = one.angular_radius = one.range = 0;
    one.half_size = vec2(0);
    if (light.kind == GN_LIGHT_DIRECTIONAL) {
        one.direction_ws = vec4(glm::normalize(at_ws), 0);
        return one;
    }
    one.kind = GN_LIGHT_POINT;
    one.position_ws = vec4(at_ws, 1);
    return one;
}

}  // namespace

LightSamples light_samples(const GnLight& light, int count, int side) {
    GN_CHECK(count >= 1 && side >= 1 && side * side <= count);
    LightSamples samples;
    if (!has_extent(light)) {
        samples.points = {
            bare(light, vec3(light.kind == GN_LIGHT_DIRECTIONAL ? light.direction_ws : light.position_ws))};
        return samples;
    }
    samples.side = side;
    for (int i = 0; i < count; ++i) {
        samples.points.push_back(bare(light, on_surface(light, sobol_owen(static_cast<uint>(i), 0))));
    }
    return samples;
}

}  // namespace gn
