// SPDX-License-Identifier: MIT
// Based on: Laine, Aila, Assarsson, Lehtinen, Akenine-Moller. Soft Shadow Volumes for Ray Tracing. ACM TOG 2005. [LAAL05]
// Based on: Forest, Barthe, Paulin. Accurate Shadows by Depth Complexity Sampling. CGF 2008. [FBP08]
// Counters become numbers of surfaces before the light's points, and these V: a pass over all samples.
layout(local_size_x = 8, local_size_y = 8) in;

int counter_of(uint word, uint i) {
    return gn_depth_unpacked(counters[word + i / GN_DEPTH_FIELDS], i % GN_DEPTH_FIELDS, GN_DEPTH_BITS);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(visibility)))) {
        return;
    }
    vec4 at = gbuffer_position_texel(pixel);
    vec3 p_ws = at.xyz;
    vec3 n_ws = gbuffer_normal_texel(pixel).xyz;
    GN_V v = GN_V(0.0);
    int most = 0;
    if (at.w > 0.5 && gn_counted(u.whole, p_ws, n_ws)) {
        GnSeenLight seen = gn_seen_light(u.light, p_ws);
        vec3 x_ws = seen.x_ws / dot(seen.x_ws, seen.x_ws);
        vec3 y_ws = seen.y_ws / dot(seen.y_ws, seen.y_ws);

        // Find the constant by the volumes of the references that hold the sample. Below its surface's horizon, where its own edges
        // end, counters are no numbers of surfaces.
        uint word = uint(pixel.y * imageSize(visibility).x + pixel.x) * u.words;
        int least = 1 << 30;
        for (uint i = 0u; i < u.samples; ++i) {
            bool above = dot(n_ws, seen.centre_ws + x_ws * points[i].x + y_ws * points[i].y) > 0.0;
            least = above ? min(least, counter_of(word, i)) : least;
        }
        vec3 heights = vec3(dot(n_ws, gn_towards(p_ws, u.reference0_ws)), dot(n_ws, gn_towards(p_ws, u.reference1_ws)),
                            dot(n_ws, gn_towards(p_ws, u.reference2_ws)));
        int constant = gn_depth_constant(gn_depth_heard(GN_DEPTH_VOTES, heights), least);

        // The points with nothing before them, above the surface, are seen, and weigh what they send.
        bool sun = u.light.kind == uint(GN_LIGHT_DIRECTIONAL);
        GN_V lit = GN_V(0.0);
        GN_V sends = GN_V(0.0);
        for (uint i = 0u; i < u.samples; ++i) {
            int count = counter_of(word, i) + constant;
            most = max(most, count);
            vec3 to_point_ws = seen.centre_ws + x_ws * points[i].x + y_ws * points[i].y;
            vec4 point_ws = sun ? vec4(to_point_ws, 0.0) : vec4(p_ws + to_point_ws, 1.0);
            bool seen_point = count <= 0 && dot(n_ws, to_point_ws) > 0.0;
            sends += GN_SENT(i);
            lit += seen_point && !GN_DEPTH_MASKED(point_ws) ? GN_V(GN_SENT(i)) : GN_V(0.0);
        }
        v = lit / sends;
        vec4 centre_ws = sun ? vec4(seen.centre_ws, 0.0) : vec4(p_ws + seen.centre_ws, 1.0);
        v = GN_DEPTH_MASKED_CENTRE(centre_ws) ? GN_V(0.0) : v;

        // Counters that more edges touched than they hold may have wrapped.
        float edges = edges_texel(pixel).r;
        if (edges > u.limit) {
            atomicAdd(crowded_samples, 1u);
            atomicMax(crowded_edges, uint(edges));
        }
    }
    imageStore(visibility, pixel, GN_V_TEXEL(v));
    GN_DEPTH_TELL
}
