// SPDX-License-Identifier: MIT
// Which form of volume each component takes for a light, and which components can be left out.
#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/volume_passes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gn {

namespace {

// Nothing that counts for the light can lie behind the box: it is out of range, beside the cone or behind the
// rectangle.
bool beyond_light(const Box& box, const GnLight& light) {
    if (light.kind == uint(GN_LIGHT_DIRECTIONAL)) {
        return false;
    }
    const dvec3 eye(light.position_ws), axis(light.direction_ws);
    const dvec3 nearest = glm::clamp(eye, dvec3(box.min), dvec3(box.max));
    if (light.range > 0.0F && glm::distance(eye, nearest) > static_cast<double>(light.range)) {
        return true;
    }
    const dvec3 to_centre = dvec3(box.centre()) - eye;
    const double radius = 0.5 * static_cast<double>(box.diagonal()), distance = glm::length(to_centre);
    if (light.kind == uint(GN_LIGHT_SPOT) && distance > radius) {
        // The sphere around the box fills an angle about its centre; compare with the cone's.
        const double off_axis = std::acos(std::clamp(glm::dot(to_centre, axis) / distance, -1.0, 1.0));
        const double cone = std::acos(std::clamp(static_cast<double>(light.cos_outer), -1.0, 1.0));
        return off_axis - std::asin(radius / distance) > cone + 1e-6;
    }
    return light.kind == uint(GN_LIGHT_RECTANGLE) && glm::dot(to_centre, axis) < -radius;
}

// The box swept away from the light to infinity is the hull of its corners and of their directions: all of them outside
// one plane of the view's frustum (left, right, top, bottom, near, far) is enough to be out of sight.
bool out_of_view(const Box& box, vec4 light_ws, const mat4& cs_from_ws) {
    const glm::dmat4 cs(cs_from_ws);
    const dvec4 light(light_ws);
    std::array<bool, 6> all_outside{true, true, true, true, true, true};
    for (const vec3 corner : box.corners()) {
        for (const dvec4 p_ws : {dvec4(corner, 1.0), dvec4(dvec3(corner) * light.w - dvec3(light), 0.0)}) {
            const dvec4 p = cs * p_ws;
            const std::array<double, 6> inside{p.w + p.x, p.w - p.x, p.w + p.y, p.w - p.y, p.w - p.z, p.z};
            for (std::size_t i = 0; i < 6; ++i) {
                all_outside[i] = all_outside[i] && inside[i] < 0.0;
            }
        }
    }
    return std::any_of(all_outside.begin(), all_outside.end(), [](bool outside) { return outside; });
}

bool outside_frustum(const Box& box, const mat4& cs_from_ws) {
    std::array<bool, 6> all_outside{true, true, true, true, true, true};
    for (const vec3 corner : box.corners()) {
        const dvec4 p = glm::dmat4(cs_from_ws) * dvec4(corner, 1.0);
        const std::array<double, 6> inside{p.w + p.x, p.w - p.x, p.w + p.y, p.w - p.y, p.w - p.z, p.z};
        for (std::size_t i = 0; i < 6; ++i) {
            all_outside[i] = all_outside[i] && inside[i] < 0.0;
        }
    }
    return std::any_of(all_outside.begin(), all_outside.end(), [](bool outside) { return outside; });
}

// Where a plane holds the hull of the near rectangle and the light: the least and the largest height above it.
struct Heights {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
    void add(double height) {
        low = std::min(low, height);
        high = std::max(high, height);
    }
};

// What lies between the near rectangle and the light: four corners and a point, or a direction without end.
struct NearHull {
    std::array<dvec3, 4> corners_ws;
    dvec4 light_ws;

