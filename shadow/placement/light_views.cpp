// SPDX-License-Identifier: MIT
// Light views around convex bodies: orthographic for the sun, perspective for lights with a position.
//
// Based on: Brabec, Annen, Seidel. Practical Shadow Mapping. Journal of Graphics Tools 2002. [BAS02b]
#include "shadow/placement/light_views.h"

#include "shadow/geometry/convex_hull.h"
#include "shadow/geometry/potential_receivers.h"
#include "shadow/placement/faces.glsl"

#include <algorithm>

namespace gn {
namespace {

struct Rectangle {
    dvec2 axis{1, 0};  ///< of its first side
    dvec2 min{0}, max{0};
    [[nodiscard]] double area() const { return (max.x - min.x) * (max.y - min.y); }
};

double cross2(dvec2 a, dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

Rectangle bounds_along(const std::vector<dvec2>& points, dvec2 axis) {
    Rectangle r{axis, dvec2(1e300), dvec2(-1e300)};
    for (const dvec2 p : points) {
        const dvec2 q(glm::dot(p, axis), cross2(axis, p));
        r.min = glm::min(r.min, q);
        r.max = glm::max(r.max, q);
    }
    return r;
}

/// The rectangle of least area has a side along an edge of the hull (Freeman and Shapira 1975).
Rectangle least_rectangle(const std::vector<dvec2>& points) {
    const std::vector<dvec2> hull = convex_hull(points);
    Rectangle best = bounds_along(points, {1, 0});
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const dvec2 edge = hull[(i + 1) % hull.size()] - hull[i];
        if (glm::length(edge) > 0) {
            const Rectangle r = bounds_along(points, glm::normalize(edge));
            best = r.area() < best.area() * (1 - 1e-9) ? r : best;
        }
    }
    return best;
}

/// Length of an interval, never shorter than the rounding of its ends to float.
double length_of(double low, double high) {
    return std::max({high - low, 1e-6 * std::max(std::abs(low), std::abs(high)), 1e-30});
}

/// Widens an interval so that a kernel of the guard's reach stays inside the map.
void widen(double& low, double& high, Guard guard, double metres, int resolution) {
    const double share = std::min(0.4, static_cast<double>(guard.texels) / resolution);
    const double size = length_of(low, high);
    const double margin = (size * share + metres) / (1 - 2 * share);
    low -= margin;
    high += margin;
}

/// Rows of a matrix to column-major glm.
mat4 from_rows(const std::array<dvec4, 4>& rows) {
    return mat4(glm::transpose(dmat4(rows[0], rows[1], rows[2], rows[3])));
}

void finish_view(GnLightView& view, const std::array<dvec4, 4>& rows, int resolution) {
    view.cs_from_ws = from_rows(rows);
    view.ws_from_cs = mat4(glm::inverse(glm::transpose(dmat4(rows[0], rows[1], rows[2], rows[3]))));
    view.resolution = static_cast<float>(resolution);
}

}  // namespace

GnLightView fit_orthographic(const ConvexBody& body, const GnLight& light, ivec2 texels, Guard guard) {
    const dvec3 axis(vec3(light.direction_ws));
    vec3 xf;
    vec3 yf;
    complete_frame(vec3(axis), xf, yf);

    // Project the body along the light; its depth range is the body's own.
    std::vector<dvec2> points;
    double near = 1e300;
    double far = -1e300;
    for (const dvec3& p : body.vertices()) {
        points.emplace_back(glm::dot(p, dvec3(xf)), glm::dot(p, dvec3(yf)));
        near = std::min(near, glm::dot(p, axis));
        far = std::max(far, glm::dot(p, axis));
    }

    // Choose the least rectangle, widened by the kernels' reach.
    Rectangle r = least_rectangle(points);
    widen(r.min.x, r.max.x, guard, static_cast<double>(guard.metres), texels.x);
    widen(r.min.y, r.max.y, guard, static_cast<double>(guard.metres), texels.y);
    const dvec3 right = r.axis.x * dvec3(xf) + r.axis.y * dvec3(yf);
    const dvec3 down = -r.axis.y * dvec3(xf) + r.axis.x * dvec3(yf);

    GnLightView view;
    const dvec2 size = r.max - r.min;
    const double texel = std::max(size.x / texels.x, size.y / texels.y);
    const double slack = 1e-4 * length_of(near, far) + 0.1 * texel;
    near -= slack + static_cast<double>(guard.metres + guard.before) + room_of(guard) * texel;
    far += slack;
    finish_view(view,
                {dvec4(right * (2 / size.x), -(r.min.x + r.max.x) / size.x),
                 dvec4(down * (2 / size.y), -(r.min.y + r.max.y) / size.y),
                 dvec4(axis / (far - near), -near / (far - near)), dvec4(0, 0, 0, 1)},
                texels.x);
    view.depth_from_ws = vec4(dvec4(axis / (far - near), -near / (far - near)));
    view.eye_ws = vec4(vec3(-axis), 0);
    view.metres_per_depth = static_cast<float>(far - near);
    return view;
}

namespace {

/// A perspective view with the rectangle [min,max] of tangents along right and down.
GnLightView perspective(dvec3 eye, dvec3 axis, dvec3 right, dvec3 down, dvec2 min, dvec2 max, double near, double far,
                        int resolution) {
    const dvec2 scale = 2.0 / (max - min);
    const dvec2 shift = -(max + min) / (max - min);
    const auto row = [&](dvec3 direction) { return dvec4(direction, -glm::dot(direction, eye)); };
    const dvec4 w = row(axis);
    GnLightView view;
    // Raster depth: far (w - near) / (w (far - near)), only for clipping and the depth test's order.
    finish_view(view,
                {scale.x * row(right) + shift.x * w, scale.y * row(down) + shift.y * w,
                 (far / (far - near)) * (w - dvec4(0, 0, 0, near)), w},
                resolution);
    view.depth_from_ws = vec4((w - dvec4(0, 0, 0, near)) / (far - near));
    view.eye_ws = vec4(vec3(eye), 1);
    view.metres_per_depth = static_cast<float>(far - near);
    return view;
}

}  // namespace

Fitted fit_perspective(const ConvexBody& body, const GnLight& light, ivec2 texels, Guard guard) {
    const dvec3 eye(vec3(light.position_ws));
    double reach = 0;
    for (const dvec3& p : body.vertices()) {
        reach = std::max(reach, glm::length(p - eye));
    }

    // Look at the middle of what is to be seen; a spot keeps its own axis.
    dvec3 axis(0);
    for (const dvec3& p : body.vertices()) {
        axis += glm::length(p - eye) > 0 ? glm::normalize(p - eye) : dvec3(0);
    }
    if (light.kind == GN_LIGHT_SPOT || glm::length(axis) == 0) {
        axis = dvec3(vec3(light.direction_ws));
    }
    axis = glm::normalize(axis);
    vec3 xf;
    vec3 yf;
    complete_frame(vec3(axis), xf, yf);

    // Project onto the plane of tangents; give up beyond 75 degrees from the axis. Depth runs from the nearest to the
    // farthest point.
    std::vector<dvec2> points;
    double near = reach;
    double far = 0;
    for (const dvec3& p : body.vertices()) {
        const dvec3 d = p - eye;
        const double along = glm::dot(d, axis);
        near = std::min(near, along);
        far = std::max(far, along);
        if (glm::length(d) < 1e-9 * reach) {
            continue;  // the apex of the light's own pyramid
        }
        if (along < 0.2588 * glm::length(d)) {
            return {};
        }
        points.emplace_back(glm::dot(d, dvec3(xf)) / along, glm::dot(d, dvec3(yf)) / along);
    }
    if (points.size() < 3) {
        return {};
    }
    Rectangle r = least_rectangle(points);
    // A world radius reaches beyond the body only where nothing receives, so that only texels widen the view.
    widen(r.min.x, r.max.x, guard, 0.0, texels.x);
    widen(r.min.y, r.max.y, guard, 0.0, texels.y);
    const dvec3 right = r.axis.x * dvec3(xf) + r.axis.y * dvec3(yf);
    const dvec3 down = -r.axis.y * dvec3(xf) + r.axis.x * dvec3(yf);

    // [EASW09] near and far planes of the body; casters before the near plane are clamped to it. A thousandth covers
    // rounding.
    const dvec2 side = (r.max - r.min) / dvec2(texels);
    const double texel = std::max(side.x, side.y);
    far *= 1.001;
    near *= 1 - room_of(guard) * texel;
    near = std::max(near - 1e-3 * (far - near) - static_cast<double>(guard.before), near_plane(far));
    return {perspective(eye, axis, right, down, r.min, r.max, near, far, texels.x), true};
}

GnLightView square_perspective(vec3 eye_ws, vec3 axis_ws, vec3 up_ws, double tangent, double near, double far,
                               int resolution) {
    const dvec3 right = glm::normalize(glm::cross(dvec3(axis_ws), dvec3(up_ws)));
    const dvec3 down = glm::cross(dvec3(axis_ws), right);
    return perspective(eye_ws, axis_ws, right, down, dvec2(-tangent), dvec2(tangent), near, far, resolution);
}

void add_cube_views(LightViews& views, const FrameInput& input, const Guard& guard, int resolution) {
    const vec3 eye_ws(input.light().shape.position_ws);
    const double far = reach_of(input);
    const double share = std::min(0.4, static_cast<double>(guard.texels) / resolution);

    // A world radius is widest in angle where receivers are nearest; it is held to a tenth of the face.
    const double tangent = 1 / (1 - 2 * share) + (guard.metres > 0 ? 0.1 : 0.0);
    const std::array<std::pair<vec3, vec3>, 6> faces{{{vec3(1, 0, 0), vec3(0, 1, 0)},
                                                      {vec3(-1, 0, 0), vec3(0, 1, 0)},
                                                      {vec3(0, 1, 0), vec3(0, 0, 1)},
                                                      {vec3(0, -1, 0), vec3(0, 0, 1)},
                                                      {vec3(0, 0, 1), vec3(0, 1, 0)},
                                                      {vec3(0, 0, -1), vec3(0, 1, 0)}}};
    views.kind = ViewKind::perspective;
    views.views.clear();
    for (const auto& [axis_ws, up_ws] : faces) {
        views.views.push_back(square_perspective(eye_ws, axis_ws, up_ws, tangent, near_plane(far), far, resolution));
        views.views.back().layer = static_cast<int>(views.views.size()) - 1;
    }
    views.layers = 6;
    views.set_data(glsl::GnFacesData{vec4(eye_ws, 1)});
}

namespace {

/// Texels that a box spans, to the longer side, where its centre is.
double texels_across(const dmat4& rows, const Box& box_ws, float resolution) {
    const dvec4 centre(dvec3(box_ws.centre()), 1);
    const dvec3 half(0.5F * box_ws.extent());
    const double w = glm::dot(rows[3], centre);
    double most = 0;
    for (int axis = 0; axis < 2; ++axis) {
        const dvec4 along = rows[axis] - rows[3] * (glm::dot(rows[axis], centre) / w);
        most = std::max(most, glm::dot(glm::abs(dvec3(along)), half) / w);
    }
    // Clip space is two units wide, and half is half of the box.
    return w > 0 ? most * static_cast<double>(resolution) : 1e300;
}

}  // namespace

std::vector<vec4> clip_rows(std::span<const GnLightView> views) {
    std::vector<vec4> rows;
    for (const GnLightView& view : views) {
        const mat4 m = glm::transpose(view.cs_from_ws);
        rows.insert(rows.end(), {m[0], m[1], m[3]});
    }
    return rows;
}

std::vector<std::uint32_t> casters_of(const Scene& scene, const GnLightView& view, float least) {
    // Before the near plane everything casts; behind the far plane nothing. The rectangle is extended a little: rounding
    // moves vertices by less than a texel.
    const dmat4 rows = glm::transpose(dmat4(view.cs_from_ws));
    const vec2 texels = vec2(view.rect_ts.z, view.rect_ts.w) * view.resolution;
    const double border = 1 + 4.0 / static_cast<double>(std::min(texels.x, texels.y));
    const dvec4 w = border * rows[3];
    std::vector<dvec4> inside{dvec4(0, 0, 0, 1 + 1e-3) - dvec4(view.depth_from_ws)};
    for (int axis = 0; axis < 2; ++axis) {
        inside.push_back(w - rows[axis]);
        inside.push_back(w + rows[axis]);
    }

    // A box casts unless it lies wholly outside one of the planes.
    std::vector<std::uint32_t> casters;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Box& box_ws = scene.objects[i].bounds_ws;
        const dvec4 centre(dvec3(box_ws.centre()), 1);
        const dvec3 half(0.5F * box_ws.extent());
        if (std::all_of(inside.begin(), inside.end(),
                        [&](const dvec4& plane) {
                            return glm::dot(plane, centre) + glm::dot(glm::abs(dvec3(plane)), half) >= 0;
                        }) &&
            (least <= 0 || texels_across(rows, box_ws, std::max(texels.x, texels.y)) >= static_cast<double>(least))) {
            casters.push_back(static_cast<std::uint32_t>(i));
        }
    }
    return casters;
}

double near_plane(double far) {
    return 1e-4 * far;
}

}  // namespace gn
