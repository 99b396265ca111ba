// SPDX-License-Identifier: MIT
// What polygons hide of the light together: by points of the light, or by the sum of areas.
#ifndef GN_SHADOW_BACKPROJECTION_COVER_GLSL
#define GN_SHADOW_BACKPROJECTION_COVER_GLSL

#include "shadow/lookup/backprojection/area.glsl"
#include "shadow/lookup/backprojection/backprojection.h"
#include "shadow/lookup/backprojection/bitmask.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// What is hidden of the light.
struct GnBackCover {
    GnBackMask mask;
    float area;
};

GN_FN GnBackCover gn_back_nothing() {
    GnBackCover cover;
    cover.mask = gn_back_no_mask();
    cover.area = 0.0f;
    return cover;
}

GN_FN GnBackCover gn_back_everything() {
    GnBackCover cover;
    cover.mask.low = uvec4(0xFFFFFFFFu);
    cover.mask.high = uvec4(0xFFFFFFFFu);
    cover.area = 1.0f;
    return cover;
}

// A polygon of four corners; of three where two are the same.
GN_FN GnBackCover gn_back_hide(GnBackCover cover, vec2 a, vec2 b, vec2 c, vec2 d, bool bitmask, bool disc) {
    vec2 low = min(min(a, b), min(c, d));
    vec2 high = max(max(a, b), max(c, d));
    if (low.x >= 1.0f || low.y >= 1.0f || high.x <= -1.0f || high.y <= -1.0f) {
        return cover;
    }
    if (!bitmask) {
        float area = gn_back_edge(a, b, disc) + gn_back_edge(b, c, disc) + gn_back_edge(c, d, disc) + gn_back_edge(d, a, disc);
        cover.area += abs(area);
        return cover;
    }
    a = gn_back_level(a);
    b = gn_back_level(b);
    c = gn_back_level(c);
    d = gn_back_level(d);
    cover.mask = gn_back_toggled(cover.mask, vec4(a.x, b.x, c.x, d.x), vec4(a.y, b.y, c.y, d.y),
                                 vec4(b.x, c.x, d.x, a.x), vec4(b.y, c.y, d.y, a.y), true);
    return cover;
}

// Two edges of an outline, a to b and c to d: of a closed one what lies within is toggled, its area has a sign.
GN_FN GnBackCover gn_back_outline(GnBackCover cover, vec2 a, vec2 b, vec2 c, vec2 d, bool bitmask, bool disc) {
    if (!bitmask) {
        cover.area += gn_back_edge(a, b, disc) + gn_back_edge(c, d, disc);
        return cover;
    }
    a = gn_back_level(a);
    b = gn_back_level(b);
    c = gn_back_level(c);
    d = gn_back_level(d);
    cover.mask = gn_back_toggled(cover.mask, vec4(a.x, c.x, a.x, c.x), vec4(a.y, c.y, a.y, c.y), vec4(b.x, d.x, a.x, c.x),
                                 vec4(b.y, d.y, a.y, c.y), false);
    return cover;
}

// What both hide.
GN_FN GnBackCover gn_back_united(GnBackCover one, GnBackCover other) {
    one.mask.low = one.mask.low | other.mask.low;
    one.mask.high = one.mask.high | other.mask.high;
    one.area += abs(other.area);
    return one;
}

// The share of the light that is hidden. Areas that overlap add up to more than there is.
GN_FN float gn_back_hidden(GnBackCover cover, bool bitmask, bool disc) {
    return bitmask ? gn_back_share(cover.mask, disc) : clamp(abs(cover.area), 0.0f, 1.0f);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
