// SPDX-License-Identifier: MIT
// Receivers beside each other, taken together: one search for all of them, and of outlines one extraction, as long as all find the
// same ones.
// Based on: Yang, Feng, Guennebaud, Liu. Packet-based Hierarchal Soft Shadow Mapping. EGSR 2009. [YFGL09]
// Departs from it: where some differ, all are looked up one by one by the same invocation.
#ifndef GN_SHADOW_BACKPROJECTION_PACKETS_GLSL
#define GN_SHADOW_BACKPROJECTION_PACKETS_GLSL

#include "shadow/lookup/backprojection/backprojection.glsl"

#ifndef __cplusplus

// What a host fixes when it compiles: the receivers of a packet.
//   #define GN_BACK_PACKET 4
#ifndef GN_BACK_PACKET
#define GN_BACK_PACKET 4
#endif

// They share view, bias and light. What does not count is not looked at.
struct GnBackPacket {
    GnReceiver receiver[GN_BACK_PACKET];
    GnProjected projected[GN_BACK_PACKET];
    bool counted[GN_BACK_PACKET];
    GnLookup first;  // of one that counts
};

GnLookup gn_back_one(GnBackPacket packet, int i) {
    return GnLookup(packet.receiver[i], packet.projected[i], packet.first.bias, packet.first.light, packet.first.view);
}

// The area that the pyramids of all of them cover.
vec4 gn_back_packet_area(GnBackPacket packet, GnBackLight lights[GN_BACK_PACKET], float nearest) {
    vec4 area_ts = vec4(1.0e9, 1.0e9, -1.0e9, -1.0e9);
    for (int i = 0; i < GN_BACK_PACKET; ++i) {
        if (packet.counted[i]) {
            vec4 one_ts = gn_back_area(packet.first.view, packet.first.projected.bounds_ts, lights[i], nearest);
            area_ts = vec4(min(area_ts.xy, one_ts.xy), max(area_ts.zw, one_ts.zw));
        }
    }
    return area_ts;
}

// What gn_back_class says of all of them alike, else -1.
float gn_back_packet_class(GnBackPacket packet, GnBackRays rays[GN_BACK_PACKET], GnBackSearch search, vec2 range,
                           GnBackprojectionParams params) {
    bool lit = true;
    bool dark = true;
    for (int i = 0; i < GN_BACK_PACKET; ++i) {
        if (packet.counted[i]) {
            float found = gn_back_class(gn_back_one(packet, i), rays[i], search, range, params);
            lit = lit && found == 1.0;
            dark = dark && found == 0.0;
        }
    }
    return lit ? 1.0 : dark ? 0.0 : -1.0;
}

// Where something can hide the light from any of them, and whether all see all of it or none: gn_back_search of all at once.
GnBackSearch gn_back_packet_search(GnBackPacket packet, GN_BACK_MAPS, GnBackLight lights[GN_BACK_PACKET],
                                   GnBackRays rays[GN_BACK_PACKET], GnBackprojectionParams params) {
    GnBackSearch result = gn_back_unsearched();
    for (int step = 0; step <= params.refine; ++step) {
        result = gn_back_within(result, packet.first, gn_back_packet_area(packet, lights, result.nearest), params);
        if (GN_BACK_PYRAMID == GN_BACK_NONE) {
            break;
        }
        vec2 range = gn_back_range(GN_BACK_THESE, result.held, packet.first.projected.layer, params);
        result.visibility = params.early_out != 0 ? gn_back_packet_class(packet, rays, result, range, params) : -1.0;
        if (result.visibility >= 0.0) {
            break;
        }
        result.nearest = max(range.x, result.nearest);
    }
    return result;
}

// A texel of the map as all of them read it.
struct GnBackAgreed {
    float depth;
    bool hides;
};

GnBackAgreed gn_back_agreed(GnBackPacket packet, GN_BACK_MAPS, GnBackMap map, GnBackRays rays[GN_BACK_PACKET], ivec2 texel,
                            GnBackprojectionParams params, inout bool same) {
    GnBackAgreed none = GnBackAgreed(0.0, false);
    if (any(lessThan(texel, map.texels.xy)) || any(greaterThan(texel, map.texels.zw))) {
        return none;
    }
    ivec2 held = clamp(texel, map.view.xy, map.view.zw);
    float found = gn_back_depth(packet.first, GN_BACK_THESE, map, held, 0.0, params);
    vec2 held_ts = gn_back_corner_ts(packet.first, map, vec2(held) + 0.5);
    vec2 texel_ts = gn_back_corner_ts(packet.first, map, vec2(texel) + 0.5);
    int counted = 0;
    int hides = 0;
    for (int i = 0; i < GN_BACK_PACKET; ++i) {
        if (packet.counted[i]) {
            float plane = gn_back_plane(gn_back_one(packet, i), held_ts, float((1 << map.level) - 1), params);
            ++counted;
            hides += int(found < plane && gn_back_between(rays[i], gn_back_point(rays[i], texel_ts, found)));
        }
    }
    same = same && (hides == 0 || hides == counted);
    return GnBackAgreed(found, hides > 0);
}

