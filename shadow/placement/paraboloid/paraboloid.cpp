// SPDX-License-Identifier: MIT
// A map for each hemisphere around a light: two for a point, one for a spot or a rectangle.
//
// Based on: Brabec, Annen, Seidel. Shadow Mapping for Hemispherical and Omnidirectional Light Sources. CGI 2002. [BAS02]
// Departs from it: texels are drawn by their own rays, so that edges are curved as they must be and no mesh needs
// tessellation; each map reaches beyond its hemisphere by the kernels' reach.
#include "shadow/placement/paraboloid/paraboloid.h"

#include "shadow/geometry/potential_receivers.h"
#include "shadow/recipe/guard.h"

namespace gn::parts::paraboloid {
namespace {

/// The hemisphere around an axis, out to `extent` in stereographic coordinates; depth is the distance over far.
GnLightView hemisphere(vec3 eye_ws, vec3 axis_ws, double extent, double far, int resolution) {
    vec3 x_ws;
    vec3 y_ws;
    complete_frame(axis_ws, x_ws, y_ws);
    const auto row = [&](vec3 axis) { return dvec4(dvec3(axis), -glm::dot(dvec3(axis), dvec3(eye_ws))); };
    const dmat4 ls_from_ws = glm::transpose(dmat4(row(x_ws), row(y_ws), row(axis_ws), dvec4(0, 0, 0, 1)));
    GnLightView view;
    view.cs_from_ws = mat4(ls_from_ws);
    view.ws_from_cs = mat4(glm::inverse(ls_from_ws));
    view.depth_from_ws = vec4(row(axis_ws) / far);
    view.eye_ws = vec4(eye_ws, 1);
    view.metres_per_depth = static_cast<float>(far);
    view.resolution = static_cast<float>(resolution);
    view.paraboloid = static_cast<float>(extent);
    return view;
}

LightViews place_paraboloid(const FrameInput& input, const Recipe& recipe) {
    const GnLight& light = input.light().shape;
    const vec3 eye_ws(light.position_ws);
    const vec3 axis_ws(light.direction_ws);
    const double far = reach_of(input);

    // Leave room for kernels; a world radius is widest in angle where receivers are nearest and is held to a tenth.
    const Guard guard = guard_of(input, recipe);
    const double share = std::min(0.4, static_cast<double>(guard.texels) / recipe.resolution);
    const double extent = 1 / (1 - 2 * share) + (guard.metres > 0 ? 0.1 : 0.0);

    LightViews views;
    views.kind = ViewKind::paraboloid;
    views.resolution = static_cast<std::uint32_t>(recipe.resolution);
    views.views.push_back(hemisphere(eye_ws, axis_ws, extent, far, recipe.resolution));
    const bool all_around = light.kind == GN_LIGHT_POINT;
    if (all_around) {
        views.views.push_back(hemisphere(eye_ws, -axis_ws, extent, far, recipe.resolution));
        views.views.back().layer = 1;
    }
    views.layers = all_around ? 2 : 1;
    views.set_data(GnParaboloidData{vec4(eye_ws, all_around ? 1 : 0), vec4(axis_ws, 0)});
    return views;
}

}  // namespace
}  // namespace gn::parts::paraboloid

namespace gn::parts {

const Part& placement_paraboloid() {
    using namespace paraboloid;
    static const Part part = [] {
        Part p;
        p.id = "paraboloid";
        p.stage = Stage::placement;
        p.title = "Dual paraboloid: a map for each hemisphere";
        p.citation = "BAS02";
        p.lights = {.spot = true, .point = true, .rectangle = true};
        p.bends = true;
        p.data_type = "GnParaboloidData";
        p.glsl = "shadow/placement/paraboloid/paraboloid.glsl";
        p.place = place_paraboloid;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
