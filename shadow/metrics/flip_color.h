// SPDX-License-Identifier: MIT
// Based on: Pontus Andersson, Jim Nilsson, Tomas Akenine-Moller, Magnus Oskarsson, Kalle Astrom, Mark D. Fairchild.
// FLIP: A Difference Evaluator for Alternating Images. PACM CGIT (HPG) 2020. [ANA+20]
//
// The colour spaces of FLIP: linear sRGB, CIE XYZ relative to the display's white, YCxCz and L*a*b*.
#pragma once

#include "base/math.h"

namespace gn::flip_color {

/// XYZ divided by the display's white point, component by component; white becomes (1, 1, 1).
vec3 xyz_from_linear(vec3 rgb);
vec3 linear_from_xyz(vec3 xyz);
/// The opponent space in which contrast sensitivity is known; linear in XYZ. [ANA+20, section 4.1.1]
inline vec3 ycxcz_from_xyz(vec3 xyz) {
    return {116.0F * xyz.y - 16.0F, 500.0F * (xyz.x - xyz.y), 200.0F * (xyz.y - xyz.z)};
}
inline vec3 xyz_from_ycxcz(vec3 c) {
    const float y = (c.x + 16.0F) / 116.0F;
    return {y + c.y / 500.0F, y, y - c.z / 200.0F};
}
/// CIE 1976 L*a*b*.
vec3 lab_from_xyz(vec3 xyz);
/// Scales chroma with lightness, as colourfulness grows with luminance (Hunt). [ANA+20, section 4.1.2]
inline vec3 hunt_adjusted(vec3 lab) {
    return {lab.x, 0.01F * lab.x * lab.y, 0.01F * lab.x * lab.z};
}
/// City-block distance in lightness plus Euclidean distance in chroma. [ANA+20, section 4.1.2]
inline float hyab(vec3 a, vec3 b) {
    const vec3 d = a - b;
    return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}
/// hyab of the pair of display colours that are furthest apart, pure green and pure blue, to the power of 0.7.
float largest_difference();

}  // namespace gn::flip_color
