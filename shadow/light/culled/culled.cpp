// SPDX-License-Identifier: MIT
// Lights that give nothing, or next to nothing, to what the camera sees get no map.
// Also here: illuminance.h, illuminance.cpp (what a light gives at a distance).
//
// Based on: Akenine-Möller, Haines, Hoffman, Pesce, Iwanicki, Hillaire. Real-Time Rendering, 4th edition. 2018. [AHH18]
// Section 7.4.1: irradiance falls off with the square of the distance.
// Departs from it: the threshold is no distance but a share of what the other lights surely give.
#include "shadow/light/culled/culled.h"

#include "shadow/geometry/potential_receivers.h"
#include "shadow/geometry/visible_objects.h"
#include "shadow/light/culled/illuminance.h"
#include "shadow/recipe/recipe.h"
#include "shadow/view/read_back.h"

#include <algorithm>

namespace gn::culled {
namespace {

using culled::Reach;

/// Boxes around what the camera sees: of each object, or of the whole scene where nobody knows its objects.
std::vector<Box> seen_boxes(const FrameInput& input) {
    const Camera& camera = input.samples.camera;
    const float aspect = static_cast<float>(input.samples.width) / static_cast<float>(input.samples.height);
    const std::vector<Plane> frustum =
        frustum_planes(camera, aspect, static_cast<double>(camera.near), static_cast<double>(camera.far));
    std::vector<Box> whole{input.scene.bounds_ws};
    if (knows_what_is_seen(input.scene)) {
        whole.clear();
        for (const Object& object : input.scene.objects) {
            whole.push_back(object.bounds_ws);
        }
    }
    std::vector<Box> seen;
    for (const Box& box_ws : whole) {
        Box part_ws;
        for (const dvec3& p_ws : corners_within(box_ws, frustum)) {
            part_ws.grow(vec3(p_ws));
        }
        if (!part_ws.empty()) {
            seen.push_back(part_ws);
        }
    }
    return seen;
}

Reach reach_of(const GnLight& light, const std::vector<Box>& seen) {
    const dvec3 eye(vec3(light.position_ws));
    Reach reach{1e300, 0};
    for (const Box& box_ws : seen) {
        const dvec3 nearest = glm::clamp(eye, dvec3(box_ws.min), dvec3(box_ws.max));
        reach.nearest = std::min(reach.nearest, glm::length(nearest - eye));
        reach.farthest = std::max(reach.farthest, farthest(box_ws, vec3(light.position_ws)));
    }
    return reach;
}

/// Why the light needs no map, or "".
std::string why_none(const FrameInput& input, const Recipe& recipe) {
    const Light& light = input.light();
    const GnLight& shape = light.shape;
    const std::vector<Box> seen = seen_boxes(input);
    const Reach reach = reach_of(shape, seen);
    const bool placed = shape.kind != GN_LIGHT_DIRECTIONAL && shape.kind != GN_LIGHT_ENVIRONMENT;

    // No sample can count: V is 0 whatever casts.
    const bool beyond = placed && shape.range > 0 && reach.nearest > 1.0001 * static_cast<double>(shape.range);
    if (seen.empty() || beyond || (placed && potential_receivers(input).empty())) {
        return fmt::format("light '{}' gets no map: nothing that the camera sees lies within its reach", light.name);
    }

    // What it gives at most is a small share of what the others give at least.
    const auto share = static_cast<double>(recipe.of<GnCulledParams>("culled").share);
    double others = 0;
    for (const Light& other : input.scene.lights) {
        others += &other == &light ? 0.0 : culled::least_illuminance(other.shape, reach_of(other.shape, seen));
    }
    if (share > 0 && culled::most_illuminance(shape, reach) < share * others) {
        return fmt::format(
            "light '{}' gets no map and casts no shadow: it gives less than {:g} of what the other lights give "
            "(culled.share)",
            light.name, share);
    }
    return {};
}

Visibility add_unless_culled(const FrameInput& input, const Recipe& recipe,
                             const std::function<Visibility(const FrameInput&)>& serve) {
    const std::string why = why_none(input, recipe);
    if (why.empty()) {
        return serve(input);
    }
    if (input.late_remarks != nullptr) {
        input.late_remarks->insert(why);
    }
    return add_no_shadow(input);
}

}  // namespace
}  // namespace gn::culled

namespace gn::parts {

const Part& light_culled() {
    using namespace gn::culled;
    static const Part part = [] {
        Part p;
        p.id = "culled";
        p.stage = Stage::light;
        p.title = "No map for lights that give next to nothing";
        p.citation = "AHH18";
        p.params = param_table<GnCulledParams>({
            GN_PARAM(GnCulledParams, share, real, 0, 1, "of illuminance",
                     "A light that gives less than this share of what suns and lamps without a range surely give to "
                     "what is seen casts no shadow: less time and memory, and a shadow that faint is missing; at 0 "
                     "only lights that reach nothing seen are left out, which changes no V."),
        });
        p.params_type = "GnCulledParams";
        p.add_light = add_unless_culled;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
