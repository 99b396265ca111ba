// SPDX-License-Identifier: MIT
// One map over everything the light sees: the spot's own frustum, or the scene's bounds for the sun.
//
// Based on: Williams. Casting Curved Shadows on Curved Surfaces. SIGGRAPH 1978. [Wil78]
#include "shadow/geometry/convex_body.h"
#include "shadow/geometry/potential_receivers.h"
#include "shadow/placement/light_views.h"
#include "shadow/recipe/guard.h"
#include "shadow/scene/clusters.h"

#include <algorithm>

namespace gn::parts::single {
namespace {

constexpr float widest_cosine = 0.0872F;  // a cone of 85 degrees: beyond it one perspective view cannot hold the light

LightViews place_single(const FrameInput& input, const Recipe& recipe) {
    const GnLight& light = input.light().shape;
    LightViews views;
    views.resolution = static_cast<std::uint32_t>(recipe.resolution);
    if (light.kind == GN_LIGHT_DIRECTIONAL) {
        // Cover the scene's box.
        Box box_ws = input.scene.bounds_ws.empty() ? Box{vec3(-1), vec3(1)} : input.scene.bounds_ws;
        views.kind = ViewKind::affine;
        views.views = {fit_orthographic(body_of(box_ws), light, recipe.resolution, guard_of(input, recipe))};
        return views;
    }
    // Cover the spot's cone, widened by the kernels' reach.
    const double tangent = std::tan(std::acos(static_cast<double>(light.cos_outer)));
    const double share = std::min(0.4, static_cast<double>(guard_of(input, recipe).texels) / recipe.resolution);
    const double far = reach_of(input);
    vec3 x;
    vec3 y;
    complete_frame(vec3(light.direction_ws), x, y);
    views.views = {square_perspective(vec3(light.position_ws), vec3(light.direction_ws), y, tangent / (1 - 2 * share),
                                      near_plane(far), far, recipe.resolution)};
    return views;
}

std::string refuses_single(const Scene&, const Light& light, const Recipe&) {
    if (light.shape.kind == GN_LIGHT_SPOT && light.shape.cos_outer < widest_cosine) {
        return fmt::format(
            "placement 'single' cannot hold light '{}' of {:.0f} degrees half-angle in one view; at most "
            "85 degrees, or use placement=cube",
            light.name, glm::degrees(std::acos(light.shape.cos_outer)));
    }
    return {};
}

/// Under a sun the map covers all there is: say where most of it is spent on a way to something far off.
std::string remark_single(const Scene& scene, const Recipe&) {
    const float most = largest_cluster(scene).diagonal();
    const float all = scene.bounds_ws.diagonal();
    const bool sun = std::any_of(scene.lights.begin(), scene.lights.end(),
                                 [](const Light& light) { return light.shape.kind == GN_LIGHT_DIRECTIONAL; });
    if (!sun || 4 * most >= all) {
        return {};
    }
    return fmt::format(
        "placement 'single' spends a sun's map on {:.3g} m, though all but a few triangles lie within {:.3g} m; "
        "placement=fit leaves out what the camera does not see",
        all, most);
}

}  // namespace
}  // namespace gn::parts::single

namespace gn::parts {

const Part& placement_single() {
    using namespace single;
    static const Part part = [] {
        Part p;
        p.id = "single";
        p.stage = Stage::placement;
        p.title = "One map over the light's own frustum or the scene's bounds";
        p.citation = "Wil78";
        p.lights = {.directional = true, .spot = true};
        p.from_centre = true;
        p.glsl = "shadow/placement/single/single.glsl";
        p.place = place_single;
        p.refuses = refuses_single;
        p.remark = remark_single;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
