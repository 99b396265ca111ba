// SPDX-License-Identifier: MIT
// Bounds of every slice's samples ([LSL10] 3.3): along directions all around the light's plane, of which every two at right
// angles span a rectangle, and along the light.
#include "shadow/placement/cascades/sdsm_samples.glsl"

struct Bounds {
    float low[GN_SDSM_AXES];
    float high[GN_SDSM_AXES];
    bool any;
};

void clear(out Bounds bounds) {
    for (int axis = 0; axis < GN_SDSM_AXES; ++axis) {
        bounds.low[axis] = 1.0e30;
        bounds.high[axis] = -1.0e30;
    }
    bounds.any = false;
}

void grow(inout Bounds bounds, float along[GN_SDSM_AXES]) {
    for (int axis = 0; axis < GN_SDSM_AXES; ++axis) {
        bounds.low[axis] = min(bounds.low[axis], along[axis]);
        bounds.high[axis] = max(bounds.high[axis], along[axis]);
    }
    bounds.any = true;
}

void flush(int cascade, inout Bounds bounds) {
    if (!bounds.any) {
        return;
    }
    for (int axis = 0; axis < GN_SDSM_AXES; ++axis) {
        atomicMax(r.lowest[GN_SDSM_AXES * cascade + axis], ~ordered(bounds.low[axis]));
        atomicMax(r.highest[GN_SDSM_AXES * cascade + axis], ordered(bounds.high[axis]));
    }
    clear(bounds);
}

void main() {
    uint x = gl_GlobalInvocationID.x;
    uint y = gl_GlobalInvocationID.y * GN_SDSM_ROWS;
    if (x >= u.size.x) {
        return;
    }
    float width = u.params.transition == GN_TRANSITION_NONE ? 0.0 : u.params.width;
    int cascade = 0;
    Bounds own;
    Bounds next;
    clear(own);
    clear(next);
    for (uint end = min(y + GN_SDSM_ROWS, u.size.y); y < end; ++y) {
        vec3 p_ws;
        float distance;
        if (!fetch(ivec2(x, y), p_ws, distance)) {
            continue;
        }
        int at = 0;
        while (at + 1 < u.params.count && distance > r.ends[at + 1]) {
            at += 1;
        }
        if (at != cascade) {
            flush(cascade, own);
            flush(cascade + 1, next);
            cascade = at;
        }
        vec3 d_ws = p_ws - u.eye_ws.xyz;
        vec2 q = vec2(dot(u.x_ws.xyz, d_ws), dot(u.y_ws.xyz, d_ws));
        float along[GN_SDSM_AXES];
        for (int axis = 0; axis < 2 * GN_SDSM_TURNS; ++axis) {
            along[axis] = dot(q, gn_sdsm_axis(axis));
        }
        along[2 * GN_SDSM_TURNS] = dot(u.z_ws.xyz, d_ws);
        grow(own, along);
        // A sample in the transition's band belongs to the next slice too.
        float position = (distance - r.ends[at]) / max(r.ends[at + 1] - r.ends[at], 1.0e-6 * r.ends[at + 1]);
        if (at + 1 < u.params.count && gn_cascades_band(position, 1.01 * width) > 0.0) {
            grow(next, along);
        }
    }
    flush(cascade, own);
    flush(cascade + 1, next);
}
