// SPDX-License-Identifier: MIT
// Reading a mipmapped map over a footprint, from the receiver's own view alone, though several views share the layer.
// Compiles as GLSL and as C++ (the tests check its law on the CPU).
#ifndef GN_SHADOW_RECEIVER_MAP_MEAN_GLSL
#define GN_SHADOW_RECEIVER_MAP_MEAN_GLSL

#include "shadow/receiver/receiver.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Where the sampler is asked, and over what.
struct GnMapFootprint {
    vec2 uv_ts;
    vec2 ddx_ts;
    vec2 ddy_ts;
};

// A texel of mip l stands for 2^l x 2^l texels, which are the view's own where its rectangle begins and ends at multiples of
// 2^l. So the footprint shrinks until such a mip serves it, and moves inwards until the texels around it are the view's.
// An anisotropic sampler spreads its fetches along the footprint, which then ends at the rectangle's border too.
GN_FN GnMapFootprint gn_within_rect(GnProjected projected, vec2 ddx_ts, vec2 ddy_ts) {
    GnMapFootprint footprint = GnMapFootprint(projected.uv_ts, ddx_ts, ddy_ts);
    vec4 bounds = projected.bounds_ts;
    if (bounds == vec4(0.0f, 0.0f, 1.0f, 1.0f)) {
        return footprint;
    }
    // The largest power of two that divides all four sides, in texels.
    ivec4 sides = ivec4(floor(bounds / projected.texel_ts + 0.5f));
    int bits = sides.x | sides.y | sides.z | sides.w;
    float most = float(bits & -bits);
    // Just below it, so that the coarser of the two mips that are mixed is no coarser than that.
    float longest = max(length(ddx_ts), length(ddy_ts)) / projected.texel_ts;
    float shrink = min(1.0f, 0.98f * most / max(longest, 1.0e-6f));
    footprint.ddx_ts = ddx_ts * shrink;
    footprint.ddy_ts = ddy_ts * shrink;
    // Half a texel of the coarser mip; a driver's logarithm may err.
    float mip = ceil(log2(max(longest * shrink, 1.0f)) + 0.01f * min(max(longest * shrink - 1.0f, 0.0f), 1.0f));
    float room = 0.5f * exp2(mip) * projected.texel_ts;
    footprint.uv_ts = clamp(projected.uv_ts, vec2(bounds.x, bounds.y) + room, vec2(bounds.z, bounds.w) - room);
    return footprint;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// The map's mean over the footprint around the receiver. `layer`: of the texture, which may have several for a view.
vec4 gn_map_mean(sampler2DArray map, GnProjected projected, int layer, vec2 ddx_ts, vec2 ddy_ts) {
    GnMapFootprint at = gn_within_rect(projected, ddx_ts, ddy_ts);
    return textureGrad(map, vec3(at.uv_ts, layer), at.ddx_ts, at.ddy_ts);
}

#endif
#endif
