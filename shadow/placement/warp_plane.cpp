// SPDX-License-Identifier: MIT
// The light's plane for a frame: where receivers lie on it, and along which direction and how far the view runs there.
//
// Based on: Wimmer, Scherzer, Purgathofer. Light Space Perspective Shadow Maps. EGSR 2004. [WSP04]
#include "shadow/placement/warp.h"

#include <algorithm>

namespace gn::warp {
namespace {

struct View {
    dvec3 eye, forward, right, up;
    double tangent_x = 1, tangent_y = 1;
};

View view_of_camera(const FrameInput& input) {
    const Camera& camera = input.samples.camera;
    View view;
    view.eye = camera.position_ws;
    view.forward = glm::normalize(dvec3(camera.forward_ws));
    view.right = glm::normalize(glm::cross(view.forward, dvec3(camera.up_ws)));
    view.up = glm::cross(view.right, view.forward);
    view.tangent_y = half_height_at(camera, 1);
    view.tangent_x = view.tangent_y * input.samples.width / input.samples.height;
    return view;
}

dvec2 on_plane(const Plane2& plane, dvec3 p_ws) {
    const dvec4 p(p_ws, 1);
    return dvec2(glm::dot(plane.x_row, p), glm::dot(plane.y_row, p)) / glm::dot(plane.w_row, p);
}

dvec4 row_of(const mat4& m, int row) {
    return dvec4(glm::transpose(dmat4(m))[row]);
}

/// The fitted view's plane in one unit on both axes, its axes still along the fitted rectangle.
Plane2 unturned(const GnLightView& fitted) {
    Plane2 plane;
    plane.fitted = fitted;
    plane.w_row = row_of(fitted.cs_from_ws, 3);
    const dvec3 axis = glm::normalize(dvec3(vec3(fitted.depth_from_ws)));
    for (int i = 0; i < 2; ++i) {
        // Take out the rectangle's shift and scale.
        dvec4 row = row_of(fitted.cs_from_ws, i);
        row -= plane.w_row *
               (fitted.eye_ws.w > 0.5F ? glm::dot(dvec3(row), axis) / glm::dot(dvec3(plane.w_row), axis) : row.w);
        (i == 0 ? plane.x_row : plane.y_row) = row / glm::length(dvec3(row));
    }
    return plane;
}

/// Turns the plane so that y runs along the image of the view direction at a point.
void align(Plane2& plane, dvec2 along) {
    const dvec2 t = glm::normalize(along);
    const dvec4 x = t.y * plane.x_row - t.x * plane.y_row;
    plane.y_row = t.x * plane.x_row + t.y * plane.y_row;
    plane.x_row = x;
    // The fitted rectangle stands at this angle, of the four that differ by quarter turns the smallest.
    constexpr double quarter = std::numbers::pi / 2;
    const double angle = std::atan2(t.x, t.y);
    plane.turn = angle - quarter * std::round(angle / quarter);
}

std::vector<Spot> spots_of(const Plane2& plane, const ConvexBody& body, const View& view) {
    std::vector<Spot> spots;
    const std::vector<dvec3> vertices = body.vertices();
    double farthest = 0;
    for (const dvec3& p : vertices) {
        farthest = std::max(farthest, glm::dot(plane.w_row, dvec4(p, 1)));
    }
    for (const dvec3& p : vertices) {
        const double w = glm::dot(plane.w_row, dvec4(p, 1));
        if (w > 1e-6 * farthest) {
            spots.push_back({on_plane(plane, p), glm::dot(p - view.eye, view.forward), w});
        }
    }
    return spots;
}

/// Angle of view and light at a point, and of the frustum's border in the plane that both span.
void set_angles(Plane2& plane, const View& view, dvec3 ray) {
    const double cosine = std::min(1.0, std::abs(glm::dot(ray, view.forward)));
    plane.angle = std::acos(cosine);
    const dvec3 aside = ray - glm::dot(ray, view.forward) * view.forward;
    const double x = std::abs(glm::dot(aside, view.right));
    const double y = std::abs(glm::dot(aside, view.up));
    const double size = glm::length(aside);
    plane.half_field =
        std::atan(std::min(view.tangent_x * size / std::max(x, 1e-12), view.tangent_y * size / std::max(y, 1e-12)));
}

dvec3 middle_of(const ConvexBody& body) {
    const std::vector<dvec3> vertices = body.vertices();
    dvec3 centre(0);
    for (const dvec3& p : vertices) {
        centre += p / static_cast<double>(vertices.size());
    }
    return centre;
}

/// Turns the plane along the image of a direction at the body's centre; false where it has none.
bool turn_along(Plane2& plane, dvec3 centre, dvec3 along_ws) {
    plane.metre = 1 / glm::dot(plane.w_row, dvec4(centre, 1));
    const dvec2 q = on_plane(plane, centre);
    const dvec2 along(glm::dot(dvec3(plane.x_row - q.x * plane.w_row), along_ws),
                      glm::dot(dvec3(plane.y_row - q.y * plane.w_row), along_ws));
    if (glm::length(along) <= 0) {
        return false;
    }
    align(plane, along);
    return true;
}

/// What the map holds, and what the warp is chosen for. False where there is nothing to warp along.
bool measure(Plane2& plane, const FrameInput& input, const ConvexBody& body, const Recipe& recipe, double pseudo_near) {
    const View view = view_of_camera(input);
    plane.spots = spots_of(plane, body, view);
    double end = 0;
    for (const Spot& spot : plane.spots) {
        end = std::max(end, spot.depth);
    }
    const double first = pseudo_near * end;
    const ConvexBody beyond = clip(body, {view.forward, -glm::dot(view.forward, view.eye) - first});
    plane.far_spots = spots_of(plane, beyond, view);
    plane.near = plane.start = 1e300;
    double last = -1e300;
    for (const Spot& spot : plane.far_spots) {
        plane.near = std::min(plane.near, spot.depth);
        plane.far = std::max(plane.far, spot.depth);
        plane.start = std::min(plane.start, spot.q.y);
        last = std::max(last, spot.q.y);
    }
    plane.near = std::max(plane.near, 1e-5 * plane.far);
    plane.length = last - plane.start;

    // Room for kernels; a world radius reaches beyond a light's cone only where nothing receives.
    const Guard guard = guard_of(input, recipe);
    plane.reach = plane.fitted.eye_ws.w > 0.5F ? 0 : static_cast<double>(guard.metres);
    plane.share = std::min(0.4, static_cast<double>(guard.texels) / recipe.resolution);
    return plane.far_spots.size() >= 3 && plane.far >= 1.001 * plane.near && plane.length > 0;
}

}  // namespace

std::optional<Plane2> plane_of(const FrameInput& input, const ConvexBody& body, const GnLightView& fitted,
                               const Recipe& recipe, double pseudo_near) {
    // The warp answers pixels that grow with the distance; an orthographic camera's do not, and n is infinite.
    if (is_orthographic(input.samples.camera)) {
        return std::nullopt;
    }
    const View view = view_of_camera(input);
    Plane2 plane = unturned(fitted);
    const bool positional = fitted.eye_ws.w > 0.5F;
    const dvec3 centre = middle_of(body);
    const dvec3 axis(vec3(input.light().shape.direction_ws));
    set_angles(plane, view, positional ? glm::normalize(centre - dvec3(vec3(fitted.eye_ws))) : axis);
    if (std::sin(plane.angle) < 1e-3 || !turn_along(plane, centre, view.forward)) {
        return std::nullopt;
    }
    return measure(plane, input, body, recipe, pseudo_near) ? std::optional(plane) : std::nullopt;
}

std::optional<Plane2> plane_along(const FrameInput& input, const ConvexBody& body, const GnLightView& fitted,
                                  const Recipe& recipe, double pseudo_near, dvec3 along_ws) {
    if (is_orthographic(input.samples.camera)) {
        return std::nullopt;
    }
    Plane2 plane = unturned(fitted);
    plane.angle = std::numbers::pi / 2;
    if (!turn_along(plane, middle_of(body), along_ws)) {
        return std::nullopt;
    }
    return measure(plane, input, body, recipe, pseudo_near) ? std::optional(plane) : std::nullopt;
}

LightViews place(const FrameInput& input, const Recipe& recipe, double pseudo_near, Choose choose) {
    const GnLight& light = input.light().shape;
    LightViews views;
    views.resolution = static_cast<std::uint32_t>(recipe.resolution);
    ConvexBody body = potential_receivers(input);
    const bool nothing = body.empty();
    if (nothing) {
        // Nothing can receive: any view will do.
        body = body_of(Box{vec3(-1), vec3(1)});
    }

    // Fit without a warp; receivers around the light take six views.
    GnLightView fitted;
    if (light.kind == GN_LIGHT_DIRECTIONAL) {
        fitted = fit_orthographic(body, light, recipe.resolution, guard_of(input, recipe));
    } else {
        const Fitted fit = fit_perspective(body, light, recipe.resolution, guard_of(input, recipe));
        if (!fit.valid) {
            add_cube_views(views, input, guard_of(input, recipe), recipe.resolution);
            return views;
        }
        fitted = fit.view;
    }

    // Warp.
    const auto plane = nothing ? std::nullopt : plane_of(input, body, fitted, recipe, pseudo_near);
    views.views = {plane ? choose(*plane, recipe) : fitted};
    views.kind = kind_of(views.views);
    return views;
}

}  // namespace gn::warp
