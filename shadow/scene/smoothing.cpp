// SPDX-License-Identifier: MIT
#include "shadow/scene/smoothing.h"

#include <algorithm>
#include <array>
#include <unordered_set>

namespace gn {

std::vector<SmoothCorner> find_smooth_corners(const Scene& scene, std::span<const std::uint32_t> triangles,
                                              const std::function<bool(std::uint32_t)>& smooth) {
    std::vector<SmoothCorner> corners;
    for (const std::uint32_t t : triangles) {
        for (std::uint8_t slot = 0; slot < 3; ++slot) {
            if (smooth(scene.triangles[t][slot])) {
                corners.push_back({.triangle = t, .slot = slot, .rest_face = face_at(scene, t, slot).normal});
            }
        }
    }
    const auto vertex_of = [&](const SmoothCorner& corner) { return scene.triangles[corner.triangle][corner.slot]; };
    const auto place_of = [&](const SmoothCorner& corner) {
        const vec3 p = scene.positions_ws[vertex_of(corner)];
        return std::array{p.x, p.y, p.z};
    };
    std::stable_sort(corners.begin(), corners.end(),
                     [&](const SmoothCorner& a, const SmoothCorner& b) { return place_of(a) < place_of(b); });
    std::unordered_set<std::uint32_t> decided;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i].begins = i == 0 || place_of(corners[i - 1]) != place_of(corners[i]);
        corners[i].decides = decided.insert(vertex_of(corners[i])).second;
    }
    return corners;
}

void smooth_normals(Scene& scene, std::span<const SmoothCorner> corners) {
    std::vector<SmoothFace> faces;
    std::vector<vec3> rest;
    for (std::size_t begin = 0, end = 0; begin < corners.size(); begin = end) {
        faces.clear();
        rest.clear();
        do {
            faces.push_back(face_at(scene, corners[end].triangle, corners[end].slot));
            rest.push_back(corners[end].rest_face);
        } while (++end < corners.size() && !corners[end].begins);
        const std::vector<vec3> normals = point_normals(faces, rest);
        for (std::size_t i = begin; i < end; ++i) {
            // Where all faces have collapsed the normal stays.
            if (corners[i].decides && normals[i - begin] != vec3(0)) {
                scene.normals_ws[scene.triangles[corners[i].triangle][corners[i].slot]] = normals[i - begin];
            }
        }
    }
}

}  // namespace gn
