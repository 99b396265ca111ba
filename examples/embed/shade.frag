// SPDX-License-Identifier: MIT
#version 460
// The host's own shading: each light times its V, the sky's light, haze, and a curve for the screen.
layout(binding = 0) uniform sampler2D depth;
layout(binding = 1) uniform sampler2D normals;
layout(binding = 2) uniform sampler2D albedo;
layout(binding = 3) uniform sampler2D sun_visibility;
layout(binding = 4) uniform sampler2D lamp_visibility;
layout(push_constant) uniform Push {
    mat4 ws_from_cs;
    vec4 eye_ws;
    vec4 towards_sun_ws;
    vec4 lamp_ws;  // w: range, metres
} push;
layout(location = 0) out vec4 picture;

const vec3 sun_light = vec3(2.7, 1.75, 0.95);
const vec3 lamp_light = vec3(26.0, 10.5, 2.7);
const vec3 zenith = vec3(0.10, 0.17, 0.36);
const vec3 horizon = vec3(0.46, 0.34, 0.28);

vec3 from_octahedral(vec2 e) {
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float fold = max(-n.z, 0.0);
    n.xy += vec2(n.x >= 0.0 ? -fold : fold, n.y >= 0.0 ? -fold : fold);
    return normalize(n);
}

vec3 sky(vec3 direction) {
    float glow = pow(max(dot(direction, push.towards_sun_ws.xyz), 0.0), 24.0);
    return mix(horizon, zenith, sqrt(clamp(direction.y, 0.0, 1.0))) + glow * vec3(0.9, 0.6, 0.3);
}

// Inverse squares, gone at the range.
float lamp_falloff(float distance) {
    float near = clamp(1.0 - pow(distance / push.lamp_ws.w, 4.0), 0.0, 1.0);
    return near * near / (distance * distance + 0.05);
}

vec3 shade(ivec2 pixel, vec3 p_ws, vec3 n_ws) {
    vec4 surface = texelFetch(albedo, pixel, 0);
    if (surface.a > 0.5) {
        return 6.0 * surface.rgb;
    }
    vec3 to_lamp = push.lamp_ws.xyz - p_ws;
    float distance = length(to_lamp);
    vec3 sun = sun_light * max(dot(n_ws, push.towards_sun_ws.xyz), 0.0) * texelFetch(sun_visibility, pixel, 0).r;
    vec3 lamp = lamp_light * max(dot(n_ws, to_lamp / distance), 0.0) * lamp_falloff(distance) *
                texelFetch(lamp_visibility, pixel, 0).r;
    vec3 ambient = mix(vec3(0.09, 0.075, 0.07), vec3(0.12, 0.17, 0.30), 0.5 + 0.5 * n_ws.y);
    return surface.rgb * (sun + lamp + ambient);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 at_cs = 2.0 * gl_FragCoord.xy / vec2(textureSize(depth, 0)) - 1.0;
    float d = texelFetch(depth, pixel, 0).r;

    // Depth 0 is infinitely far away; there is nothing but the sky.
    vec4 across = push.ws_from_cs * vec4(at_cs, 0.5, 1.0);
    vec3 direction = normalize(across.xyz / across.w - push.eye_ws.xyz);
    vec3 light = sky(direction);
    if (d > 0.0) {
        vec4 p = push.ws_from_cs * vec4(at_cs, d, 1.0);
        vec3 p_ws = p.xyz / p.w;
        float haze = 1.0 - exp(-pow(distance(p_ws, push.eye_ws.xyz) / 58.0, 3.0));
        light = mix(shade(pixel, p_ws, from_octahedral(texelFetch(normals, pixel, 0).xy)), horizon, haze);
    }
    light *= 0.54;  // exposure
    vec3 curved = light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14);
    picture = vec4(pow(clamp(curved, 0.0, 1.0), vec3(1.0 / 2.2)), 1.0);
}
