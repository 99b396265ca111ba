// SPDX-License-Identifier: MIT
// Every filterable map on every kind of view, affine, perspective, six of a cube, curved and several: one box casts, nothing overlaps, and well inside its shadow a map may not be
// brighter than the percentage of closer texels, which is none.
#include "scenes/analytic.h"
#include "tests/rig.h"

namespace gn::every_placement_test {
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
    EXPECT_GT(samples, 60);
    return sum / samples;
}

TEST(EveryPlacementRendered, NoFilterableMapLightsTheUmbraOfASingleCaster) {
    // What is left: exp(-c h) of a caster h before the receiver, and of moments what their rounding is worth. Both go with
    // the share of the depth range that the box has, and are a few hundredths at most.
    const test::ComparisonOptions options{.width = 48, .height = 48, .samples = 1};
    std::vector<std::pair<std::string, std::string>> placed{{"contact:light=point", "cube"},
                                                            {"contact:light=point", "paraboloid"},
                                                            {"contact", "fit"},
                                                            {"contact", "lispsm"},
                                                            {"contact", "cascades"}};
#ifdef __SANITIZE_ADDRESS__
    placed.resize(2);  // sanitizers see the same code on every other
#endif
    // The step of a truncated series is a ramp of 1 / 32 of the range: over the whole ground as high as the box.
    constexpr std::array<std::string_view, 2> stepped{"convolution", "cssm"};
    for (const auto& [scene, placement] : placed) {
        for (const Part* map : all_parts()) {
            if (map->id == "penumbra-deep" && placement == "paraboloid") {
                continue;  // refused: its rays are straight
            }
            const bool deep = placement == "cube" || placement == "cascades";
            if (map->stage == Stage::map && map->filterable && !(deep && holds(stepped, map->id))) {
                // A paraboloid spreads a hemisphere over what three faces of a cube and a half share.
                const int resolution = placement == "paraboloid" ? 1024 : 512;
                const std::string recipe =
                    fmt::format("vsm,map={},resolution={},placement={}", map->id, resolution, placement);
                const std::string few = test::with_few_points(load_recipe(recipe), recipe);
                EXPECT_LT(light_in_the_umbra(test::compare(scene, few, options)), 0.05) << few;
            }
        }
    }
}

}  // namespace
}  // namespace gn::every_placement_test