    [[nodiscard]] Heights along(dvec3 axis) const {
        Heights heights;
        for (const dvec3 corner : corners_ws) {
            heights.add(glm::dot(axis, corner));
        }
        const double light = glm::dot(axis, dvec3(light_ws));
        if (light_ws.w > 0.0) {
            heights.add(light);
        } else if (light != 0.0) {
            heights.add(std::copysign(std::numeric_limits<double>::infinity(), light));
        }
        return heights;
    }
    [[nodiscard]] dvec3 to_light(dvec3 from) const { return dvec3(light_ws) - from * light_ws.w; }
};

NearHull near_hull(vec4 light_ws, const mat4& cs_from_ws) {
    NearHull hull{{}, dvec4(light_ws)};
    const glm::dmat4 ws_from_cs = glm::inverse(glm::dmat4(cs_from_ws));
    const std::array<dvec2, 4> around{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    for (std::size_t i = 0; i < around.size(); ++i) {
        const dvec4 corner = ws_from_cs * dvec4(around[i], 1.0, 1.0);
        hull.corners_ws[i] = dvec3(corner) / corner.w;
    }
    return hull;
}

Heights along(const Box& box, dvec3 axis) {
    Heights heights;
    for (const vec3 corner : box.corners()) {
        heights.add(glm::dot(axis, dvec3(corner)));
    }
    return heights;
}

// A box grown by what positions, and the rasterizer's clipping of them, are rounded by.
Box grown(const Box& box) {
    const float size = std::max({box.diagonal(), glm::length(box.min), glm::length(box.max)});
    return {box.min - vec3(1e-5F * size), box.max + vec3(1e-5F * size)};
}

}  // namespace

bool may_shade_view(const Box& box, const GnLight& light, const mat4* cs_from_ws) {
    const vec4 light_ws = light_point_ws(light);
    // Around a light inside the box all directions are away from it.
    const bool inside = light_ws.w > 0.0F && box.contains(vec3(light_ws));
    return !beyond_light(box, light) && (cs_from_ws == nullptr || inside || !out_of_view(box, light_ws, *cs_from_ws));
}

bool may_shade_near_plane(const Box& box, vec4 light_ws, const mat4& cs_from_ws) {
    // Two convex bodies are apart if a normal of one's face, or the product of an edge of each, separates them.
    const Box body = grown(box);
    const NearHull hull = near_hull(light_ws, cs_from_ws);
    const auto apart = [&](dvec3 axis) {
        const Heights a = hull.along(axis), b = along(body, axis);
        return a.high < b.low || b.high < a.low;
    };
    const std::array<dvec3, 3> box_edges{dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)};
    if (std::any_of(box_edges.begin(), box_edges.end(), apart)) {
        return false;
    }
    const auto& corner = hull.corners_ws;
    const std::array<dvec3, 6> hull_edges{corner[1] - corner[0],    corner[3] - corner[0],    hull.to_light(corner[0]),
                                          hull.to_light(corner[1]), hull.to_light(corner[2]), hull.to_light(corner[3])};
    if (apart(glm::cross(hull_edges[0], hull_edges[1]))) {
        return false;
    }
    for (std::size_t i = 2; i < hull_edges.size(); ++i) {
        if (apart(glm::cross(hull_edges[i], hull_edges[i % 2])) ||
            apart(glm::cross(hull_edges[i], hull_edges[1 - i % 2]))) {
            return false;
        }
    }
    return std::none_of(hull_edges.begin(), hull_edges.end(), [&](dvec3 edge) {
        return std::any_of(box_edges.begin(), box_edges.end(),
                           [&](dvec3 other) { return apart(glm::cross(edge, other)); });
    });
}

namespace {

// The half of its surface that a component casts with, or nothing where no sample can see its shadow.
std::uint32_t form_of(const Component& component, const GnLight& light, const VolumeOptions& options,
                      const mat4* cs_from_ws) {
    const vec4 light_ws = light_point_ws(light);
    const Box& box = component.bounds_ws;
    // A light inside the solid meets its surface from within: only the general form is safe there.
    const bool inside = light_ws.w > 0.0F && box.contains(vec3(light_ws));
    if (options.culling && !may_shade_view(box, light, cs_from_ws)) {
        return GN_VOLUMES_NONE;
    }
    if (!options.closed || !component.closed || inside) {
        return GN_VOLUMES_ANY;
    }
    // The back of a one-sided triangle is not there to cast.
    return component.outward > 0 ? GN_VOLUMES_FRONT : component.one_sided ? GN_VOLUMES_ANY : GN_VOLUMES_BACK;
}

// The side of the samples on which it counts.
std::uint32_t side_of(const Component& component, const GnLight& light, VolumeMode mode, const mat4* cs_from_ws) {
    if (mode == VolumeMode::behind || mode == VolumeMode::before) {
        return mode == VolumeMode::before ? GN_VOLUMES_BEFORE : 0;
    }
    const bool held =
        cs_from_ws == nullptr || may_shade_near_plane(component.bounds_ws, light_point_ws(light), *cs_from_ws);
    // Split volumes are counted on both sides, each at other samples.
    if (!held) {
        return mode == VolumeMode::split ? GN_VOLUMES_BEFORE | GN_VOLUMES_CAPPED : GN_VOLUMES_BEFORE;
    }
    return mode == VolumeMode::capped ? GN_VOLUMES_BEFORE | GN_VOLUMES_CAPPED : 0;
}

}  // namespace

