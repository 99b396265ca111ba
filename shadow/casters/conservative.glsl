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

// Farther than any texel.
const float gn_far_texel = 1.0e30f;

// A margin with which a triangle reaches everywhere, also from behind the eye.
const float gn_everywhere = 1.0e8f;

// Grows a rectangle by a corner before the eye, and by where the edge to the next corner leaves what lies before the eye: the
// sides to which it goes on without end.
GN_FN void gn_bound_corner(vec3 a, vec3 b, GN_INOUT(vec2) first, GN_INOUT(vec2) last) {
    if (a.z > 0.0f) {
        vec2 at = vec2(a.x, a.y) / a.z;
        first = min(first, at);
        last = max(last, at);
    }
    if ((a.z > 0.0f) != (b.z > 0.0f)) {
        vec2 towards = vec2(a.x, a.y) * b.z - vec2(b.x, b.y) * a.z;
        vec2 slack = 1.0e-5f * (abs(vec2(a.x, a.y) * b.z) + abs(vec2(b.x, b.y) * a.z));
        vec2 side = a.z > 0.0f ? -towards : towards;
        first = vec2(side.x < slack.x ? -gn_far_texel : first.x, side.y < slack.y ? -gn_far_texel : first.y);
        last = vec2(side.x > -slack.x ? gn_far_texel : last.x, side.y > -slack.y ? gn_far_texel : last.y);
    }
}

// The edges of a triangle of such positions that reaches `margin` texels further along both axes; what lies behind the eye is
// left out. `bounds`: first texel and end.
GN_FN GnTexelEdges gn_texel_edges_grown(vec3 a, vec3 b, vec3 c, ivec4 bounds, float margin) {
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
    edges.slack += margin * vec3(abs(edges.a.x) + abs(edges.a.y), abs(edges.b.x) + abs(edges.b.y),
                                 abs(edges.c.x) + abs(edges.c.y));
    vec2 first = vec2(gn_far_texel);
    vec2 last = vec2(-gn_far_texel);
    gn_bound_corner(a, b, first, last);
    gn_bound_corner(b, c, first, last);
    gn_bound_corner(c, a, first, last);
    vec2 low = vec2(float(bounds.x), float(bounds.y));
    vec2 high = vec2(float(bounds.z), float(bounds.w));
    first = first - margin;
    last = last + margin;
    first = clamp(floor(first - 1.0e-6f * (abs(first) + 1.0f)), low, high);
    last = clamp(floor(last + 1.0e-6f * (abs(last) + 1.0f)) + 1.0f, low, high);
    edges.texels = ivec4(int(first.x), int(first.y), int(last.x), int(last.y));
    if (margin >= gn_everywhere) {
        edges.slack = vec3(gn_far_texel);
        edges.texels = bounds;
    }
    return edges;
}

GN_FN GnTexelEdges gn_texel_edges(vec3 a, vec3 b, vec3 c, ivec4 bounds) {
    return gn_texel_edges_grown(a, b, c, bounds, 0.0f);
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

// Whether it may reach into a square of `side` texels, from its first texel on.
GN_FN bool gn_touches_block(GnTexelEdges edges, ivec2 first, int side) {
    float reach = 0.5f * float(side);
    vec2 centre = vec2(float(first.x) + reach, float(first.y) + reach);
    vec3 x = vec3(edges.a.x, edges.b.x, edges.c.x);
    vec3 y = vec3(edges.a.y, edges.b.y, edges.c.y);
    vec3 most = x * centre.x + y * centre.y + vec3(edges.a.z, edges.b.z, edges.c.z) + reach * (abs(x) + abs(y)) + edges.slack;
    return most.x >= 0.0f && most.y >= 0.0f && most.z >= 0.0f;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#endif
#endif
