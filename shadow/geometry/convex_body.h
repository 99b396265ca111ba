// SPDX-License-Identifier: MIT
// Convex bodies as the polygons of their faces: boxes, frusta, and what planes leave of them.
#pragma once

#include "shadow/scene/scene.h"

#include <vector>

namespace gn {

/// Points with dot(normal, p) + offset >= 0 are inside.
struct Plane {
    dvec3 normal_ws{0};
    double offset = 0;
};

/// A convex polyhedron as its faces' polygons; empty when clipped away.
struct ConvexBody {
    std::vector<std::vector<dvec3>> faces_ws;
    [[nodiscard]] bool empty() const { return faces_ws.empty(); }
    [[nodiscard]] std::vector<dvec3> vertices() const;
};
ConvexBody body_of(const Box& box_ws);
/// The camera's frustum between two distances along its axis.
ConvexBody body_of(const Camera& camera, float aspect, double near, double far);
/// The part of the body inside the plane, with a lid where it was cut.
ConvexBody clip(const ConvexBody& body, const Plane& plane);
std::vector<Plane> frustum_planes(const Camera& camera, float aspect, double near, double far);

}  // namespace gn
