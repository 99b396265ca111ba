// SPDX-License-Identifier: MIT
// Based on: Sen, Cammarano, Hanrahan. Shadow Silhouette Maps. SIGGRAPH 2003. [SCH03]
// Six vertices an edge: a quad around it where the surface turns away from the light there, else nothing.
#ifdef GN_TILES
layout(push_constant) uniform Push { int layer; };
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[4]; };
#else
layout(push_constant) uniform Push { int view; };
#endif
layout(location = 0) flat out vec4 out_segment;     // ends, in cells
layout(location = 1) flat out vec4 out_depth_over_w;  // depth / w and 1 / w of both ends

// Which side of its plane a triangle turns to the light.
int side(uvec3 corners, vec4 eye_ws) {
    vec3 a = positions[corners.x];
    vec3 n = cross(positions[corners.y] - a, positions[corners.z] - a);
    return int(sign(dot(n, eye_ws.xyz - a * eye_ws.w)));
}

// [SCH03] 3: an edge is a silhouette where the directions in which lit sides run through it do not cancel.
bool is_silhouette(uint edge, vec4 eye_ws) {
    int sum = 0;
    for (uint i = first[edge]; i < first[edge + 1u]; ++i) {
        int s = side(triangles[(around[i] & 0x7fffffffu) >> 1], eye_ws);
        // The highest bit: a triangle that casts from its front alone is not there from behind.
        s = (around[i] & 0x80000000u) != 0u ? max(s, 0) : s;
        sum += (around[i] & 1u) != 0u ? -s : s;
    }
    return sum != 0;
}

// Cuts [t.x, t.y] to where a linear function with these values at both ends is positive.
void clip(inout vec2 t, float at_a, float at_b) {
    float crossing = at_a == at_b ? 0.0 : at_a / (at_a - at_b);
    if (at_a < 0.0) {
        t.x = at_b < 0.0 ? 2.0 : max(t.x, crossing);
    } else if (at_b < 0.0) {
        t.y = min(t.y, crossing);
    }
}

void main() {
    uint edge = uint(gl_VertexIndex) / 6u;
#ifdef GN_TILES
    GnLightView v = views[gl_InstanceIndex];
    gl_ClipDistance = float[](-1.0, -1.0, -1.0, -1.0);
#else
    GnLightView v = views[view];
#endif
    gl_Position = vec4(2.0, 2.0, 0.5, 1.0);
    out_segment = vec4(0.0);
    out_depth_over_w = vec4(0.0, 1.0, 0.0, 1.0);
    if (!is_silhouette(edge, v.eye_ws)) {
        return;
    }
    // Cut off what lies behind the light or far beside its view.
    vec3 a_ws = positions[edges[edge].x];
    vec3 b_ws = positions[edges[edge].y];
    vec4 a_cs = gn_clip(v, a_ws);
    vec4 b_cs = gn_clip(v, b_ws);
    vec2 t = vec2(0.0, 1.0);
    float least_w = v.eye_ws.w > 0.5 ? 1.0e-5 * v.metres_per_depth : 1.0e-4;
    clip(t, a_cs.w - least_w, b_cs.w - least_w);
    clip(t, 1.5 * a_cs.w - a_cs.x, 1.5 * b_cs.w - b_cs.x);
    clip(t, 1.5 * a_cs.w + a_cs.x, 1.5 * b_cs.w + b_cs.x);
    clip(t, 1.5 * a_cs.w - a_cs.y, 1.5 * b_cs.w - b_cs.y);
    clip(t, 1.5 * a_cs.w + a_cs.y, 1.5 * b_cs.w + b_cs.y);
    if (t.x >= t.y) {
        return;
    }
    float a_depth = dot(v.depth_from_ws, vec4(a_ws, 1.0));
    float b_depth = dot(v.depth_from_ws, vec4(b_ws, 1.0));
    vec2 depths = vec2(mix(a_depth, b_depth, t.x), mix(a_depth, b_depth, t.y));
    vec4 from_cs = mix(a_cs, b_cs, t.x);
    vec4 to_cs = mix(a_cs, b_cs, t.y);
    out_depth_over_w = vec4(depths.x / from_cs.w, 1.0 / from_cs.w, depths.y / to_cs.w, 1.0 / to_cs.w);

    // From clip space to cells, which lie half a texel off the texels.
    vec2 from = (v.rect_ts.xy + (from_cs.xy / from_cs.w * 0.5 + 0.5) * v.rect_ts.zw) * v.resolution - 0.5;
    vec2 to = (v.rect_ts.xy + (to_cs.xy / to_cs.w * 0.5 + 0.5) * v.rect_ts.zw) * v.resolution - 0.5;
    out_segment = vec4(from, to);

    // Draw a quad that holds the centre of every cell the segment touches: all around it three quarters of a cell.
    vec2 along = distance(from, to) > 1.0e-6 ? normalize(to - from) * 0.75 : vec2(0.75, 0.0);
    vec2 across = vec2(-along.y, along.x);
    int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexIndex % 6];
    vec2 p = (corner & 1) == 0 ? from - along : to + along;
    p += (corner & 2) == 0 ? -across : across;
    gl_Position = vec4(p / v.resolution * 2.0 - 1.0, 0.5, 1.0);
#ifdef GN_TILES
    vec4 rect = v.rect_ts * v.resolution;
    if (gn_tile_in(v, layer)) {
        gl_ClipDistance = float[](p.x - rect.x, rect.x + rect.z - p.x, p.y - rect.y, rect.y + rect.w - p.y);
    }
#endif
}
