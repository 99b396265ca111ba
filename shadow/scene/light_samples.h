// SPDX-License-Identifier: MIT
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09]
//
// The points that stand for a light of some extent, and what each weighs at a receiver: the same for shadow maps, which are
// drawn from them, and for the truth, which sends rays to them.
#ifndef GN_SHADOW_SCENE_LIGHT_SAMPLES_H
#define GN_SHADOW_SCENE_LIGHT_SAMPLES_H

#include "shadow/scene/light.h"

#ifdef __cplusplus
#include <vector>

using glm::max;
using glm::sqrt;
#endif

/// What V of the point `one` of a light weighs at a receiver, so that the weighted mean over the light's points estimates what
/// [EASW09] eq. 1.6 does. V of a sphere is uniform over the cone that it subtends: its points, spread over its surface,
/// weigh the solid angle of their patch, cosine / distance^2, here in units of the centre's distance. All others are
/// spread as V is uniform.
GN_FN float gn_point_weight(GnLight light, GnLight one, vec3 p_ws) {
    if (light.kind != uint(GN_LIGHT_POINT) || light.radius <= 0.0f) {
        return 1.0f;
    }
    vec3 from_centre = p_ws - vec3(light.position_ws);
    vec3 from_point = p_ws - vec3(one.position_ws);
    float centre2 = dot(from_centre, from_centre);
    float point2 = dot(from_point, from_point);
    float cosine = dot(vec3(one.position_ws) - vec3(light.position_ws), from_point) / light.radius;
    // From inside the sphere every point shows its back.
    float facing = centre2 < light.radius * light.radius ? -cosine : cosine;
    return point2 > 0.0f ? max(facing, 0.0f) * centre2 / (point2 * sqrt(point2)) : 0.0f;
}

/// The pixel of a square of `side` that takes point `index` of `count`, counted row by row; side * side is at most `count`.
GN_FN int gn_point_cell(int index, int count, int side) {
    return (index * side * side) / count;
}

/// Whether a receiver's pixel takes point `index` of `count`: the pixels of a square of `side` share the points out among
/// them, in runs that are spread over the light by themselves. Fewer points than pixels are taken by all of them.
GN_FN bool gn_point_taken(int index, int count, ivec2 pixel, int side) {
    if (side * side > count) {
        return true;
    }
    int cell = (pixel.y % side) * side + pixel.x % side;
    return gn_point_cell(index, count, side) == cell;
}

#ifdef __cplusplus
namespace gn {

/// Points of one light, each a light without extent: a point, or a sun.
struct LightSamples {
    std::vector<GnLight> points;
    int side = 1;  ///< of the square of pixels that share them; side * side is at most their number
};

/// `count` points of a light's surface (directions of a sun), spread by a scrambled (0,2)-sequence; one, its centre, where
/// it has no extent. Their weights are gn_point_weight.
LightSamples light_samples(const GnLight& light, int count, int side = 1);

}  // namespace gn
#endif

#endif
