// SPDX-License-Identifier: MIT
// Based on: Chan, Durand. Rendering Fake Soft Shadows with Smoothies. EGSR 2003. [CD03]
// A fin on a silhouette edge, outwards as a light view sees it: the vertex shader of what is evaluated on it.
layout(push_constant) uniform Push { int index; };
layout(location = 0) out vec3 p_ws;
layout(location = 1) flat out vec3 a_ws;
layout(location = 2) flat out vec3 b_ws;
layout(location = 3) flat out float unit_ws;  // the light's half width along the fin; of a sun its tangent

void main() {
    uint side = sides[uint(gl_VertexIndex) / 6u];
    uint corner = uint(gl_VertexIndex) % 6u;
    corner = corner < 3u ? corner : corner == 3u ? 2u : corner == 4u ? 1u : 3u;
    uvec2 edge = edges[side >> 1];
    bool turned = (side & 1u) != 0u;
    a_ws = positions[turned ? edge.y : edge.x];
    b_ws = positions[turned ? edge.x : edge.y];
    // Out of the hard shadow's side: as gn_lit_side says.
    vec3 along_ws = normalize(b_ws - a_ws);
    vec3 away_ws = a_ws * u.light_ws.w - u.light_ws.xyz;
    vec3 out_ws = cross(away_ws, along_ws);
    float size = length(out_ws);
    out_ws = size > 0.0 ? out_ws / size : vec3(0.0);
    unit_ws = length(u.round_ws) > 0.0 ? u.round_ws.x
                                       : abs(dot(out_ws, u.x_ws.xyz)) + abs(dot(out_ws, u.y_ws.xyz));
    // Of a lamp fins are as wide as the light, of a sun as its penumbra at the end of what the view sees.
    float reach = unit_ws * (u.light_ws.w > 0.0 ? 1.0 : views[index].metres_per_depth);
    // Inwards by a texel: where a fin only meets the caster, the rasterizer leaves texels to neither.
    vec4 edge_cs = gn_clip(views[index], a_ws);
    vec4 end_cs = gn_clip(views[index], a_ws + out_ws * reach);
    vec2 fin_ts = (end_cs.xy / end_cs.w - edge_cs.xy / edge_cs.w) * 0.5 * views[index].rect_ts.zw;
    float inwards = edge_cs.w > 0.0 && end_cs.w > 0.0 ? min(1.0 / (views[index].resolution * max(length(fin_ts), 1.0e-30)), 1.0) : 0.0;
    p_ws = ((corner & 1u) != 0u ? b_ws + along_ws * reach : a_ws - along_ws * reach) +
           ((corner & 2u) != 0u ? out_ws * reach : -out_ws * (reach * inwards));
    gl_Position = gn_clip(views[index], p_ws);
    gl_Position.z = 0.5 * gl_Position.w;
}
