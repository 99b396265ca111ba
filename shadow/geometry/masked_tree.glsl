// SPDX-License-Identifier: MIT
// A ray through the tree of masked casters: whether it meets one of their triangles where that is there.
float masked_texel(MaskedMaterial material, ivec2 at) {
    ivec2 size = ivec2(material.width, material.height);
    ivec2 wrapped = ivec2((material.ways & 1u) != 0u ? (at.x % size.x + size.x) % size.x : clamp(at.x, 0, size.x - 1),
                          (material.ways & 2u) != 0u ? (at.y % size.y + size.y) % size.y : clamp(at.y, 0, size.y - 1));
    uint i = material.first + uint(wrapped.y) * material.width + uint(wrapped.x);
    return float((masked_texels[i >> 2] >> (8u * (i & 3u))) & 255u) / 255.0;
}

// As the truth reads it: the finest level, weighted in floats, where a sampler weighs in steps of 1 / 256.
float masked_alpha(MaskedMaterial material, vec2 uv) {
    uv = vec2((material.ways & 1u) != 0u ? uv.x - floor(uv.x) : clamp(uv.x, 0.0, 1.0),
              (material.ways & 2u) != 0u ? uv.y - floor(uv.y) : clamp(uv.y, 0.0, 1.0));
    vec2 p = uv * vec2(material.width, material.height) - 0.5;
    ivec2 base = ivec2(floor(p));
    vec2 f = p - floor(p);
    return mix(mix(masked_texel(material, base), masked_texel(material, base + ivec2(1, 0)), f.x),
               mix(masked_texel(material, base + ivec2(0, 1)), masked_texel(material, base + ivec2(1, 1)), f.x), f.y);
}

bool masked_triangle_hides(uvec2 item, vec3 p_ws, vec3 n_ws, vec4 light_ws) {
    uvec3 corners = uvec3(indices[3u * item.x], indices[3u * item.x + 1u], indices[3u * item.x + 2u]);
    vec3 a_ws = positions[corners.x], b_ws = positions[corners.y], c_ws = positions[corners.z];
    if (gn_triangle_missed(p_ws, light_ws, a_ws, b_ws, c_ws)) {
        return false;
    }
    // A sample's own surface never hides it, nor what shows the light its missing back.
    vec4 hit = gn_triangle_hit(p_ws, light_ws, a_ws, b_ws, c_ws);
    MaskedMaterial material = masked_materials[item.y];
    if (hit.w == 0.0 || gn_triangle_own(p_ws, n_ws, a_ws, b_ws, c_ws) ||
        ((material.ways & 4u) != 0u && gn_volumes_side(a_ws, b_ws, c_ws, light_ws) < 0)) {
        return false;
    }
    uvec3 worn = min(corners, uvec3(colors.length() - 1));
    float alpha = material.base_alpha * dot(hit.xyz, vec3(colors[worn.x].a, colors[worn.y].a, colors[worn.z].a)) *
                  masked_alpha(material, hit.x * uvs[corners.x] + hit.y * uvs[corners.y] + hit.z * uvs[corners.z]);
    return alpha >= material.cutoff;
}

bool masked_hides(vec3 p_ws, vec3 n_ws, vec4 light_ws) {
    // A ray along an axis has slabs that it never meets or never leaves.
    vec3 way = light_ws.xyz - p_ws * light_ws.w;
    vec3 each = 1.0 / mix(way, vec3(1.0e-30), equal(way, vec3(0.0)));
    float end = light_ws.w > 0.0 ? 1.00001 : 1.0e30;
    uint at = 0u, nodes = masked_nodes[0].behind;
    while (at < nodes) {
        MaskedNode node = masked_nodes[at];
        vec3 a = (node.low_ws - p_ws) * each, b = (node.high_ws - p_ws) * each;
        vec3 enter = min(a, b), leave = max(a, b);
        if (max(max(enter.x, enter.y), max(enter.z, 0.0)) > min(min(leave.x, leave.y), min(leave.z, end))) {
            at = node.behind;
            continue;
        }
        uint first = node.held >> 3, count = node.held & 7u;
        for (uint i = 0u; i < count; ++i) {
            if (masked_triangle_hides(masked_items[first + i], p_ws, n_ws, light_ws)) {
                return true;
            }
        }
        ++at;
    }
    return false;
}
