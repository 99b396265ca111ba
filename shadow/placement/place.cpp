// SPDX-License-Identifier: MIT
#include "shadow/placement/place.h"

#include <algorithm>

namespace gn {

ViewKind kind_of(std::span<const GnLightView> views) {
    const auto bent = [](const GnLightView& view) { return view.paraboloid > 0; };
    const auto logarithmic = [](const GnLightView& view) { return view.paraboloid < 0; };
    const auto affine = [](const GnLightView& view) {
        const mat4& m = view.cs_from_ws;
        return vec4(m[0].w, m[1].w, m[2].w, m[3].w) == vec4(0, 0, 0, 1);
    };
    if (std::any_of(views.begin(), views.end(), bent)) {
        return ViewKind::paraboloid;
    }
    if (std::any_of(views.begin(), views.end(), logarithmic)) {
        return ViewKind::logarithmic;
    }
    return std::all_of(views.begin(), views.end(), affine) ? ViewKind::affine : ViewKind::perspective;
}

LightViews place_views(const FrameInput& input, const Recipe& recipe) {
    const Part& placement = recipe.placement_for(input.whole_light().shape);
    LightViews views = placement.place(input, recipe);
    views.part = &placement;
    GN_CHECK(views.buffer.valid() || views.kind == kind_of(views.views));
    GN_CHECK(views.buffer.valid() || !views.tiles);
    return views;
}

}  // namespace gn
