// SPDX-License-Identifier: MIT
#include "shadow/placement/place.h"

namespace gn {

LightViews place_views(const FrameInput& input, const Recipe& recipe) {
    const Part& placement = recipe.placement_for(input.light().shape);
    LightViews views = placement.place(input, recipe);
    views.part = &placement;
    return views;
}

}  // namespace gn
