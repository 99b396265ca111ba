// SPDX-License-Identifier: MIT
// Based on: Wimmer, Scherzer, Purgathofer. Light Space Perspective Shadow Maps. EGSR 2004. [WSP04]
// Departs from it: the warp acts on the light's plane only and depth stays linear, so that no near or far plane of the
// warp exists; sideways its centre lies where the warped receivers are narrowest, not always before the eye.
#include "shadow/placement/warp.h"

#include <algorithm>

namespace gn::warp {
namespace {

constexpr double half_turn = std::numbers::pi;

/// Before the turn and the rectangle.
dvec2 warped_point(const Plane2& plane, const Warp& warp, dvec2 q) {
    const double along = q.y - plane.start;
    return dvec2(q.x - warp.x_centre, along) / (1 + warp.strength * along);
}

dvec2 turned(dvec2 q, double turn) {
    return {std::cos(turn) * q.x + std::sin(turn) * q.y, std::cos(turn) * q.y - std::sin(turn) * q.x};
}

/// Width of the warped points for a centre; convex in it, as the difference of a maximum and a minimum of lines.
double width_at(const Plane2& plane, const std::vector<dvec2>& points, Warp warp, double x_centre) {
    warp.x_centre = x_centre;
    double low = 1e300;
    double high = -1e300;
    for (const dvec2 q : points) {
        const double x = warped_point(plane, warp, q).x;
        low = std::min(low, x);
        high = std::max(high, x);
    }
    return high - low;
}

/// The middle of all the centres that are best: often many are, since one end of the receivers alone decides.
double narrowest_centre(const Plane2& plane, const std::vector<dvec2>& points, const Warp& warp) {
    const auto [low, high] =
        std::minmax_element(points.begin(), points.end(), [](dvec2 a, dvec2 b) { return a.x < b.x; });
    const double size = high->x - low->x;
    double sum = 0;
    for (const bool leftmost : {true, false}) {
        double a = low->x - 2 * size;
        double b = high->x + 2 * size;
        for (int step = 0; step < 60; ++step) {
            const double third = (b - a) / 3;
            const double left = width_at(plane, points, warp, a + third);
            const double right = width_at(plane, points, warp, b - third);
            const double equal = 1e-9 * right;
            const bool keep_left = leftmost ? left <= right + equal : left < right - equal;
            (keep_left ? b : a) = keep_left ? b - third : a + third;
        }
        sum += 0.5 * (a + b);
    }
    return 0.5 * sum;
}

/// The rectangle around the warped points with room for the kernels' texels.
void fit_rectangle(const Plane2& plane, const std::vector<dvec2>& points, Warp& warp) {
    warp.min = dvec2(1e300);
    warp.max = dvec2(-1e300);
    for (const dvec2 q : points) {
        const dvec2 r = turned(warped_point(plane, warp, q), warp.turn);
        warp.min = glm::min(warp.min, r);
        warp.max = glm::max(warp.max, r);
    }
    const dvec2 size = warp.max - warp.min;
    const dvec2 margin = glm::max(size, dvec2(1e-9 * std::max(size.x, size.y))) * (plane.share / (1 - 2 * plane.share));
    warp.min -= margin;
    warp.max += margin;
}

/// Whether a map's corner lies beyond the horizon, or so close to it that kernels there see all directions.
bool meets_horizon(const Plane2& plane, const Warp& warp) {
    // With y' = y / (1 + k y), 1 / w = 1 - k y' of a point of the map.
    const double least = 0.25 / (1 + warp.strength * plane.length);
    for (const dvec2 corner : {warp.min, warp.max, dvec2(warp.min.x, warp.max.y), dvec2(warp.max.x, warp.min.y)}) {
        if (1 - warp.strength * turned(corner, -warp.turn).y < least) {
            return true;
        }
    }
    return false;
}

}  // namespace

std::vector<dvec2> outline(const Plane2& plane) {
    std::vector<dvec2> points;
    for (const Spot& spot : plane.spots) {
        for (const dvec2 side : {dvec2(-1, -1), dvec2(1, -1), dvec2(-1, 1), dvec2(1, 1)}) {
            points.push_back(spot.q + plane.reach * side);
        }
    }
    return points;
}

Warp centred_warp(const Plane2& plane, const std::vector<dvec2>& points, double strength) {
    double first = plane.start;
    for (const dvec2 q : points) {
        first = std::min(first, q.y);
    }
    // Keep the centre of projection behind all receivers, those before the pseudo-near plane too.
    Warp warp{.strength = strength};
    if (first < plane.start) {
        warp.strength = std::min(warp.strength, 0.8 / (plane.start - first));
    }
    warp.x_centre = narrowest_centre(plane, points, warp);
    return warp;
}

Warp make_warp(const Plane2& plane, double strength, double turn) {
    const std::vector<dvec2> points = outline(plane);
    Warp warp = centred_warp(plane, points, strength);
    warp.turn = turn;

    // Fit, and weaken the warp until the kernels at the far border end before the horizon.
    for (int step = 0; step < 200; ++step) {
        warp.x_centre = narrowest_centre(plane, points, warp);
        fit_rectangle(plane, points, warp);
        if (!meets_horizon(plane, warp)) {
            break;
        }
        warp.strength *= 0.9;
    }
    return warp;
}

namespace {

/// Homography of the plane: rows give the map's x, y in [-1,1] and w from (x, y, 1) of the plane.
std::array<dvec3, 3> homography(const Plane2& plane, const Warp& warp) {
    const dvec3 w(0, warp.strength, 1 - warp.strength * plane.start);
    const dvec3 x(1, 0, -warp.x_centre);
    const dvec3 y(0, 1, -plane.start);
    const double c = std::cos(warp.turn);
    const double s = std::sin(warp.turn);
    const dvec2 scale = 2.0 / (warp.max - warp.min);
    const dvec2 shift = -(warp.max + warp.min) / (warp.max - warp.min);
    return {scale.x * (c * x + s * y) + shift.x * w, scale.y * (c * y - s * x) + shift.y * w, w};
}

}  // namespace

GnLightView view_of(const Plane2& plane, const Warp& warp) {
    const auto h = homography(plane, warp);
    const auto row = [&](dvec3 r) { return r.x * plane.x_row + r.y * plane.y_row + r.z * plane.w_row; };
    // Depth stays the fitted view's and is written by fragments; z is clamped and only has to keep the matrix regular.
    GnLightView view = plane.fitted;
    const dmat4 rows(row(h[0]), row(h[1]), dvec4(plane.fitted.depth_from_ws), row(h[2]));
    view.cs_from_ws = mat4(glm::transpose(rows));
    view.ws_from_cs = mat4(glm::inverse(glm::transpose(rows)));
    return view;
}

double worst_error(const Plane2& plane, const Warp& warp) {
    const auto h = homography(plane, warp);
    double worst = 0;
    for (const Spot& spot : plane.far_spots) {
        const dvec3 q(spot.q, 1);
        const double w = glm::dot(h[2], q);
        for (int axis = 0; axis < 2; ++axis) {
            // A texel is as long as the inverse of the gradient of the map's coordinate.
            const dvec3 row = h[static_cast<std::size_t>(axis)];
            const dvec2 gradient = (dvec2(row) - dvec2(h[2]) * (glm::dot(row, q) / w)) / w;
            worst = std::max(worst, spot.distance / (glm::length(gradient) * spot.depth));
        }
    }
    return worst;
}

double optimal_distance(double near, double far) {
    return near + std::sqrt(far * near);
}

double strength_of(double eta, double near, double far, double length) {
    // Metres of the light's plane per metre of depth; 1 where the light is overhead.
    const double scale = length / (far - near);
    if (eta <= 0) {
        return (1 + eta) / (scale * optimal_distance(near, far));
    }
    return 1 / (scale * (near + (1 - eta) * (optimal_distance(near, far) - near)));
}

double falloff(double angle, double half_field) {
    // The frustum's side turns parallel to the light at angle = half_field [Llo07, section 5.2.1].
    constexpr double eta_b = -0.2;
    const double a = half_field / 3;
    const double b = half_field;
    const double c = half_field + 0.3 * (half_turn / 2 - half_field);
    if (angle <= a) {
        return -1;
    }
    if (angle <= b) {
        return -1 + (1 + eta_b) * (angle - a) / (b - a);
    }
    return angle >= c ? 0 : eta_b - eta_b * std::sin(half_turn / 2 * (angle - b) / (c - b));
}

namespace {

/// The rectangle turns to the unwarped map's as the warp fades, so that the two meet.
double turn_of(const Plane2& plane, double eta) {
    return std::clamp((-0.2 - eta) / 0.8, 0.0, 1.0) * plane.turn;
}

Warp even_warp(const Plane2& plane, double eta) {
    return make_warp(plane, strength_of(eta, plane.near, plane.far, plane.length), turn_of(plane, eta));
}

}  // namespace

GnLightView even_view(const Plane2& plane, double eta) {
    const double full = (1 + falloff(plane.angle, plane.half_field)) * (1 + eta);
    if (full <= 0) {
        return plane.fitted;
    }

    // Take the full warp where it does no harm; else the strongest that does none, by bisection.
    const double limit = 1.001 * worst_error(plane, even_warp(plane, -1));
    const Warp best = even_warp(plane, full - 1);
    if (worst_error(plane, best) <= limit) {
        return view_of(plane, best);
    }
    double low = 0;
    double high = full;
    for (int step = 0; step < 20; ++step) {
        const double middle = 0.5 * (low + high);
        const Warp tried = even_warp(plane, middle - 1);
        (worst_error(plane, tried) <= limit ? low : high) = middle;
    }
    return low <= 1e-5 ? plane.fitted : view_of(plane, even_warp(plane, low - 1));
}

GnLightView sine_view(const Plane2& plane, double eta) {
    // n' = n / sin(gamma) [WSP04]; the parameter as for the even warp, with a body one metre of depth a metre of plane.
    const double sine = std::sin(plane.angle);
    const double depth = plane.metre * (plane.far - plane.near);
    const double strength = sine * strength_of(eta, plane.near, plane.far, depth);
    const double share = (1 + eta) * sine;
    return share <= 1e-5 ? plane.fitted : view_of(plane, make_warp(plane, strength, turn_of(plane, share - 1)));
}

}  // namespace gn::warp
