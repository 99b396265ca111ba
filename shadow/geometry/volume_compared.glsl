// SPDX-License-Identifier: MIT
// Based on: Everitt, Kilgard. Practical and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering. 2002. [EK02]
// A compared cap's vertex: of the near cap and of the far one, or on the near plane. What casts from both sides and shows its back
// is compared by its plane, turned to the eye: depths of two sheets are not exact enough near the edge that they share.
layout(constant_id = 3) const int LISTED_BEFORE = 0;
layout(constant_id = 4) const int ON_NEAR = 0;
layout(constant_id = 5) const int BEFORE = 0;
layout(location = 0) flat out int turned;
layout(location = 1) flat out vec3 to_eye_ws;
layout(location = 2) flat out vec3 corner_of_ws;
#ifdef GN_VOLUMES_RUNS
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[5]; };
#else
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[1]; };
#endif
invariant gl_Position;
void main() {
    uint corners = gn_volumes_has_far_cap(u.frame) ? 6u : 3u;
    uint slot = uint(gl_VertexIndex) / corners;
    uint corner = uint(gl_VertexIndex) % corners;
    uint cap = caps[LISTED_BEFORE != 0 ? u.frame.triangles - 1u - slot : u.frame.opaque_triangles + slot];
    uint t = cap >> 1;
    turned = int(cap & 1u);
    to_eye_ws = corner_of_ws = vec3(0.0);
    // The near cap keeps the order of the triangle's corners, the far cap is its mirror image at infinity.
    bool far = corner >= 3u;
    vec3 p_ws = positions[indices[3u * t + (far ? (6u - corner) % 3u : corner)]];
    vec4 corner_ws = far ? gn_volumes_extrude(p_ws, u.frame.light_ws, u.frame.reach) : vec4(p_ws, 1.0);
    vec4 corner_cs = gn_view_position(u.frame.cs_from_ws, corner_ws);
    if (ON_NEAR != 0) {
        vec4 light_cs = gn_view_position(u.frame.cs_from_ws, u.frame.light_ws);
        gl_Position = gn_volumes_on_near(corner_cs, light_cs);
        gl_ClipDistance[0] = far ? -1.0 : gn_volumes_before_near(corner_cs, light_cs);
        return;
    }
    gl_Position = corner_cs;
    gl_ClipDistance[0] = gn_volumes_beyond_near(gl_Position);
#ifdef GN_VOLUMES_RUNS
    vec4 within = gn_volumes_within_run(runs[owners[t] >> 3], u.picture, gl_Position);
    for (int i = 0; i < 4; ++i) {
        gl_ClipDistance[i + 1] = within[i];
    }
#endif
    // A triangle with one side lies before a sample only where it shows its back, which nobody sees, and one of an open sheet where
    // its back does not show: elsewhere both count as every opaque cap does.
    vec3 a_ws = positions[indices[3u * t]];
    vec3 b_ws = positions[indices[3u * t + 1u]];
    vec3 c_ws = positions[indices[3u * t + 2u]];
    if ((owners[t] & 4u) == 0u && gn_volumes_side(a_ws, b_ws, c_ws, u.frame.eye_ws) > 0) {
        gl_Position.z = 0.0;
    } else if ((owners[t] & 7u) == 1u && !far) {
        to_eye_ws = -normalize(cross(b_ws - a_ws, c_ws - a_ws));
        corner_of_ws = a_ws;
        gl_Position.z = BEFORE != 0 ? gl_Position.w : 0.0;
    }
}
