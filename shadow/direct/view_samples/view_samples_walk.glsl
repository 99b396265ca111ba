// SPDX-License-Identifier: MIT
// What one triangle does in one tree of samples: it finds those that it may hide any of the light from, and takes away from each
// the points that it hides. A long walk is handed over, with where it stands, and shared out by subtrees (GN_REST).

// Drivers may end loops, all of an invocation's together after 65536 rounds, and go on behind them: those of eight that run in step
// stay below with this many each. What was cut is told all the same.
const uint most_rounds = 4000u;
uint rounds = 0u;
bool cut = false;

// Which points of a word are left of a line: `sure` holds no other, `maybe` leaves none out. [EASW09] section 5.3.3.2
struct Left {
    uint texel;
    uint none;     // all bits where the line leaves none of the light
    uint all;      // likewise all of it
    uint blurred;  // and where rounding keeps its texel from being asked
};
Left left_of(vec3 edge, vec3 origin_ws, vec3 centre_from_p) {
    GnLightLine line = gn_light_line(u.sampled, edge, centre_from_p);
    float rounding = gn_line_rounding(u.sampled, line, edge, origin_ws, centre_from_p);
    Left left;
    left.texel = uint(gn_left_texel(u.sampled, line, u.angles, u.offsets));
    left.none = line.offset < -line.reach - rounding ? ~0u : 0u;
    left.all = line.offset > line.reach + rounding ? ~0u : 0u;
    left.blurred = rounding > gn_left_blur ? ~0u : 0u;
    return left;
}
void intersect(Left left, uint word, inout uint sure, inout uint maybe) {
#ifdef GN_BRACKET
    uvec2 masks = left_map[word * u.texels + left.texel];
#else
    uvec2 masks = uvec2(left_map[word * u.texels + left.texel]);
#endif
    sure &= (left.all | (masks.x & ~left.blurred)) & ~left.none;
    maybe &= (left.all | masks.y | left.blurred) & ~left.none;
}

void ask(uint place, uint triangle, GnOccluder t, bool crosses) {
    uvec4 at = points[2u * place];
    vec3 p_ws = uintBitsToFloat(at.xyz);
    vec3 n_ws = uintBitsToFloat(points[2u * place + 1u].xyz);
    uint pattern = pattern_of(at.w);

    // The triangle's edges as lines across the light; inside is left of all three.
    GnOcclusion o = gn_occlusion(t, p_ws, n_ws);
    vec3 origin_ws = gn_ray_origin(p_ws, n_ws);
    vec3 centre_from_p = gn_towards(origin_ws, u.sampled.centre_ws);
    float side = o.height < 0.0 ? 1.0 : -1.0;
    Left ab = left_of(side * o.edges.ab, origin_ws, centre_from_p);
    Left bc = left_of(side * o.edges.bc, origin_ws, centre_from_p);
    Left ca = left_of(side * o.edges.ca, origin_ws, centre_from_p);

    uint word = 0u;
    for (; word < GN_WORDS; ++word) {
        // What is not hidden yet.
        uint open = o.hides ? ~hidden[place * GN_WORDS + word] : 0u;
        uint sure = open;
        uint maybe = open;
        intersect(ab, pattern * GN_WORDS + word, sure, maybe);
        intersect(bc, pattern * GN_WORDS + word, sure, maybe);
        intersect(ca, pattern * GN_WORDS + word, sure, maybe);

        // Points on both sides of the triangle's plane, and those near an edge, are asked one by one.
        sure = crosses ? 0u : sure;
        uint first = pattern * u.count + 32u * word;
        uint left = maybe & ~sure;
        rounds += 2u + uint(bitCount(left));
        for (; left != 0u; left &= left - 1u) {
            uint i = uint(findLSB(left));
            sure |= gn_in_the_way(o, t, origin_ws, light_points[first + i]) ? 1u << i : 0u;
        }
        cut = cut || left != 0u;
#if GN_MASKED
        left = sure;
        rounds += 1u + uint(bitCount(left));
        for (; left != 0u; left &= left - 1u) {
            uint i = uint(findLSB(left));
            vec3 shares = gn_hit_shares(o.edges, gn_towards(origin_ws, light_points[first + i]));
            sure &= gn_mask_solid(triangle, shares) ? ~0u : ~(1u << i);
        }
        cut = cut || left != 0u;
#endif
        if (sure != 0u) {
            atomicOr(hidden[place * GN_WORDS + word], sure);
        }
    }
    cut = cut || word < GN_WORDS;
#ifdef GN_COUNT_ASKED
    atomicAdd(asked[place], 1u);
#endif
}

