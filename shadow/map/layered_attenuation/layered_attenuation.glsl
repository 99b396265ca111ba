// SPDX-License-Identifier: MIT
// A layer of a texel, and the layers that a receiver is on. Compiles as GLSL and as C++.
//
// Based on: Agrawala, Ramamoorthi, Heirich, Moll. Efficient Image-Based Methods for Rendering Soft Shadows. SIGGRAPH 2000.
// [ARHM00]
#ifndef GN_SHADOW_MAP_LAYERED_ATTENUATION_GLSL
#define GN_SHADOW_MAP_LAYERED_ATTENUATION_GLSL

#include "shadow/casters/caster_depth.glsl"
#include "shadow/map/layered_attenuation/layered_attenuation.h"
#include "shadow/receiver/texel_box.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Unit normal, towards the eye, of the surface that a texel holds: its depth, and how that changes from texel to texel.
GN_FN vec3 gn_layer_normal(GnLightView view, vec2 uv_ts, float depth, vec2 slope) {
    float texel_ts = 1.0f / view.resolution;
    vec3 p_ws = gn_point_at(view, uv_ts, depth);
    vec3 x_ws = gn_point_at(view, uv_ts + vec2(texel_ts, 0.0f), depth + slope.x) - p_ws;
    vec3 y_ws = gn_point_at(view, uv_ts + vec2(0.0f, texel_ts), depth + slope.y) - p_ws;
    vec3 n_ws = normalize(cross(x_ws, y_ws));
    return dot(n_ws, gn_to_eye(view, p_ws)) < 0.0f ? -n_ws : n_ws;
}

// How far a layer lies from the receiver's plane, in texels at the receiver: 0 for the layer that the receiver is on.
GN_FN float gn_layer_distance(GnReceiver receiver, float texel_ws, vec3 layer_ws) {
    return abs(dot(layer_ws - receiver.p_ws, receiver.n_ws)) / texel_ws;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// V of the layer of one texel that lies nearest to the receiver's plane, and 1; or 0 and 0 where none is within epsilon.
vec2 gn_layer_visibility(GnLookup at, sampler2DArray layers, ivec2 texel, GnLayeredAttenuationParams params) {
    vec2 centre_ts = (vec2(texel) + 0.5) * at.projected.texel_ts;
    vec3 near_ws = gn_point_at(at.view, centre_ts, 0.0);
    vec3 far_ws = gn_point_at(at.view, centre_ts, 1.0);
    float least = params.epsilon;
    vec2 found = vec2(0.0);
    for (int i = 0; i < params.layers; ++i) {
        // Nearest first: behind the first empty one all are.
        vec2 layer = texelFetch(layers, ivec3(texel, at.projected.layer * params.layers + i), 0).rg;
        if (layer.x >= 1.0) {
            break;
        }
        float away = gn_layer_distance(at.receiver, at.projected.texel_ws, mix(near_ws, far_ws, layer.x));
        if (away <= least) {
            least = away;
            found = vec2(layer.y, 1.0);
        }
    }
    return found;
}

// Mean over the footprint's texels of the V of the receiver's layer there. Where none has it, on surfaces that cast nothing and
// behind the last layer, the nearest layer decides alone.
float gn_layered_attenuation_visibility(GnLookup at, sampler2DArray layers, vec2 ddx_ts, vec2 ddy_ts,
                                        GnLayeredAttenuationParams params) {
    GnTexelBox box = gn_texel_box(at.projected, gn_seen_at(at.view, at.receiver.p_ws), 0.5 * (abs(ddx_ts) + abs(ddy_ts)));
    vec2 sum = vec2(0.0);
    for (int y = box.first.y; y <= box.last.y; ++y) {
        for (int x = box.first.x; x <= box.last.x; ++x) {
            sum += gn_box_weight(box, ivec2(x, y)) * gn_layer_visibility(at, layers, ivec2(x, y), params);
        }
    }
    // Less than a thousandth of a texel is rounding.
    if (sum.y > 1.0e-3) {
        return sum.x / sum.y;
    }
    ivec2 texel = ivec2(floor(at.projected.uv_ts / at.projected.texel_ts));
    vec2 centre_ts = (vec2(texel) + 0.5) * at.projected.texel_ts;
    float nearest = texelFetch(layers, ivec3(texel, at.projected.layer * params.layers), 0).r;
    return gn_depth_at(at.projected, centre_ts, at.bias) <= nearest ? 1.0 : 0.0;
}

#endif
#endif
