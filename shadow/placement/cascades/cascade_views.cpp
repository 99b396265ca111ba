// SPDX-License-Identifier: MIT
// Slices of the view, boxes around them, their casters, and what the choice function is told.
//
// Based on: Zhang, Sun, Xu, Lun. Parallel-Split Shadow Maps for Large-scale Virtual Environments. VRCIA 2006. [ZSXL06]
#include "shadow/placement/cascades/cascade_views.h"

#include "shadow/geometry/visible_objects.h"
#include "shadow/placement/cascades/cascades.glsl"
#include "shadow/placement/shelf.h"

#include <algorithm>
#include <numeric>

namespace gn::cascades {
namespace {

dvec3 axis_of(const GnLight& light) {
    return glm::normalize(dvec3(vec3(light.direction_ws)));
}

/// Never shorter than the rounding of its ends to float.
double length_of(Interval interval) {
    const double rounding = 1e-6 * std::max(std::abs(interval.near), std::abs(interval.far));
    return std::max({interval.far - interval.near, rounding, 1e-30});
}

/// A metric interval widened so that a kernel of the guard's reach stays inside the map.
Interval widened(Interval interval, Guard guard, int resolution) {
    const double share = std::min(0.4, static_cast<double>(guard.texels) / resolution);
    const double size = length_of(interval);
    const double margin = (size * share + static_cast<double>(guard.metres)) / (1 - 2 * share);
    return {interval.near - margin, interval.far + margin};
}

}  // namespace

Interval range_of(const FrameInput& input, const GnCascadesParams& params) {
    const Camera& camera = input.samples.camera;
    Interval range{camera.near, camera.far};
    if (params.distance > 0) {
        range.far = std::clamp(static_cast<double>(params.distance), 1.001 * range.near, range.far);
    }
    if (input.scene.bounds_ws.empty()) {
        return range;
    }
    if (params.fit == GN_FIT_STABLE && params.split < GN_SPLIT_SDSM_MINMAX) {
        range = stable_range(input, params, range);
        return params.far == GN_FAR_OBJECTS ? stable_cut(input, range) : range;
    }
    // The potential receivers' own range.
    const ConvexBody body = potential_receivers(input, range.near, range.far);
    if (!body.empty()) {
        const dvec3 forward = glm::normalize(dvec3(camera.forward_ws));
        const Interval along = extent_of(body, forward);
        const double eye = glm::dot(forward, dvec3(camera.position_ws));
        range.near = std::clamp(along.near - eye, range.near, range.far);
        range.far = std::clamp(along.far - eye, 1.001 * range.near, range.far);
    }
    if (params.far == GN_FAR_OBJECTS) {
        range.far = std::clamp(farthest_seen(input, range.near, range.far), 1.001 * range.near, range.far);
    }
    return range;
}

std::vector<Interval> slices_of(const GnCascadesParams& params, Interval range) {
    const auto end = [&](int i) {
        return static_cast<double>(
            glsl::gn_cascades_split(params, static_cast<float>(range.near), static_cast<float>(range.far), i));
    };
    const double width = params.transition == GN_TRANSITION_NONE ? 0.0 : static_cast<double>(params.width);
    std::vector<Interval> slices;
    for (int i = 0; i < params.count; ++i) {
        // The band of the transition belongs to both; a little more covers the rounding of the view depth.
        const double band = i == 0 ? 0.0 : width * (end(i) - end(i - 1));
        slices.push_back({(1 - 1e-5) * (end(i) - band), (1 + 1e-5) * end(i + 1)});
    }
    return slices;
}

int side_of(const GnCascadesParams& params, int resolution, std::size_t i) {
    return resolution >> glsl::gn_cascades_halvings(static_cast<int>(i), params.count, params.falloff);
}

uint packed_halvings(const GnCascadesParams& params) {
    uint packed = 0;
    for (int i = 0; i < params.count; ++i) {
        packed |= static_cast<uint>(glsl::gn_cascades_halvings(i, params.count, params.falloff)) << (4 * i);
    }
    return packed;
}

void put_into_layers(const GnCascadesParams& params, int resolution, LightViews& views) {
    const auto halved = [&](std::size_t i) {
        return glsl::gn_cascades_halvings(static_cast<int>(i), params.count, params.falloff);
    };
    std::vector<std::size_t> order(views.views.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return halved(a) < halved(b); });
    Shelf shelf{halved(order.back())};
    for (const std::size_t i : order) {
        shelf.put(views.views[i], halved(i));
        views.views[i].resolution = static_cast<float>(resolution);
    }
    views.layers = static_cast<std::uint32_t>(views.views[order.back()].layer) + 1;
}

