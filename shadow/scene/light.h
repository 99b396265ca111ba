// SPDX-License-Identifier: MIT
// A light as C++ and GLSL see it, and which view samples count for it.
//
// Units: directional intensity in lux, spot and point in candela, rectangle in candela per square metre. Sizes in
// metres, angles in radians. A rectangle emits towards +direction_ws only. An environment shines from everywhere, in lux on a
// surface that all of it reaches; its colours stand in GnSky.
#ifndef GN_SHADOW_SCENE_LIGHT_H
#define GN_SHADOW_SCENE_LIGHT_H

#include "base/shared.h"

#define GN_LIGHT_DIRECTIONAL 0
#define GN_LIGHT_SPOT 1
#define GN_LIGHT_POINT 2
#define GN_LIGHT_RECTANGLE 3
#define GN_LIGHT_ENVIRONMENT 4

struct GnLight {
    vec4 position_ws GN_DEFAULT(vec4(0));             ///< xyz; the centre of the emitting shape (unused if directional)
    vec4 direction_ws GN_DEFAULT(vec4(0, -1, 0, 0));  ///< xyz unit: the way light travels along the axis
    vec4 right_ws GN_DEFAULT(vec4(1, 0, 0, 0));       ///< xyz unit: rectangle's first axis
    vec4 up_ws GN_DEFAULT(vec4(0, 0, 1, 0));          ///< xyz unit: rectangle's second axis
    vec4 color GN_DEFAULT(vec4(1));                   ///< rgb linear, multiplied by intensity
    vec2 half_size GN_DEFAULT(vec2(0));               ///< rectangle: half extents along right, up, metres
    uint kind GN_DEFAULT(0u);                         ///< GN_LIGHT_*
    float intensity GN_DEFAULT(1.0f);                 ///< lux, cd or cd/m^2 by kind
    float radius GN_DEFAULT(0.0f);                    ///< spot: of its disc, point: of its sphere, metres
    float angular_radius GN_DEFAULT(0.0f);            ///< directional: of the cone it subtends, radians
    float cos_inner GN_DEFAULT(1.0f);                 ///< spot: full intensity inside
    float cos_outer GN_DEFAULT(0.0f);                 ///< spot: none outside
    float range GN_DEFAULT(0.0f);                     ///< metres; 0 means unlimited
    float texture GN_DEFAULT(0.0f);                   ///< rectangle: of Scene::textures what it shows, plus 1; 0: none
    float unused0 GN_DEFAULT(0.0f);
    float unused1 GN_DEFAULT(0.0f);
};

/// What an environment looks like, relative to its intensity: the light that surfaces get, and the sky that is seen.
struct GnSky {
    vec4 above GN_DEFAULT(vec4(0.85f, 0.95f, 1.1f, 0));  ///< rgb on a surface that faces up: a pale sky
    vec4 below GN_DEFAULT(vec4(0.5f, 0.48f, 0.45f,
                               0));  ///< rgb on a surface that faces down: half of it, from the ground
    vec4 zenith GN_DEFAULT(vec4(0.55f, 0.75f, 1.1f, 0));   ///< rgb at the top of the picture, where no surface is seen
    vec4 horizon GN_DEFAULT(vec4(1.0f, 0.98f, 0.94f, 0));  ///< rgb at the bottom
    float seen GN_DEFAULT(1.5f);  ///< how much brighter the sky itself is than the light from it
};

#ifdef __cplusplus
using glm::dot;
using glm::normalize;
#endif

/// From p towards the light's centre; unit.
GN_FN vec3 gn_to_light(GnLight light, vec3 p_ws) {
    return light.kind == uint(GN_LIGHT_DIRECTIONAL) ? -vec3(light.direction_ws)
                                                    : normalize(vec3(light.position_ws) - p_ws);
}

/// Least cosine of incidence of a sample that counts. Below it, within 0.056 degrees of edge-on, the light adds less than a
/// thousandth of what it adds to a surface that faces it, and rounding decides whether it adds any: the cosine of 90
/// degrees in floats is 4e-8, a normal from rounded vertices errs by more. A power of two, so that every side of the
/// comparison rounds alike.
const float gn_least_cosine = 0.0009765625f;

/// Whether a view sample counts for the light: faces it, lies in its range and its cone (or before the rectangle).
GN_FN bool gn_counted(GnLight light, vec3 p_ws, vec3 n_ws) {
    vec3 to_light = gn_to_light(light, p_ws);
    if (!(dot(n_ws, to_light) >= gn_least_cosine)) {
        return false;
    }
    if (light.kind == uint(GN_LIGHT_DIRECTIONAL)) {
        return true;
    }
    vec3 offset = vec3(light.position_ws) - p_ws;
    if (light.range > 0.0f && dot(offset, offset) > light.range * light.range) {
        return false;
    }
    float cosine = dot(-to_light, vec3(light.direction_ws));
    if (light.kind == uint(GN_LIGHT_SPOT)) {
        return cosine > light.cos_outer;
    }
    return light.kind == uint(GN_LIGHT_POINT) || cosine > 0.0f;
}

#endif
