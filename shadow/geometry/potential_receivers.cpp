// SPDX-License-Identifier: MIT
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09]
#include "shadow/geometry/potential_receivers.h"

#include "shadow/scene/clusters.h"

#include <algorithm>

namespace gn {
namespace {

/// The box with a little thickness, so that a flat one has a volume, inside the camera's frustum.
ConvexBody seen_of(const Box& box_ws, const std::vector<Plane>& frustum) {
    const vec3 thickness(1e-5F * box_ws.diagonal());
    ConvexBody body = body_of(Box{box_ws.min - thickness, box_ws.max + thickness});
    for (const Plane& plane : frustum) {
        body = clip(body, plane);
    }
    return body;
}

std::vector<Plane> frustum_of(const FrameInput& input, double near, double far) {
    const float aspect = static_cast<float>(input.samples.width) / static_cast<float>(input.samples.height);
    return frustum_planes(input.samples.camera, aspect, near, far);
}

LightReach::Found& remembered(const FrameInput& input) {
    const uvec2 size(input.samples.width, input.samples.height);
    for (LightReach::Found& found : input.reach->found) {
        if (found.size == size) {
            return found;
        }
    }
    return input.reach->found.emplace_back(LightReach::Found{.size = size});
}

Box find_seen_bounds(const FrameInput& input) {
    const auto kept = input.derive("cluster bounds", 0, [&] { return cluster_bounds(input.scene); });
    const std::vector<Box>& clusters = *kept;
    if (clusters.size() == 1) {
        return clusters.front();
    }
    const Camera& camera = input.samples.camera;
    const std::vector<Plane> frustum =
        frustum_of(input, static_cast<double>(camera.near), static_cast<double>(camera.far));
    Box seen;
    for (const Box& box_ws : clusters) {
        if (!seen_of(box_ws, frustum).empty()) {
            seen.grow(box_ws);
        }
    }
    return seen.empty() ? input.scene.bounds_ws : seen;
}

/// ∩ L: within the light's range, before a rectangle's plane, inside a spot's pyramid.
ConvexBody lit_part(ConvexBody body, const GnLight& light) {
    const dvec3 axis(vec3(light.direction_ws));
    const dvec3 eye(vec3(light.position_ws));
    for (int side = 0; side < 6 && light.kind != GN_LIGHT_DIRECTIONAL && light.range > 0; ++side) {
        dvec3 normal(0);
        normal[side / 2] = side % 2 == 0 ? 1 : -1;
        body = clip(body, {normal, static_cast<double>(light.range) - glm::dot(normal, eye)});
    }
    if (light.kind == GN_LIGHT_RECTANGLE || light.kind == GN_LIGHT_SPOT) {
        body = clip(body, {axis, -glm::dot(axis, eye)});
    }
    if (light.kind == GN_LIGHT_SPOT && light.cos_outer > 0.1F) {
        const double tangent = std::tan(std::acos(static_cast<double>(light.cos_outer)));
        vec3 x;
        vec3 y;
        complete_frame(vec3(light.direction_ws), x, y);
        for (const dvec3 side : {dvec3(x), -dvec3(x), dvec3(y), -dvec3(y)}) {
            const dvec3 normal = tangent * axis + side;
            body = clip(body, {normal, -glm::dot(normal, eye)});
        }
    }
    return body;
}

}  // namespace

FrameInput remembering(const FrameInput& input) {
    FrameInput same = input;
    same.reach = std::make_shared<LightReach>();
    return same;
}

Box seen_bounds(const FrameInput& input) {
    if (input.reach == nullptr) {
        return find_seen_bounds(input);
    }
    std::optional<Box>& seen_ws = remembered(input).seen_ws;
    if (!seen_ws) {
        seen_ws = find_seen_bounds(input);
    }
    return *seen_ws;
}

ConvexBody potential_receivers(const FrameInput& input) {
    const auto find = [&] {
        const Camera& camera = input.samples.camera;
        return potential_receivers(input, static_cast<double>(camera.near), static_cast<double>(camera.far));
    };
    if (input.reach == nullptr) {
        return find();
    }
    if (!remembered(input).receivers) {
        ConvexBody found = find();
        remembered(input).receivers = std::move(found);
    }
    return *remembered(input).receivers;
}

ConvexBody potential_receivers(const FrameInput& input, double near, double far) {
    // S ∩ V: the scene's box cut by the camera's frustum.
    const Box box_ws = seen_bounds(input);
    return box_ws.empty() ? ConvexBody{}
                          : lit_part(seen_of(box_ws, frustum_of(input, near, far)), input.whole_light().shape);
}

ConvexBody lit_bounds(const FrameInput& input) {
    const Box box_ws = seen_bounds(input);
    return box_ws.empty() ? ConvexBody{} : lit_part(seen_of(box_ws, {}), input.whole_light().shape);
}

double farthest(const Box& box_ws, vec3 p_ws) {
    double distance = 0;
    for (const vec3 corner : box_ws.corners()) {
        distance = std::max(distance, glm::length(dvec3(corner) - dvec3(p_ws)));
    }
    return distance;
}

double reach_of(const FrameInput& input) {
    const GnLight& light = input.light().shape;
    const double reach = farthest(seen_bounds(input), vec3(light.position_ws));
    // The range is the whole light's, about its own centre.
    const GnLight& whole = input.whole_light().shape;
    const double aside = glm::length(dvec3(vec3(light.position_ws)) - dvec3(vec3(whole.position_ws)));
    const double range = whole.range > 0 ? static_cast<double>(whole.range) + aside : reach;
    return 1.001 * std::min(reach, range);
}

}  // namespace gn
