// SPDX-License-Identifier: MIT
// Based on: Everitt, Kilgard. Practical and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering. 2002. [EK02]
// Based on: Kim, Kim, Turk. A Shadow-Volume Algorithm for Opaque and Transparent Nonmanifold Casters. JGT 2008. [KKJ08]
//
// The formulas of the volumes; they compile as GLSL and as C++. Define GN_VOLUMES_DOUBLE where shaders have 64-bit floats.
#ifndef GN_SHADOW_GEOMETRY_VOLUMES_GLSL
#define GN_SHADOW_GEOMETRY_VOLUMES_GLSL

#include "shadow/geometry/volumes.h"

// A host whose device has doubles may ask for them:
//   #define GN_VOLUMES_DOUBLE
#ifdef __cplusplus
using glm::abs;
#define GN_VOLUMES_VEC3 glm::dvec3
#define GN_VOLUMES_REAL double
#elif defined(GN_VOLUMES_DOUBLE)
#define GN_VOLUMES_VEC3 dvec3
#define GN_VOLUMES_REAL double
#else
#define GN_VOLUMES_VEC3 vec3
#define GN_VOLUMES_REAL float
#endif

// On which side of the triangle's plane the light is: 1 before its front (counter-clockwise), -1 behind, 0 in the plane.
// With 64 bits the differences of the coordinates are exact and the sign errs only where the light is in the plane.
GN_FN int gn_volumes_side(vec3 a_ws, vec3 b_ws, vec3 c_ws, vec4 light_ws) {
    vec3 l_ws = vec3(light_ws);
    if (light_ws.w > 0.0f && (l_ws == a_ws || l_ws == b_ws || l_ws == c_ws)) {
        return 0;
    }
    GN_VOLUMES_VEC3 a = GN_VOLUMES_VEC3(a_ws);
    GN_VOLUMES_VEC3 n = cross(GN_VOLUMES_VEC3(b_ws) - a, GN_VOLUMES_VEC3(c_ws) - a);
    GN_VOLUMES_VEC3 to_light = GN_VOLUMES_VEC3(l_ws) - a * GN_VOLUMES_REAL(light_ws.w);
    GN_VOLUMES_REAL height = dot(n, to_light);
    return height > GN_VOLUMES_REAL(0) ? 1 : (height < GN_VOLUMES_REAL(0) ? -1 : 0);
}

// How often the triangle bounds the volume: 1 as wound, -1 turned over, 0 not at all. Turned so, it faces the light.
GN_FN int gn_volumes_multiplicity(int side, int form) {
    if (form == GN_VOLUMES_ANY) {
        return side;
    }
    if (form == GN_VOLUMES_FRONT) {
        return side > 0 ? 1 : 0;
    }
    return form == GN_VOLUMES_BACK && side < 0 ? -1 : 0;
}

// A multiplicity with the side of the samples on which its volume counts, for the pass that lists sides.
GN_FN int gn_volumes_packed(int m, bool before) {
    return m != 0 && before ? m + 4 : m;
}
GN_FN int gn_volumes_unpacked(int packed) {
    return packed > 1 ? packed - 4 : packed;
}

// The way that light takes at a point.
GN_FN vec3 gn_volumes_away(vec3 p_ws, vec4 light_ws) {
    return p_ws * light_ws.w - vec3(light_ws);
}

// How much farther than the caster volumes reach from a point light where they end.
const float gn_volumes_growth = 1048576.0f;

// Where the light pushes a point to: infinitely far away, a direction with w = 0. [EK02] section 3.2
// Departs from it: an orthographic camera shows no such point, and one that looks along the light would see no side of a
// volume and nowhere its end. There volumes end beyond all that is seen, a sun's after `reach` metres.
GN_FN vec4 gn_volumes_extrude(vec3 p_ws, vec4 light_ws, float reach) {
    vec3 away_ws = gn_volumes_away(p_ws, light_ws);
    if (reach <= 0.0f) {
        return vec4(away_ws, 0.0f);
    }
    return light_ws.w > 0.0f ? vec4(away_ws + vec3(light_ws) / gn_volumes_growth, 1.0f / gn_volumes_growth)
                             : vec4(p_ws + away_ws * reach, 1.0f);
}

