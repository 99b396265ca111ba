// SPDX-License-Identifier: MIT
// Light views around slices of the view: boxes, rectangles of least area, and windows of a fixed texel grid.
//
// Based on: Valient. Stable Rendering of Cascaded Shadow Maps. ShaderX6 2008. [Val08]
// Departs from it: the grid is fixed to the world to 1/256 of a texel by gn_clip, not only to rounding.
#include "shadow/placement/cascades/cascade_views.h"

#include "shadow/placement/cascades/cascades.glsl"

#include <algorithm>
#include <bit>

namespace gn::cascades {
namespace {

dvec3 axis_of(const GnLight& light) {
    return glm::normalize(dvec3(vec3(light.direction_ws)));
}

void set_row(mat4& m, int row, dvec4 values) {
    for (int column = 0; column < 4; ++column) {
        m[column][row] = static_cast<float>(values[column]);
    }
}

dvec4 row_of(const mat4& m, int row) {
    return {m[0][row], m[1][row], m[2][row], m[3][row]};
}

/// Completes an orthographic view whose x and y rows are set.
void finish(GnLightView& view, const GnLight& light, int resolution, Interval depth) {
    view.eye_ws = vec4(vec3(-axis_of(light)), 0);
    view.resolution = static_cast<float>(resolution);
    view.affine_depth = 1;
    set_depth_range(view, light, depth);
}

/// A metric interval widened so that a kernel of the guard's reach stays inside the map.
Interval widened(Interval interval, Guard guard, int resolution) {
    const double share = std::min(0.4, static_cast<double>(guard.texels) / resolution);
    const double size = std::max(interval.far - interval.near, 1e-6);
    const double margin = (size * share + static_cast<double>(guard.metres)) / (1 - 2 * share);
    return {interval.near - margin, interval.far + margin};
}

/// Square of the distance from the axis to the frustum's corners, per distance along it.
double corner_slope(const Camera& camera, double aspect) {
    const double tangent = std::tan(0.5 * static_cast<double>(camera.yfov));
    return tangent * tangent * (1 + aspect * aspect);
}

/// The scene's bounds on the light's plane: the rectangle of least area, as still as the scene.
struct SceneWindow {
    dvec3 x{1, 0, 0}, y{0, 1, 0};
    dvec2 centre{0}, half{0};  ///< along x and y, metres
};

SceneWindow scene_window(const GnLight& light, const Box& scene_ws) {
    const Box box_ws = scene_ws.empty() ? Box{vec3(-1), vec3(1)} : scene_ws;
    const GnLightView fitted = fit_orthographic(body_of(box_ws), light, 1, {});
    SceneWindow window;
    for (int axis = 0; axis < 2; ++axis) {
        const dvec4 row = row_of(fitted.cs_from_ws, axis);
        window.half[axis] = 1 / glm::length(dvec3(row));
        (axis == 0 ? window.x : window.y) = dvec3(row) * window.half[axis];
        window.centre[axis] = -row.w * window.half[axis];
    }
    // A flat scene seen edge-on still has a width.
    window.half = glm::max(window.half, dvec2(1e-3 * std::max(window.half.x, window.half.y)));
    return window;
}

/// The least distance along the axis at which a camera outside the scene can see any of it, in steps of two so that it
/// changes only when the camera has moved far.
double first_distance(const Camera& camera, double aspect, const Box& box_ws) {
    const dvec3 eye(camera.position_ws);
    const dvec3 nearest = glm::clamp(eye, dvec3(box_ws.min), dvec3(box_ws.max));
    const double diagonal = static_cast<double>(box_ws.diagonal());
    const double least = glm::length(nearest - eye) / std::sqrt(1 + corner_slope(camera, aspect));
    return least > 1e-6 * diagonal ? diagonal * std::exp2(std::floor(std::log2(least / diagonal))) : 0.0;
}

/// Distances that hold whatever can be seen, however the camera turns and moves by a little.
Interval stable_range(const FrameInput& input, const GnCascadesParams& params, Interval range) {
    const Camera& camera = input.samples.camera;
    const Box& box_ws = input.scene.bounds_ws;
    const double aspect = static_cast<double>(input.samples.width) / static_cast<double>(input.samples.height);
    range.near = std::clamp(first_distance(camera, aspect, box_ws), range.near, range.far / 1.001);

    // Nothing lies farther than the scene's diagonal from a camera inside it; outside, double until that holds.
    double reach = std::max(1.001 * static_cast<double>(box_ws.diagonal()), 2 * range.near);
    const double needed = farthest(box_ws, camera.position_ws);
    while (reach < needed && reach < range.far) {
        reach *= 2;
    }
    range.far = std::min(range.far, reach);
    if (params.distance > 0) {
        return range;
    }

    // A sphere that ends here is as wide as the scene. The last window holds the scene and all beyond: split before it.
    const SceneWindow window = scene_window(input.light().shape, box_ws);
    const double wide = 1.001 * std::max(window.half.x, window.half.y) / std::sqrt(corner_slope(camera, aspect));
    range.far = std::clamp(wide, 1.001 * range.near, range.far);
    return range;
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
        return stable_range(input, params, range);
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

Interval extent_of(const ConvexBody& body, dvec3 axis) {
    Interval extent{1e300, -1e300};
    for (const dvec3& p : body.vertices()) {
        extent.near = std::min(extent.near, glm::dot(p, axis));
        extent.far = std::max(extent.far, glm::dot(p, axis));
    }
    return extent;
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

GnLightView plain_view(const ConvexBody& body, const LightFrame& frame, int resolution, Guard guard) {
    GnLight light;
    light.direction_ws = vec4(vec3(frame.z), 0);
    const Interval u = widened(extent_of(body, frame.x), guard, resolution);
    const Interval v = widened(extent_of(body, frame.y), guard, resolution);
    GnLightView view;
    set_row(view.cs_from_ws, 0, dvec4(frame.x * 2.0, -(u.near + u.far)) / (u.far - u.near));
    set_row(view.cs_from_ws, 1, dvec4(frame.y * 2.0, -(v.near + v.far)) / (v.far - v.near));
    Interval depth = extent_of(body, frame.z);
    const double slack = 1e-4 * std::max(depth.far - depth.near, 1e-3);
    depth = {depth.near - slack - static_cast<double>(guard.metres), depth.far + slack};
    finish(view, light, resolution, depth);
    return view;
}

Sphere sphere_around(Interval slice, double yfov, double aspect) {
    // Equally far from the near and the far corners, or around the far ones where the slice is wider than long.
    const double tangent = std::tan(0.5 * yfov);
    const double k = tangent * tangent * (1 + aspect * aspect);
    Sphere sphere;
    sphere.centre = std::min(slice.far, 0.5 * (slice.near + slice.far) * (1 + k));
    sphere.radius = std::sqrt((slice.far - sphere.centre) * (slice.far - sphere.centre) + slice.far * slice.far * k);
    return sphere;
}

Grid grid_of(const Sphere& sphere, const GnLight& light, const Box& scene_ws, int resolution, Guard guard,
             double spare) {
    // Positions are rounded to float before anything else: three products and two sums lose up to this many metres.
    const vec3 largest = scene_ws.empty() ? vec3(1) : glm::max(glm::abs(scene_ws.min), glm::abs(scene_ws.max));
    const double rounding = static_cast<double>(largest.x + largest.y + largest.z) * 0x1p-22;
    const double more = static_cast<double>(guard.metres) + rounding;

    // Along each axis the window follows the sphere, or stands still around the scene where that is smaller.
    const SceneWindow scene = scene_window(light, scene_ws);
    const double round = (sphere.radius + more) * (1 + spare);
    Grid grid;
    dvec2 reach(0);
    for (int axis = 0; axis < 2; ++axis) {
        grid.still[axis] = !scene_ws.empty() && scene.half[axis] + more <= round;
        reach[axis] = grid.still[axis] ? scene.half[axis] + more : round;
    }

    // Windows sit on whole texels. Beyond 2^23 texels from the origin a float offset holds only every other one, or fewer.
    while (rounding * 0x1p22 * resolution > grid.step * 0x1p23 * 2 * std::min(reach.x, reach.y)) {
        grid.step *= 2;
    }
    const double share = std::min(0.4, (static_cast<double>(guard.texels) + grid.step) / resolution);
    const dvec2 half = reach / (1 - 2 * share);
    const double free = 1 - (sphere.radius + more) * (1 - 2 * share) / round;
    grid.margin = 0.5 * resolution * free - static_cast<double>(guard.texels);
    grid.resolution = resolution;
    set_row(grid.view.cs_from_ws, 0, dvec4(scene.x / half.x, -1));
    set_row(grid.view.cs_from_ws, 1, dvec4(scene.y / half.y, -1));
    grid.home = 0.5 * resolution * scene.centre / half;

    // Depth runs over the whole scene: it must not follow the camera either.
    const dvec3 axis = axis_of(light);
    Interval depth = extent_of(body_of(scene_ws.empty() ? Box{vec3(-1), vec3(1)} : scene_ws), axis);
    const double slack = 1e-4 * std::max(depth.far - depth.near, 1e-3) + rounding;
    depth = {depth.near - slack - static_cast<double>(guard.metres), depth.far + slack};
    finish(grid.view, light, resolution, depth);
    if (std::has_single_bit(static_cast<unsigned>(resolution))) {
        // 1.5 x 2^15 texels: a float of that size has a last place of 1/256 of a texel.
        grid.view.grid = 1.5F * 0x1p15F * 2.0F / static_cast<float>(resolution);
    }
    return grid;
}

dvec2 texel_of(const Grid& grid, dvec3 p_ws) {
    const dvec3 u(row_of(grid.view.cs_from_ws, 0));
    const dvec3 v(row_of(grid.view.cs_from_ws, 1));
    return 0.5 * grid.resolution * dvec2(glm::dot(u, p_ws), glm::dot(v, p_ws));
}

namespace {

/// The texel at the window's centre: the point's, or along a still axis the scene's.
dvec2 centre_of(const Grid& grid, dvec3 centre_ws) {
    const dvec2 centre = texel_of(grid, centre_ws);
    return {grid.still.x ? grid.home.x : centre.x, grid.still.y ? grid.home.y : centre.y};
}

/// Texel g stands at g 2 / n in clip units before the offset: exact for n a power of two and whole g.
GnLightView shifted(const Grid& grid, dvec2 first) {
    GnLightView view = grid.view;
    for (int axis = 0; axis < 2; ++axis) {
        view.cs_from_ws[3][axis] = static_cast<float>(-2.0 * first[axis] / grid.resolution - 1.0);
    }
    view.ws_from_cs = mat4(glm::inverse(dmat4(view.cs_from_ws)));
    return view;
}

}  // namespace

ivec2 window_around(const Grid& grid, dvec3 centre_ws) {
    const dvec2 centre = centre_of(grid, centre_ws);
    ivec2 first(0);
    for (int axis = 0; axis < 2; ++axis) {
        double step = grid.step;
        while (std::abs(centre[axis]) + grid.resolution > step * 0x1p23) {
            step *= 2;
        }
        const double texel = std::round((centre[axis] - 0.5 * grid.resolution) / step) * step;
        first[axis] = static_cast<int>(std::clamp(texel, -0x1p30, 0x1p30));
    }
    return first;
}

GnLightView view_of(const Grid& grid, ivec2 first) {
    return shifted(grid, dvec2(first));
}

GnLightView loose_view(const Grid& grid, dvec3 centre_ws) {
    GnLightView view = shifted(grid, centre_of(grid, centre_ws) - 0.5 * grid.resolution);
    view.grid = 0;
    return view;
}

std::vector<std::uint32_t> casters_of(const Scene& scene, const GnLightView& view) {
    // Before the near plane everything casts; behind the far plane nothing. The rectangle is extended a little: rounding
    // moves vertices by less than a texel.
    const double border = 1 + 4.0 / static_cast<double>(view.resolution);
    const dvec4 w = border * row_of(view.cs_from_ws, 3);
    std::vector<dvec4> inside{dvec4(0, 0, 0, 1 + 1e-3) - dvec4(view.depth_from_ws)};
    for (int axis = 0; axis < 2; ++axis) {
        inside.push_back(w - row_of(view.cs_from_ws, axis));
        inside.push_back(w + row_of(view.cs_from_ws, axis));
    }

    // A box casts unless it lies wholly outside one of the planes.
    std::vector<std::uint32_t> casters;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Box& box_ws = scene.objects[i].bounds_ws;
        const dvec4 centre(dvec3(box_ws.centre()), 1);
        const dvec3 half(0.5F * box_ws.extent());
        if (std::all_of(inside.begin(), inside.end(), [&](const dvec4& plane) {
                return glm::dot(plane, centre) + glm::dot(glm::abs(dvec3(plane)), half) >= 0;
            })) {
            casters.push_back(static_cast<std::uint32_t>(i));
        }
    }
    return casters;
}

std::array<vec4, 16> pack(const GnCascadesParams& params, Interval range, const LightFrame& frame,
                          std::span<const GnLightView> views, Guard guard) {
    std::array<vec4, 16> data{};
    const float limit = views.empty() ? 1.0F : 1.0F - 2.0F * std::min(0.4F, guard.texels / views[0].resolution);
    data[0] = vec4(params.count, params.transition, params.select, params.width);
    data[3] = vec4(static_cast<float>(range.near), limit, 0, 0);
    data[4] = vec4(vec3(frame.x), 0);
    data[5] = vec4(vec3(frame.y), 0);
    for (int i = 0; i < static_cast<int>(views.size()); ++i) {
        data[1 + static_cast<unsigned>(i) / 4][i % 4] =
            glsl::gn_cascades_split(params, static_cast<float>(range.near), static_cast<float>(range.far), i + 1);

        // u = scale (c x + s y) + offset, v likewise a quarter turn further.
        const dvec4 u = row_of(views[static_cast<std::size_t>(i)].cs_from_ws, 0);
        const dvec4 v = row_of(views[static_cast<std::size_t>(i)].cs_from_ws, 1);
        const double angle = std::atan2(glm::dot(dvec3(u), frame.y), glm::dot(dvec3(u), frame.x));
        const dvec3 turned = std::cos(angle) * frame.y - std::sin(angle) * frame.x;
        data[6 + static_cast<unsigned>(i)] = vec4(dvec4(glm::length(dvec3(u)), glm::dot(dvec3(v), turned), u.w, v.w));
        data[14 + static_cast<unsigned>(i) / 4][i % 4] = static_cast<float>(angle);
    }
    return data;
}

}  // namespace gn::cascades
