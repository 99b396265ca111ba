// SPDX-License-Identifier: MIT
// A pixel of the G-buffer.
layout(push_constant, scalar) uniform Push {
    vec4 base_color;
    vec3 emissive;
    float roughness;
    float metallic;
    float alpha_cutoff;
    uint first_triangle;
    uint object_id;
    float surface;        // position.w: 2 where no shadow is received, else 1
} push;
layout(location = 0) in vec3 in_position_ws;
layout(location = 1) in vec3 in_normal_ws;
layout(location = 2) in vec2 in_uv;
layout(location = 3) in vec4 in_color;
layout(location = 0) out vec4 out_position;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out vec4 out_shading_normal;
layout(location = 3) out vec4 out_albedo;
layout(location = 4) out vec4 out_material;
layout(location = 5) out vec4 out_emission;

void main() {
    vec4 base_color = push.base_color * in_color;
#ifdef GN_TEXTURED
    base_color = texture(base_color_texture, in_uv) * push.base_color * in_color;
#endif
#ifdef GN_MASKED
    if (textureLod(base_color_texture, in_uv, 0.0).a * push.base_color.a * in_color.a < push.alpha_cutoff) {
        discard;
    }
#endif
    // Take the exact plane of the triangle, and move the interpolated point into it.
    uint corner = 3u * (push.first_triangle + uint(gl_PrimitiveID));
    vec3 a_ws = positions[indices[corner]];
    vec3 edge0 = positions[indices[corner + 1u]] - a_ws;
    vec3 edge1 = positions[indices[corner + 2u]] - a_ws;
    vec3 n_ws = cross(edge0, edge1);
    float area = length(n_ws);
    vec3 to_eye = gn_ray_to_eye(u.view, in_position_ws);
    n_ws = area > 0.0 ? n_ws / area : normalize(to_eye);
    vec3 p_ws = in_position_ws - n_ws * dot(n_ws, in_position_ws - a_ws);
    n_ws = dot(n_ws, to_eye) < 0.0 ? -n_ws : n_ws;

    // Orient the shading normal likewise; where the mesh has none, the geometric one serves.
    vec3 shading_ws = dot(in_normal_ws, in_normal_ws) > 0.25 ? normalize(in_normal_ws) : n_ws;
    shading_ws = dot(shading_ws, n_ws) < 0.0 ? -shading_ws : shading_ws;
    out_position = vec4(p_ws, push.surface);
    out_normal = vec4(n_ws, dot(u.view.axis_ws, vec4(p_ws, 1.0)));
    out_shading_normal = vec4(shading_ws, 0.0);
    out_albedo = vec4(base_color.rgb, 1.0);
    out_material = vec4(push.roughness, push.metallic, float(push.object_id & 255u) / 255.0,
                        float((push.object_id >> 8) & 255u) / 255.0);
    out_emission = vec4(push.emissive, 0.0);
}
