// SPDX-License-Identifier: MIT
// Slices of the view and the light views around them, on the CPU.
#pragma once

#include "shadow/geometry/convex_body.h"
#include "shadow/geometry/potential_receivers.h"
#include "shadow/placement/cascades/cascades.h"
#include "shadow/placement/light_views.h"

namespace gn::cascades {

/// Distances along the camera's axis, metres.
struct Interval {
    double near = 0, far = 0;
};

/// What the cascades share. Stable cascades take it from the camera's optics and the scene's bounds alone, so that it does
/// not change while the camera moves inside the scene, and outside only by steps of two; the others from the potential
/// receivers. The last cascade also serves what lies beyond, as far as its map holds it.
Interval range_of(const FrameInput& input, const GnCascadesParams& params);

/// Of stable cascades: what can be seen within `range`, however the camera turns and moves by a little.
Interval stable_range(const FrameInput& input, const GnCascadesParams& params, Interval range);
/// The same ended at the farthest object that is seen, in steps of half an octave so that windows keep their size until it
/// lies nearer or farther by that much.
Interval stable_cut(const FrameInput& input, Interval range);

/// The slice of each cascade: from its split backwards by the band of the transition before it.
std::vector<Interval> slices_of(const GnCascadesParams& params, Interval range);

/// Texels along a side of map `i`.
int side_of(const GnCascadesParams& params, int resolution, std::size_t i);
/// How often each is halved, as GnCascadesData packs it.
uint packed_halvings(const GnCascadesParams& params);
/// Packs the maps, which know only their own size so far, into as few layers of `resolution` as hold them; sets layers,
/// rectangles and the number of layers.
void put_into_layers(const GnCascadesParams& params, int resolution, LightViews& views);

/// Two axes of the light's plane, for bounding boxes: x along what the camera looks at.
struct LightFrame {
    dvec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};
LightFrame facing(const Camera& camera, const GnLight& light);
/// The same, turned about the light by an angle in radians.
LightFrame turned(const LightFrame& frame, double angle);

/// The bounding box in light space of a slice's potential receivers.
GnLightView plain_view(const ConvexBody& body, const LightFrame& frame, int resolution, Guard guard);

/// A matrix's row, of the four numbers that one clip coordinate is made of.
inline void set_row(mat4& m, int row, dvec4 values) {
    for (int column = 0; column < 4; ++column) {
        m[column][row] = static_cast<float>(values[column]);
    }
}
inline dvec4 row_of(const mat4& m, int row) {
    return {m[0][row], m[1][row], m[2][row], m[3][row]};
}

/// Completes an orthographic view whose x and y rows are set.
void complete(GnLightView& view, const GnLight& light, int resolution, Interval depth);
/// Sets the depth axis of an orthographic view, metres along the light.
void set_depth_range(GnLightView& view, const GnLight& light, Interval depth);
/// A range of depths with room for rounding at both ends, and for biases and kernels before the nearest; `texel` in metres.
Interval with_slack(Interval depth, Guard guard, double texel, double rounding);
/// Of the points of a body along a direction.
Interval extent_of(const ConvexBody& body, dvec3 axis);

/// The smallest sphere around a slice whose centre lies on the camera's axis.
struct Sphere {
    double centre = 0;  ///< distance along the axis, metres
    double radius = 0;
};
Sphere sphere_around(Interval slice, double yfov, double aspect);
/// The same under any camera.
Sphere sphere_around(Interval slice, const Camera& camera, double aspect);

/// The texel grid of one stable cascade: an endless plane of texels fixed to the world, of which a map is a window.
/// Axes and texel size depend on the light, the optics and the scene's bounds, never on where the camera is.
struct Grid {
    GnLightView view;  ///< its window begins at texel (0, 0)
    int resolution = 0;
    double step = 1;          ///< texels that windows move by
    double margin = 0;        ///< texels between the sphere, widened by the kernels' reach, and the window's border
    glm::bvec2 still{false};  ///< along which axes the window holds the whole scene and stays where it is
    dvec2 home{0};            ///< texel of the scene's centre
};
/// `spare` widens windows that follow the camera, by a share of themselves, so that they may follow late.
Grid grid_of(const Sphere& sphere, const GnLight& light, const Box& scene_ws, int resolution, Guard guard,
             double spare);
/// The grid coordinates of a point, in texels.
dvec2 texel_of(const Grid& grid, dvec3 p_ws);
/// The first texel of the window centred on a point.
ivec2 window_around(const Grid& grid, dvec3 centre_ws);
/// The view of the window that begins at texel `first`.
GnLightView view_of(const Grid& grid, ivec2 first);
/// The view centred on a point to the last bit, on no grid: what snapping is measured against.
GnLightView loose_view(const Grid& grid, dvec3 centre_ws);

/// What the choice function is given.
GnCascadesData choice_data(const GnCascadesParams& params, Interval range, const LightFrame& frame,
                           std::span<const GnLightView> views, Guard guard);

/// Whether splits and views are made of the view samples.
inline bool by_samples(const GnCascadesParams& params) {
    return params.split >= GN_SPLIT_SDSM_MINMAX;
}
/// The sentence why a recipe's cascades cannot serve a light, or "".
std::string refuses(const Scene& scene, const Light& light, const Recipe& recipe);

/// SDSM: splits and views made on the GPU from the view samples of this frame.
LightViews place_by_samples(const FrameInput& input, const Recipe& recipe, const GnCascadesParams& params);

/// Replaces windows by kept ones where they are recent enough, and says what must be drawn.
struct Window {
    Grid grid;
    dvec3 centre_ws{0};
};
void keep_windows(const FrameInput& input, const Recipe& recipe, const GnCascadesParams& params,
                  std::span<const Window> windows, LightViews& views);

}  // namespace gn::cascades
