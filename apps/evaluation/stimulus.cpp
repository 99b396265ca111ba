// SPDX-License-Identifier: MIT
#include "apps/evaluation/stimulus.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>

namespace gn {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Integral of sqrt(1 - x^2).
double half_disc(double x) {
    x = std::clamp(x, -1.0, 1.0);
    return 0.5 * (x * std::sqrt(1 - x * x) + std::asin(x));
}

/// Area of the unit disc within x0 <= x <= x1 and above e.
double strip_above(double x0, double x1, double e) {
    if (e < 0) {
        return 2 * (half_disc(x1) - half_disc(x0)) - strip_above(x0, x1, -e);
    }
    const double reach = e < 1 ? std::sqrt(1 - e * e) : 0;
    const double from = std::clamp(x0, -reach, reach), to = std::clamp(x1, -reach, reach);
    return half_disc(to) - half_disc(from) - e * (to - from);
}

/// Share of the unit disc above a straight edge at a distance.
double share_above(double e) {
    return strip_above(-1, 1, e) / pi;
}

/// Where the shadow's edge is at x: what lies above (y greater) is lit.
double edge_at(const Stimulus& s, double x, double half_width) {
    if (s.pattern == Pattern::stair) {
        // Texel centres decide: the edge y = x becomes steps whose middles lie on it.
        return s.line ? x : s.artifact * std::floor(x / s.artifact) + 0.5 * s.artifact;
    }
    // One step of one texel in the middle; its edge rises by a texel over the picture.
    return s.line ? 0.5 * s.artifact * x / half_width : (x < 0 ? -0.5 : 0.5) * s.artifact;
}

/// The slope of the edge itself.
double slope_of(const Stimulus& s, double half_width) {
    return s.pattern == Pattern::stair ? 1 : 0.5 * s.artifact / half_width;
}

double light_with(const Stimulus& s, double x, double y, double half_width) {
    if (s.radius <= 0) {
        return y > edge_at(s, x, half_width) ? 1 : 0;
    }
    if (s.line) {
        const double slope = slope_of(s, half_width);
        return share_above((slope * x - y) / (s.radius * std::sqrt(1 + slope * slope)));
    }
    // The edge is level between two texels' borders.
    const auto above = [&](double from, double to) {
        const double edge = edge_at(s, 0.5 * (from + to), half_width);
        return strip_above((from - x) / s.radius, (to - x) / s.radius, (edge - y) / s.radius);
    };
    const double left = x - s.radius, right = x + s.radius;
    if (s.pattern == Pattern::step) {
        const double middle = std::clamp(0.0, left, right);
        return ((middle > left ? above(left, middle) : 0) + (right > middle ? above(middle, right) : 0)) / pi;
    }
    double area = 0;
    for (double from = left; from < right;) {
        const double to = std::min(right, s.artifact * (std::floor(from / s.artifact + 1e-9) + 1));
        area += above(from, to);
        from = to;
    }
    return area / pi;
}

/// Quarter turns, and a mirror, of a place.
void turned(int turn, double& x, double& y) {
    if (turn >= 4) {
        x = -x;
    }
    for (int i = 0; i < turn % 4; ++i) {
        const double before = x;
        x = -y;
        y = before;
    }
}

constexpr double default_half_width = 300;

double quantized(const Stimulus& s, double lit) {
    const double light = 1 - s.contrast * (1 - lit);
    return std::round(255 * std::pow(light, 1 / s.gamma)) / 255;
}

/// An edge through the pixels' centres would have values halfway between two of eight bits, which nothing but equality hides.
constexpr double off_centre = 0.1371;

bool same_pictures(Stimulus s, int size) {
    const double half = 0.5 * size;
    // Beyond the disc and a texel both are plain.
    const double reach = s.radius + 2 * s.artifact;
    for (int column = 0; column < size; ++column) {
        const double x = column + 0.5 - half;
        s.line = true;
        const double edge = edge_at(s, x, half);
        for (double y = std::floor(edge - reach) + 0.5; y <= edge + reach; y += 1) {
            if (std::abs(y) > half) {
                continue;
            }
            s.line = true;
            const double line = quantized(s, light_with(s, x, y + off_centre, half));
            s.line = false;
            if (quantized(s, light_with(s, x, y + off_centre, half)) != line) {
                return false;
            }
        }
        // Stairs repeat: one of them is all.
        if (s.pattern == Pattern::stair && column > 2 * s.artifact) {
            break;
        }
    }
    return true;
}

}  // namespace

std::string_view name_of(Pattern pattern) {
    return pattern == Pattern::step ? "step" : "stair";
}

double light_at(const Stimulus& stimulus, double x, double y) {
    return light_with(stimulus, x, y, default_half_width);
}

Image draw(const Stimulus& stimulus, int size) {
    GN_CHECK(size > 0);
    Image picture(size, size, 1);
    const double half = 0.5 * size;
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            double x = column + 0.5 - half, y = row + 0.5 - half;
            turned(stimulus.turn, x, y);
            // Far from the edge there is nothing to integrate.
            const double edge = edge_at(stimulus, x, half);
            const double reach = 2 * stimulus.radius + 2 * stimulus.artifact;
            const double lit = std::abs(y - edge) > reach ? (y > edge ? 1.0 : 0.0) : light_with(stimulus, x, y, half);
            picture.at(column, row) = static_cast<float>(quantized(stimulus, lit));
        }
    }
    return picture;
}

std::optional<double> reference_radius(Pattern pattern, double artifact, double contrast, int size, double most) {
    Stimulus s;
    s.pattern = pattern;
    s.artifact = artifact;
    s.contrast = contrast;
    s.gamma = 1;  // intensities as numbers, as the thesis has them: a screen's curve would tell apart even faint darks
    // Upwards in tenths: agreement at one radius says nothing of the next.
    for (double radius = artifact; radius <= most; radius += 0.1) {
        s.radius = radius;
        if (same_pictures(s, size)) {
            return radius;
        }
    }
    return std::nullopt;
}

}  // namespace gn
