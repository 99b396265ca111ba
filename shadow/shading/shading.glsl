// SPDX-License-Identifier: MIT
// Light reaching a sample, and what the surface sends on: Lambert diffuse and a GGX microfacet lobe.
// Based on: Walter, Marschner, Li, Torrance. Microfacet Models for Refraction through Rough Surfaces. EGSR 2007. [WMLT07]
#ifndef GN_SHADOW_SHADING_GLSL
#define GN_SHADOW_SHADING_GLSL

#include "shadow/scene/light.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

const float gn_pi = 3.14159265f;

// Illuminance (lux) on a surface that faces the unshadowed light, before the cosine of the surface.
GN_FN float gn_illuminance(GnLight light, vec3 p_ws) {
    if (light.kind == uint(GN_LIGHT_DIRECTIONAL)) {
        return light.intensity;
    }
    vec3 d_ws = vec3(light.position_ws) - p_ws;
    // A surface that touches the light is as far from it as the rounding of its place.
    float distance2 = max(dot(d_ws, d_ws), 1.0e-12f * dot(p_ws, p_ws) + 1.0e-30f);
    float cosine = dot(normalize(d_ws), -vec3(light.direction_ws));

    // The range fades the light out as the glTF extension recommends.
    float window = 1.0f;
    if (light.range > 0.0f) {
        float q = distance2 / (light.range * light.range);
        window = clamp(1.0f - q * q, 0.0f, 1.0f);
    }
    if (light.kind == uint(GN_LIGHT_RECTANGLE)) {
        float area = 4.0f * light.half_size.x * light.half_size.y;
        return window * light.intensity * area * max(cosine, 0.0f) / distance2;
    }
    float cone = 1.0f;
    if (light.kind == uint(GN_LIGHT_SPOT)) {
        cone = clamp((cosine - light.cos_outer) / max(light.cos_inner - light.cos_outer, 1.0e-4f), 0.0f, 1.0f);
        cone *= cone;
    }
    return window * cone * light.intensity / distance2;
}

// Radiance per illuminance, cosine included: diffuse + specular of a metal-roughness surface.
GN_FN vec3 gn_reflect(vec3 n_ws, vec3 to_eye_ws, vec3 to_light_ws, vec3 base_color, float roughness, float metallic) {
    float n_l = clamp(dot(n_ws, to_light_ws), 0.0f, 1.0f);
    float n_v = max(dot(n_ws, to_eye_ws), 1.0e-3f);
    vec3 half_ws = normalize(to_eye_ws + to_light_ws);
    float n_h = clamp(dot(n_ws, half_ws), 0.0f, 1.0f);
    float v_h = clamp(dot(to_eye_ws, half_ws), 0.0f, 1.0f);

    // [WMLT07] eq. 33: the distribution; eq. 34 and 23: Smith's shadowing, correlated form.
    float alpha = max(roughness * roughness, 0.01f);
    float a2 = alpha * alpha;
    float d = n_h * n_h * (a2 - 1.0f) + 1.0f;
    float distribution = a2 / (gn_pi * d * d);
    float g_l = n_v * sqrt(n_l * n_l * (1.0f - a2) + a2);
    float g_v = n_l * sqrt(n_v * n_v * (1.0f - a2) + a2);
    float geometry = 0.5f / max(g_l + g_v, 1.0e-5f);

    vec3 f0 = mix(vec3(0.04f), base_color, metallic);
    vec3 fresnel = f0 + (vec3(1.0f) - f0) * pow(1.0f - v_h, 5.0f);
    vec3 diffuse = base_color * ((1.0f - metallic) / gn_pi);
    return (diffuse * (vec3(1.0f) - fresnel) + fresnel * (distribution * geometry)) * n_l;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