// Outlines found once, whose edges are projected for each. `same` ends false where some find others.
void gn_back_packet_contours(inout GnBackCover covers[GN_BACK_PACKET], GnBackPacket packet, GN_BACK_MAPS, GnBackMap map,
                             GnBackRays rays[GN_BACK_PACKET], GnBackprojectionParams params, inout bool same) {
    for (int y = map.texels.y - 1; y <= map.texels.w && same; ++y) {
        GnBackAgreed a = gn_back_agreed(packet, GN_BACK_THESE, map, rays, ivec2(map.texels.x - 1, y), params, same);
        GnBackAgreed b = a;
        for (int x = map.texels.x; x <= map.texels.z + 1 && same; ++x) {
            GnBackAgreed d = gn_back_agreed(packet, GN_BACK_THESE, map, rays, ivec2(x, y), params, same);
            GnBackAgreed c = gn_back_agreed(packet, GN_BACK_THESE, map, rays, ivec2(x, y + 1), params, same);
            uint segments = gn_back_segments(int(a.hides) + 2 * int(d.hides) + 4 * int(c.hides) + 8 * int(b.hides));
            for (int i = 0; i < (segments != 0u && same ? GN_BACK_PACKET : 0); ++i) {
                if (packet.counted[i]) {
                    GnBackMap one = map;
                    one.rays = rays[i];
                    vec2 sides[4];
                    sides[0] = gn_back_corner(packet.first, one, vec2(x, float(y) + 0.5), a.hides ? a.depth : d.depth);
                    sides[1] = gn_back_corner(packet.first, one, vec2(float(x) + 0.5, y + 1), d.hides ? d.depth : c.depth);
                    sides[2] = gn_back_corner(packet.first, one, vec2(x, float(y) + 1.5), c.hides ? c.depth : b.depth);
                    sides[3] = gn_back_corner(packet.first, one, vec2(float(x) - 0.5, y + 1), b.hides ? b.depth : a.depth);
                    vec2 to = sides[segments >> 2 & 3u];
                    bool two = (segments >> 8) > 1u;
                    covers[i] = gn_back_outline(covers[i], sides[segments & 3u], to, two ? sides[segments >> 4 & 3u] : to,
                                                two ? sides[segments >> 6 & 3u] : to, GN_BACK_COMBINE == GN_BACK_BITMASK,
                                                map.disc);
                }
            }
            a = d;
            b = c;
        }
    }
}

// V of each by outlines of one level, added to `v` with a weight.
void gn_back_packet_level(inout float v[GN_BACK_PACKET], GnBackPacket packet, GN_BACK_MAPS, GnBackSearch search, int level,
                          float weight, GnBackRays rays[GN_BACK_PACKET], bool disc, GnBackprojectionParams params,
                          inout bool same) {
    ivec4 view = gn_back_view_texels(packet.first.projected.bounds_ts, packet.first.projected.texel_ts);
    GnBackMap map;
    map.rays = rays[0];
    map.texels = gn_back_at_level(search.texels, view, level);
    map.view = view >> level;
    map.level = level;
    map.peeled = 0;
    map.disc = disc;
    GnBackCover covers[GN_BACK_PACKET];
    for (int i = 0; i < GN_BACK_PACKET; ++i) {
        covers[i] = gn_back_nothing();
    }
    gn_back_packet_contours(covers, packet, GN_BACK_THESE, map, rays, params, same);
    for (int i = 0; i < GN_BACK_PACKET; ++i) {
        covers[i].area = abs(covers[i].area);
        v[i] += weight * (1.0 - gn_back_hidden(covers[i], GN_BACK_COMBINE == GN_BACK_BITMASK, disc));
    }
}

// V of all; false where they must be looked up one by one.
bool gn_back_packet(GnBackPacket packet, GN_BACK_MAPS, GnBackprojectionParams params, out float v[GN_BACK_PACKET]) {
    GnBackLight lights[GN_BACK_PACKET];
    GnBackRays rays[GN_BACK_PACKET];
    for (int i = 0; i < GN_BACK_PACKET; ++i) {
        lights[i] = gn_back_light(packet.first.light, packet.receiver[i].p_ws);
        rays[i] = gn_back_rays(packet.first.view, lights[i]);
        v[i] = 0.0;
    }
    GnBackSearch search = gn_back_packet_search(packet, GN_BACK_THESE, lights, rays, params);
    if (search.visibility >= 0.0) {
        for (int i = 0; i < GN_BACK_PACKET; ++i) {
            v[i] = search.visibility;
        }
        return true;
    }
    if (!search.whole && gn_back_views_end) {
        return false;
    }
    float coarseness = gn_back_coarseness(search, params);
    int level = int(params.blend != 0 ? floor(coarseness) : ceil(coarseness));
    float between = coarseness - float(level);
    bool same = true;
    for (int end = 0; end <= (between > 0.0 ? 1 : 0) && same; ++end) {
        gn_back_packet_level(v, packet, GN_BACK_THESE, search, level + end, end == 0 ? 1.0 - max(between, 0.0) : between, rays,
                             lights[0].disc, params, same);
    }
    return same;
}
#endif

#endif
