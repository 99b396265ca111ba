// SPDX-License-Identifier: MIT
// Every filterable map on every placement: one box casts, nothing overlaps, and well inside its shadow a map may not be
// brighter than the percentage of closer texels, which is none.
#include "scenes/analytic.h"
#include "tests/rig.h"

namespace gn {
namespace {

/// Mean visibility of the ground well inside the box's shadow; the rims' kernels stay outside of it.
double light_in_the_umbra(const test::Comparison& c) {
    double sum = 0;
    int samples = 0;
    for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
        const vec4 p_ws = c.frame.samples.position_ws[i];
        if (p_ws.w > 0.5F && p_ws.y < 1e-3F && scenes::contact_scene::distance_to_foot(dvec3(p_ws)) > 0.2 &&
            scenes::contact_scene::well_in_shadow(c.scene.lights.front().shape, dvec3(p_ws), 0.2)) {
            sum += c.visibility().values[i];
            ++samples;
        }
    }
    EXPECT_GT(samples, 100);
    return sum / samples;
}

TEST(EveryPlacementRendered, NoFilterableMapLightsTheUmbraOfASingleCaster) {
    // What is left: exp(-c h) of a caster h before the receiver, the ramp of a truncated series, and of moments what their
    // rounding is worth. All go with the share of the depth range that the box has, and are a few hundredths here.
    const test::ComparisonOptions options{.width = 96, .height = 96, .samples = 1};
    const std::vector<std::pair<std::string, std::string>> placed{
        {"contact:light=point", "cube"}, {"contact:light=point", "paraboloid"}, {"contact", "single"}, {"contact", "fit"},
        {"contact", "lispsm"},           {"contact", "tsm"},                    {"contact", "psm"},    {"contact", "cascades"}};
    for (const auto& [scene, placement] : placed) {
        for (const Part* map : all_parts()) {
            if (map->stage == Stage::map && map->gives == "filterable") {
                const std::string recipe = fmt::format("vsm,map={},resolution=1024,placement={}", map->id, placement);
                EXPECT_LT(light_in_the_umbra(test::compare(scene, recipe, options)), 0.05) << recipe;
            }
        }
    }
}

}  // namespace
}  // namespace gn
