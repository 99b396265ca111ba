// SPDX-License-Identifier: MIT
// Slices of equal ratio between nearest and farthest ([LSL10] 3.1); or, where the histogram counts, those that minimize the
// mean over all samples of the size of their texels: a slice that ends at z has texels proportional to z, and a sample errs
// where an edge lies within a texel of it. Gaps between the samples take no slice by themselves.
#include "shadow/placement/cascades/sdsm_steps.glsl"
layout(local_size_x = 1) in;
const int COARSE = 64;  // bins that a slice can end at
const float NEVER = 1.0e30;

float edge(int bin) { return distance_at(u.near, u.far, float(bin) / float(COARSE)); }
// What the texels of a slice between two bins are in proportion to: its end, or its length where the view does not widen.
float size_of(int first, int end, float far) { return min(edge(end), far) - (u.even != 0 ? edge(first) : 0.0); }

void main() {
    bool none = r.farthest == 0u;
    float near = none ? 1.0 : unordered(~r.nearest) * (1.0 - 1.0e-5);
    float far = none ? 2.0 : unordered(r.farthest) * (1.0 + 1.0e-5);
    int count = u.params.count;
    for (int i = 0; i <= count; ++i) {
        r.ends[i] = i == 0 ? near : i == count ? far : distance_at(near, far, float(i) / float(count));
    }
    if (none || u.params.split != GN_SPLIT_SDSM_HISTOGRAM) {
        return;
    }
    // Samples before every edge.
    float sums[COARSE + 1];
    sums[0] = 0.0;
    for (int b = 0; b < COARSE; ++b) {
        sums[b + 1] = sums[b];
        for (int fine = 0; fine < GN_SDSM_BINS / COARSE; ++fine) {
            sums[b + 1] += float(r.bins[b * (GN_SDSM_BINS / COARSE) + fine]);
        }
    }
    // best[b]: least cost of all samples before edge b in i slices, the last beginning at edge starts[i][b].
    float best[COARSE + 1];
    int starts[GN_CASCADES_MOST * (COARSE + 1)];
    for (int b = 0; b <= COARSE; ++b) {
        best[b] = size_of(0, b, far) * sums[b];
        starts[b] = 0;
    }
    for (int i = 1; i < count; ++i) {
        for (int b = COARSE; b >= 1; --b) {
            float least = NEVER;
            int start = 0;
            for (int a = 0; a <= b; ++a) {
                float cost = best[a] + size_of(a, b, far) * (sums[b] - sums[a]);
                if (cost < least) {
                    least = cost;
                    start = a;
                }
            }
            best[b] = least;
            starts[i * (COARSE + 1) + b] = start;
        }
    }
    // Walk back from the last slice.
    int b = COARSE;
    for (int i = count - 1; i >= 1; --i) {
        b = starts[i * (COARSE + 1) + b];
        r.ends[i] = clamp(edge(b), near, r.ends[i + 1]);
    }
}