GnHider hider_of(GnOccluder t) {
    return gn_hider(u.sampled_ls, gn_ls_from_ws(u.axes, t.a), gn_ls_from_ws(u.axes, t.b), gn_ls_from_ws(u.axes, t.c));
}

// From node `at` on; gives the node before which it stopped.
uint walk(uint triangle, GnOccluder t, GnHider hider, uint at, uint end, uint most) {
    bool crosses = hider.end_low <= 0.0 && hider.end_high >= 0.0;
    while (at < end && rounds < most) {
        uint held = 0u;
        while (held == 0u && at < end && rounds < most) {
            SampleNode node = nodes[at];
            bool may = gn_may_hide(u.sampled_ls, hider, node.low_ls, node.high_ls);
            held = may ? node.held : 0u;
            at = may ? at + 1u : node.behind;
            ++rounds;
        }
        if (held != 0u) {
            ask(held - 1u, triangle, t, crosses);
        }
    }
    cut = cut || (at < end && rounds < most);
    return at;
}

// The end of a tree's nodes that hold samples.
uint tree_end(uint tree) {
    uint each = 1u << (2u * GN_LEVELS);
    uint held = used > tree * each ? min(used - tree * each, each) : 0u;
    return tree * gn_tree_nodes(GN_LEVELS) + (held > 0u ? gn_tree_node(held - 1u, 0u, GN_LEVELS) + 1u : 0u);
}

layout(local_size_x = 64) in;
#if !defined(GN_REST)
layout(push_constant, scalar) uniform Push { uint first; uint count; int outward; } push;
void main() {
    uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
    if (i >= push.count) {
        return;
    }
    uint triangle = push.first + i;
    GnOccluder t = gn_occluder(triangle);
    GnHider hider = hider_of(t);

    // What shows the light its missing back, and a solid's face that all of the light sees, hides nothing that others do not.
    bool before = hider.end_low > 0.0;
    bool behind = hider.end_high < 0.0;
    bool spare = (push.outward > 0 && before) || (push.outward < 0 && behind) || (t.one_sided && behind);
    uint at = gl_WorkGroupID.z * gn_tree_nodes(GN_LEVELS);
    uint end = spare || hider.n == vec3(0.0) ? at : tree_end(gl_WorkGroupID.z);

    at = walk(triangle, t, hider, at, end, most_rounds);
    if (at < end && !cut) {
        uint slot = atomicAdd(rest_used, 1u);
        cut = slot >= u.rest_most;
        rest[min(slot, u.rest_most - 1u)] = uvec2(triangle, at);
    }
    if (cut) {
        atomicOr(was_cut, 1u);
    }
}
#else
// Each of 256 invocations walks a subtree of 16 samples, as far as the walk that was handed over had not been there.
void main() {
    uint i = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (i >= min(rest_used, u.rest_most)) {
        return;
    }
    uvec2 entry = rest[i];
    uint tree = entry.y / gn_tree_nodes(GN_LEVELS);
    uint first = (gl_WorkGroupID.z * 64u + gl_LocalInvocationIndex) * 16u;
    uint own = tree * gn_tree_nodes(GN_LEVELS) + gn_tree_node(first, 2u, GN_LEVELS);
    uint end = min(own + gn_tree_nodes(2u), tree_end(tree));
    GnOccluder t = gn_occluder(entry.x);
    walk(entry.x, t, hider_of(t), max(own, entry.y), end, ~0u);
    if (cut) {
        atomicOr(was_cut, 1u);
    }
}
#endif
