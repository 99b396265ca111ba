// SPDX-License-Identifier: MIT
// Solids swept from a line: lathes, rings, tubes, and walls over an arched underside.
#include "scenes/mesh_builder.h"

#include "base/error.h"

#include <algorithm>

namespace gn::scenes {
namespace {

// The normals at both ends of every segment of a polyline whose outside is to the right of its direction: averaged
// with the neighbour's where the corner is blunter than 40 degrees.
std::vector<std::array<vec2, 2>> segment_normals(std::span<const vec2> line, bool loop) {
    const std::size_t count = loop ? line.size() : line.size() - 1;
    std::vector<vec2> flat(count);
    for (std::size_t i = 0; i < count; ++i) {
        const vec2 along = line[(i + 1) % line.size()] - line[i];
        flat[i] = glm::normalize(vec2(along.y, -along.x));
    }
    const auto blend = [&](std::size_t i, std::size_t other) {
        return glm::dot(flat[i], flat[other]) > 0.766F ? glm::normalize(flat[i] + flat[other]) : flat[i];
    };
    std::vector<std::array<vec2, 2>> normals(count);
    for (std::size_t i = 0; i < count; ++i) {
        normals[i][0] = i > 0 || loop ? blend(i, (i + count - 1) % count) : flat[i];
        normals[i][1] = i + 1 < count || loop ? blend(i, (i + 1) % count) : flat[i];
    }
    return normals;
}

}  // namespace

void MeshBuilder::lathe(std::span<const vec2> profile, int sides) {
    // Cap the ends that lie off the axis.
    std::vector<vec2> line(profile.begin(), profile.end());
    if (line.front().x > 0) {
        line.insert(line.begin(), vec2(0, line.front().y));
    }
    if (line.back().x > 0) {
        line.emplace_back(0, line.back().y);
    }
    // Sweep every segment about the axis; a corner on the axis makes one triangle a side instead of two.
    const auto normals = segment_normals(line, false);
    const auto direction = [&](int k) {
        const float angle = 2 * pi * static_cast<float>(k % sides) / static_cast<float>(sides);
        return vec3(std::sin(angle), 0, std::cos(angle));
    };
    float v = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const float length = glm::distance(line[i], line[i + 1]);
        const float girth = std::max(line[i].x, line[i + 1].x) * 2 * pi;
        std::array<std::vector<std::uint32_t>, 2> ids;
        for (int k = 0; k <= sides; ++k) {
            for (std::size_t e = 0; e < 2; ++e) {
                const vec2 at = line[i + e];
                const vec2 n = normals[i][e];
                const vec2 uv(static_cast<float>(k) / static_cast<float>(sides) * girth,
                              v + static_cast<float>(e) * length);
                ids[e].push_back(vertex(direction(k) * at.x + vec3(0, at.y, 0), direction(k) * n.x + vec3(0, n.y, 0),
                                        uv * repeats_));
            }
        }
        for (std::size_t k = 0; k < static_cast<std::size_t>(sides); ++k) {
            if (line[i].x > 0) {
                triangle(ids[0][k], ids[0][k + 1], ids[1][k + 1]);
            }
            if (line[i + 1].x > 0) {
                triangle(ids[0][k], ids[1][k + 1], ids[1][k]);
            }
        }
        v += length;
    }
}

void MeshBuilder::ring(float radius, float height, float tube, int sides, int tube_sides) {
    for (int k = 0; k < sides; ++k) {
        for (int j = 0; j < tube_sides; ++j) {
            std::array<std::uint32_t, 4> ids{};
            for (int corner = 0; corner < 4; ++corner) {
                const int dk = corner == 1 || corner == 2 ? 1 : 0;
                const int dj = corner >= 2 ? 1 : 0;
                const float a = 2 * pi * static_cast<float>((k + dk) % sides) / static_cast<float>(sides);
                const float b = 2 * pi * static_cast<float>((j + dj) % tube_sides) / static_cast<float>(tube_sides);
                const vec3 out(std::sin(a), 0, std::cos(a));
                const vec3 n = out * std::cos(b) + vec3(0, std::sin(b), 0);
                ids[static_cast<std::size_t>(corner)] =
                    vertex(out * radius + n * tube + vec3(0, height, 0), n, vec2(a * radius, b * tube) * repeats_);
            }
            triangle(ids[0], ids[1], ids[2]);
            triangle(ids[0], ids[2], ids[3]);
        }
    }
}

