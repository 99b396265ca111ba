// SPDX-License-Identifier: MIT
#include "world.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>

namespace {

constexpr float ground_half = 60;  // metres
constexpr float clearing = 5.6F;   // nothing moves nearer to the middle than 0.5 m outside of this
constexpr float highest = 3.4F;    // the tall box
constexpr float golden_angle = 2.3999632F;

/// Object i of the spiral takes its share of the plane: so many square metres each.
glm::vec2 place(std::uint32_t i, float turned, float& radius) {
    constexpr float share = 0.62F / 3.14159265F;
    radius = std::sqrt((clearing + 0.5F) * (clearing + 0.5F) + share * static_cast<float>(i));
    const float angle = golden_angle * static_cast<float>(i) + turned;
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Waves that run outwards, 0 to 1.
float wave(float radius, float seconds) {
    return 0.5F + 0.5F * std::sin(0.9F * radius - 2.0F * seconds);
}

glm::mat4 placed(glm::vec3 at_ws, glm::vec3 scale, float turned) {
    const glm::mat4 moved = glm::translate(glm::mat4(1), at_ws);
    return glm::scale(glm::rotate(moved, turned, glm::vec3(0, 1, 0)), scale);
}

glm::vec4 color_of(std::uint32_t i, bool ball) {
    const float along = 0.5F + 0.5F * std::sin(0.006F * static_cast<float>(i));
    return ball ? glm::vec4(glm::mix(glm::vec3(0.72F, 0.14F, 0.08F), glm::vec3(0.80F, 0.45F, 0.08F), along), 0)
                : glm::vec4(glm::mix(glm::vec3(0.55F, 0.52F, 0.48F), glm::vec3(0.16F, 0.30F, 0.38F), along), 0);
}

}  // namespace

World::World(std::uint32_t moving) : balls_(moving / 5) {
    columns_ = moving - balls_;
    const Mesh box = add_box(), ball = add_ball();

    // The ground, the tall box and the columns are boxes; the last ball is the lamp's.
    add_group(box, 2 + columns_);
    add_group(ball, balls_ + 1);
    casters = 2 + columns_ + balls_;
    colors = {{0.36F, 0.33F, 0.30F, 0}, {0.52F, 0.50F, 0.48F, 0}};
    for (std::uint32_t i = 0; i < columns_; ++i) {
        colors.push_back(color_of(i, false));
    }
    for (std::uint32_t i = 0; i < balls_; ++i) {
        colors.push_back(color_of(i, true));
    }
    colors.emplace_back(1.0F, 0.62F, 0.28F, 1);
    least_ws = {-ground_half, -0.2F, -ground_half};
    greatest_ws = {ground_half, highest, ground_half};
}

glm::vec3 World::towards_sun() {
    return glm::normalize(glm::vec3(-0.60F, 0.52F, -0.62F));
}

void World::pose(float seconds, std::span<glm::mat4> ws_from_os) const {
    ws_from_os[0] = placed({0, -0.2F, 0}, {2 * ground_half, 0.2F, 2 * ground_half}, 0);
    ws_from_os[1] = placed({-1.4F, 0, -1.2F}, {1.6F, highest, 0.8F}, 0);
    std::uint32_t column = 0, ball = 0;
    for (std::uint32_t i = 0; i < columns_ + balls_; ++i) {
        float radius = 0;
        const glm::vec2 at = place(i, 0.05F * seconds, radius);
        const float up = wave(radius, seconds);
        if (i % 5 == 4) {
            ws_from_os[2 + columns_ + ball++] = placed({at.x, 0.3F + 0.9F * up, at.y}, glm::vec3(0.3F), 0);
        } else {
            ws_from_os[2 + column++] = placed({at.x, 0, at.y}, {0.4F, 0.25F + 1.1F * up, 0.4F}, std::atan2(at.x, at.y));
        }
    }
    ws_from_os[2 + columns_ + balls_] = placed(lamp_ws, glm::vec3(lamp_radius), 0);
}

void World::add_group(const Mesh& mesh, std::uint32_t count) {
    const std::uint32_t first = groups.empty() ? 0 : groups.back().first + groups.back().count;
    groups.push_back({mesh, first, count});
}

/// One metre wide and deep around the y axis, from y = 0 to 1; outsides are counter-clockwise.
Mesh World::add_box() {
    Mesh mesh{static_cast<std::uint32_t>(vertices.size()), 24, static_cast<std::uint32_t>(indices.size()), 36};
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0F, 1.0F}) {
            glm::vec3 n(0), u(0);
            n[axis] = side;
            u[(axis + 1) % 3] = 1;
            const glm::vec3 v = glm::cross(n, u);
            const auto first = static_cast<std::uint32_t>(vertices.size()) - mesh.first_vertex;
            for (const glm::vec2 at : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
                vertices.push_back({0.5F * (n + at.x * u + at.y * v) + glm::vec3(0, 0.5F, 0), n});
            }
            indices.insert(indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
        }
    }
    return mesh;
}

/// Radius 1 around the origin: an octahedron's faces, each cut into a grid of triangles on the sphere.
Mesh World::add_ball() {
    constexpr std::uint32_t cuts = 6;
    Mesh mesh{static_cast<std::uint32_t>(vertices.size()), 0, static_cast<std::uint32_t>(indices.size()), 0};
    for (unsigned face = 0; face < 8; ++face) {
        const glm::vec3 x((face & 1U) != 0 ? -1 : 1, 0, 0), y(0, (face & 2U) != 0 ? -1 : 1, 0),
            z(0, 0, (face & 4U) != 0 ? -1 : 1);
        const bool mirrored = glm::dot(glm::cross(x, y), z) < 0;
        const std::array<glm::vec3, 3> corners{x, mirrored ? z : y, mirrored ? y : z};
        const auto begin = static_cast<std::uint32_t>(vertices.size()) - mesh.first_vertex;

        // Row r has cuts + 1 - r points.
        const auto at = [&](std::uint32_t row, std::uint32_t column) {
            return begin + row * (cuts + 1) - row * (row - 1) / 2 + column;
        };
        for (std::uint32_t row = 0; row <= cuts; ++row) {
            for (std::uint32_t column = 0; column + row <= cuts; ++column) {
                const glm::vec3 n =
                    glm::normalize(static_cast<float>(cuts - row - column) * corners[0] +
                                   static_cast<float>(column) * corners[1] + static_cast<float>(row) * corners[2]);
                vertices.push_back({n, n});
                if (column + row < cuts) {
                    indices.insert(indices.end(), {at(row, column), at(row, column + 1), at(row + 1, column)});
                }
                if (column + row + 1 < cuts) {
                    indices.insert(indices.end(), {at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)});
                }
            }
        }
    }
    mesh.vertex_count = static_cast<std::uint32_t>(vertices.size()) - mesh.first_vertex;
    mesh.index_count = static_cast<std::uint32_t>(indices.size()) - mesh.first_index;
    return mesh;
}
