// SPDX-License-Identifier: MIT
// Views whose rectangles the GPU chooses: one draw of a whole layer takes each view as an instance, moves it into its
// rectangle and cuts off what reaches beyond.
// Compiles as GLSL and as C++.
#ifndef GN_SHADOW_CASTERS_TILES_GLSL
#define GN_SHADOW_CASTERS_TILES_GLSL

#include "base/shared.h"
#include "shadow/light_view.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Whether a view has texels in a layer.
GN_FN bool gn_tile_in(GnLightView view, int layer) {
    return view.layer == layer && view.rect_ts.z > 0.0f && view.rect_ts.w > 0.0f;
}

// The layer's clip position of a view's clip position.
GN_FN vec4 gn_tile_clip(GnLightView view, vec4 p_cs) {
    vec2 extent = vec2(view.rect_ts.z, view.rect_ts.w);
    vec2 middle = 2.0f * vec2(view.rect_ts.x, view.rect_ts.y) + extent - 1.0f;
    return vec4(p_cs.x * extent.x + middle.x * p_cs.w, p_cs.y * extent.y + middle.y * p_cs.w, p_cs.z, p_cs.w);
}

// Distances from the four sides of the view, for gl_ClipDistance; the whole view is cut off where it is not of this layer.
GN_FN vec4 gn_tile_sides(GnLightView view, vec4 p_cs, int layer) {
    return gn_tile_in(view, layer) ? vec4(p_cs.w + p_cs.x, p_cs.w - p_cs.x, p_cs.w + p_cs.y, p_cs.w - p_cs.y)
                                   : vec4(-1.0f, -1.0f, -1.0f, -1.0f);
}

// First texel of the view's rectangle, and the last one.
GN_FN ivec4 gn_tile_texels(GnLightView view) {
    vec2 first = vec2(view.rect_ts.x, view.rect_ts.y) * view.resolution + 0.5f;
    vec2 end = vec2(view.rect_ts.x + view.rect_ts.z, view.rect_ts.y + view.rect_ts.w) * view.resolution + 0.5f;
    return ivec4(int(first.x), int(first.y), int(end.x) - 1, int(end.y) - 1);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
