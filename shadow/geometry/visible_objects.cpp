// SPDX-License-Identifier: MIT
// Based on: Akenine-Möller, Haines, Hoffman, Pesce, Iwanicki, Hillaire. Real-Time Rendering, 4th edition. 2018. [AHH18] 7.4
#include "shadow/geometry/visible_objects.h"

#include <algorithm>

namespace gn {
namespace {

/// Room for the rounding of the box's own corners, and for bodies without a volume.
Box thickened(const Box& box_ws) {
    const vec3 size = glm::max(glm::abs(box_ws.min), glm::abs(box_ws.max));
    const float thickness = std::max(1e-5F * box_ws.diagonal(), 1e-6F * std::max({size.x, size.y, size.z}));
    return {box_ws.min - thickness, box_ws.max + thickness};
}

}  // namespace

bool knows_what_is_seen(const Scene& scene) {
    return !scene.triangles.empty();
}

std::vector<dvec3> corners_within(const Box& box_ws, std::span<const Plane> planes) {
    const Box box = thickened(box_ws);
    const dvec3 centre(box.centre());
    const dvec3 half(0.5F * box.extent());
    std::vector<Plane> cutting;
    for (const Plane& plane : planes) {
        const double middle = glm::dot(plane.normal_ws, centre) + plane.offset;
        const double reach = glm::dot(glm::abs(plane.normal_ws), half);
        if (middle + reach < 0) {
            return {};
        }
        if (middle - reach < 0) {
            cutting.push_back(plane);
        }
    }
    if (cutting.empty()) {
        const auto corners = box.corners();
        return {corners.begin(), corners.end()};
    }
    ConvexBody body = body_of(box);
    for (const Plane& plane : cutting) {
        body = clip(body, plane);
    }
    return body.vertices();
}

double farthest_seen(const FrameInput& input, double near, double far) {
    if (!knows_what_is_seen(input.scene)) {
        return far;
    }
    const Camera& camera = input.samples.camera;
    const float aspect = static_cast<float>(input.samples.width) / static_cast<float>(input.samples.height);
    const std::vector<Plane> frustum = frustum_planes(camera, aspect, near, far);
    const dvec3 forward = glm::normalize(dvec3(camera.forward_ws));
    const double eye = glm::dot(forward, dvec3(camera.position_ws));
    double farthest = near;
    for (const Object& object : input.scene.objects) {
        // Look closer only at what would reach farther.
        const Box& box_ws = object.bounds_ws;
        const double end = glm::dot(forward, dvec3(box_ws.centre())) - eye +
                           glm::dot(glm::abs(forward), dvec3(0.501F * box_ws.extent()));
        if (end <= farthest || object.triangle_count == 0) {
            continue;
        }
        for (const dvec3& p : corners_within(box_ws, frustum)) {
            farthest = std::max(farthest, glm::dot(forward, p) - eye);
        }
    }
    return std::min(farthest, far);
}

}  // namespace gn
