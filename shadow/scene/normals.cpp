// SPDX-License-Identifier: MIT
// Shading normals where a file gives none: angle-weighted means of the faces around a point, broken at creases.
#include "base/error.h"
#include "shadow/scene/model.h"
#include "shadow/scene/smoothing.h"

#include <algorithm>
#include <numeric>

namespace gn {

namespace {

// Faces that meet at more than 50 degrees keep their edge.
constexpr float crease_cosine = 0.6428F;
// Around the tips of large fans, comparing all pairs of faces would take quadratic time: no creases there.
constexpr std::size_t most_compared = 64;

// A corner without a normal: of which triangle, at which welded point.
struct Corner {
    std::uint32_t triangle = 0;
    std::uint32_t point = 0;
    std::uint8_t slot = 0;
};

// One number for all vertices at the same place, so that texture seams do not show as creases.
std::vector<std::uint32_t> weld(const Scene& scene) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t v = 0; v < scene.positions_ws.size(); ++v) {
        if (scene.normals_ws[v] == vec3(0.0F)) {
            order.push_back(v);
        }
    }
    const auto key = [&](std::uint32_t v) {
        const vec3 p = scene.positions_ws[v];
        return std::array{p.x, p.y, p.z};
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> point_of(scene.positions_ws.size(), 0);
    std::uint32_t points = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        points += i > 0 && key(order[i]) != key(order[i - 1]) ? 1U : 0U;
        point_of[order[i]] = points;
    }
    return point_of;
}

std::vector<Corner> collect_corners(const Scene& scene) {
    const std::vector<std::uint32_t> point_of = weld(scene);
    std::vector<Corner> corners;
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const uvec3 t = scene.triangles[i];
        for (int slot = 0; slot < 3; ++slot) {
            if (scene.normals_ws[t[slot]] == vec3(0.0F)) {
                corners.push_back({i, point_of[t[slot]], static_cast<std::uint8_t>(slot)});
            }
        }
    }
    std::stable_sort(corners.begin(), corners.end(),
                     [](const Corner& a, const Corner& b) { return a.point < b.point; });
    return corners;
}

// Writes a corner's normal; where the vertex already has another one, the corner gets a vertex of its own.
class VertexSplitter {
  public:
    explicit VertexSplitter(Scene& scene) : scene_(scene) {}

    std::vector<std::uint32_t> copied;  ///< the vertex of which each added one is a copy

    void begin_point() { copies_.clear(); }

    void set(const Corner& corner, vec3 normal) {
        std::uint32_t& vertex = scene_.triangles[corner.triangle][corner.slot];
        const std::uint32_t original = vertex;
        if (scene_.normals_ws[original] == vec3(0.0F)) {
            scene_.normals_ws[original] = normal;
            copies_.push_back({original, original});
            return;
        }
        const std::size_t searched = std::min(copies_.size(), most_compared);
        for (std::size_t i = 0; i < searched; ++i) {
            if (copies_[i].original == original && glm::dot(scene_.normals_ws[copies_[i].vertex], normal) > 0.99999F) {
                vertex = copies_[i].vertex;
                return;
            }
        }
        vertex = static_cast<std::uint32_t>(scene_.positions_ws.size());
        scene_.positions_ws.push_back(vec3(scene_.positions_ws[original]));
        scene_.normals_ws.push_back(normal);
        scene_.uvs.push_back(vec2(scene_.uvs[original]));
        if (!scene_.colors.empty()) {
            scene_.colors.push_back(vec4(scene_.colors[original]));
        }
        copies_.push_back({original, vertex});
        copied.push_back(original);
    }

  private:
    struct Copy {
        std::uint32_t original, vertex;
    };
    Scene& scene_;
    std::vector<Copy> copies_;
};

}  // namespace

SmoothFace face_at(const Scene& scene, std::uint32_t triangle, int slot) {
    const uvec3 t = scene.triangles[triangle];
    const std::array corners{dvec3(scene.positions_ws[t.x]), dvec3(scene.positions_ws[t.y]),
                             dvec3(scene.positions_ws[t.z])};
    const dvec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const dvec3 p = corners[static_cast<std::size_t>(slot)];
    const dvec3 u = corners[static_cast<std::size_t>((slot + 1) % 3)] - p;
    const dvec3 v = corners[static_cast<std::size_t>((slot + 2) % 3)] - p;
    return {.normal = glm::dot(across, across) > 0.0 ? vec3(glm::normalize(across)) : vec3(0.0F),
            .angle = static_cast<float>(std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)))};
}

std::vector<vec3> point_normals(std::span<const SmoothFace> faces, std::span<const vec3> creased_by) {
    vec3 all(0.0F);
    for (const SmoothFace& face : faces) {
        all += face.angle * face.normal;
    }
    const std::size_t count = faces.size();
    std::vector<vec3> normals(count);
    for (std::size_t i = 0; i < count; ++i) {
        vec3 sum = count > most_compared ? all : vec3(0.0F);
        for (std::size_t j = 0; count <= most_compared && j < count; ++j) {
            const bool smooth = glm::dot(creased_by[i], creased_by[j]) >= crease_cosine;
            sum += smooth ? faces[j].angle * faces[j].normal : vec3(0.0F);
        }
        const float length = glm::length(sum);
        normals[i] = length > 1e-6F ? sum / length : faces[i].normal;
    }
    return normals;
}

std::vector<std::uint32_t> complete_normals(Scene& scene) {
    const std::vector<Corner> corners = collect_corners(scene);
    if (scene.positions_ws.size() + corners.size() > std::numeric_limits<std::uint32_t>::max()) {
        fail("the scene has too many vertices without normals ({})", corners.size());
    }
    VertexSplitter splitter(scene);
    std::vector<SmoothFace> faces;
    std::vector<vec3> creased_by;
    for (std::size_t begin = 0, end = 0; begin < corners.size(); begin = end) {
        while (end < corners.size() && corners[end].point == corners[begin].point) {
            ++end;
        }
        faces.clear();
        creased_by.clear();
        for (std::size_t i = begin; i < end; ++i) {
            faces.push_back(face_at(scene, corners[i].triangle, corners[i].slot));
            creased_by.push_back(faces.back().normal);
        }
        const std::vector<vec3> normals = point_normals(faces, creased_by);
        splitter.begin_point();
        for (std::size_t i = begin; i < end; ++i) {
            splitter.set(corners[i], normals[i - begin]);
        }
    }

    // Vertices that no triangle uses still hold a unit vector.
    std::replace(scene.normals_ws.begin(), scene.normals_ws.end(), vec3(0.0F), vec3(0.0F, 1.0F, 0.0F));
    return std::move(splitter.copied);
}

}  // namespace gn
