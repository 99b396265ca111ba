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

// Whether a box with this centre and these half sides may cast into the view: before its near plane everything does, behind its
// far plane nothing. The rectangle is extended by two texels, and by what rounding moves: a part of 2^17 of all that is added.
// A paraboloid's view sees all around.
GN_FN bool gn_tile_reached(GnLightView view, vec3 centre_ws, vec3 half_ws) {
    if (view.paraboloid > 0.0f) {
        return true;
    }
    float border = 1.0f + 4.0f / max(view.rect_ts.z * view.resolution, 1.0f);
    for (int side = 0; side < 5; ++side) {
        vec4 plane = vec4(0.0f, 0.0f, 0.0f, 1.0f) - view.depth_from_ws;
        if (side < 4) {
            float sign = (side & 1) == 0 ? 1.0f : -1.0f;
            int row = side / 2;
            plane = vec4(0.0f);
            for (int i = 0; i < 4; ++i) {
                plane[i] = border * view.cs_from_ws[i][3] + sign * view.cs_from_ws[i][row];
            }
        }
        vec3 normal = vec3(plane.x, plane.y, plane.z);
        vec3 size = abs(normal);
        float slack = 1.0f / 131072.0f * (dot(size, abs(centre_ws) + half_ws) + abs(plane.w));
        if (dot(normal, centre_ws) + plane.w + dot(size, half_ws) < -slack) {
            return false;
        }
    }
    return true;
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
