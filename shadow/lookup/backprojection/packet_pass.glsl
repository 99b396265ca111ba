// SPDX-License-Identifier: MIT
// The lookup pass of packets, the body of a shader that has what passes over view samples have, `packets.glsl`, the side of a packet
// GN_BACK_SIDE, the list MAPS of what the lookup reads, and an image `visibility`.
layout(local_size_x = 8, local_size_y = 8) in;

float seen_in(GnReceiver receiver, int index) {
    GnLightView view = known_view(index);
    GnBias bias = known_bias();
    GnLookup at = GnLookup(receiver, gn_project(receiver, view, bias), bias, u.light, view);
    return at.projected.inside ? gn_backprojection_visibility(at, MAPS, u.lookup_params) : 1.0;
}

float seen_alone(GnReceiver receiver) {
    GnChoice choice = GN_CHOOSE(receiver, placement);
    float v = seen_in(receiver, choice.first);
    if (choice.second >= 0 && choice.weight > 0.0) {
        v = mix(v, seen_in(receiver, choice.second), choice.weight);
    }
    return gn_unit(v);
}

void store(ivec2 first, int i, float v) {
    ivec2 pixel = first + ivec2(i % GN_BACK_SIDE, i / GN_BACK_SIDE);
    if (all(lessThan(pixel, ivec2(u.view.size.xy)))) {
        imageStore(visibility, pixel, vec4(gn_unit(v)));
    }
}

void main() {
    ivec2 first = GN_BACK_SIDE * ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ivec2(u.view.size.xy);
    if (any(greaterThanEqual(first, size))) {
        return;
    }

    // Read the packet's samples: together are those that one view serves alone.
    GnBackPacket packet;
    packet.first.bias = known_bias();
    packet.first.light = u.light;
    int index = -1;
    bool together = true;
    for (int i = 0; i < GN_BACK_PACKET; ++i) {
        ivec2 pixel = first + ivec2(i % GN_BACK_SIDE, i / GN_BACK_SIDE);
        GnReceiver receiver;
        bool counted = all(lessThan(pixel, size)) && read_sample(pixel, receiver);
        packet.counted[i] = counted;
        if (counted) {
            GnChoice choice = GN_CHOOSE(receiver, placement);
            together = together && (index < 0 || index == choice.first) && (choice.second < 0 || choice.weight <= 0.0);
            packet.receiver[i] = receiver;
            packet.first.receiver = receiver;
            index = choice.first;
        }
    }
    float v[GN_BACK_PACKET];
    for (int i = 0; i < GN_BACK_PACKET; ++i) {
        v[i] = 0.0;
    }
    if (index >= 0 && together) {
        packet.first.view = known_view(index);
        packet.first.projected = gn_project(packet.first.receiver, packet.first.view, packet.first.bias);
        for (int i = 0; i < GN_BACK_PACKET; ++i) {
            if (!packet.counted[i]) {
                packet.receiver[i] = packet.first.receiver;
            }
            packet.projected[i] = gn_project(packet.receiver[i], packet.first.view, packet.first.bias);
            together = together && packet.projected[i].inside;
        }
        together = together && gn_back_packet(packet, MAPS, u.lookup_params, v);
    }

    if (together) {
        for (int i = 0; i < GN_BACK_PACKET; ++i) {
            store(first, i, packet.counted[i] ? v[i] : 0.0);
        }
        return;
    }
    // A number that no compiler knows, so that it writes the lookup out once.
    for (int i = 0; i < u.lookup_params.packet * u.lookup_params.packet; ++i) {
        ivec2 pixel = first + ivec2(i % GN_BACK_SIDE, i / GN_BACK_SIDE);
        GnReceiver receiver;
        bool counted = all(lessThan(pixel, size)) && read_sample(pixel, receiver);
        store(first, i, counted ? seen_alone(receiver) : 0.0);
    }
}
