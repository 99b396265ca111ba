// SPDX-License-Identifier: MIT
// Which texels a triangle touches, however little: its edges as functions of a place, each moved out by half a texel.
// Compiles as GLSL and as C++.
//
// Based on: Hasselgren, Akenine-Moeller, Ohlsson. Conservative Rasterization. GPU Gems 2, 2005. [HAO05]
// Based on: Olano, Greer. Triangle Scan Conversion using 2D Homogeneous Coordinates. Graphics Hardware 1997. [OG97]
// Departs from them: fragments of the bounding rectangle decide by the edges themselves, so that nothing is clipped before.
#ifndef GN_SHADOW_CASTERS_CONSERVATIVE_GLSL
#define GN_SHADOW_CASTERS_CONSERVATIVE_GLSL

#include "base/shared.h"
#include "shadow/light_view.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Not negative at (x, y, 1) on the inner side of each edge, x and y in texels; `slack` is added to each for rounding. First
// texel and end of the texels that can be touched.
struct GnTexelEdges {
    vec3 a;
    vec3 b;
    vec3 c;
    vec3 slack;
    ivec4 texels;
};

// A clip position as (x w, y w, w), x and y in texels of the view's layer.
GN_FN vec3 gn_texel_position(GnLightView view, vec4 p_cs) {
    float n = view.resolution;
    float x = view.rect_ts.x * p_cs.w + 0.5f * (p_cs.x + p_cs.w) * view.rect_ts.z;
    float y = view.rect_ts.y * p_cs.w + 0.5f * (p_cs.y + p_cs.w) * view.rect_ts.w;
    return vec3(x * n, y * n, p_cs.w);
}

// The sum of what cancels in the cross product, at places up to `most` texels.
GN_FN float gn_edge_size(vec3 a, vec3 b, float most) {
    float x = abs(a.y * b.z) + abs(a.z * b.y);
    float y = abs(a.z * b.x) + abs(a.x * b.z);
    return (x + y) * most + abs(a.x * b.y) + abs(a.y * b.x);
}

// The edges of a triangle of such positions; what lies behind the eye is left out. `bounds`: first texel and end.
GN_FN GnTexelEdges gn_texel_edges(vec3 a, vec3 b, vec3 c, ivec4 bounds) {
    GnTexelEdges edges;
    edges.a = cross(b, c);
    edges.b = cross(c, a);
    edges.c = cross(a, b);
    float turn = dot(a, edges.a) < 0.0f ? -1.0f : 1.0f;
    edges.a = turn * edges.a;
    edges.b = turn * edges.b;
    edges.c = turn * edges.c;
    float most = float(max(bounds.z, bounds.w));
    edges.slack = 1.0e-6f * vec3(gn_edge_size(b, c, most), gn_edge_size(c, a, most), gn_edge_size(a, b, most));
    edges.texels = bounds;
    if (a.z > 0.0f && b.z > 0.0f && c.z > 0.0f) {
        vec2 pa = vec2(a.x, a.y) / a.z;
        vec2 pb = vec2(b.x, b.y) / b.z;
        vec2 pc = vec2(c.x, c.y) / c.z;
        vec2 first = min(min(pa, pb), pc);
        vec2 last = max(max(pa, pb), pc);
        vec2 low = vec2(float(bounds.x), float(bounds.y));
        vec2 high = vec2(float(bounds.z), float(bounds.w));
        first = clamp(floor(first - 1.0e-6f * (abs(first) + 1.0f)), low, high);
        last = clamp(floor(last + 1.0e-6f * (abs(last) + 1.0f)) + 1.0f, low, high);
        edges.texels = ivec4(int(first.x), int(first.y), int(last.x), int(last.y));
    } else if (a.z <= 0.0f && b.z <= 0.0f && c.z <= 0.0f) {
        edges.texels = ivec4(bounds.x, bounds.y, bounds.x, bounds.y);
    }
    return edges;
}

// Whether a half plane reaches into the texel around `centre`.
GN_FN bool gn_edge_touches(vec3 edge, float slack, vec2 centre) {
    return edge.x * centre.x + edge.y * centre.y + edge.z + 0.5f * (abs(edge.x) + abs(edge.y)) + slack >= 0.0f;
}

// Whether the triangle reaches into a texel. Of a triangle before the eye exactly, but for rounding.
GN_FN bool gn_touches(GnTexelEdges edges, ivec2 texel) {
    vec2 centre = vec2(float(texel.x) + 0.5f, float(texel.y) + 0.5f);
    return texel.x >= edges.texels.x && texel.y >= edges.texels.y && texel.x < edges.texels.z && texel.y < edges.texels.w &&
           gn_edge_touches(edges.a, edges.slack.x, centre) && gn_edge_touches(edges.b, edges.slack.y, centre) &&
           gn_edge_touches(edges.c, edges.slack.z, centre);
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
