// SPDX-License-Identifier: MIT
// Nearest and farthest sample, and how many lie in each ratio of distances.
#include "shadow/placement/cascades/sdsm_samples.glsl"
void main() {
    uint x = gl_GlobalInvocationID.x;
    uint y = gl_GlobalInvocationID.y * GN_SDSM_ROWS;
    if (x >= u.size.x) {
        return;
    }
    uint nearest = 0u;
    uint farthest = 0u;
    int bin = -1;
    uint run = 0u;
    for (uint end = min(y + GN_SDSM_ROWS, u.size.y); y < end; ++y) {
        vec3 p_ws;
        float distance;
        if (!fetch(ivec2(x, y), p_ws, distance)) {
            continue;
        }
        nearest = max(nearest, ~ordered(distance));
        farthest = max(farthest, ordered(distance));
        float t = step_of(u.near, u.far, distance);
        int at = clamp(int(t * GN_SDSM_BINS), 0, GN_SDSM_BINS - 1);
        if (at != bin && run > 0u) {
            atomicAdd(r.bins[bin], run);
            run = 0u;
        }
        bin = at;
        run += 1u;
    }
    if (run > 0u) {
        atomicAdd(r.bins[bin], run);
        atomicMax(r.nearest, nearest);
        atomicMax(r.farthest, farthest);
    }
}