// Whether volumes have a cap at their far end: those of a sun meet in one point at infinity.
GN_FN bool gn_volumes_has_far_cap(GnVolumesFrame frame) {
    return frame.light_ws.w > 0.0f || frame.reach > 0.0f;
}

// Where the near plane lies, in clip space: 0 in it, positive beyond it.
GN_FN float gn_volumes_beyond_near(vec4 p_cs) {
    return p_cs.w - p_cs.z;
}

// Where the light throws a point's shadow on the near plane: the line through both meets the plane there. Its w is positive
// where the point lies between light and plane, up to the side (gn_volumes_before_near). [HHLH05] section 3
GN_FN vec4 gn_volumes_on_near(vec4 p_cs, vec4 light_cs) {
    float p = gn_volumes_beyond_near(p_cs), l = gn_volumes_beyond_near(light_cs);
    vec4 q_cs = l < 0.0f ? light_cs * p - p_cs * l : p_cs * l - light_cs * p;
    return vec4(q_cs.x, q_cs.y, q_cs.w, q_cs.w);
}

// How far a point lies on the light's side of the near plane.
GN_FN float gn_volumes_before_near(vec4 p_cs, vec4 light_cs) {
    float p = gn_volumes_beyond_near(p_cs);
    return gn_volumes_beyond_near(light_cs) < 0.0f ? -p : p;
}

// Corners of a side: two triangles, or one where both points at infinity are the same and it nowhere ends before.
GN_FN uint gn_volumes_corners(GnVolumesFrame frame) {
    return gn_volumes_has_far_cap(frame) || frame.capped != 0 || frame.low_ws.w > 0.0f ? 6u : 3u;
}

// The far end of the strip of a side that lies at its edge: pushed away by what 16 pixels span there, so that even seen
// at a slant the strip is wider than the rasterizer's grid.
GN_FN vec4 gn_volumes_strip(GnVolumesFrame frame, vec3 p_ws, vec3 away_ws) {
    float reach = 16.0f * frame.pixel * (frame.eye_ws.w > 0.0f ? length(p_ws - vec3(frame.eye_ws)) : 1.0f);
    float size = length(away_ws);
    return vec4(size > 0.0f ? p_ws + away_ws * (reach / size) : p_ws, 1.0f);
}

// Where a volume ends that nobody sees beyond a plane of the box: on the plane, but no nearer than its strip, so that samples
// which a strip lifts see the side as the strip.
// [LWGM04] section 4, departing from it: a plane of all receivers, not an interval of each
GN_FN vec4 gn_volumes_clamped(GnVolumesFrame frame, vec3 p_ws, uint plane) {
    uint axis = (plane - 1u) >> 1;
    float bound = ((plane - 1u) & 1u) != 0u ? frame.high_ws[axis] : frame.low_ws[axis];
    vec3 away_ws = gn_volumes_away(p_ws, frame.light_ws);
    float t = (bound - p_ws[axis]) / away_ws[axis];
    vec4 strip_ws = gn_volumes_strip(frame, p_ws, away_ws);
    vec3 least_ws = vec3(strip_ws) - p_ws;
    return t > 0.0f && t * t * dot(away_ws, away_ws) > dot(least_ws, least_ws) ? vec4(p_ws + away_ws * t, 1.0f)
                                                                               : strip_ws;
}

// Where a slice begins, pixels.
GN_FN uint gn_volumes_slice(uint size, uint slice) {
    return size * slice / uint(GN_VOLUMES_SLICES);
}

