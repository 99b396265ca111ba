// SPDX-License-Identifier: MIT
#include "shadow/recipe/guard.h"

#include "shadow/scene/main_mass.h"

#include <algorithm>

namespace gn {

Box main_bounds(const FrameInput& input) {
    const Scene& scene = input.scene;
    if (scene.triangles.empty()) {
        return scene.bounds_ws;  // lent: what the host says
    }
    return *input.derive("bounds without strays", 0, [&] { return bounds_without_strays(scene); });
}

Guard guard_of(const FrameInput& input, const Recipe& recipe) {
    return guard_of(recipe, input.light(), main_bounds(input));
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
