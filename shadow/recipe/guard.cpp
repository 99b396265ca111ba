// SPDX-License-Identifier: MIT
#include "shadow/recipe/guard.h"

#include <algorithm>

namespace gn {

Guard guard_of(const FrameInput& input, const Recipe& recipe) {
    return guard_of(recipe, input.light(), input.scene.bounds_ws);
}

Guard guard_of(const Recipe& recipe, const Light& light, const Box& bounds_ws) {
    Guard total;
    for (const Part* part : {recipe.map, recipe.lookup}) {
        if (part != nullptr && part->guard != nullptr) {
            const Guard guard = part->guard(recipe, light, bounds_ws);
            total.texels += guard.texels;
            total.metres += guard.metres;
            total.pixels += guard.pixels;
            total.before = std::max(total.before, guard.before);
        }
    }
    total.texels += 1;  // the receiver's own texel and the bias's shift
    return total;
}

}  // namespace gn
