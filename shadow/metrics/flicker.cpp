// SPDX-License-Identifier: MIT
#include "shadow/metrics/flicker.h"

#include "base/error.h"
#include "shadow/metrics/metrics.h"

#include <cmath>

namespace gn {

std::vector<int> same_points(const PathView& from, const PathView& to, float offset) {
    const dmat4 cs_from_ws(to.cs_from_ws);
    std::vector<int> same(from.position_ws.size(), -1);
    for (std::size_t i = 0; i < same.size(); ++i) {
        // Project the point; its pixel is the one whose centre is nearest.
        const vec4 point = from.position_ws[i];
        const dvec4 p_cs = cs_from_ws * dvec4(dvec3(vec3(point)), 1.0);
        if (point.w < 0.5F || !(p_cs.w > 0.0)) {
            continue;
        }
        const double x = (p_cs.x / p_cs.w * 0.5 + 0.5) * to.width, y = (p_cs.y / p_cs.w * 0.5 + 0.5) * to.height;
        if (!(x >= 0 && y >= 0 && x < to.width && y < to.height)) {
            continue;
        }
        const double column = std::floor(x), row = std::floor(y);

        // It must be near, and show the same surface.
        const auto pixel =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(to.width) + static_cast<std::size_t>(column);
        const vec4 seen = to.position_ws[pixel];
        const bool near = std::hypot(x - column - 0.5, y - row - 0.5) <= static_cast<double>(offset);
        const double width_ws = p_cs.w * static_cast<double>(to.pixel_size);
        const bool alike = glm::dot(vec3(to.normal_ws[pixel]), vec3(from.normal_ws[i])) > flicker_alike;
        if (near && alike && seen.w > 0.5F && glm::distance(dvec3(vec3(seen)), dvec3(vec3(point))) <= width_ws) {
            same[i] = static_cast<int>(pixel);
        }
    }
    return same;
}

SignedError signed_error(std::span<const float> technique, std::span<const float> reference,
                         std::span<const std::uint8_t> counted, int width, int height) {
    GN_CHECK_EQ(technique.size(), reference.size());
    const std::vector<std::uint8_t> edges = edge_pixels(reference, counted, width, height);
    SignedError error{std::vector<float>(reference.size(), 0.0F), {counted.begin(), counted.end()}};
    for (std::size_t i = 0; i < reference.size(); ++i) {
        if (counted[i] != 0) {
            const float wrong = reference[i] < 0.5F ? 1.0F : 0.0F;
            error.values[i] = (std::isfinite(technique[i]) ? technique[i] : wrong) - reference[i];
            error.counted[i] = edges[i] != 0 ? 0 : 1;
        }
    }
    return error;
}

Flicker& Flicker::operator+=(const Flicker& more) {
    samples += more.samples;
    squares += more.squares;
    fourths += more.fourths;
    return *this;
}

std::optional<double> Flicker::root_mean_square() const {
    return samples == 0 ? std::nullopt : std::optional(std::sqrt(squares / static_cast<double>(samples)));
}

double Flicker::told_by() const {
    return fourths > 0 ? squares * squares / fourths : 0;
}

Flicker flicker_between(const SignedError& from, const SignedError& to, std::span<const int> same) {
    GN_CHECK_EQ(from.values.size(), same.size());
    Flicker sum;
    for (std::size_t i = 0; i < same.size(); ++i) {
        if (same[i] < 0 || from.counted[i] == 0 || to.counted[static_cast<std::size_t>(same[i])] == 0) {
            continue;
        }
        const auto change =
            static_cast<double>(to.values[static_cast<std::size_t>(same[i])]) - static_cast<double>(from.values[i]);
        sum.squares += change * change;
        sum.fourths += change * change * change * change;
        ++sum.samples;
    }
    return sum;
}

}  // namespace gn
