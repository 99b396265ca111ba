// SPDX-License-Identifier: MIT
#include "shadow/geometry/convex_body.h"

#include <algorithm>

namespace gn {
namespace {

struct CameraFrame {
    dvec3 eye, right, up, forward;
};

CameraFrame frame_of(const Camera& camera) {
    const dvec3 forward = glm::normalize(dvec3(camera.forward_ws));
    const dvec3 right = glm::normalize(glm::cross(forward, dvec3(camera.up_ws)));
    return {camera.position_ws, right, glm::cross(right, forward), forward};
}

/// Six quadrilaterals over eight corners numbered by bits x, y, z.
ConvexBody box_like(const std::array<dvec3, 8>& c) {
    ConvexBody body;
    for (const auto& face :
         {std::array{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}) {
        std::vector<dvec3> polygon;
        for (const int corner : face) {
            polygon.push_back(c[static_cast<std::size_t>(corner)]);
        }
        body.faces_ws.push_back(polygon);
    }
    return body;
}

/// Sutherland and Hodgman's clip of one polygon; the points on the plane are collected for the lid.
std::vector<dvec3> clip_polygon(const std::vector<dvec3>& polygon, const Plane& plane, std::vector<dvec3>& lid) {
    std::vector<dvec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 a = polygon[i];
        const dvec3 b = polygon[(i + 1) % polygon.size()];
        const double da = glm::dot(plane.normal_ws, a) + plane.offset;
        const double db = glm::dot(plane.normal_ws, b) + plane.offset;
        if (da >= 0) {
            kept.push_back(a);
        }
        if (da == 0) {
            lid.push_back(a);
        }
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
            const dvec3 cut = a + (b - a) * (da / (da - db));
            kept.push_back(cut);
            lid.push_back(cut);
        }
    }
    return kept;
}

/// Orders coplanar points around their centre.
std::vector<dvec3> ordered(std::vector<dvec3> points, dvec3 normal) {
    dvec3 centre(0);
    for (const dvec3& p : points) {
        centre += p / static_cast<double>(points.size());
    }
    vec3 x;
    vec3 y;
    complete_frame(glm::normalize(vec3(normal)), x, y);
    std::sort(points.begin(), points.end(), [&](const dvec3& a, const dvec3& b) {
        const auto angle = [&](const dvec3& p) {
            return std::atan2(glm::dot(p - centre, dvec3(y)), glm::dot(p - centre, dvec3(x)));
        };
        return angle(a) < angle(b);
    });
    return points;
}

}  // namespace

std::vector<dvec3> ConvexBody::vertices() const {
    std::vector<dvec3> all;
    for (const auto& face : faces_ws) {
        all.insert(all.end(), face.begin(), face.end());
    }
    return all;
}

ConvexBody body_of(const Box& box_ws) {
    std::array<dvec3, 8> corners{};
    const auto floats = box_ws.corners();
    std::transform(floats.begin(), floats.end(), corners.begin(), [](vec3 c) { return dvec3(c); });
    return box_like(corners);
}

ConvexBody body_of(const Camera& camera, float aspect, double near, double far) {
    const CameraFrame frame = frame_of(camera);
    std::array<dvec3, 8> corners{};
    for (unsigned i = 0; i < 8; ++i) {
        const double distance = (i & 4U) != 0U ? far : near;
        const double half_height = half_height_at(camera, distance);
        const double x = ((i & 1U) != 0U ? half_height : -half_height) * static_cast<double>(aspect);
        const double y = (i & 2U) != 0U ? half_height : -half_height;
        corners[i] = frame.eye + distance * frame.forward + x * frame.right + y * frame.up;
    }
    return box_like(corners);
}

std::vector<Plane> frustum_planes(const Camera& camera, float aspect, double near, double far) {
    const CameraFrame frame = frame_of(camera);
    const double y = half_height_at(camera, 1);
    const double x = y * static_cast<double>(aspect);
    const double along = glm::dot(frame.forward, frame.eye);
    // Perspective planes pass through the eye, those of an orthographic camera beside it.
    const auto side = [&](dvec3 inwards, double half) {
        const bool parallel = is_orthographic(camera);
        const dvec3 normal = parallel ? inwards : half * frame.forward + inwards;
        return Plane{normal, (parallel ? half : 0.0) - glm::dot(normal, frame.eye)};
    };
    return {{frame.forward, -along - near},
            {-frame.forward, along + far},
            side(frame.right, x),
            side(-frame.right, x),
            side(frame.up, y),
            side(-frame.up, y)};
}

ConvexBody clip(const ConvexBody& body, const Plane& plane) {
    ConvexBody clipped;
    std::vector<dvec3> lid;
    bool cut = false;
    for (const auto& face : body.faces_ws) {
        std::vector<dvec3> kept = clip_polygon(face, plane, lid);
        cut = cut || kept.size() != face.size() || kept != face;
        if (kept.size() >= 3) {
            clipped.faces_ws.push_back(std::move(kept));
        }
    }
    if (cut && !clipped.empty() && lid.size() >= 3) {
        clipped.faces_ws.push_back(ordered(std::move(lid), plane.normal_ws));
    }
    return clipped;
}

}  // namespace gn
