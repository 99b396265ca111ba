// SPDX-License-Identifier: MIT
#include "scenes/mesh_builder.h"

#include "base/error.h"

#include <algorithm>

namespace gn::scenes {
namespace {

// Texture coordinates in metres along a face with normal n: world axes projected onto the plane nearest to it.
vec2 planar_uv(vec3 p, vec3 n) {
    const vec3 a = glm::abs(n);
    if (a.y >= a.x && a.y >= a.z) {
        return {p.x, p.z};
    }
    return a.x >= a.z ? vec2(p.z, -p.y) : vec2(p.x, -p.y);
}

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

int MeshBuilder::material(std::string name, vec3 linear_rgb, float roughness, float metallic, int texture) {
    Material m;
    m.name = std::move(name);
    m.base_color = vec4(linear_rgb, 1.0F);
    m.roughness = roughness;
    m.metallic = metallic;
    m.base_color_texture = texture;
    scene_.materials.push_back(std::move(m));
    return static_cast<int>(scene_.materials.size()) - 1;
}

int MeshBuilder::texture(Texture texture) {
    scene_.textures.push_back(std::move(texture));
    return static_cast<int>(scene_.textures.size()) - 1;
}

void MeshBuilder::begin(std::string name, int material, float repeats_per_metre) {
    close_object();
    Object object;
    object.name = std::move(name);
    object.material = material;
    object.first_triangle = static_cast<std::uint32_t>(scene_.triangles.size());
    scene_.objects.push_back(std::move(object));
    ws_from_os_ = mat4(1.0F);
    repeats_ = repeats_per_metre;
    open_ = true;
}

void MeshBuilder::place(const mat4& ws_from_os) {
    ws_from_os_ = ws_from_os;
}

void MeshBuilder::place(vec3 position_ws, float yaw) {
    ws_from_os_ = glm::rotate(glm::translate(mat4(1.0F), position_ws), yaw, vec3(0, 1, 0));
}

void MeshBuilder::close_object() {
    if (!open_) {
        return;
    }
    Object& object = scene_.objects.back();
    object.triangle_count = static_cast<std::uint32_t>(scene_.triangles.size()) - object.first_triangle;
    GN_CHECK(object.triangle_count > 0);
    for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
        const uvec3 corners = scene_.triangles[object.first_triangle + t];
        for (int k = 0; k < 3; ++k) {
            object.bounds_ws.grow(scene_.positions_ws[corners[k]]);
        }
    }
    open_ = false;
}

void MeshBuilder::finish() {
    close_object();
    for (const Object& object : scene_.objects) {
        scene_.bounds_ws.grow(object.bounds_ws);
    }
}

std::uint32_t MeshBuilder::vertex(vec3 p_os, vec3 n_os, vec2 uv) {
    scene_.positions_ws.emplace_back(ws_from_os_ * vec4(p_os, 1.0F));
    scene_.normals_ws.push_back(glm::normalize(vec3(ws_from_os_ * vec4(n_os, 0.0F))));
    scene_.uvs.push_back(uv);
    return static_cast<std::uint32_t>(scene_.positions_ws.size()) - 1;
}

void MeshBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    scene_.triangles.emplace_back(a, b, c);
}

void MeshBuilder::polygon(std::span<const vec3> corners, vec3 n_os) {
    std::vector<std::uint32_t> ids;
    for (const vec3 p : corners) {
        ids.push_back(vertex(p, n_os, planar_uv(p, n_os) * repeats_));
    }
    for (std::size_t i = 2; i < ids.size(); ++i) {
        triangle(ids[0], ids[i - 1], ids[i]);
    }
}

void MeshBuilder::face(vec3 a, vec3 b, vec3 c, vec3 d) {
    polygon(std::array{a, b, c, d}, glm::normalize(glm::cross(c - a, d - b)));
}

void MeshBuilder::sheet(vec3 corner, vec3 edge_u, vec3 edge_v, bool unit_uv) {
    const vec3 n = glm::normalize(glm::cross(edge_u, edge_v));
    const vec2 size = unit_uv ? vec2(1) : vec2(glm::length(edge_u), glm::length(edge_v)) * repeats_;
    const auto a = vertex(corner, n, {0, size.y});
    const auto b = vertex(corner + edge_u, n, {size.x, size.y});
    const auto c = vertex(corner + edge_u + edge_v, n, {size.x, 0});
    const auto d = vertex(corner + edge_v, n, {0, 0});
    triangle(a, b, c);
    triangle(a, c, d);
}

void MeshBuilder::box(vec3 low, vec3 high) {
    std::array<vec3, 8> c = Box{low, high}.corners();
    face(c[0], c[4], c[6], c[2]);  // -x
    face(c[1], c[3], c[7], c[5]);  // +x
    face(c[0], c[1], c[5], c[4]);  // -y
    face(c[2], c[6], c[7], c[3]);  // +y
    face(c[0], c[2], c[3], c[1]);  // -z
    face(c[4], c[5], c[7], c[6]);  // +z
}

void MeshBuilder::chamfered_slab(vec3 low, vec3 high, float chamfer) {
    // Three rings of four corners: the bottom, the foot of the chamfer, the top.
    const auto ring_at = [&](float y, float inset) {
        return std::array{vec3(low.x + inset, y, low.z + inset), vec3(low.x + inset, y, high.z - inset),
                          vec3(high.x - inset, y, high.z - inset), vec3(high.x - inset, y, low.z + inset)};
    };
    const std::array rings{ring_at(low.y, 0), ring_at(high.y - chamfer, 0), ring_at(high.y, chamfer)};
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t next = (k + 1) % 4;
        for (std::size_t r = 0; r < 2; ++r) {
            face(rings[r][k], rings[r][next], rings[r + 1][next], rings[r + 1][k]);
        }
    }
    face(rings[2][0], rings[2][1], rings[2][2], rings[2][3]);
    face(rings[0][3], rings[0][2], rings[0][1], rings[0][0]);
}

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

void MeshBuilder::prism(std::span<const vec2> outline, float depth) {
    std::vector<vec3> front, back;
    for (const vec2 p : outline) {
        front.emplace_back(p, depth);
        back.emplace_back(p, 0.0F);
    }
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const std::size_t next = (i + 1) % outline.size();
        face(back[i], back[next], front[next], front[i]);
    }
    polygon(front, vec3(0, 0, 1));
    std::reverse(back.begin(), back.end());
    polygon(back, vec3(0, 0, -1));
}

void MeshBuilder::blade(std::span<const vec3> ridge, std::span<const float> half_widths, float thickness) {
    // A triangular cross-section at every point of the ridge: left, right, keel.
    const auto section = [&](std::size_t i) {
        const vec3 side(0, 0, half_widths[i]);
        return std::array{ridge[i] - side, ridge[i] + side, ridge[i] - vec3(0, thickness, 0)};
    };
    for (std::size_t i = 0; i + 1 < ridge.size(); ++i) {
        const auto a = section(i), b = section(i + 1);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            face(a[k], a[next], b[next], b[k]);
        }
    }
    const auto first = section(0), last = section(ridge.size() - 1);
    polygon(std::array{first[0], first[2], first[1]}, glm::normalize(ridge[0] - ridge[1]));
    polygon(last, glm::normalize(ridge.back() - ridge[ridge.size() - 2]));
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
