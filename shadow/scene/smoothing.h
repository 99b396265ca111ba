// SPDX-License-Identifier: MIT
// Shading normals that no file gave, found anew where their faces bend: angle-weighted means, broken at the creases of rest.
#pragma once

#include "shadow/scene/scene.h"

#include <functional>
#include <span>

namespace gn {

/// A face as one of its corners sees it.
struct SmoothFace {
    vec3 normal{0};   ///< unit; 0 without area
    float angle = 0;  ///< radians, at the corner
};
SmoothFace face_at(const Scene& scene, std::uint32_t triangle, int slot);

/// The normal of every face's corner at one point: the mean of those faces that meet its own without a crease, which
/// `creased_by`, a unit vector a face, decides.
std::vector<vec3> point_normals(std::span<const SmoothFace> faces, std::span<const vec3> creased_by);

/// A corner whose vertex no file gave a normal.
struct SmoothCorner {
    std::uint32_t triangle = 0;  ///< of the scene
    std::uint8_t slot = 0;
    bool begins = false;   ///< the first at its point
    bool decides = false;  ///< the first of its vertex, which takes this corner's normal
    vec3 rest_face{0};     ///< normal of its triangle at rest
};

/// The corners of `triangles` whose vertices `smooth` accepts, as they stand, sorted by points.
std::vector<SmoothCorner> find_smooth_corners(const Scene& scene, std::span<const std::uint32_t> triangles,
                                              const std::function<bool(std::uint32_t)>& smooth);
/// Writes the normals of their vertices by where the triangles stand now.
void smooth_normals(Scene& scene, std::span<const SmoothCorner> corners);

}  // namespace gn
