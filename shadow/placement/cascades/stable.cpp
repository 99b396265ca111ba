// SPDX-License-Identifier: MIT
// Stable cascades: ranges and windows of a fixed texel grid, which depend on light, optics and scene only.
//
// Based on: Valient. Stable Rendering of Cascaded Shadow Maps. ShaderX6 2008. [Val08]
// Departs from it: the grid is fixed to the world to 1/256 of a texel by gn_clip, not only to rounding; a window that would
// be wider than the scene stands still around the scene instead.
#include "shadow/geometry/visible_objects.h"
#include "shadow/placement/cascades/cascade_views.h"

#include <algorithm>
#include <bit>

namespace gn::cascades {
namespace {

/// Square of the distance from the axis to the frustum's corners, per distance along it.
double corner_slope(const Camera& camera, double aspect) {
    const double tangent = half_height_at(camera, 1);
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
    const double diagonal = static_cast<double>(box_ws.diagonal());
    const dvec3 nearest = glm::clamp(eye, dvec3(box_ws.min), dvec3(box_ws.max));
    const double least =
        is_orthographic(camera)
            ? extent_of(body_of(box_ws), dvec3(camera.forward_ws)).near - glm::dot(dvec3(camera.forward_ws), eye)
            : glm::length(nearest - eye) / std::sqrt(1 + corner_slope(camera, aspect));
    return least > 1e-6 * diagonal ? diagonal * std::exp2(std::floor(std::log2(least / diagonal))) : 0.0;
}

}  // namespace

Interval stable_range(const FrameInput& input, const GnCascadesParams& params, Interval range) {
    const Camera& camera = input.samples.camera;
    const Box box_ws = seen_bounds(input);
    const double aspect = static_cast<double>(input.samples.width) / static_cast<double>(input.samples.height);
    range.near = std::clamp(first_distance(camera, aspect, box_ws), range.near, range.far / 1.001);

    // Nothing lies farther than the scene's diagonal from a camera inside it; outside, double until that holds.
    double reach = std::max(1.001 * static_cast<double>(box_ws.diagonal()), 2 * range.near);
    const double needed = farthest(box_ws, camera.position_ws);
    while (reach < needed && reach < range.far) {
        reach *= 2;
    }
    range.far = std::min(range.far, reach);
    if (params.distance > 0 || is_orthographic(camera)) {
        return range;
    }

    // A sphere that ends here is as wide as the scene. The last window holds the scene and all beyond: split before it.
    const SceneWindow window = scene_window(input.light().shape, box_ws);
    const double wide = 1.001 * std::max(window.half.x, window.half.y) / std::sqrt(corner_slope(camera, aspect));
    range.far = std::clamp(wide, 1.001 * range.near, range.far);
    return range;
}

Interval stable_cut(const FrameInput& input, Interval range) {
    const double unit = static_cast<double>(seen_bounds(input).diagonal());
    const double seen = farthest_seen(input, range.near, range.far);
    if (unit > 0 && seen > range.near) {
        const double reach = unit * std::exp2(0.5 * std::ceil(2 * std::log2(seen / unit)));
        range.far = std::clamp(reach, 1.001 * range.near, range.far);
    }
    return range;
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

Sphere sphere_around(Interval slice, const Camera& camera, double aspect) {
    if (!is_orthographic(camera)) {
        return sphere_around(slice, static_cast<double>(camera.yfov), aspect);
    }
    // Around a box as wide everywhere.
    const double across = half_height_at(camera, 1) * std::sqrt(1 + aspect * aspect);
    return {0.5 * (slice.near + slice.far), std::hypot(0.5 * (slice.far - slice.near), across)};
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
    const dvec3 axis = glm::normalize(dvec3(vec3(light.direction_ws)));
    const double texel = 2 * std::max(half.x, half.y) / resolution;
    const Interval depth = with_slack(extent_of(body_of(scene_ws.empty() ? Box{vec3(-1), vec3(1)} : scene_ws), axis),
                                      guard, texel, rounding);
    complete(grid.view, light, resolution, depth);
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

}  // namespace gn::cascades
