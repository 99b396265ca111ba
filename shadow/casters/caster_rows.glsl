// SPDX-License-Identifier: MIT
// Geometry stage of casters in logarithmic views. Straight edges are curves there: a triangle's bounding rectangle is drawn, and
// every texel finds its own point of the triangle.
#include "shadow/receiver/logarithm.glsl"
layout(push_constant, scalar) uniform Push { int view; float base_alpha; float alpha_cutoff; int object; int draw; } push;
layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;
layout(location = 1) flat out vec4 out_a;
layout(location = 2) flat out vec4 out_b;
layout(location = 3) flat out vec4 out_c;
#ifdef GN_MASKED
layout(location = 1) in vec3 in_mask[];
layout(location = 4) flat out vec3 out_mask_a;
layout(location = 5) flat out vec3 out_mask_b;
layout(location = 6) flat out vec3 out_mask_c;
#endif
#ifdef GN_TILES
layout(location = 7) flat in int in_view[];
layout(location = 7) flat out int out_view;
#endif
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
        bool right = facing < 0.0 ? i >= 2 : (i & 1) != 0;
        bool below = facing < 0.0 ? (i & 1) != 0 : i >= 2;
        out_a = a;
        out_b = b;
        out_c = c;
#ifdef GN_MASKED
        out_mask_a = in_mask[0];
        out_mask_b = in_mask[1];
        out_mask_c = in_mask[2];
#endif
        gl_Position = vec4(right ? box.z : box.x, below ? box.w : box.y, 0.5, 1.0);
#ifdef GN_TILES
        out_view = view;
        gl_Position = gn_tile_clip(views[view], gl_Position);
#endif
        EmitVertex();
    }
    EndPrimitive();
}
