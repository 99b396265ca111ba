// SPDX-License-Identifier: MIT
// From the events of a texel to the nodes of its function. The body of a shader that has lists per texel, to add, the image
// `functions` and what counts where they have no room.
//
// Based on: St-Amour, Paquette, Poulin. Soft Shadows from Extended Light Sources with Penumbra Deep Shadow Maps. Graphics
// Interface 2005. [SPP05]
// Departs from it: the nodes of too long a function are found with twice the epsilon, and so on.

uint next_of(uint node) { return list_nodes[node - 1u].y; }

// A list of at most `length` nodes is cut off from what follows it, which is returned.
uint cut(uint node, uint length) {
    for (uint i = 1u; node != 0u && i < length; ++i) {
        node = next_of(node);
    }
    if (node == 0u) {
        return 0u;
    }
    uint rest = next_of(node);
    list_nodes[node - 1u].y = 0u;
    return rest;
}

// Sorts a list by its values, by merging runs of 1, 2, 4 ... nodes; returns its first node.
uint sorted(uint first) {
    for (uint length = 1u; first != 0u; length *= 2u) {
        uint rest = first, tail = 0u, merges = 0u;
        first = 0u;
        while (rest != 0u) {
            uint a = rest;
            uint b = cut(a, length);
            rest = cut(b, length);
            ++merges;
            while (a != 0u || b != 0u) {
                bool takes_a = b == 0u || (a != 0u && gn_list_value(a) <= gn_list_value(b));
                uint taken = takes_a ? a : b;
                a = takes_a ? next_of(a) : a;
                b = takes_a ? b : next_of(b);
                if (tail == 0u) {
                    first = taken;
                } else {
                    list_nodes[tail - 1u].y = taken;
                }
                tail = taken;
            }
        }
        if (tail != 0u) {
            list_nodes[tail - 1u].y = 0u;
        }
        if (merges <= 1u) {
            break;
        }
    }
    return first;
}

int written = 0;
vec2 last = vec2(0.0);

void write_node(ivec3 texel, vec2 node) {
    if (written < u.params.nodes) {
        imageStore(functions, ivec3(texel.xy, texel.z * u.params.nodes + written), vec4(node, 0.0, 0.0));
    }
    last = node;
    ++written;
}

// Lets the line go on to V at a depth; where it cannot, ends it where it is and begins another.
void pass(ivec3 texel, inout GnPenumbraLine line, vec2 at, float epsilon) {
    if (gn_penumbra_passes(line, at, epsilon)) {
        return;
    }
    vec2 end = gn_penumbra_end(line);
    if (line.passed > line.node.x) {
        write_node(texel, end);
        line = gn_penumbra_line(end);
        if (gn_penumbra_passes(line, at, epsilon)) {
            return;
        }
    }
    // A step: a line that has not gone any way passes whatever lies further on.
    write_node(texel, at);
    line = gn_penumbra_line(at);
}

// The function of sorted events within epsilon; counts the nodes that it takes.
void fit(ivec3 texel, uint first, float epsilon) {
    written = 0;
    float per_point = 1.0 / float(u.points);
    float seen = float(u.points);
    GnPenumbraLine line = gn_penumbra_line(vec2(0.0, 1.0));
    write_node(texel, line.node);
    uint node = first;
    while (node != 0u) {
        float depth = uintBitsToFloat(gn_list_value(node) & ~1u);
        pass(texel, line, vec2(depth, seen * per_point), epsilon);
        // All events of one depth are one step.
        while (node != 0u && uintBitsToFloat(gn_list_value(node) & ~1u) == depth) {
            seen += (gn_list_value(node) & 1u) != 0u ? 1.0 : -1.0;
            node = next_of(node);
        }
        pass(texel, line, vec2(depth, seen * per_point), epsilon);
    }
    pass(texel, line, vec2(1.0, seen * per_point), epsilon);
    write_node(texel, gn_penumbra_end(line));
}

layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel.xy, ivec2(u.list_size.xy)))) {
        return;
    }
    uint first = sorted(gn_list_first(texel));
    list_heads[gn_list_texel(texel)] = first;
    float epsilon = u.params.epsilon;
    fit(texel, first, epsilon);
    while (written > u.params.nodes && epsilon < 1.0) {
        epsilon = max(2.0 * epsilon, 1.0 / 256.0);
        fit(texel, first, epsilon);
    }
    if (epsilon > u.params.epsilon) {
        atomicAdd(wide_count, 1u);
        atomicMax(widest, floatBitsToUint(epsilon));
    }
    while (written < u.params.nodes) {
        write_node(texel, vec2(2.0, last.y));
    }
}
