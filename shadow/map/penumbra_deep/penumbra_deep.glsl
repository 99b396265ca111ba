// SPDX-License-Identifier: MIT
// V along the ray of a texel: a function of depth, straight between its nodes, of which the first is at depth 0. Compiles as GLSL
// and as C++.
//
// Based on: St-Amour, Paquette, Poulin. Soft Shadows from Extended Light Sources with Penumbra Deep Shadow Maps. Graphics
// Interface 2005. [SPP05]
#ifndef GN_SHADOW_MAP_PENUMBRA_DEEP_GLSL
#define GN_SHADOW_MAP_PENUMBRA_DEEP_GLSL

#include "shadow/casters/caster_depth.glsl"
#include "shadow/map/penumbra_deep/penumbra_deep.h"
#include "shadow/receiver/texel_box.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// A line from a node that errs by no more than epsilon at all that it has passed: the slopes that are left to it. [SPP05] takes
// this from deep shadow maps.
struct GnPenumbraLine {
    vec2 node;     // depth, V
    float least;   // slopes
    float most;
    float passed;  // the depth that it reached
    bool level;    // all that it passed has the node's V
};

// A level stretch longer than this share of the depths stays level: receivers in light and umbra have no share of epsilon.
const float gn_penumbra_rest = 0.01f;

GN_FN GnPenumbraLine gn_penumbra_line(vec2 node) { return GnPenumbraLine(node, -3.0e38f, 3.0e38f, node.x, true); }

// Where the line ends if it goes no further: in the middle of what is left to it.
GN_FN vec2 gn_penumbra_end(GnPenumbraLine line) {
    if (line.passed <= line.node.x || line.level) {
        return vec2(line.passed, line.node.y);
    }
    return vec2(line.passed, clamp(line.node.y + 0.5f * (line.least + line.most) * (line.passed - line.node.x), 0.0f, 1.0f));
}

// Whether the line can pass V = `at.y` at depth `at.x` within epsilon; then it does.
GN_FN bool gn_penumbra_passes(GN_INOUT(GnPenumbraLine) line, vec2 at, float epsilon) {
    float way = at.x - line.node.x;
    if (way <= 0.0f) {
        return abs(at.y - line.node.y) <= epsilon;
    }
    bool level = line.level && at.y == line.node.y;
    if (line.level && !level && line.passed - line.node.x > gn_penumbra_rest) {
        return false;
    }
    float least = max(line.least, (at.y - epsilon - line.node.y) / way);
    float most = min(line.most, (at.y + epsilon - line.node.y) / way);
    if (least > most) {
        return false;
    }
    line.least = least;
    line.most = most;
    line.passed = at.x;
    line.level = level;
    return true;
}

// Depth of the receiver's plane on the ray from near_ws (depth 0) to far_ws (depth 1); of the receiver itself where that is
// further along than a few texels.
GN_FN float gn_penumbra_depth(GnReceiver receiver, float own, float most, vec3 near_ws, vec3 far_ws) {
    float fall = dot(far_ws - near_ws, receiver.n_ws);
    float depth = dot(receiver.p_ws - near_ws, receiver.n_ws) / (abs(fall) > 1.0e-6f ? fall : 1.0e-6f);
    return clamp(depth, own - most, own + most);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// V of a texel's function at a depth; before a step where it has one there.
float gn_penumbra_at(sampler2DArray functions, ivec2 texel, int first, int count, float depth) {
    vec2 before = texelFetch(functions, ivec3(texel, first), 0).rg;
    for (int i = 1; i < count; ++i) {
        vec2 node = texelFetch(functions, ivec3(texel, first + i), 0).rg;
        if (node.x >= depth) {
            float way = node.x - before.x;
            return way > 0.0 ? mix(before.y, node.y, clamp((depth - before.x) / way, 0.0, 1.0)) : before.y;
        }
        before = node;
    }
    return before.y;
}

// Mean over the footprint's texels, of each where its ray meets the receiver's plane.
float gn_penumbra_deep_visibility(GnLookup at, sampler2DArray functions, vec2 ddx_ts, vec2 ddy_ts,
                                  GnPenumbraDeepParams params) {
    GnTexelBox box = gn_texel_box(at.projected, gn_seen_at(at.view, at.receiver.p_ws), 0.5 * (abs(ddx_ts) + abs(ddy_ts)));
    float own = at.projected.depth + gn_depth_epsilon + at.projected.bias;
    float most = at.bias.slope_max * at.projected.texel_ws / at.projected.metres_per_depth;
    vec2 sum = vec2(0.0);
    for (int y = box.first.y; y <= box.last.y; ++y) {
        for (int x = box.first.x; x <= box.last.x; ++x) {
            vec2 centre_ts = (vec2(x, y) + 0.5) * at.projected.texel_ts;
            vec3 near_ws = gn_point_at(at.view, centre_ts, 0.0);
            vec3 far_ws = gn_point_at(at.view, centre_ts, 1.0);
            float depth = gn_penumbra_depth(at.receiver, own, most, near_ws, far_ws) - at.projected.bias;
            float weight = gn_box_weight(box, ivec2(x, y));
            sum += weight * vec2(gn_penumbra_at(functions, ivec2(x, y), at.projected.layer * params.nodes, params.nodes, depth), 1.0);
        }
    }
    return sum.y > 0.0 ? sum.x / sum.y : 1.0;
}

#endif
#endif
