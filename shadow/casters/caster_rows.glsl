// SPDX-License-Identifier: MIT
// Geometry stage of casters in logarithmic views. Straight edges are curves there: a triangle's bounding rectangle is drawn, and
// every texel finds its own point of the triangle.
#include "shadow/receiver/logarithm.glsl"
layout(push_constant, scalar) uniform Push { int view; float base_alpha; float alpha_cutoff; int object; int draw; } push;
layout(location = 1) flat out vec4 out_a;
layout(location = 2) flat out vec4 out_b;
layout(location = 3) flat out vec4 out_c;
void main() {
#ifdef GN_TILES
    int view = in_view[0];
#else
    int view = push.view;
#endif
    vec4 a = gl_in[0].gl_Position;
    vec4 b = gl_in[1].gl_Position;
    vec4 c = gl_in[2].gl_Position;
    float rate = max(-views[view].paraboloid, 0.0);
    vec4 box = gn_log_bounds(a.xyw, b.xyw, c.xyw, rate);
    // Rows run against y / w.
    float facing = gn_log_facing(a.xyw, b.xyw, c.xyw) * (rate > 0.0 ? -1.0 : 1.0);
    if (box.x >= box.z || box.y >= box.w || facing == 0.0) {
        return;
    }
    for (int i = 0; i < 4; ++i) {
        out_a = a;
        out_b = b;
        out_c = c;
        emit_corner(corner_of(box, i, facing));
    }
    EndPrimitive();
}
