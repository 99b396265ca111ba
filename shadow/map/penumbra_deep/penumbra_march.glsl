// SPDX-License-Identifier: MIT
// A ray of the centre's map through the map of one point: where it passes behind what the point sees, and out again. The body of
// a shader that has the point's views, its depths and lists per texel, and `choose_view(vec3 p_ws)`.
//
// Based on: St-Amour, Paquette, Poulin. Soft Shadows from Extended Light Sources with Penumbra Deep Shadow Maps. Graphics
// Interface 2005. [SPP05]

// A depth in [0,1] and whether the point is seen from there on, as one number; numbers are ordered as the depths are.
uint event_of(float depth, bool seen) { return (floatBitsToUint(depth) & ~1u) | (seen ? 1u : 0u); }

// The ray in one view: clip coordinates at depth 0 and their change to depth 1, and likewise the view's own depth.
struct Ray {
    vec4 from_cs;
    vec4 way_cs;
    float from_depth;
    float way_depth;
};

// The part of the ray's depths that the view sees, nothing where begin >= end.
vec2 seen_part(Ray ray) {
    vec2 part = vec2(0.0, 1.0);
    for (int i = 0; i < 5; ++i) {
        // w + x, w - x, w + y, w - y and w itself are positive within the view.
        vec4 side = i == 4 ? vec4(0.0, 0.0, 0.0, 1.0) : vec4(i == 0 ? 1.0 : i == 1 ? -1.0 : 0.0, i == 2 ? 1.0 : i == 3 ? -1.0 : 0.0, 0.0, 1.0);
        float at = dot(side, ray.from_cs) - (i == 4 ? 1.0e-6 : 0.0);
        float change = dot(side, ray.way_cs);
        if (change == 0.0) {
            part = at < 0.0 ? vec2(1.0, 0.0) : part;
        } else if (change > 0.0) {
            part.x = max(part.x, -at / change);
        } else {
            part.y = min(part.y, -at / change);
        }
    }
    return part;
}

vec2 texel_at(GnLightView view, Ray ray, float s) {
    vec4 p_cs = ray.from_cs + s * ray.way_cs;
    return (view.rect_ts.xy + (p_cs.xy / p_cs.w * 0.5 + 0.5) * view.rect_ts.zw) * view.resolution;
}

// Where the ray crosses a border of one axis, in the view's own [-1,1].
float leaves_at(float from, float way, float from_w, float way_w, float border) {
    float divisor = way - border * way_w;
    return (border * from_w - from) / divisor;
}

void march(ivec3 list, GnLightView view, int index, vec3 near_ws, vec3 far_ws) {
    Ray ray;
    ray.from_cs = view.cs_from_ws * vec4(near_ws, 1.0);
    ray.way_cs = view.cs_from_ws * vec4(far_ws, 1.0) - ray.from_cs;
    ray.from_depth = dot(view.depth_from_ws, vec4(near_ws, 1.0));
    ray.way_depth = dot(view.depth_from_ws, vec4(far_ws, 1.0)) - ray.from_depth;
    vec2 part = seen_part(ray);
    if (part.x >= part.y) {
        return;
    }
    vec2 first = round(view.rect_ts.xy * view.resolution);
    vec2 size = round(view.rect_ts.zw * view.resolution);
    ivec2 low = ivec2(first), high = ivec2(first + size) - 1;
    ivec2 texel = clamp(ivec2(floor(texel_at(view, ray, part.x))), low, high);
    ivec2 last = clamp(ivec2(floor(texel_at(view, ray, part.y))), low, high);
    vec2 ahead = vec2(sign(last - texel));
    bool hidden = false;
    float s = part.x;
    int most = int(size.x + size.y) + 4;
    for (int i = 0; i < most && s < part.y; ++i) {
        // The way through one texel: it is left across an axis until the last one is reached there.
        vec2 border = ((vec2(texel) + max(ahead, vec2(0.0)) - first) / size) * 2.0 - 1.0;
        vec2 out_at = vec2(texel.x == last.x ? 2.0 : leaves_at(ray.from_cs.x, ray.way_cs.x, ray.from_cs.w, ray.way_cs.w, border.x),
                           texel.y == last.y ? 2.0 : leaves_at(ray.from_cs.y, ray.way_cs.y, ray.from_cs.w, ray.way_cs.w, border.y));
        float end = clamp(min(out_at.x, out_at.y), s, part.y);

        // What the point sees there hides all that lies behind it, and nothing that another view serves.
        float occluder = texelFetch(point_depth, ivec3(texel, view.layer), 0).r + gn_depth_epsilon;
        bool served = serves(index, mix(near_ws, far_ws, 0.5 * (s + end)));
        bool hidden_first = served && ray.from_depth + s * ray.way_depth > occluder;
        bool hidden_last = served && ray.from_depth + end * ray.way_depth > occluder;
        if (hidden_first != hidden) {
            gn_list_add(list, event_of(s, hidden));
        }
        if (hidden_last != hidden_first) {
            float crossing = (occluder - ray.from_depth) / ray.way_depth;
            gn_list_add(list, event_of(clamp(crossing, s, end), hidden_first));
        }
        hidden = hidden_last;
        texel += ivec2(out_at.x <= out_at.y ? ahead.x : 0.0, out_at.x <= out_at.y ? 0.0 : ahead.y);
        s = end;
    }
    if (hidden && part.y < 1.0) {
        gn_list_add(list, event_of(part.y, true));
    }
}
