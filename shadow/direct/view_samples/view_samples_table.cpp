// SPDX-License-Identifier: MIT
// Based on: Eisemann, Decoret. Visibility Sampling on GPU and Applications. Eurographics 2007. [ED07]
// Based on: Sintorn, Eisemann, Assarsson. Sample Based Visibility for Soft Shadows using Alias-free Shadow Maps. EGSR 2008. [SEA08]
// Departs from it: beside the points left of a texel's middle line a map may hold those left of all its lines and of any.
#include "shadow/direct/view_samples/view_samples_table.h"

#include "base/math.h"

#include <cmath>

namespace gn {
namespace {

using glsl::GnSampledLight;

/// Another light of the same shape, of width one where its size only scales it.
GnLight unit_light(const GnLight& light) {
    GnLight unit = light;
    unit.position_ws = vec4(0);
    unit.direction_ws = vec4(0, 0, -1, 0);
    unit.right_ws = vec4(1, 0, 0, 0);
    unit.up_ws = vec4(0, 1, 0, 0);
    unit.half_size = vec2(0.5F);
    unit.radius = 0.5F;
    unit.angular_radius = std::max(light.angular_radius, 1e-4F);
    return unit;
}

/// The line in the middle of a texel.
struct MiddleLine {
    vec3 n;
    float offset;
};
MiddleLine middle_line(const LeftMapShape& shape, int around, int across) {
    const float range = glsl::gn_left_range(shape.light);
    const float offset =
        range * (2.0F * (static_cast<float>(across) + 0.5F) / static_cast<float>(shape.offsets) - 1.0F);
    const int rings = shape.light.solid != 0 ? shape.angles / 2 : 1;
    const float turn = 2 * pi * ((static_cast<float>(around / rings) + 0.5F) / static_cast<float>(shape.angles) - 0.5F);
    if (shape.light.solid == 0) {
        return {vec3(std::cos(turn), std::sin(turn), 0), offset};
    }
    const float rise = pi * (static_cast<float>(around % rings) + 0.5F) / static_cast<float>(rings);
    return {vec3(std::sin(rise) * std::cos(turn), std::sin(rise) * std::sin(turn), std::cos(rise)), offset};
}

}  // namespace

GnSampledLight sampled_light(const GnLight& light) {
    GnSampledLight sampled{};
    vec3 x(light.right_ws);
    vec3 y(light.up_ws);
    vec2 width = 2.0F * light.half_size;
    sampled.centre_ws = vec4(vec3(light.position_ws), 1);
    sampled.square = light.kind == GN_LIGHT_RECTANGLE ? 1 : 0;
    if (light.kind == GN_LIGHT_POINT) {
        sampled.solid = 1;
        sampled.x_ws = vec4(2 * light.radius, 0, 0, 0);
        sampled.y_ws = vec4(0, 2 * light.radius, 0, 0);
        sampled.z_ws = vec4(0, 0, 2 * light.radius, 0);
        return sampled;
    }
    if (light.kind != GN_LIGHT_RECTANGLE) {
        complete_frame(vec3(light.direction_ws), x, y);
        width = vec2(2 * light.radius);
    }
    // A sun's points, seen on a plane across its middle at a distance of one.
    if (light.kind == GN_LIGHT_DIRECTIONAL) {
        sampled.centre_ws = vec4(-vec3(light.direction_ws), 0);
        width = vec2(2 * std::tan(light.angular_radius));
    }
    sampled.x_ws = vec4(width.x * x, 0);
    sampled.y_ws = vec4(width.y * y, 0);
    return sampled;
}

glsl::GnLightAxes light_axes(const GnLight& light) {
    vec3 x(1, 0, 0);
    vec3 y(0, 1, 0);
    vec3 z(0, 0, 1);
    if (light.kind != GN_LIGHT_POINT) {
        z = vec3(light.direction_ws);
        complete_frame(z, x, y);
    }
    return {vec4(x, 0), vec4(y, 0), vec4(z, 0)};
}

GnSampledLight ls_from_ws(const glsl::GnLightAxes& axes, GnSampledLight light) {
    for (vec4* v : {&light.centre_ws, &light.x_ws, &light.y_ws, &light.z_ws}) {
        *v = vec4(glsl::gn_ls_from_ws(axes, vec3(*v)), v->w);
    }
    return light;
}

std::vector<vec4> points_ws(const LightSamples& samples) {
    std::vector<vec4> points;
    for (const GnLight& one : samples.points) {
        points.push_back(one.kind == GN_LIGHT_DIRECTIONAL ? vec4(-vec3(one.direction_ws), 0)
                                                          : vec4(vec3(one.position_ws), 1));
    }
    return points;
}

std::vector<vec3> point_coordinates(const GnLight& light, int count) {
    const GnLight unit = unit_light(light);
    const GnSampledLight sampled = sampled_light(unit);
    std::vector<vec3> coordinates;
    for (const vec4& point : points_ws(light_samples(unit, count))) {
        const vec3 centre_ws(sampled.centre_ws);
        const vec3 from_centre =
            point.w > 0 ? vec3(point) - centre_ws : vec3(point) / glm::dot(vec3(point), centre_ws) - centre_ws;
        const auto along = [&](const vec4& axis) {
            const float length2 = glm::dot(axis, axis);
            return length2 > 0 ? glm::dot(from_centre, vec3(axis)) / length2 : 0.0F;
        };
        coordinates.emplace_back(along(sampled.x_ws), along(sampled.y_ws), along(sampled.z_ws));
    }
    return coordinates;
}

std::size_t left_map_texels(const LeftMapShape& shape) {
    return static_cast<std::size_t>(glsl::gn_left_around(shape.light, shape.angles)) *
           static_cast<std::size_t>(shape.offsets);
}

std::vector<std::uint32_t> left_sample_map(const LeftMapShape& shape, const std::vector<vec3>& coordinates) {
    const std::size_t texels = left_map_texels(shape);
    const std::size_t count = coordinates.size();
    const std::size_t patterns = count / static_cast<std::size_t>(shape.count);
    const std::size_t each = shape.bracket ? 2 : 1;
    std::vector<std::uint32_t> map(patterns * static_cast<std::size_t>(shape.words) * texels * each, 0);

    // A point moves against its line by half a texel's offset, and by half a texel's turn at its distance from the middle.
    const float half_offset = glsl::gn_left_range(shape.light) / static_cast<float>(shape.offsets);
    const float half_turn = pi / static_cast<float>(shape.angles) * (shape.light.solid != 0 ? std::sqrt(2.0F) : 1.0F);
    for (std::size_t texel = 0; texel < texels; ++texel) {
        const MiddleLine line =
            middle_line(shape, static_cast<int>(texel) / shape.offsets, static_cast<int>(texel) % shape.offsets);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t pattern = i / static_cast<std::size_t>(shape.count);
            const std::size_t own = i % static_cast<std::size_t>(shape.count);
            const std::size_t word = pattern * static_cast<std::size_t>(shape.words) + own / 32;
            const float left = glm::dot(line.n, coordinates[i]) + line.offset;
            std::uint32_t* const to = &map[(word * texels + texel) * each];
            const std::uint32_t bit = 1U << (own % 32);
            if (!shape.bracket) {
                to[0] |= left >= 0 ? bit : 0;
                continue;
            }
            const float moves = glm::length(coordinates[i]) * half_turn + half_offset + 2 * glsl::gn_left_blur;
            to[0] |= left > moves ? bit : 0;
            to[1] |= left > -moves ? bit : 0;
        }
    }
    return map;
}

}  // namespace gn
