// SPDX-License-Identifier: MIT
// Where the taps of search and filter lie on the light: the kernels of `pcf`, in the light's own shape.
// Sets: shadow/lookup/poisson.h [MF92]. Squares onto discs: Shirley, Chiu. A Low Distortion Map Between Disk and Square. Journal
// of Graphics Tools 1997. [SC97], as base/disc.h on the host.
#ifndef GN_SHADOW_LOOKUP_PCSS_KERNEL_GLSL
#define GN_SHADOW_LOOKUP_PCSS_KERNEL_GLSL

#include "shadow/lookup/pcss/pcss.h"
#include "shadow/receiver/light_extent.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// A point of the square [-1,1]^2 on the unit disc: squares about the centre become circles, areas keep their ratios. [SC97]
GN_FN vec2 gn_disc_of_square(vec2 p) {
    bool flat_side = abs(p.x) > abs(p.y);
    float radius = flat_side ? p.x : p.y;
    float along = radius == 0.0f ? 0.0f : 0.78539816f * (flat_side ? p.y : p.x) / radius;
    vec2 way = vec2(cos(along), sin(along));
    return radius * (flat_side ? way : vec2(way.y, way.x));
}

// A point of the unit disc on the square [-1,1]^2: the inverse.
GN_FN vec2 gn_square_of_disc(vec2 p) {
    bool flat_side = abs(p.x) > abs(p.y);
    float radius = sign(flat_side ? p.x : p.y) * length(p);
    float along = radius == 0.0f ? 0.0f : 1.27323954f * asin(clamp((flat_side ? p.y : p.x) / radius, -1.0f, 1.0f));
    return flat_side ? vec2(radius, radius * along) : vec2(radius * along, radius);
}

// Point `i` of a raster of `side` x `side` cells of [-1,1]^2, row by row: the cell's centre.
GN_FN vec2 gn_raster_point(int i, int side) {
    return (2.0f * vec2(float(i % side), float(i / side)) + 1.0f) / float(side) - 1.0f;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// A host may fix the kernel when it compiles:
//   #define GN_PCSS_KERNEL GN_PCSS_VOGEL
// and list the points of a set on the unit disc:
//   #define GN_PCSS_SET vec2(0.0), vec2(0.5)
//   with #define GN_PCSS_SET_POINTS 2
#ifndef GN_PCSS_KERNEL
#define GN_PCSS_KERNEL params.kernel
#endif
#ifdef GN_PCSS_SET
const vec2 gn_pcss_set[GN_PCSS_SET_POINTS] = vec2[GN_PCSS_SET_POINTS](GN_PCSS_SET);
#endif

// Points of the light one after the other: of the spiral, or of a set or a raster, the first `count` of them.
struct GnPcssKernel {
    GnExtentPoints spiral;
    int kernel;
    int side;   // of a raster
    int taken;
    vec2 turn;  // of sets
};

// A raster has the largest square number of points that is not above what was asked for.
int gn_pcss_count(int kernel, int taps) {
    int side = int(sqrt(float(taps) + 0.5));
    return kernel == GN_PCSS_GRID ? side * side : taps;
}

GnPcssKernel gn_pcss_kernel(GnPcssParams params, bool square, int count, float noise) {
    float angle = GN_PCSS_KERNEL == GN_PCSS_ROTATED_POISSON ? 6.28318531 * noise : 0.0;
    return GnPcssKernel(gn_extent_points(square, count, noise), GN_PCSS_KERNEL, int(sqrt(float(count) + 0.5)), 0, vec2(cos(angle), sin(angle)));
}

vec2 gn_pcss_next(inout GnPcssKernel points) {
    if (points.kernel == GN_PCSS_GRID) {
        vec2 q = gn_raster_point(points.taken++, points.side);
        return points.spiral.square ? q : gn_disc_of_square(q);
    }
#ifdef GN_PCSS_SET
    vec2 p = gn_pcss_set[points.taken++];
    vec2 q = vec2(points.turn.x * p.x - points.turn.y * p.y, points.turn.y * p.x + points.turn.x * p.y);
    return points.spiral.square ? gn_square_of_disc(q) : q;
#else
    return gn_extent_next(points.spiral);
#endif
}

#endif
#endif
