// SPDX-License-Identifier: MIT
// A perspective of the light's plane whose rows follow the logarithm of its w.
//
// Based on: Lloyd. Logarithmic Perspective Shadow Maps. University of North Carolina at Chapel Hill 2007. [Llo07]
// Departs from it: the perspective's strength fades by the function that it gives for light space perspective maps, and no
// further than to the unwarped map's coarsest texel.
#include "shadow/placement/warp.h"

#include <algorithm>

namespace gn::warp {
namespace {

/// Columns are those of a perspective, rows run from ln(first) to ln(last) of w = 1 + strength (y - start).
struct Rows {
    Warp warp;                 ///< its x_centre and strength
    double low = 0, high = 0;  ///< of x / w
    double first = 1, last = 1;
    [[nodiscard]] double rate() const { return std::log(last / first); }
};

Rows make_rows(const Plane2& plane, double strength) {
    const std::vector<dvec2> points = outline(plane);
    Rows rows{.warp = centred_warp(plane, points, strength), .low = 1e300, .high = -1e300, .first = 1e300, .last = 0};
    for (const dvec2 q : points) {
        const double w = 1 + rows.warp.strength * (q.y - plane.start);
        const double x = (q.x - rows.warp.x_centre) / w;
        rows.low = std::min(rows.low, x);
        rows.high = std::max(rows.high, x);
        rows.first = std::min(rows.first, w);
        rows.last = std::max(rows.last, w);
    }
    // Room for the kernels' texels: rows of equal ratios, and columns.
    const double share = plane.share / (1 - 2 * plane.share);
    const double ratio = std::pow(rows.last / rows.first, share);
    rows.first /= ratio;
    rows.last *= ratio;
    const double margin =
        share * std::max(rows.high - rows.low, 1e-9 * std::max(std::abs(rows.low), std::abs(rows.high)));
    rows.low -= margin;
    rows.high += margin;
    return rows;
}

/// As worst_error: of x' = 2 x / (w (high - low)) and y' = 2 ln(w) / rate.
double worst_of(const Plane2& plane, const Rows& rows) {
    double worst = 0;
    for (const Spot& spot : plane.far_spots) {
        const double w = 1 + rows.warp.strength * (spot.q.y - plane.start);
        const double x = (spot.q.x - rows.warp.x_centre) / w;
        const double across = 2 / (rows.high - rows.low) * glm::length(dvec2(1, x * rows.warp.strength)) / w;
        const double along = 2 * rows.warp.strength / (w * rows.rate());
        worst = std::max(worst, spot.distance / (std::min(across, along) * spot.depth));
    }
    return worst;
}

GnLightView view_of(const Plane2& plane, const Rows& rows) {
    const dvec4 w = rows.warp.strength * plane.y_row + (1 - rows.warp.strength * plane.start) * plane.w_row;
    const dvec4 x = plane.x_row - rows.warp.x_centre * plane.w_row;
    const double size = rows.high - rows.low;
    // y / w is first / w: 1 on the first row and exp(-rate) on the last.
    const dmat4 rows_of_cs(2 / size * x - (rows.high + rows.low) / size * w, rows.first * plane.w_row,
                           dvec4(plane.fitted.depth_from_ws), w);
    GnLightView view = plane.fitted;
    view.cs_from_ws = mat4(glm::transpose(rows_of_cs));
    view.ws_from_cs = mat4(glm::inverse(glm::transpose(rows_of_cs)));
    view.paraboloid = -static_cast<float>(rows.rate());
    return view;
}

}  // namespace

GnLightView logarithmic_view(const Plane2& plane, double eta) {
    const auto rows_of = [&](double share) {
        return make_rows(plane, strength_of(share - 1, plane.near, plane.far, plane.length));
    };
    // A float tells rows apart whose ratios differ by its last place: a weaker warp is none.
    constexpr double least_rate = 0.01;
    const double full = (1 + falloff(plane.angle, plane.half_field)) * (1 + eta);
    if (full <= 0 || rows_of(full).rate() < least_rate) {
        return plane.fitted;
    }
    const double limit = 1.001 * worst_error(plane, make_warp(plane, 0, plane.turn));
    if (worst_of(plane, rows_of(full)) <= limit) {
        return view_of(plane, rows_of(full));
    }
    double low = 0;
    double high = full;
    for (int step = 0; step < 20; ++step) {
        const double middle = 0.5 * (low + high);
        const Rows tried = rows_of(middle);
        (tried.rate() >= least_rate && worst_of(plane, tried) <= limit ? low : high) = middle;
    }
    return low <= 1e-5 ? plane.fitted : view_of(plane, rows_of(low));
}

}  // namespace gn::warp
