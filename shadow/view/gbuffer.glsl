// SPDX-License-Identifier: MIT
// A pixel of the G-buffer.
layout(push_constant, scalar) uniform Push {
    vec4 base_color;
    float roughness;
    float metallic;
    float alpha_cutoff;
    uint first_triangle;
    uint object;
    float surface;        // position.w: 2 where no shadow is received, else 1
} push;
layout(location = 0) in vec3 in_position_ws;
layout(location = 1) in vec3 in_normal_ws;
layout(location = 2) in vec2 in_uv;
layout(location = 3) flat in vec3 in_corner_ws;  // of the triangle: its first
#ifdef GN_COLORED
layout(location = 4) in vec4 in_color;
#endif
layout(location = 0) out vec4 out_position;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out vec4 out_albedo;
layout(location = 3) out uvec2 out_surface;

void main() {
    vec4 base_color = push.base_color;
#ifdef GN_COLORED
    base_color *= in_color;
#endif
#ifdef GN_MASKED
    if (textureLod(base_color_texture, in_uv, 0.0).a * base_color.a < push.alpha_cutoff) {
        discard;
    }
#endif
#ifdef GN_TEXTURED
    base_color *= texture(base_color_texture, in_uv);
#endif
    // Take the exact plane of the triangle, and move the interpolated point into it.
    vec3 to_eye = gn_ray_to_eye(u.view, in_position_ws);
    vec3 n_ws = face_normals[push.first_triangle + uint(gl_PrimitiveID)];
    n_ws = n_ws == vec3(0.0) ? normalize(to_eye) : n_ws;
    vec3 p_ws = in_position_ws - n_ws * dot(n_ws, in_position_ws - in_corner_ws);
    n_ws = dot(n_ws, to_eye) < 0.0 ? -n_ws : n_ws;

    // Orient the shading normal likewise; where the mesh has none, the geometric one serves.
    vec3 shading_ws = dot(in_normal_ws, in_normal_ws) > 0.25 ? normalize(in_normal_ws) : n_ws;
    shading_ws = dot(shading_ws, n_ws) < 0.0 ? -shading_ws : shading_ws;
    out_position = vec4(p_ws, push.surface);
    out_normal = vec4(n_ws, dot(u.view.axis_ws, vec4(p_ws, 1.0)));
    out_albedo = vec4(base_color.rgb, push.metallic);
    out_surface = gn_surface(shading_ws, push.object, push.roughness);
}
