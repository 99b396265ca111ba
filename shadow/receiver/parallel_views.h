// SPDX-License-Identifier: MIT
#pragma once

#include "shadow/receiver/parallel_views.glsl"
#include "shadow/stages.h"

#include <optional>
#include <vector>

namespace gn {

/// Up to so many views are all read by software, and one of them is taken.
constexpr std::size_t most_taken = 4;

struct ParallelViews {
    GnViewAxes axes;
    std::vector<GnViewPlace> places;  ///< one a view
};

/// What two to `most_taken` affine views share that look one way along the same axes; nothing of others, and of views that the GPU
/// makes.
std::optional<ParallelViews> parallel_views(const LightViews& views);

}  // namespace gn
