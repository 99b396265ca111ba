// SPDX-License-Identifier: MIT
#include "shadow/geometry/swept_boxes.h"

#include "shadow/geometry/caster_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gn {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// The greatest height of a box over a direction: that of its centre, and what its half extents add.
double height_of(const Box& box, dvec3 way_ws) {
    const dvec3 centre = 0.5 * (dvec3(box.min) + dvec3(box.max)), half = 0.5 * (dvec3(box.max) - dvec3(box.min));
    return glm::dot(way_ws, centre) + glm::dot(glm::abs(way_ws), half);
}

// A box grown by what positions, and the rasterizer's clipping of them, are rounded by.
Box grown(const Box& box) {
    const float size = std::max({box.diagonal(), glm::length(box.min), glm::length(box.max)});
    return {box.min - vec3(1e-5F * size), box.max + vec3(1e-5F * size)};
}

}  // namespace

SweptBoxes::SweptBoxes(const GnLight& light, const mat4* cs_from_ws)
    : light_(light),
      light_ws_(light_point_ws(light)),
      cone_(std::acos(std::clamp(static_cast<double>(light.cos_outer), -1.0, 1.0))) {
    if (cs_from_ws == nullptr) {
        return;
    }
    const glm::dmat4 rows = glm::transpose(glm::dmat4(*cs_from_ws));
    planes_ws_ = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
                  rows[3] - rows[1], rows[3] - rows[2], rows[2]};

    // The near rectangle, seen from the light, and every direction that can part this hull from a box: a normal of one's face, or
    // the product of an edge of each.
    const glm::dmat4 ws_from_cs = glm::inverse(glm::dmat4(*cs_from_ws));
    const std::array<dvec2, 4> around{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    std::array<dvec3, 4> corner{};
    for (std::size_t i = 0; i < around.size(); ++i) {
        const dvec4 corner_ws = ws_from_cs * dvec4(around[i], 1.0, 1.0);
        corner[i] = dvec3(corner_ws) / corner_ws.w;
    }
    near_ws_ = corner;
    const auto to_light = [&](dvec3 from_ws) { return dvec3(light_ws_) - from_ws * light_ws_.w; };
    const std::array<dvec3, 3> box_edges{dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)};
    const std::array<dvec3, 6> hull_edges{corner[1] - corner[0], corner[3] - corner[0], to_light(corner[0]),
                                          to_light(corner[1]),   to_light(corner[2]),   to_light(corner[3])};
    for (const dvec3 edge : box_edges) {
        add_axis(edge);
    }
    add_axis(glm::cross(hull_edges[0], hull_edges[1]));
    for (std::size_t i = 2; i < hull_edges.size(); ++i) {
        // Rays to the light from neighbouring corners span the hull's other faces.
        add_axis(glm::cross(hull_edges[i], hull_edges[i % 2]));
        add_axis(glm::cross(hull_edges[i], hull_edges[1 - i % 2]));
    }
    for (const dvec3 edge : hull_edges) {
        for (const dvec3 other : box_edges) {
            add_axis(glm::cross(edge, other));
        }
    }
}

void SweptBoxes::add_axis(dvec3 way_ws) {
    Axis axis{way_ws, glm::abs(way_ws), infinite, -infinite};
    const auto add = [&](double height) {
        axis.low = std::min(axis.low, height);
        axis.high = std::max(axis.high, height);
    };
    for (const dvec3 corner_ws : *near_ws_) {
        add(glm::dot(way_ws, corner_ws));
    }
    const double light = glm::dot(way_ws, dvec3(light_ws_));
    if (light_ws_.w > 0.0) {
        add(light);
    } else if (light != 0.0) {
        add(std::copysign(infinite, light));
    }
    axes_.at(axis_count_++) = axis;
}

bool SweptBoxes::beyond_light(const Box& box) const {
    if (light_.kind == uint(GN_LIGHT_DIRECTIONAL)) {
        return false;
    }
    const dvec3 eye(light_.position_ws), axis(light_.direction_ws);
    const dvec3 nearest = glm::clamp(eye, dvec3(box.min), dvec3(box.max));
    if (light_.range > 0.0F && glm::distance(eye, nearest) > static_cast<double>(light_.range)) {
        return true;
    }
    const dvec3 to_centre = dvec3(box.centre()) - eye;
    const double radius = 0.5 * static_cast<double>(box.diagonal()), distance = glm::length(to_centre);
    if (light_.kind == uint(GN_LIGHT_SPOT) && distance > radius) {
        // The sphere around the box fills an angle about its centre; compare with the cone's.
        const double off_axis = std::acos(std::clamp(glm::dot(to_centre, axis) / distance, -1.0, 1.0));
        return off_axis - std::asin(radius / distance) > cone_ + 1e-6;
    }
    return light_.kind == uint(GN_LIGHT_RECTANGLE) && glm::dot(to_centre, axis) < -radius;
}

bool SweptBoxes::out_of_sight(const Box& box) const {
    return planes_ws_ && std::any_of(planes_ws_->begin(), planes_ws_->end(),
                                     [&](const dvec4& plane) { return height_of(box, dvec3(plane)) + plane.w < 0.0; });
}

bool SweptBoxes::may_shade_view(const Box& box) const {
    if (beyond_light(box)) {
        return false;
    }
    // Around a light inside the box all directions are away from it.
    if (!planes_ws_ || (light_ws_.w > 0.0 && box.contains(vec3(light_ws_)))) {
        return true;
    }
    // The swept box is the hull of its corners and of their directions: all of them outside one plane of the view's frustum is
    // enough to be out of sight.
    return std::none_of(planes_ws_->begin(), planes_ws_->end(), [&](const dvec4& plane) {
        const dvec3 normal(plane);
        const double height = height_of(box, normal);
        return height + plane.w < 0.0 && light_ws_.w * height - glm::dot(normal, dvec3(light_ws_)) < 0.0;
    });
}

bool SweptBoxes::may_shade_near_plane(const Box& box) const {
    if (!near_ws_) {
        return true;
    }
    // Two convex bodies are apart if one of the directions says so.
    const Box body = grown(box);
    const dvec3 centre = 0.5 * (dvec3(body.min) + dvec3(body.max)), half = 0.5 * (dvec3(body.max) - dvec3(body.min));
    return std::none_of(axes_.begin(), axes_.begin() + static_cast<std::ptrdiff_t>(axis_count_), [&](const Axis& a) {
        const double middle = glm::dot(a.way_ws, centre), reach = glm::dot(a.abs_ws, half);
        return a.high < middle - reach || middle + reach < a.low;
    });
}

}  // namespace gn
