// SPDX-License-Identifier: MIT
// Based on: Lauritzen, McCool. Layered Variance Shadow Maps. Graphics Interface 2008. [LM08]
// One workgroup a map layer: prefix sums over its bins, then Lloyd's relaxation of its splits.
shared vec3 prefix[GN_LVSM_BINS + 1];
#define GN_LLOYD_BEFORE(i) prefix[i]
#include "shadow/map/lvsm/lloyd.glsl"
#define THREADS 128
#define RUN (GN_LVSM_BINS / THREADS)
layout(local_size_x = THREADS) in;
shared vec3 runs[THREADS];
void main() {
    int row = int(gl_WorkGroupID.x);
    int thread = int(gl_LocalInvocationIndex);

    // Sum each thread's run of bins.
    vec3 sum = vec3(0);
    for (int i = thread * RUN; i < (thread + 1) * RUN; ++i) {
        uint bin = uint(row * GN_LVSM_BINS + i);
        float weight = float(bins[2u * bin]) + 4294967296.0 * float(bins[2u * bin + 1u]);
        float x = (float(i) + 0.5) / float(GN_LVSM_BINS) - 0.5;
        prefix[i] = sum;
        sum += weight * vec3(1.0, x, x * x);
    }
    // Scan the runs.
    runs[thread] = sum;
    for (int stride = 1; stride < THREADS; stride *= 2) {
        barrier();
        vec3 other = thread >= stride ? runs[thread - stride] : vec3(0);
        barrier();
        runs[thread] += other;
    }
    barrier();
    for (int i = thread * RUN; i < (thread + 1) * RUN; ++i) {
        prefix[i] += thread > 0 ? runs[thread - 1] : vec3(0);
    }
    if (thread == THREADS - 1) {
        prefix[GN_LVSM_BINS] = runs[thread];
    }
    barrier();
    if (thread != 0) {
        return;
    }
    // Relax from where the frame before left the splits.
    GnLloydSplits s = gn_lloyd_uniform(u.params.layers);
#ifdef GN_BEFORE
    for (int k = 1; k < u.params.layers; ++k) {
        s.at[k] = imageLoad(splits_before, ivec3(k, row, 0)).r;
    }
#endif
    if (prefix[GN_LVSM_BINS].x > 0.0) {
        for (int i = 0; i < u.params.iterations; ++i) {
            s = gn_lloyd_iterate(s, u.params.layers);
        }
    }
    for (int k = 0; k <= u.params.layers; ++k) {
        imageStore(splits, ivec3(k, row, 0), vec4(s.at[k]));
    }
}
