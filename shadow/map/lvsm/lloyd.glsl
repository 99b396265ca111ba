// SPDX-License-Identifier: MIT
// Where layers are split: weighted k-means over a histogram of second occluder depths, by Lloyd's relaxation.
// Based on: Lauritzen, McCool. Layered Variance Shadow Maps. Graphics Interface 2008. [LM08]
// Based on: Lauritzen. Rendering Antialiased Shadows using Warped Variance Shadow Maps. Waterloo 2008. [Lau08]
// Departs from it: means come from prefix sums over a histogram of depths, not from a mip pyramid for every two splits.
//
// Splits are moved where a host says, i from 0 to GN_LVSM_BINS, what the sums over the bins before i are of
// vec3(weight, weight x, weight x^2) where x is the middle of the bin minus one half:
//   #define GN_LLOYD_BEFORE(i) vec3(0.0f)
#ifndef GN_SHADOW_MAP_LVSM_LLOYD_GLSL
#define GN_SHADOW_MAP_LVSM_LLOYD_GLSL

#include "shadow/map/lvsm/lvsm.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// The mean and its weight of two depths or more: [Lau08] 4.1.2, mu + sigma with the weight sigma^2.
GN_FN vec2 gn_lloyd_sample(vec4 depths) {
    float mean = dot(depths, vec4(0.25f));
    vec4 off = depths - mean;
    float variance = dot(off, off) * 0.25f;
    return vec2(min(mean + sqrt(variance), 1.0f), variance);
}

// [Lau08] 4.1.2: low and high variances clamped. Below one deviation nothing counts, above the other all count alike.
GN_FN float gn_lloyd_weight(float variance, float least, float most) {
    return variance < least * least ? 0.0f : min(variance / (most * most), 1.0f);
}

// splits[0] = 0 and splits[layers] = 1 stay; those between are the means.
struct GnLloydSplits {
    float at[GN_LVSM_MAX_LAYERS + 1];
};

GN_FN GnLloydSplits gn_lloyd_uniform(int layers) {
    GnLloydSplits splits;
    for (int k = 0; k <= GN_LVSM_MAX_LAYERS; ++k) {
        splits.at[k] = min(float(k) / float(layers), 1.0f);
    }
    return splits;
}

GN_FN int gn_lloyd_bin(float depth) { return clamp(int(depth * float(GN_LVSM_BINS) + 0.5f), 0, GN_LVSM_BINS); }

// The bins of the cluster around split k: up to the middle between it and its neighbours.
GN_FN ivec2 gn_lloyd_cluster(GnLloydSplits splits, int layers, int k) {
    return ivec2(k == 1 ? 0 : gn_lloyd_bin(0.5f * (splits.at[k - 1] + splits.at[k])),
                 k == layers - 1 ? GN_LVSM_BINS : gn_lloyd_bin(0.5f * (splits.at[k] + splits.at[k + 1])));
}

#ifdef GN_LLOYD_BEFORE
GN_FN vec3 gn_lloyd_sums(ivec2 bins) { return GN_LLOYD_BEFORE(bins.y) - GN_LLOYD_BEFORE(bins.x); }

// What is less than rounding of the prefix sums counts as empty.
GN_FN bool gn_lloyd_empty(vec3 sums) { return sums.x <= 1.0e-5f * vec3(GN_LLOYD_BEFORE(GN_LVSM_BINS)).x; }

GN_FN float gn_lloyd_mean(vec3 sums) { return 0.5f + sums.y / sums.x; }

// Standard deviation within a cluster.
GN_FN float gn_lloyd_spread(vec3 sums) {
    float mean = sums.y / sums.x;
    return sqrt(max(sums.z / sums.x - mean * mean, 0.0f));
}

// [Lau08] 4.1.3: one split whose cluster is empty moves into the cluster with the most weight and halves it.
GN_FN GnLloydSplits gn_lloyd_teleport(GnLloydSplits splits, int layers) {
    int empty = 0;
    int heaviest = 0;
    float most = 0.0f;
    for (int k = 1; k < layers; ++k) {
        vec3 sums = gn_lloyd_sums(gn_lloyd_cluster(splits, layers, k));
        if (gn_lloyd_empty(sums)) {
            empty = empty == 0 ? k : empty;
        } else if (sums.x > most && gn_lloyd_spread(sums) > 2.0f / float(GN_LVSM_BINS)) {
            most = sums.x;
            heaviest = k;
        }
    }
    if (empty == 0 || heaviest == 0) {
        return splits;
    }

    // Put one split a standard deviation to either side of the heavy cluster's mean.
    vec3 heavy = gn_lloyd_sums(gn_lloyd_cluster(splits, layers, heaviest));
    float low = max(gn_lloyd_mean(heavy) - gn_lloyd_spread(heavy), 0.0f);
    float high = min(gn_lloyd_mean(heavy) + gn_lloyd_spread(heavy), 1.0f);

    // Close the gap that the empty split leaves, open one beside the heavy split.
    if (empty < heaviest) {
        for (int k = empty; k < heaviest - 1; ++k) {
            splits.at[k] = splits.at[k + 1];
        }
        splits.at[heaviest - 1] = low;
        splits.at[heaviest] = high;
    } else {
        for (int k = empty; k > heaviest + 1; --k) {
            splits.at[k] = splits.at[k - 1];
        }
        splits.at[heaviest] = low;
        splits.at[heaviest + 1] = high;
    }
    return splits;
}

// One iteration: an empty split teleports, then every split moves to the mean of its cluster.
GN_FN GnLloydSplits gn_lloyd_iterate(GnLloydSplits splits, int layers) {
    splits = gn_lloyd_teleport(splits, layers);
    GnLloydSplits next = splits;
    for (int k = 1; k < layers; ++k) {
        vec3 sums = gn_lloyd_sums(gn_lloyd_cluster(splits, layers, k));
        if (!gn_lloyd_empty(sums)) {
            next.at[k] = gn_lloyd_mean(sums);
        }
    }
    return next;
}

#endif

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
