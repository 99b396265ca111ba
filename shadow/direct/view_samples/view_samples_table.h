// SPDX-License-Identifier: MIT
// Left-sample maps: for every line across a light, which of its points lie left of it.
//
// Based on: Eisemann, Decoret. Visibility Sampling on GPU and Applications. Eurographics 2007. [ED07]
#pragma once

#include "shadow/direct/view_samples/view_samples.glsl"
#include "shadow/scene/light_samples.h"

#include <cstdint>
#include <vector>

namespace gn {

/// The light's middle and axes; a light without extent has axes of no length.
glsl::GnSampledLight sampled_light(const GnLight& light);

/// The axes of its boxes of samples: its own, of a sphere the world's.
glsl::GnLightAxes light_axes(const GnLight& light);
/// The same light in coordinates along the axes.
glsl::GnSampledLight ls_from_ws(const glsl::GnLightAxes& axes, glsl::GnSampledLight light);

/// The points that light_samples gives, in order: w = 1 places, w = 0 directions towards a sun; ws, metres.
std::vector<vec4> points_ws(const LightSamples& samples);

/// Coordinates of `count` points along the axes of a light, each at most one half: the same for all lights of the kind, but for
/// suns, whose points depend on their size a little.
std::vector<vec3> point_coordinates(const GnLight& light, int count);

/// What a map is made for.
struct LeftMapShape {
    glsl::GnSampledLight light;
    int angles = 128, offsets = 64;
    int words = 1;   ///< of 32 points, that a pattern takes
    int count = 32;  ///< points of a pattern
    bool bracket =
        false;  ///< two words a texel: left of all its lines, and left of any; else one: left of its middle line
};
std::size_t left_map_texels(const LeftMapShape& shape);
/// Pattern by pattern, word by word, the texels' words; bit i of word w is point 32 w + i.
std::vector<std::uint32_t> left_sample_map(const LeftMapShape& shape, const std::vector<vec3>& coordinates);

}  // namespace gn