void MeshBuilder::tube(std::span<const vec3> path, std::span<const float> radii, int sides) {
    GN_CHECK_EQ(path.size(), radii.size());
    // Carry a frame along the path by the smallest turn between neighbouring tangents.
    std::vector<std::vector<vec3>> points;
    std::vector<std::vector<vec3>> outs;
    vec3 x{0}, y{0};
    for (std::size_t i = 0; i < path.size(); ++i) {
        const vec3 tangent = glm::normalize(path[std::min(i + 1, path.size() - 1)] - path[i == 0 ? 0 : i - 1]);
        if (i == 0) {
            complete_frame(tangent, x, y);
        }
        x = glm::normalize(x - tangent * glm::dot(x, tangent));
        y = glm::cross(tangent, x);
        auto& ring_points = points.emplace_back();
        auto& ring_outs = outs.emplace_back();
        for (int k = 0; k < sides; ++k) {
            const float a = 2 * pi * static_cast<float>(k) / static_cast<float>(sides);
            ring_outs.push_back(x * std::cos(a) + y * std::sin(a));
            ring_points.push_back(path[i] + ring_outs.back() * radii[i]);
        }
    }
    // Skin neighbouring rings, then cap both ends.
    float v = 0;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        const float length = glm::distance(path[i], path[i + 1]);
        std::array<std::vector<std::uint32_t>, 2> ids;
        for (std::size_t k = 0; k <= static_cast<std::size_t>(sides); ++k) {
            const std::size_t at = k % static_cast<std::size_t>(sides);
            const float u = 2 * pi * radii[0] * static_cast<float>(k) / static_cast<float>(sides);
            for (std::size_t e = 0; e < 2; ++e) {
                ids[e].push_back(
                    vertex(points[i + e][at], outs[i + e][at], vec2(u, v + static_cast<float>(e) * length) * repeats_));
            }
        }
        for (std::size_t k = 0; k < static_cast<std::size_t>(sides); ++k) {
            triangle(ids[0][k], ids[0][k + 1], ids[1][k + 1]);
            triangle(ids[0][k], ids[1][k + 1], ids[1][k]);
        }
        v += length;
    }
    polygon(points.back(), glm::normalize(path.back() - path[path.size() - 2]));
    std::reverse(points.front().begin(), points.front().end());
    polygon(points.front(), glm::normalize(path[0] - path[1]));
}

void MeshBuilder::rod(vec3 from, vec3 to, float radius, int sides) {
    tube(std::array{from, to}, std::array{radius, radius}, sides);
}

void MeshBuilder::sphere(vec3 centre, float radius, int sides) {
    std::vector<vec2> profile;
    const int rings = std::max(sides / 2, 3);
    for (int i = 0; i <= rings; ++i) {
        const float a = pi * static_cast<float>(i) / static_cast<float>(rings);
        const bool pole = i == 0 || i == rings;
        profile.emplace_back(pole ? 0.0F : radius * std::sin(a), -radius * std::cos(a));
    }
    const mat4 before = ws_from_os_;
    ws_from_os_ = glm::translate(before, centre);
    lathe(profile, sides);
    ws_from_os_ = before;
}

void MeshBuilder::wall_over(std::span<const vec2> underside, float top, float depth) {
    // One vertical strip of front, back, top and soffit for every segment of the underside.
    const auto normals = segment_normals(underside, false);
    const auto at = [&](std::size_t i, bool high, bool front) {
        return vec3(underside[i].x, high ? top : underside[i].y, front ? depth : 0.0F);
    };
    float along = 0;
    for (std::size_t i = 0; i + 1 < underside.size(); ++i) {
        face(at(i, false, true), at(i + 1, false, true), at(i + 1, true, true), at(i, true, true));
        face(at(i + 1, false, false), at(i, false, false), at(i, true, false), at(i + 1, true, false));
        face(at(i, true, true), at(i + 1, true, true), at(i + 1, true, false), at(i, true, false));
        const float length = glm::distance(underside[i], underside[i + 1]);
        std::array<std::uint32_t, 4> ids{};
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t e = k == 1 || k == 2 ? 1 : 0;
            const bool front = k >= 2;
            ids[k] = vertex(at(i + e, false, front), vec3(normals[i][e], 0),
                            vec2(along + static_cast<float>(e) * length, front ? depth : 0.0F) * repeats_);
        }
        triangle(ids[0], ids[1], ids[2]);
        triangle(ids[0], ids[2], ids[3]);
        along += length;
    }
    // Close both ends.
    const std::size_t last = underside.size() - 1;
    face(at(0, false, false), at(0, false, true), at(0, true, true), at(0, true, false));
    face(at(last, false, true), at(last, false, false), at(last, true, false), at(last, true, true));
}

}  // namespace gn::scenes
