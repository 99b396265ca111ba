// SPDX-License-Identifier: MIT
// Based on: Everitt, Kilgard. Practical and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering. 2002. [EK02]
// A side of a volume, or with STRIP its beginning at the edge that it hangs from; of those that count behind the sample, or
// with LISTED_BEFORE before it. The shader clips at the near plane itself: depth clamping, which keeps what lies beyond the far plane,
// turns the fixed clipping off.
layout(constant_id = 0) const int STRIP = 0;
layout(constant_id = 3) const int LISTED_BEFORE = 0;
layout(location = 0) flat out vec3 a_ws;
layout(location = 1) flat out vec3 b_ws;
#ifdef GN_VOLUMES_RUNS
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[5]; };
#else
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[1]; };
#endif
invariant gl_Position;

vec4 end_ws(vec3 p_ws, bool far, uint plane) {
    if (!far) {
        return vec4(p_ws, 1.0);
    }
    if (STRIP == 0 && plane != 0u) {
        return gn_volumes_clamped(u.frame, p_ws, plane);
    }
    return STRIP != 0 ? gn_volumes_strip(u.frame, p_ws, gn_volumes_away(p_ws, u.frame.light_ws))
                      : gn_volumes_extrude(p_ws, u.frame.light_ws, u.frame.reach);
}

// Where a side passes through the near plane along both its rays, it ends there in the very corners of the cap that closes
// its volume: clipping would round them otherwise, and leave cracks. [HHLH05] section 4
bool ends_at_near(bool far, uint plane) {
    vec4 light_cs = gn_view_position(u.frame.cs_from_ws, u.frame.light_ws);
    bool through = true;
    for (int i = 0; i < 2; ++i) {
        vec3 p_ws = i == 0 ? a_ws : b_ws;
        float here = gn_volumes_beyond_near(gn_view_position(u.frame.cs_from_ws, end_ws(p_ws, far, plane)));
        float there = gn_volumes_beyond_near(gn_view_position(u.frame.cs_from_ws, end_ws(p_ws, !far, plane)));
        through = through && here < 0.0 && there > 0.0;
    }
    return through;
}

void main() {
    // From outside the side is a, a at infinity, b at infinity, b; where both points at infinity are one, its first
    // triangle is nothing.
    uint corners = STRIP != 0 ? 6u : gn_volumes_corners(u.frame);
    uint slot = uint(gl_VertexIndex) / corners;
    uint side = sides[LISTED_BEFORE != 0 ? u.frame.most_sides - 1u - slot : slot];
    uint plane = side >> GN_VOLUMES_SIDE_BITS;
    side &= (1u << GN_VOLUMES_SIDE_BITS) - 1u;
    uint corner = uint(gl_VertexIndex) % corners + 6u - corners;
    uvec2 edge = edges[side >> 1];
    a_ws = positions[edge.x];
    b_ws = positions[edge.y];
    bool turned = (side & 1u) != 0u;
    bool second = corner == 2u || corner >= 4u;
    bool far = corner == 1u || corner == 2u || corner == 4u;
    vec3 p_ws = second != turned ? b_ws : a_ws;
    gl_Position = gn_view_position(u.frame.cs_from_ws, end_ws(p_ws, far, plane));
    if (STRIP == 0 && u.frame.capped != 0 && ends_at_near(far, plane)) {
        gl_Position = gn_volumes_on_near(gn_view_position(u.frame.cs_from_ws, vec4(p_ws, 1.0)),
                                         gn_view_position(u.frame.cs_from_ws, u.frame.light_ws));
    }
    gl_ClipDistance[0] = gn_volumes_beyond_near(gl_Position);
#ifdef GN_VOLUMES_RUNS
    uint component = owners[around[first[side >> 1]] >> 1] >> 3;
    vec4 within = gn_volumes_within_run(runs[component], u.picture, gl_Position);
    for (int i = 0; i < 4; ++i) {
        gl_ClipDistance[i + 1] = within[i];
    }
#endif
}