// How far a point lies within the run of slices, in clip space, on its left, right, upper and lower side. The planes between slices
// pass through the eye and run between pixels: nothing is drawn along them, and no sample lies on them. [LWGM04] section 4.2
GN_FN vec4 gn_volumes_within_run(uvec4 run, uvec2 size, vec4 p_cs) {
    if (run.x == 0u) {
        return vec4(-1.0f);
    }
    uint slices = uint(GN_VOLUMES_SLICES);
    float left = 2.0f * float(gn_volumes_slice(size.x, slices - run.x)) / float(size.x) - 1.0f;
    float right = 2.0f * float(gn_volumes_slice(size.x, run.y)) / float(size.x) - 1.0f;
    float upper = 2.0f * float(gn_volumes_slice(size.y, slices - run.z)) / float(size.y) - 1.0f;
    float lower = 2.0f * float(gn_volumes_slice(size.y, run.w)) / float(size.y) - 1.0f;
    return vec4(p_cs.x - left * p_cs.w, right * p_cs.w - p_cs.x, p_cs.y - upper * p_cs.w, lower * p_cs.w - p_cs.y);
}

// Whether a ray to the light from somewhere between `from_ws` and `to_ws` may meet the box; never false where one does. On each axis the
// places that the rays reach after a share u of the way lie between those of the two corners.
GN_FN bool gn_volumes_may_hold(vec3 low_ws, vec3 high_ws, vec3 from_ws, vec3 to_ws, vec4 light_ws) {
    float enter = 0.0f, leave = light_ws.w > 0.0f ? 1.0f : 3.0e38f;
    for (int axis = 0; axis < 3; ++axis) {
        // The least of them not beyond the box's upper side, the greatest not before its lower one: way * u <= room.
        for (int end = 0; end < 2; ++end) {
            float at = end == 0 ? from_ws[axis] : to_ws[axis];
            float way = light_ws[axis] - light_ws.w * at;
            way = end == 0 ? way : -way;
            float room = end == 0 ? high_ws[axis] - at : at - low_ws[axis];
            if (way > 0.0f) {
                leave = room / way < leave ? room / way : leave;
            } else if (way < 0.0f) {
                enter = room / way > enter ? room / way : enter;
            } else if (room < 0.0f) {
                return false;
            }
        }
    }
    return enter <= leave;
}

// Whether a sample lies beyond a triangle as the eye sees it, by more than rounding of a plane and of a position in it (4 units of the
// coordinates): unit normal towards the eye, and a corner.
GN_FN bool gn_volumes_beyond(vec3 to_eye_ws, vec3 corner_ws, vec3 p_ws) {
    float reach = 4.0f / 8388608.0f * dot(abs(to_eye_ws), max(abs(p_ws), abs(corner_ws)));
    return dot(to_eye_ws, p_ws - corner_ws) < -reach;
}

// Whether the sample lies on the edge as far as the rasterizer can tell. A side that hangs from an edge of the sample's
// own surface is behind the sample: it lies beyond the surface's plane, the camera and the light before it.
GN_FN bool gn_volumes_touches(GnVolumesFrame frame, vec3 p_ws, vec3 n_ws, vec3 a_ws, vec3 b_ws) {
    vec3 along = b_ws - a_ws, from_a = p_ws - a_ws;
    float t = dot(from_a, along) / dot(along, along);
    vec3 off = from_a - along * (t < 0.0f ? 0.0f : (t > 1.0f ? 1.0f : t));
    // A step of `snap` pixels across the view, and the longer one that it is on a surface seen at a slant.
    vec3 to_eye = vec3(frame.eye_ws) - p_ws * frame.eye_ws.w;
    float distance2 = dot(to_eye, to_eye), slant = abs(dot(n_ws, to_eye));
    float reach = frame.snap * frame.pixel * distance2;
    // The edge lies in the surface's plane, but for the rounding of coordinates.
    float rounding = 5.0e-7f * (abs(p_ws.x) + abs(p_ws.y) + abs(p_ws.z));
    float height = abs(dot(n_ws, off)) - rounding;
    return dot(off, off) * slant * slant <= reach * reach &&
           (height <= 0.0f || height * height * distance2 <= reach * reach);
}

#endif
