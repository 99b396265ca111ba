// SPDX-License-Identifier: MIT
// Based on: Zhang. Forward Shadow Mapping. Eurographics Workshop on Rendering 1998. [Zha98]
// A texel of view `index` carried into the picture, where it lights the samples that lie in its splat.
layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform Push { int index; };

float depth_at(ivec2 texel) { return texelFetch(depth_map, ivec3(texel, views[index].layer), 0).r; }

vec3 position_at(ivec2 texel, float depth) {
    return gn_forward_position(views[index], (vec2(texel) + 0.5) / views[index].resolution, depth);
}

// How the surface runs from a texel to the next: on the side where depth changes less.
vec3 step_ws(ivec2 texel, ivec2 axis, ivec2 low, ivec2 high, float depth) {
    ivec2 after = min(texel + axis, high);
    ivec2 before = max(texel - axis, low);
    float depth_after = depth_at(after);
    float depth_before = depth_at(before);
    bool forwards = after != texel && (before == texel || abs(depth_after - depth) <= abs(depth_before - depth));
    vec3 p_ws = position_at(texel, depth);
    return forwards ? position_at(after, depth_after) - p_ws : p_ws - position_at(before, depth_before);
}

vec2 pixel_of(vec4 p_cs) { return (p_cs.xy / p_cs.w * 0.5 + 0.5) * vec2(u.view.size.xy); }

// [Zha98]: one sample receives a splat where its own plane passes through the lit point.
void receive(int pixel, vec2 uv_ts, float depth) {
    GnForwardSample s = samples[pixel];
    float weight = gn_forward_weight((s.uv_ts - uv_ts) * views[index].resolution, u.params.radius);
    if (s.view != index || weight == 0.0) {
        return;
    }
    vec2 d_ts = uv_ts - s.uv_ts;
    float plane = s.depth + dot(s.plane_slope, d_ts) / max(1.0 - dot(s.plane_fall, d_ts), gn_least_divisor);
    if (plane <= depth && plane >= depth - s.slack) {
        atomicAdd(light[pixel], uint(weight * 65536.0 + 0.5));
    }
}

void main() {
    // Take one texel of the view's rectangle; without a caster it lights nothing.
    GnLightView view = views[index];
    ivec2 low = ivec2(view.rect_ts.xy * view.resolution + 0.5);
    ivec2 high = ivec2((view.rect_ts.xy + view.rect_ts.zw) * view.resolution + 0.5) - 1;
    ivec2 texel = low + ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThan(texel, high))) {
        return;
    }
    float depth = depth_at(texel);
    if (depth >= 1.0) {
        return;
    }
    // Carry it into the view.
    vec3 p_ws = position_at(texel, depth);
    vec4 p_cs = u.view.cs_from_ws * vec4(p_ws, 1.0);
    if (p_cs.w <= 0.0) {
        return;
    }
    // Bound the splat on screen.
    float reach = max(float(u.params.radius), 0.5);
    vec3 x_ws = reach * step_ws(texel, ivec2(1, 0), low, high, depth);
    vec3 y_ws = reach * step_ws(texel, ivec2(0, 1), low, high, depth);
    vec2 centre = pixel_of(p_cs);
    vec2 extent = vec2(0.0);
    for (int i = 0; i < 4; ++i) {
        vec3 corner_ws = p_ws + ((i & 1) == 0 ? -x_ws : x_ws) + ((i & 2) == 0 ? -y_ws : y_ws);
        vec4 corner_cs = u.view.cs_from_ws * vec4(corner_ws, 1.0);
        vec2 off = corner_cs.w > 0.0 ? abs(pixel_of(corner_cs) - centre) : vec2(float(u.params.max_pixels));
        extent = max(extent, off);
    }
    extent = min(extent + 1.0, vec2(float(u.params.max_pixels)));
    vec2 size = vec2(u.view.size.xy);
    ivec2 from = ivec2(clamp(floor(centre - extent), vec2(0.0), size));
    ivec2 to = ivec2(clamp(ceil(centre + extent), vec2(0.0), size));

    // Splat.
    vec2 uv_ts = (vec2(texel) + 0.5) / view.resolution;
    for (int y = from.y; y < to.y; ++y) {
        for (int x = from.x; x < to.x; ++x) {
            receive(y * int(u.view.size.x) + x, uv_ts, depth);
        }
    }
}
