// SPDX-License-Identifier: MIT
// The potential shadow receivers PSR = L ∩ V ∩ S as a convex body, and light views fitted to bodies.
//
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09]
#pragma once

#include "shadow/recipe/part.h"
#include "shadow/recipe/recipe.h"
#include "shadow/stages.h"

#include <vector>

namespace gn {

/// Points with dot(normal, p) + offset >= 0 are inside.
struct Plane {
    dvec3 normal_ws{0};
    double offset = 0;
};

/// A convex polyhedron as its faces' polygons; empty when clipped away.
struct ConvexBody {
    std::vector<std::vector<dvec3>> faces_ws;
    [[nodiscard]] bool empty() const { return faces_ws.empty(); }
    [[nodiscard]] std::vector<dvec3> vertices() const;
};
ConvexBody body_of(const Box& box_ws);
/// The camera's frustum between two distances along its axis.
ConvexBody body_of(const Camera& camera, float aspect, double near, double far);
/// The part of the body inside the plane, with a lid where it was cut.
ConvexBody clip(const ConvexBody& body, const Plane& plane);
std::vector<Plane> frustum_planes(const Camera& camera, float aspect, double near, double far);

/// The bounds of what the camera can see: of the scene's clusters that meet its frustum, so that a triangle that strayed
/// far away widens no map and no depth range. All of the scene where the camera sees none.
Box seen_bounds(const FrameInput& input);

/// L ∩ V ∩ S for the whole view: what the light reaches of what the camera sees of the scene's box.
ConvexBody potential_receivers(const FrameInput& input);
/// The same between two distances along the camera's axis (one cascade).
ConvexBody potential_receivers(const FrameInput& input, double near, double far);

/// The kernels' reach of the recipe's map and lookup together.
Guard guard_of(const Recipe& recipe, const Light& light, const Box& bounds_ws);
Guard guard_of(const FrameInput& input, const Recipe& recipe);

/// Texels between a view's near plane and the nearest receiver: the bias and the cone move what is compared towards the
/// light, and what casts before the near plane is stored on it. Without this room flat receivers come before it.
inline double room_of(Guard guard) {
    return 2 + 2 * static_cast<double>(guard.texels);
}

/// A rotation-free description of an orthographic or perspective light view.
struct Fitted {
    GnLightView view;
    bool valid = false;
};
/// The tightest orthographic view along the light's direction around the body: the rectangle of least area. Casters
/// before the near plane are kept by depth clamping. Guards widen it.
GnLightView fit_orthographic(const ConvexBody& body, const GnLight& light, int resolution, Guard guard);
/// The tightest perspective view from the light's position, near and far planes the body's own, or invalid when the body
/// spans too wide an angle.
Fitted fit_perspective(const ConvexBody& body, const GnLight& light, int resolution, Guard guard);
/// A square perspective view along `axis` with half-angle tangent 1 x widen and linear depth between near and far.
GnLightView square_perspective(vec3 eye_ws, vec3 axis_ws, vec3 up_ws, double tangent, double near, double far,
                               int resolution);

/// Six perspective views around the light, layers in the order of gn_face_of, each wider than 90 degrees by the kernels'
/// reach; sets views, layers and data[0] = (light's position, 1).
void add_cube_views(LightViews& views, const FrameInput& input, const Recipe& recipe);

/// Distance from a point to the farthest corner of the box.
double farthest(const Box& box_ws, vec3 p_ws);
/// How far a light with a position must see: to the farthest of what the camera can see, or to the light's range, beyond
/// which no sample counts.
double reach_of(const FrameInput& input);
/// Distance to the near plane of a light whose receivers may be anywhere: small, since depth is linear and costs no precision.
double near_plane(double far);

}  // namespace gn
