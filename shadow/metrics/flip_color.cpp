// SPDX-License-Identifier: MIT
// Based on: Pontus Andersson, Jim Nilsson, Tomas Akenine-Moller, Magnus Oskarsson, Kalle Astrom, Mark D. Fairchild.
// FLIP: A Difference Evaluator for Alternating Images. PACM CGIT (HPG) 2020. [ANA+20]
#include "shadow/metrics/flip_color.h"

namespace gn::flip_color {
namespace {

/// The XYZ, with Y = 1, of a chromaticity.
dvec3 xyz_from_xy(double x, double y) {
    return {x / y, 1.0, (1.0 - x - y) / y};
}

/// Columns are the primaries of sRGB, scaled so that their sum is the white; rows divided by that white. The white is D65
/// to five digits as the authors of [ANA+20] have it, where sRGB rounds to four.
glm::dmat3 white_relative_matrix() {
    const dvec3 white = xyz_from_xy(0.31271, 0.32902);
    const glm::dmat3 primaries(xyz_from_xy(0.64, 0.33), xyz_from_xy(0.30, 0.60), xyz_from_xy(0.15, 0.06));
    const dvec3 scale = glm::inverse(primaries) * white;
    glm::dmat3 matrix(primaries[0] * scale.x / white, primaries[1] * scale.y / white, primaries[2] * scale.z / white);
    return matrix;
}

/// The cube root with its linear toe.
float lab_curve(float t) {
    constexpr float delta = 6.0F / 29.0F;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3.0F * delta * delta) + 4.0F / 29.0F;
}

}  // namespace

vec3 xyz_from_linear(vec3 rgb) {
    static const glm::mat3 matrix(white_relative_matrix());
    return matrix * rgb;
}

vec3 linear_from_xyz(vec3 xyz) {
    static const glm::mat3 matrix(glm::inverse(white_relative_matrix()));
    return matrix * xyz;
}

vec3 lab_from_xyz(vec3 xyz) {
    const vec3 f(lab_curve(xyz.x), lab_curve(xyz.y), lab_curve(xyz.z));
    return {116.0F * f.y - 16.0F, 500.0F * (f.x - f.y), 200.0F * (f.y - f.z)};
}

float largest_difference() {
    const vec3 green = hunt_adjusted(lab_from_xyz(xyz_from_linear({0, 1, 0})));
    const vec3 blue = hunt_adjusted(lab_from_xyz(xyz_from_linear({0, 0, 1})));
    return std::pow(hyab(green, blue), 0.7F);
}

}  // namespace gn::flip_color
