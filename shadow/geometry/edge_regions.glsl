// SPDX-License-Identifier: MIT
// The region in which an edge hides part of a light, as a rectangle on the screen: the vertex shader of what is evaluated there,
// one rectangle an edge. The sample itself says whether it is in the region; the rectangle need only hold it.
layout(location = 0) flat out vec3 a_ws;
layout(location = 1) flat out vec3 b_ws;
layout(location = 2) flat out uint edge_index;

// The corners of a box around the light, as steps from its centre; a sun's around its direction.
vec3 light_corner(int i, vec3 x_ws, vec3 y_ws) {
    return ((i & 1) != 0 ? x_ws : -x_ws) + ((i & 2) != 0 ? y_ws : -y_ws);
}

// How far along `way` from e the scene's box reaches: what the sample is part of.
float reach_of(vec3 e_ws, vec3 way_ws) {
    vec3 corner = mix(u.region.low_ws.xyz, u.region.high_ws.xyz, greaterThan(way_ws, vec3(0.0)));
    return dot(corner - e_ws, way_ws);
}

vec4 points_cs[10];

// The near end of the region is the edge; its far end lies where every ray from the light past the edge has left the scene.
// False where the region cannot be bounded: the edge lies in the light.
bool find_points() {
    bool sun = u.region.light_ws.w == 0.0;
    vec3 middle_ws = 0.5 * (a_ws + b_ws);
    vec3 way_ws = middle_ws * u.region.light_ws.w - u.region.light_ws.xyz;
    vec3 x_ws = u.region.x_ws.xyz;
    vec3 y_ws = u.region.y_ws.xyz;
    if (u.region.x_ws.w > 0.0) {
        // A sphere: the disc that the edge's nearer end sees.
        float near = min(distance(a_ws, u.region.light_ws.xyz), distance(b_ws, u.region.light_ws.xyz));
        float sine = u.region.x_ws.w / near;
        if (sine > 0.9) {
            return false;
        }
        gn_across(normalize(way_ws), x_ws, y_ws);
        x_ws *= u.region.x_ws.w / (1.0 - sine);
        y_ws *= u.region.x_ws.w / (1.0 - sine);
    }
    float s = 0.0;
    for (int i = 0; i < 8; ++i) {
        vec3 e_ws = (i & 4) != 0 ? b_ws : a_ws;
        vec3 ray_ws = e_ws * u.region.light_ws.w - u.region.light_ws.xyz - light_corner(i, x_ws, y_ws);
        vec3 axis_ws = normalize(way_ws);
        float rate = dot(ray_ws, axis_ws);
        if (rate <= 1.0e-4 * length(way_ws)) {
            return false;
        }
        s = max(s, reach_of(e_ws, axis_ws) / rate);
    }
    for (int i = 0; i < 8; ++i) {
        vec3 e_ws = (i & 4) != 0 ? b_ws : a_ws;
        vec3 ray_ws = e_ws * u.region.light_ws.w - u.region.light_ws.xyz - light_corner(i, x_ws, y_ws);
        points_cs[i] = GN_EDGE_CLIP(vec4(e_ws + s * ray_ws, 1.0));
    }
    points_cs[8] = GN_EDGE_CLIP(vec4(a_ws, 1.0));
    points_cs[9] = GN_EDGE_CLIP(vec4(b_ws, 1.0));
    GN_EDGE_NEAR
    return true;
}

// Beyond the near plane, clip coordinates are none of the screen's.
float before_eye(vec4 p_cs) { return p_cs.w - p_cs.z; }

vec2 pixel_of(vec4 p_cs) { return (p_cs.xy / p_cs.w) * 0.5 * u.region.size; }

// Every point of the hull on the screen, for `pass` 0 the sum of their places and products, for 1 their extent along an axis.
vec2 low;
vec2 high;
vec2 sum;
vec3 products;
float many;
void take(vec4 p_cs, int pass, vec2 axis) {
    vec2 p = pixel_of(p_cs);
    if (pass == 0) {
        sum += p;
        products += vec3(p.x * p.x, p.x * p.y, p.y * p.y);
        many += 1.0;
    } else {
        vec2 at = vec2(dot(p, axis), dot(p, vec2(-axis.y, axis.x)));
        low = min(low, at);
        high = max(high, at);
    }
}
void take_all(int pass, vec2 axis) {
    for (int i = 0; i < 10; ++i) {
        if (before_eye(points_cs[i]) > 0.0) {
            take(points_cs[i], pass, axis);
            continue;
        }
        for (int j = 0; j < 10; ++j) {
            float inside = before_eye(points_cs[j]);
            if (inside > 0.0) {
                float t = inside / (inside - before_eye(points_cs[i]));
                take(mix(points_cs[j], points_cs[i], t), pass, axis);
            }
        }
    }
}

void main() {
    uint side = sides[uint(gl_VertexIndex) / 6u];
    uint corner = uint(gl_VertexIndex) % 6u;
    uvec2 edge = edges[side >> 1];
    bool turned = (side & 1u) != 0u;
    edge_index = side >> 1;
    a_ws = positions[turned ? edge.y : edge.x];
    b_ws = positions[turned ? edge.x : edge.y];
    corner = corner < 3u ? corner : corner == 3u ? 2u : corner == 4u ? 1u : 3u;
    vec2 unit = vec2(corner & 1u, corner >> 1u);
    if (!find_points()) {
        gl_Position = vec4(2.0 * unit - 1.0, 0.5, 1.0);
        return;
    }
    // Turn the rectangle along the longer way of what is seen, and hold it to the screen's own size.
    low = vec2(1.0e30);
    high = vec2(-1.0e30);
    sum = vec2(0.0);
    products = vec3(0.0);
    many = 0.0;
    take_all(0, vec2(1.0, 0.0));
    if (many == 0.0) {
        gl_Position = vec4(2.0, 2.0, 0.5, 1.0);
        return;
    }
    vec2 mean = sum / many;
    vec3 spread = products / many - vec3(mean.x * mean.x, mean.x * mean.y, mean.y * mean.y);
    float angle = 0.5 * atan(2.0 * spread.y, spread.x - spread.z);
    vec2 axis = isnan(angle) || isinf(angle) ? vec2(1.0, 0.0) : vec2(cos(angle), sin(angle));
    take_all(1, axis);
    float reach = length(u.region.size);
    low = clamp(low - 1.0, vec2(-reach), vec2(reach));
    high = clamp(high + 1.0, vec2(-reach), vec2(reach));
    vec2 at = mix(low, high, unit);
    vec2 p = axis * at.x + vec2(-axis.y, axis.x) * at.y;
    gl_Position = vec4(p / (0.5 * u.region.size), 0.5, 1.0);
}
