// SPDX-License-Identifier: MIT
// Which form of volume each component takes for a light, and which components can be left out.
#include "shadow/direct/volumes/volumes_passes.h"
#include "shadow/geometry/caster_geometry.h"

#include <algorithm>

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

}  // namespace

std::vector<std::uint32_t> component_forms(std::span<const Component> components, const GnLight& light,
                                           const GnVolumesParams& params, const mat4* cs_from_ws) {
    const vec4 light_ws = light_point_ws(light);
    std::vector<std::uint32_t> forms;
    forms.reserve(components.size());
    for (const Component& component : components) {
        const Box& box = component.bounds_ws;
        // A light inside the solid meets its surface from within: only the general form is safe there.
        const bool inside = light_ws.w > 0.0F && box.contains(vec3(light_ws));
        if (params.culling != 0 && (beyond_light(box, light) ||
                                    (cs_from_ws != nullptr && !inside && out_of_view(box, light_ws, *cs_from_ws)))) {
            forms.push_back(GN_VOLUMES_NONE);
        } else if (params.closed == 0 || !component.closed || inside) {
            forms.push_back(GN_VOLUMES_ANY);
        } else {
            // The back of a one-sided triangle is not there to cast.
            forms.push_back(component.outward > 0 ? GN_VOLUMES_FRONT
                            : component.one_sided ? GN_VOLUMES_ANY
                                                  : GN_VOLUMES_BACK);
        }
    }
    return forms;
}

}  // namespace gn