LightFrame facing(const Camera& camera, const GnLight& light) {
    LightFrame frame;
    frame.z = axis_of(light);
    const dvec3 forward(camera.forward_ws);
    dvec3 along = forward - glm::dot(forward, frame.z) * frame.z;
    if (glm::length(along) < 1e-3) {
        along = dvec3(camera.up_ws) - glm::dot(dvec3(camera.up_ws), frame.z) * frame.z;
    }
    frame.x = glm::normalize(along);
    frame.y = glm::cross(frame.z, frame.x);
    return frame;
}

LightFrame turned(const LightFrame& frame, double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return {c * frame.x + s * frame.y, c * frame.y - s * frame.x, frame.z};
}

Interval extent_of(const ConvexBody& body, dvec3 axis) {
    Interval extent{1e300, -1e300};
    for (const dvec3& p : body.vertices()) {
        extent.near = std::min(extent.near, glm::dot(p, axis));
        extent.far = std::max(extent.far, glm::dot(p, axis));
    }
    return extent;
}

Interval with_slack(Interval depth, Guard guard, double texel, double rounding) {
    const double slack = 1e-4 * length_of(depth) + 0.1 * texel + rounding;
    const double room = static_cast<double>(guard.metres + guard.before) + room_of(guard) * texel;
    return {depth.near - slack - room, depth.far + slack};
}

void set_depth_range(GnLightView& view, const GnLight& light, Interval depth) {
    const dvec3 axis = axis_of(light);
    const double metres = depth.far - depth.near;
    const dvec4 row(axis / metres, -depth.near / metres);
    set_row(view.cs_from_ws, 2, row);
    view.depth_from_ws = vec4(row);
    view.metres_per_depth = static_cast<float>(metres);
    view.ws_from_cs = mat4(glm::inverse(dmat4(view.cs_from_ws)));
}

void complete(GnLightView& view, const GnLight& light, int resolution, Interval depth) {
    view.eye_ws = vec4(vec3(-axis_of(light)), 0);
    view.resolution = static_cast<float>(resolution);
    set_depth_range(view, light, depth);
}

GnLightView plain_view(const ConvexBody& body, const LightFrame& frame, int resolution, Guard guard) {
    GnLight light;
    light.direction_ws = vec4(vec3(frame.z), 0);
    const Interval u = widened(extent_of(body, frame.x), guard, resolution);
    const Interval v = widened(extent_of(body, frame.y), guard, resolution);
    const double texel = std::max(u.far - u.near, v.far - v.near) / resolution;
    GnLightView view;
    set_row(view.cs_from_ws, 0, dvec4(frame.x * 2.0, -(u.near + u.far)) / (u.far - u.near));
    set_row(view.cs_from_ws, 1, dvec4(frame.y * 2.0, -(v.near + v.far)) / (v.far - v.near));
    complete(view, light, resolution, with_slack(extent_of(body, frame.z), guard, texel, 0));
    return view;
}

GnCascadesData choice_data(const GnCascadesParams& params, Interval range, const LightFrame& frame,
                           std::span<const GnLightView> views, Guard guard) {
    GnCascadesData data{.count = params.count,
                        .transition = params.transition,
                        .select = params.select,
                        .width = params.width,
                        .near = static_cast<float>(range.near)};
    data.limit = views.empty() ? 1.0F : 1.0F - 2.0F * std::min(0.4F, guard.texels / views[0].resolution);
    data.halved = packed_halvings(params);
    data.x_ws = vec4(vec3(frame.x), 0);
    data.y_ws = vec4(vec3(frame.y), 0);
    for (std::size_t i = 0; i < views.size(); ++i) {
        data.ends[i] = glsl::gn_cascades_split(params, static_cast<float>(range.near), static_cast<float>(range.far),
                                               static_cast<int>(i) + 1);

        // u = scale (c x + s y) + offset, v likewise a quarter turn further.
        const dvec4 u = row_of(views[i].cs_from_ws, 0);
        const dvec4 v = row_of(views[i].cs_from_ws, 1);
        const double angle = std::atan2(glm::dot(dvec3(u), frame.y), glm::dot(dvec3(u), frame.x));
        const dvec3 turned = std::cos(angle) * frame.y - std::sin(angle) * frame.x;
        data.fits[i] = vec4(dvec4(glm::length(dvec3(u)), glm::dot(dvec3(v), turned), u.w, v.w));
        data.angles[i] = static_cast<float>(angle);
    }
    return data;
}

}  // namespace gn::cascades
