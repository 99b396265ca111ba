// SPDX-License-Identifier: MIT
// A renderer's own depth and normals, whatever their form, as position and normal of each pixel.
layout(local_size_x = 8, local_size_y = 8) in;

float depth_of(ivec2 pixel) { return texelFetch(lent_depth, pixel, 0).r; }
bool is_seen(float depth) { return GN_REVERSED ? depth > 0.0 : depth < 1.0; }

// Metres along the camera's axis.
float distance_of(float depth) {
    return GN_PERSPECTIVE ? float(u.z_offset / (depth - u.z_scale)) : u.z_offset + u.z_scale * depth;
}

vec3 position_of(ivec2 pixel, float z) {
    vec2 at = vec2(pixel) + 0.5;
    vec3 across_ws = u.first_ws.xyz + at.x * u.right_ws.xyz + at.y * u.down_ws.xyz;
    return u.eye_ws.xyz + (GN_PERSPECTIVE ? z * (u.forward_ws.xyz + across_ws) : z * u.forward_ws.xyz + across_ws);
}

vec3 to_eye(vec3 p_ws) { return GN_PERSPECTIVE ? u.eye_ws.xyz - p_ws : -u.forward_ws.xyz; }

// The nearer of both neighbours on an axis lies on the same surface, if any does.
vec3 step_of(ivec2 pixel, ivec2 axis, vec3 p_ws, float z) {
    vec3 best = vec3(0.0);
    float least = 3.0e38;
    for (int side = -1; side <= 1; side += 2) {
        ivec2 neighbour = pixel + side * axis;
        if (any(lessThan(neighbour, ivec2(0))) || any(greaterThanEqual(neighbour, textureSize(lent_depth, 0)))) {
            continue;
        }
        float depth = depth_of(neighbour);
        float beside = distance_of(depth);
        if (is_seen(depth) && abs(beside - z) < least) {
            least = abs(beside - z);
            best = float(side) * (position_of(neighbour, beside) - p_ws);
        }
    }
    return best;
}

vec3 normal_of(ivec2 pixel, vec3 p_ws, float z) {
#if GN_NORMALS == 0
    vec3 n = cross(step_of(pixel, ivec2(0, 1), p_ws, z), step_of(pixel, ivec2(1, 0), p_ws, z));
    return dot(n, n) > 0.0 ? normalize(n) : normalize(to_eye(p_ws));
#else
    vec3 n = texelFetch(lent_normals, pixel, 0).xyz;
#if GN_NORMALS == 2 || GN_NORMALS == 4
    n = 2.0 * n - 1.0;
#endif
#if GN_NORMALS >= 3
    return gn_from_octahedral(n.xy);
#else
    return normalize(n);
#endif
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, textureSize(lent_depth, 0)))) {
        return;
    }
    float depth = depth_of(pixel);
    vec4 position = vec4(0.0);
    vec4 normal = vec4(0.0);
    if (is_seen(depth)) {
        float z = distance_of(depth);
        position = vec4(position_of(pixel, z), 1.0);
        vec3 n_ws = normal_of(pixel, position.xyz, z);
        normal = vec4(dot(n_ws, to_eye(position.xyz)) < 0.0 ? -n_ws : n_ws, z);
    }
    imageStore(position_ws, pixel, position);
    imageStore(normal_ws, pixel, normal);
}
