// SPDX-License-Identifier: MIT
// Based on: Bittner, Mattausch, Silvennoinen, Wimmer. Shadow Caster Culling for Efficient Shadow Mapping. I3D 2011. [BMSW11]
#include "shadow/placement/receiver_mask.h"

#include "shadow/geometry/convex_hull.h"
#include "shadow/geometry/visible_objects.h"

#include <algorithm>
#include <bit>

namespace gn {
namespace {

/// Texels by which the rasterizer's and the projection's rounding may move what is drawn.
constexpr double rounding_texels = 2;

/// Lowest and highest x of an outline between two heights; low > high where it does not reach there.
dvec2 span_between(const std::vector<dvec2>& outline, double low, double high) {
    dvec2 span(1e300, -1e300);
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const dvec2 a = outline[i];
        const dvec2 b = outline[(i + 1) % outline.size()];
        if (std::max(a.y, b.y) < low || std::min(a.y, b.y) > high) {
            continue;
        }
        for (const double y : {std::clamp(a.y, low, high), std::clamp(b.y, low, high)}) {
            const double x = a.y == b.y ? a.x : a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
            span = {std::min(span.x, x), std::max(span.y, x)};
        }
        if (a.y == b.y) {
            span = {std::min({span.x, a.x, b.x}), std::max({span.y, a.x, b.x})};
        }
    }
    return span;
}

/// Bits first to last.
std::uint64_t bits(int first, int last) {
    return (~std::uint64_t{0} >> (63 - (last - first))) << first;
}

}  // namespace

ReceiverMask::ReceiverMask(const GnLightView& view, const GnLight& light, const Guard& guard)
    : cs_from_ws_(view.cs_from_ws) {
    const dvec2 texels = dvec2(view.rect_ts.z, view.rect_ts.w) * static_cast<double>(view.resolution);
    kernel_ = (static_cast<double>(guard.texels) + rounding_texels) * static_cast<double>(cells) / texels;
    rounding_ = rounding_texels * static_cast<double>(cells) / texels;
    vec3 x, y;
    complete_frame(glm::normalize(vec3(light.direction_ws)), x, y);
    x_ws_ = static_cast<double>(guard.metres) * dvec3(x);
    y_ws_ = static_cast<double>(guard.metres) * dvec3(y);
}

std::array<ReceiverMask::Row, ReceiverMask::cells> ReceiverMask::rows_of(std::span<const dvec3> points_ws,
                                                                         dvec2 reach) const {
    std::array<Row, cells> rows{};
    std::vector<dvec2> points;
    points.reserve(points_ws.size());
    for (const dvec3& p_ws : points_ws) {
        points.push_back((dvec2(cs_from_ws_ * dvec4(p_ws, 1)) * 0.5 + 0.5) * static_cast<double>(cells));
    }

    // The outline, row by row, each as high as the reach is.
    const std::vector<dvec2> hull = convex_hull(points);
    const std::vector<dvec2>& outline = hull.empty() ? points : hull;
    for (int row = 0; row < cells; ++row) {
        const dvec2 span = span_between(outline, row - reach.y, row + 1 + reach.y);
        if (span.x <= span.y && span.y + reach.x >= 0 && span.x - reach.x < cells) {
            const auto cell = [](double x) { return static_cast<int>(std::clamp(std::floor(x), 0.0, cells - 1.0)); };
            rows[static_cast<std::size_t>(row)] = {cell(span.x - reach.x), cell(span.y + reach.x)};
        }
    }
    return rows;
}

void ReceiverMask::add(std::span<const dvec3> corners_ws) {
    // A kernel in metres is a square across the rays around every receiver.
    std::vector<dvec3> points(corners_ws.begin(), corners_ws.end());
    if (x_ws_ != dvec3(0)) {
        for (const dvec3& p : corners_ws) {
            for (const dvec3 aside : {x_ws_ + y_ws_, x_ws_ - y_ws_}) {
                points.push_back(p + aside);
                points.push_back(p - aside);
            }
        }
    }
    const std::array<Row, cells> rows = rows_of(points, kernel_);
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (rows[row].first <= rows[row].last) {
            marked_[row] |= bits(rows[row].first, rows[row].last);
        }
    }
}

bool ReceiverMask::meets(const Box& box_ws) const {
    std::array<dvec3, 8> corners;
    const auto floats = box_ws.corners();
    std::transform(floats.begin(), floats.end(), corners.begin(), [](vec3 c) { return dvec3(c); });
    const std::array<Row, cells> rows = rows_of(corners, rounding_);
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (rows[row].first <= rows[row].last && (marked_[row] & bits(rows[row].first, rows[row].last)) != 0) {
            return true;
        }
    }
    return false;
}

double ReceiverMask::share() const {
    int count = 0;
    for (const std::uint64_t row : marked_) {
        count += std::popcount(row);
    }
    return static_cast<double>(count) / (cells * cells);
}

Guard with_bias(Guard guard, const GnBias& bias, const GnLightView& view) {
    const mat4 rows = glm::transpose(view.cs_from_ws);
    const vec2 per_metre(glm::length(vec3(rows[0])) * view.rect_ts.z, glm::length(vec3(rows[1])) * view.rect_ts.w);
    const float texel = 2 / (view.resolution * std::min(per_metre.x, per_metre.y));
    // As gn_biased moves them; what it moves along the rays stays where it is on the map.
    const float kernel = bias.receiver_plane == 0 ? 2 * std::abs(bias.kernel) : 0.0F;
    const float unit = texel + kernel * std::max(guard.texels * texel, guard.metres);
    guard.metres +=
        (std::abs(bias.normal) + std::abs(bias.view)) * unit + std::abs(bias.normal_world) + std::abs(bias.view_world);
    return guard;
}

std::vector<std::uint32_t> casters_on_receivers(const FrameInput& input, const GnLightView& view, const Guard& guard,
                                                double near, double far, const std::vector<std::uint32_t>& casters) {
    // Mark what the frustum holds of each object.
    const Camera& camera = input.samples.camera;
    const float aspect = static_cast<float>(input.samples.width) / static_cast<float>(input.samples.height);
    const std::vector<Plane> frustum = frustum_planes(camera, aspect, near, far);
    ReceiverMask mask(view, input.light().shape, guard);
    for (const Object& object : input.scene.objects) {
        if (object.triangle_count > 0) {
            const std::vector<dvec3> corners = corners_within(object.bounds_ws, frustum);
            if (!corners.empty()) {
                mask.add(corners);
            }
        }
    }

    // Keep what falls onto a mark.
    std::vector<std::uint32_t> kept;
    std::copy_if(casters.begin(), casters.end(), std::back_inserter(kept),
                 [&](std::uint32_t i) { return mask.meets(input.scene.objects[i].bounds_ws); });
    return kept;
}

}  // namespace gn
