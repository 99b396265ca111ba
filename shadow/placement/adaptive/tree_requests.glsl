// SPDX-License-Identifier: MIT
// What every view sample asks for ([LSO07] 3.1): a column of pixels counts the tiles that it needs, runs of one tile at once.
layout(local_size_x = 64) in;

bool fetch(ivec2 pixel, out GnReceiver receiver) {
    vec4 position = gbuffer_position_texel(pixel);
    vec4 normal = gbuffer_normal_texel(pixel);
    if (position.w < 0.5 || !gn_counted(t.light, position.xyz, normal.xyz)) {
        return false;
    }
    receiver = gn_receiver(u.view, pixel, position, normal);
    return true;
}

GnAdaptivePlace place_of(int map, vec3 p_ws) {
    mat4 m = t.maps[map].cs_from_ws;
    return gn_adaptive_place(vec4(m[0].x, m[1].x, m[2].x, m[3].x), vec4(m[0].y, m[1].y, m[2].y, m[3].y),
                             vec4(m[0].w, m[1].w, m[2].w, m[3].w), p_ws);
}

// With rounds of refinement: down from where all begin while tiles changed.
int level_of(int map, vec2 uv, int wanted) {
#ifdef GN_TREE_REFINED
    int level = min(t.start, wanted);
    while (level < min(wanted, t.limit) &&
           int(changed[gn_adaptive_node(t.data.levels, map, level, gn_adaptive_cell(uv, level))]) > t.threshold) {
        ++level;
    }
    return level;
#else
    return wanted;
#endif
}

void main() {
    uint x = gl_GlobalInvocationID.x;
    uint y = gl_GlobalInvocationID.y * GN_TREE_ROWS;
    if (x >= t.size.x) {
        return;
    }
    int node = -1;
    uint run = 0u;
    uint samples = 0u;
    uint steep = 0u;
    for (uint end = min(y + GN_TREE_ROWS, t.size.y); y < end; ++y) {
        GnReceiver receiver;
        if (!fetch(ivec2(x, y) * t.step + t.step / 2, receiver)) {
            continue;
        }
        int map = gn_adaptive_map(t.data, receiver.p_ws);
        GnAdaptivePlace place = place_of(map, receiver.p_ws);
        int level = level_of(map, place.uv, gn_adaptive_wanted(t.data, receiver, place));
        int at = gn_adaptive_node(t.data.levels, map, level, gn_adaptive_cell(place.uv, level));
        if (at != node && run > 0u) {
            atomicAdd(own[node], run);
            run = 0u;
        }
        node = at;
        run += 1u;
        samples += 1u;
        float finest = t.data.texels * exp2(float(t.data.levels));
        steep += gn_undersampling(receiver, place.du_ws, place.dv_ws, 1.0) > finest ? 1u : 0u;
    }
    if (run > 0u) {
        atomicAdd(own[node], run);
        atomicAdd(c.samples, samples);
    }
    if (steep > 0u) {
        atomicAdd(c.steep, steep);
    }
}
