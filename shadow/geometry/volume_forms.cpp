// SPDX-License-Identifier: MIT
// Which form of volume each component takes for a light, and which components can be left out.
#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/swept_boxes.h"
#include "shadow/geometry/volume_passes.h"

#include <algorithm>
#include <cmath>

namespace gn {

namespace {

// The half of its surface that a component casts with, or nothing where no sample can see its shadow.
std::uint32_t form_of(const Component& component, vec4 light_ws, const VolumeOptions& options,
                      const SweptBoxes& swept) {
    const Box& box = component.bounds_ws;
    // A light inside the solid meets its surface from within: only the general form is safe there.
    const bool inside = light_ws.w > 0.0F && box.contains(vec3(light_ws));
    if (options.culling && !swept.may_shade_view(box)) {
        return GN_VOLUMES_NONE;
    }
    if (!options.closed || !component.closed || inside) {
        return GN_VOLUMES_ANY;
    }
    // The back of a one-sided triangle is not there to cast.
    return component.outward > 0 ? GN_VOLUMES_FRONT : component.one_sided ? GN_VOLUMES_ANY : GN_VOLUMES_BACK;
}

// The side of the samples on which it counts.
std::uint32_t side_of(const Component& component, VolumeMode mode, const SweptBoxes& swept) {
    if (mode == VolumeMode::behind || mode == VolumeMode::before) {
        return mode == VolumeMode::before ? GN_VOLUMES_BEFORE : 0;
    }
    const bool held = swept.may_shade_near_plane(component.bounds_ws);
    // Split volumes are counted on both sides, each at other samples.
    if (!held) {
        return mode == VolumeMode::split ? GN_VOLUMES_BEFORE | GN_VOLUMES_CAPPED : GN_VOLUMES_BEFORE;
    }
    return mode == VolumeMode::capped ? GN_VOLUMES_BEFORE | GN_VOLUMES_CAPPED : 0;
}

}  // namespace

Box volume_region(const FrameInput& input) {
    const GnLight& light = input.light().shape;
    const SweptBoxes swept(light, &input.samples.constants.cs_from_ws);
    Box reach;
    if (light.kind != uint(GN_LIGHT_DIRECTIONAL) && light.range > 0.0F) {
        reach = {vec3(light.position_ws) - vec3(light.range), vec3(light.position_ws) + vec3(light.range)};
    }
    Box region;
    for (const Object& object : input.scene.objects) {
        Box box = object.bounds_ws;
        if (!object.receives || swept.beyond_light(box) || swept.out_of_sight(box)) {
            continue;
        }
        if (!reach.empty()) {
            box = {glm::max(box.min, reach.min), glm::min(box.max, reach.max)};
        }
        region.grow(box.min);
        region.grow(box.max);
    }
    const auto corners_ws = swept.near_corners_ws();
    for (const dvec3 corner_ws : *corners_ws) {
        region.grow(vec3(corner_ws));
    }
    const vec3 slack = 1e-4F * (region.max - region.min) + 1e-5F * glm::max(glm::abs(region.min), glm::abs(region.max));
    return {region.min - slack, region.max + slack};
}

std::uint32_t volume_end(const Box& caster, vec4 light_ws, const Box& region) {
    // Of the planes that every ray from the caster runs towards the nearest; none where rays nearly miss it.
    constexpr float least = 0.05F;
    const std::array<vec3, 8> corners_ws = caster.corners();
    std::array<vec3, 8> away_ws{};
    for (std::size_t i = 0; i < corners_ws.size(); ++i) {
        away_ws[i] = glm::normalize(corners_ws[i] * light_ws.w - vec3(light_ws));
    }
    std::uint32_t nearest = 0;
    float reach = 4.0F * region.diagonal();
    for (std::uint32_t plane = 1; plane <= 6; ++plane) {
        const auto axis = static_cast<int>((plane - 1) / 2);
        const bool high = (plane - 1) % 2 == 1;
        float farthest = 0;
        bool all = true;
        for (std::size_t i = 0; i < corners_ws.size() && all; ++i) {
            const float along = high ? away_ws[i][axis] : -away_ws[i][axis];
            all = all && along > least;
            const float height = high ? region.max[axis] - corners_ws[i][axis] : corners_ws[i][axis] - region.min[axis];
            farthest = std::max(farthest, height / along);
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
    const SweptBoxes swept(light, cs_from_ws);
    const vec4 light_ws = light_point_ws(light);
    std::vector<std::uint32_t> forms;
    forms.reserve(components.size());
    for (const Component& component : components) {
        const std::uint32_t form = form_of(component, light_ws, options, swept);
        forms.push_back(form == GN_VOLUMES_NONE ? form : form | side_of(component, options.mode, swept));
    }
    return forms;
}

}  // namespace gn