Box volume_region(const FrameInput& input) {
    const GnLight& light = input.light().shape;
    Box reach;
    if (light.kind != uint(GN_LIGHT_DIRECTIONAL) && light.range > 0.0F) {
        reach = {vec3(light.position_ws) - vec3(light.range), vec3(light.position_ws) + vec3(light.range)};
    }
    Box region;
    for (const Object& object : input.scene.objects) {
        Box box = object.bounds_ws;
        if (!object.receives || beyond_light(box, light) || outside_frustum(box, input.samples.constants.cs_from_ws)) {
            continue;
        }
        if (!reach.empty()) {
            box = {glm::max(box.min, reach.min), glm::min(box.max, reach.max)};
        }
        region.grow(box.min);
        region.grow(box.max);
    }
    for (const dvec3 corner_ws : near_hull(vec4(0), input.samples.constants.cs_from_ws).corners_ws) {
        region.grow(vec3(corner_ws));
    }
    const vec3 slack = 1e-4F * (region.max - region.min) + 1e-5F * glm::max(glm::abs(region.min), glm::abs(region.max));
    return {region.min - slack, region.max + slack};
}

std::uint32_t volume_end(const Box& caster, vec4 light_ws, const Box& region) {
    // Of the planes that every ray from the caster runs towards the nearest; none where rays nearly miss it.
    constexpr float least = 0.05F;
    std::uint32_t nearest = 0;
    float reach = 4.0F * region.diagonal();
    for (std::uint32_t plane = 1; plane <= 6; ++plane) {
        const auto axis = static_cast<int>((plane - 1) / 2);
        const bool high = (plane - 1) % 2 == 1;
        float farthest = 0;
        bool all = true;
        for (const vec3 corner_ws : caster.corners()) {
            const vec3 away_ws = corner_ws * light_ws.w - vec3(light_ws);
            const float along = (high ? 1.0F : -1.0F) * away_ws[axis], size = glm::length(away_ws);
            all = all && along > least * size;
            const float height = high ? region.max[axis] - corner_ws[axis] : corner_ws[axis] - region.min[axis];
            farthest = std::max(farthest, height * size / along);
        }
        if (all && farthest < reach) {
            reach = farthest;
            nearest = plane;
        }
    }
    return nearest;
}

void clamp_forms(std::span<const Component> components, vec4 light_ws, const Box& region,
                 std::span<std::uint32_t> forms) {
    for (std::size_t i = 0; i < components.size(); ++i) {
        // Behind the samples the far ends count, and split or closed volumes have other ends.
        if ((forms[i] & (GN_VOLUMES_BEFORE | GN_VOLUMES_CAPPED)) == GN_VOLUMES_BEFORE) {
            forms[i] |= volume_end(components[i].bounds_ws, light_ws, region) << GN_VOLUMES_PLANE_SHIFT;
        }
    }
}

std::vector<std::uint32_t> component_forms(std::span<const Component> components, const GnLight& light,
                                           const VolumeOptions& options, const mat4* cs_from_ws) {
    std::vector<std::uint32_t> forms;
    forms.reserve(components.size());
    for (const Component& component : components) {
        const std::uint32_t form = form_of(component, light, options, cs_from_ws);
        forms.push_back(form == GN_VOLUMES_NONE ? form : form | side_of(component, light, options.mode, cs_from_ws));
    }
    return forms;
}

}  // namespace gn
