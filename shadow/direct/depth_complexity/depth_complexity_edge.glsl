// SPDX-License-Identifier: MIT
// Based on: Laine, Aila, Assarsson, Lehtinen, Akenine-Moller. Soft Shadow Volumes for Ray Tracing. ACM TOG 2005. [LAAL05]
// What an edge does at a view sample: the body of a fragment of add_edge_regions. Silhouettes are those that the sample sees; the
// result is how many surfaces begin or end at the edge.
    GnSeenLight seen = gn_seen_light(u.light, p_ws);
    vec2 a;
    vec2 b;
    bool touches =
        gn_depth_edge(seen, u.light.kind == uint(GN_LIGHT_DIRECTIONAL), a_ws - p_ws, b_ws - p_ws, a, b);

    // Sum the triangles around it as the sample sees them. Loops, since a branch that is not taken costs as much here.
    int winding = 0;
    uint end = touches ? first[edge_index + 1u] : 0u;
    for (uint i = first[edge_index]; i < end; ++i) {
        uint t = around[i] >> 1;
        int m = gn_depth_multiplicity(positions[indices[3u * t]], positions[indices[3u * t + 1u]],
                                      positions[indices[3u * t + 2u]], owners[t], forms[owners[t] >> 3], p_ws, n_ws);
        winding += (around[i] & 1u) != 0u ? -m : m;
    }
    winding *= gn_depth_turn(seen);
    result = float(abs(winding));

    // Add to the counters of all points, a word at a time; the references stand behind the points.
    vec2 reference0 = gn_on_light(seen, gn_towards(p_ws, u.reference0_ws));
    vec2 reference1 = gn_on_light(seen, gn_towards(p_ws, u.reference1_ws));
    vec2 reference2 = gn_on_light(seen, gn_towards(p_ws, u.reference2_ws));
    uint word = uint(pixel.y * u.width + pixel.x) * u.words;
    uint words = winding != 0 ? u.words : 0u;
    for (uint w = 0u; w < words; ++w) {
        uint packed = 0u;
        for (uint field = 0u; field < GN_DEPTH_FIELDS; ++field) {
            uint i = w * GN_DEPTH_FIELDS + field;
            vec2 q = i < u.samples        ? points[i].xy
                     : i == u.samples      ? reference0
                     : i == u.samples + 1u ? reference1
                                           : reference2;
            packed += gn_depth_packed(winding * gn_depth_crossings(a, b, q), field, GN_DEPTH_BITS);
        }
        if (packed != 0u) {
            atomicAdd(counters[word + w], packed);
        }
    }
