// SPDX-License-Identifier: MIT
// One map warped by a perspective along the view: what perspective, trapezoidal and light space perspective shadow maps
// share. They differ only in how strong the warp is.
//
// Based on: Wimmer, Scherzer, Purgathofer. Light Space Perspective Shadow Maps. EGSR 2004. [WSP04]
#pragma once

#include "shadow/geometry/convex_body.h"
#include "shadow/geometry/potential_receivers.h"
#include "shadow/placement/light_views.h"

#include <optional>

namespace gn::warp {

/// A vertex of the potential receivers on the light's plane.
struct Spot {
    dvec2 q{0};           ///< x across, y along the view
    double depth = 0;     ///< metres along the camera's axis
    double distance = 1;  ///< metres along the light's axis from a light with a position; 1 for the sun
};

/// The light's plane: metres across the rays for the sun, tangents (its post-perspective space) for a light with a
/// position. There every light shines straight down, so that a warp within the plane changes neither its direction nor
/// its type. y runs along what the camera sees, and the plane's coordinates are homogeneous in the world.
struct Plane2 {
    GnLightView fitted;  ///< the view without a warp
    dvec4 x_row{0}, y_row{0}, w_row{0};
    std::vector<Spot> spots;      ///< all of the body, what the map must hold
    std::vector<Spot> far_spots;  ///< of the body beyond the pseudo-near plane, what the warp is chosen for
    double start = 0;             ///< y of the line where the warp begins
    double length = 0;            ///< from there to the end of the body
    double near = 0, far = 0;     ///< metres along the camera's axis, of the body beyond the pseudo-near plane
    double angle = 0;             ///< between view and light, 0 to pi/2
    double half_field = 0;        ///< of the camera's frustum in the plane of view and light, radians
    double turn = 0;              ///< from these axes to the fitted rectangle's, at most an eighth of a full turn
    double metre = 1;             ///< in the plane's unit, at the body's centre
    double reach = 0;             ///< of the kernels, in the plane's unit
    double share = 0;             ///< of the kernels, as a share of the map
};

/// A projective map of the plane onto the shadow map: w = 1 + strength (y - start). Strength 1/n puts the centre of
/// projection a distance n before the start; 0 is uniform.
struct Warp {
    double strength = 0;
    double turn = 0;       ///< of the map's rectangle against the plane's axes, radians
    double x_centre = 0;   ///< of the centre of projection
    dvec2 min{0}, max{0};  ///< of the rectangle
};

/// What a map must hold: the spots, each as a square of the kernels' reach.
std::vector<dvec2> outline(const Plane2& plane);
/// As strong as asked, or less where receivers would reach the centre of projection, which lies where they are narrowest.
/// Without a rectangle.
Warp centred_warp(const Plane2& plane, const std::vector<dvec2>& points, double strength);
/// Warps as strongly as asked, or less where receivers or kernels would reach the centre of projection or the horizon.
/// The rectangle holds all spots and the kernels' reach.
Warp make_warp(const Plane2& plane, double strength, double turn);
GnLightView view_of(const Plane2& plane, const Warp& warp);

/// Side of a texel over distance from the eye, the largest at any far spot, for a map of one texel: perspective aliasing.
double worst_error(const Plane2& plane, const Warp& warp);

/// n of the even error along the view, z_n + sqrt(z_f z_n), for the depths near and far.
double optimal_distance(double near, double far);
/// Distance n for the warp's parameter: -1 uniform (infinite), 0 even error along the view, 1 even error across it.
/// Returns 1/n, for a body of `length` on the light's plane between depths in the ratio far/near.
double strength_of(double eta, double near, double far, double length);
/// The parameter falls from 0 to -1 as the light turns into the view. Angles in radians.
double falloff(double angle, double half_field);

/// The warp of light space perspective shadow maps: the even error's at eta = 0, faded by the falloff, and at most so
/// strong that no receiver gets a coarser texel on screen than the coarsest of the unwarped map.
GnLightView even_view(const Plane2& plane, double eta);
/// The same as first published: the centre lies n / sin(angle) before the nearest receiver, on the light's plane, whatever
/// that does to texels.
GnLightView sine_view(const Plane2& plane, double eta);
/// A perspective whose rows then follow the logarithm of w: the same error along the view everywhere, at eta = 1 across it too.
/// It fades as the even warp does, from eta down to -1, and is as strong as no receiver gets a coarser texel on screen by than the
/// coarsest of the unwarped map.
GnLightView logarithmic_view(const Plane2& plane, double eta);
/// Receivers nearer than this share of the farthest one's depth do not steer the warp unless asked otherwise. Without it
/// whatever stands before the camera takes the whole map; a ratio of depths of two hundred to one is what one map can serve.
inline constexpr double usual_near = 0.005;

/// The plane of a body of receivers under its fitted view, or nothing where there is no direction or depth to warp along,
/// or the camera is orthographic.
/// `pseudo_near` as a share of the farthest receiver's depth: nearer ones are in the map but do not steer the warp.
std::optional<Plane2> plane_of(const FrameInput& input, const ConvexBody& body, const GnLightView& fitted,
                               const Recipe& recipe, double pseudo_near);
/// The same where depth grows along another direction of the world than the camera's axis, such as a side of its frustum: y runs
/// along its image, whatever angle view and light have, and nothing fades.
std::optional<Plane2> plane_along(const FrameInput& input, const ConvexBody& body, const GnLightView& fitted,
                                  const Recipe& recipe, double pseudo_near, dvec3 along_ws);

/// The views of a part: `choose` gets the plane and returns the warped view. Where there is nothing to warp (the view
/// looks along the light, no depth, an orthographic camera, receivers around the light) the views are `fit`'s.
using Choose = GnLightView (*)(const Plane2& plane, const Recipe& recipe);
LightViews place(const FrameInput& input, const Recipe& recipe, double pseudo_near, Choose choose);

}  // namespace gn::warp
