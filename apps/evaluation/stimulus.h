// SPDX-License-Identifier: MIT
// Based on: Kreuzer. Using Perception-Based Filtering to Hide Shadow Artifacts. TU Wien 2017. [Kre17]
// What the threshold study shows: the edge of a shadow on a white plane seen from straight above, filtered, pixel by pixel.
#pragma once

#include "base/image.h"

#include <optional>
#include <string_view>

namespace gn {

/// What texels make of an edge: one step of an edge that runs along the texels, or the stairs of one at 45 degrees.
enum class Pattern { step, stair };
std::string_view name_of(Pattern pattern);

struct Stimulus {
    Pattern pattern = Pattern::step;
    double artifact = 10;  ///< pixels along a texel's side
    double radius = 30;    ///< of the filter's disc, pixels
    double contrast = 1;   ///< 1: the shadow is black; 0.5: half the plane's light
    bool line = false;     ///< the edge itself, without texels
    int turn = 0;          ///< quarter turns, and from 4 on mirrored: nothing to be learnt from where a step was
    double gamma = 2.2;    ///< of the screen: a value v shines as v^gamma
};

/// Light that reaches a point, 0 to 1 of the unshadowed: the share of the filter's disc that lies in the light, in closed form.
/// x, y: pixels from the picture's centre, which the edge goes through.
double light_at(const Stimulus& stimulus, double x, double y);

/// The picture as the screen's values, in eight bits: size x size, one channel, in [0,1].
Image draw(const Stimulus& stimulus, int size);

/// [Kre17] section 4.4: the least radius at which the filtered artifact and the filtered line are the same in every eight-bit
/// pixel of a picture of that size; found to a tenth of a pixel, and absent beyond `most`.
std::optional<double> reference_radius(Pattern pattern, double artifact, double contrast, int size, double most);

}  // namespace gn
