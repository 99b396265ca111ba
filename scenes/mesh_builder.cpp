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

}  // namespace gn::scenes
