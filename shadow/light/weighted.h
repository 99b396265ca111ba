// SPDX-License-Identifier: MIT
// A light that is served as several: the stages behind run for each, and V is the weighted mean.
#pragma once

#include "shadow/recipe/recipe.h"

#include <functional>
#include <string>

namespace gn {

/// V of the input's light by the recipe's light part: sum of w_i(p) V_i(p) over sum of w_i(p), 1 where no light weighs
/// anything, 0 where the sample does not count for the whole light. A light behind a sample's surface shows it nothing.
/// `serve` adds the stages behind for one light. All lights share one set of resources, so that bytes do not grow with
/// their number; histories keep nothing of them.
Visibility add_weighted(const FrameInput& input, const Recipe& recipe,
                        const std::function<Visibility(const FrameInput&)>& serve);

/// The same of these lights. `watch`, where there is one, may add passes that look at the V of each, by its index.
using WatchLight = std::function<void(const FrameInput& one, int index, const Visibility& visibility)>;
Visibility add_weighted(const FrameInput& input, const Recipe& recipe, std::vector<Light> given,
                        const std::function<Visibility(const FrameInput&)>& serve, const WatchLight& watch = {});

/// The sentence why the recipe's light cannot look from the points of a spot, whose cone its placement sees from the centre, or "".
std::string refuses_one_centre(const Light& light, const Recipe& recipe);

}  // namespace gn
