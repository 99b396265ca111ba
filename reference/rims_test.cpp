// SPDX-License-Identifier: MIT
// Rims around lit samples, where geometry gives the answer.
#include "reference/quads_test.h"
#include "reference/truth.h"

#include <gtest/gtest.h>

namespace gn::rims_test {
namespace {

GnLight sun_from(vec3 towards_light_ws) {
    GnLight sun;
    sun.kind = GN_LIGHT_DIRECTIONAL;
    sun.direction_ws = vec4(-glm::normalize(towards_light_ws), 0);
    return sun;
}

/// A level floor of 20 m at height 0.
QuadScene level_floor() {
    QuadScene quads;
    quads.add(vec3(-10, 0, 10), vec3(20, 0, 0), vec3(0, 0, -20));
    return quads;
}

/// Whether a sample of the floor at (x, 0, 0) has a rim within the given surroundings.
bool beside(const Truth& truth, float x, vec3 a_ws, vec3 b_ws, const GnLight& light) {
    Samples samples;
    samples.add(vec3(x, 0, 0), vec3(0, 1, 0));
    const std::vector<Surroundings> around{{a_ws, b_ws}};
    return truth.blocked_around(samples.position_ws, samples.normal_ws, around, light).at(0) != 0;
}

TEST(Rims, ARoofsEdgeIsWithinReachOrNot) {
    // A roof 3 m above the floor over x > 0, under a vertical sun: its shadow's edge is at x = 0.
    QuadScene quads = level_floor();
    quads.add(vec3(0, 3, 5), vec3(5, 0, 0), vec3(0, 0, -10));
    finish_scene(quads.scene);
    const Truth truth(quads.scene);
    const GnLight sun = sun_from(vec3(0, 1, 0));
    const vec3 b_ws(0, 0, 0.5F);
    EXPECT_TRUE(beside(truth, -0.4F, vec3(0.5F, 0, 0), b_ws, sun));
    EXPECT_FALSE(beside(truth, -0.6F, vec3(0.5F, 0, 0), b_ws, sun));
    // Only the axis that points to the edge reaches it; the sign of an axis does not matter.
    EXPECT_FALSE(beside(truth, -0.4F, vec3(0.3F, 0, 0), b_ws, sun));
    EXPECT_TRUE(beside(truth, -0.4F, b_ws, vec3(-0.5F, 0, 0), sun));
    // Nothing is asked of a sample without surroundings, even in the dark.
    EXPECT_FALSE(beside(truth, 1, vec3(0), vec3(0), sun));
}

TEST(Rims, SurroundingsAreStretchedAlongTheSunsRays) {
    // Under a sun at 30 degrees a metre across the rays is two metres of the floor: the edge of a roof 1 m high, whose
    // shadow begins at x = -sqrt(3), is met from 1.9 m away by 1 m across.
    QuadScene quads = level_floor();
    quads.add(vec3(0, 1, 5), vec3(5, 0, 0), vec3(0, 0, -10));
    finish_scene(quads.scene);
    const Truth truth(quads.scene);
    const vec3 to_sun(std::sqrt(0.75F), 0.5F, 0);
    const vec3 across(0.5F, -std::sqrt(0.75F), 0);
    const float edge = -std::sqrt(3.0F);
    EXPECT_TRUE(beside(truth, edge - 0.9F, across * 0.5F, vec3(0, 0, 0.1F), sun_from(to_sun)));
    EXPECT_FALSE(beside(truth, edge - 1.1F, across * 0.5F, vec3(0, 0, 0.1F), sun_from(to_sun)));
}

TEST(Rims, TheSamplesOwnSurfaceIsNone) {
    // A bare floor; a slope that rises from the floor at 45 degrees; a lit wall that it meets at a right angle.
    const vec3 to_sun = glm::normalize(vec3(-1, 1, 0));
    const vec3 across = glm::normalize(vec3(1, 1, 0)) * 0.5F;
    for (const vec3 rising : {vec3(0), vec3(3, 3, 0), vec3(0, 3, 0)}) {
        QuadScene quads = level_floor();
        if (rising != vec3(0)) {
            quads.add(vec3(0, 0, 5), rising, vec3(0, 0, -10));
        }
        finish_scene(quads.scene);
        EXPECT_FALSE(beside(Truth(quads.scene), -0.2F, across, vec3(0, 0, 0.5F), sun_from(to_sun))) << rising.x;
    }
    // A wall that hangs over the floor, out of its reach, is another surface.
    QuadScene quads = level_floor();
    quads.add(vec3(-2, 2, 5), vec3(0, 3, 0), vec3(0, 0, -10));
    finish_scene(quads.scene);
    EXPECT_TRUE(beside(Truth(quads.scene), -0.2F, across, vec3(0, 0, 0.5F), sun_from(to_sun)));
}

TEST(Rims, WhatAlphaTakesAwayBlocksNothing) {
    for (const float alpha : {0.2F, 0.8F}) {
        QuadScene quads = level_floor();
        Material leaf;
        leaf.alpha_mode = AlphaMode::mask;
        leaf.alpha_cutoff = 0.5F;
        leaf.base_color.a = alpha;
        quads.scene.materials.push_back(leaf);
        quads.add(vec3(0, 3, 5), vec3(5, 0, 0), vec3(0, 0, -10), 1);
        finish_scene(quads.scene);
        EXPECT_EQ(beside(Truth(quads.scene), -0.4F, vec3(0.5F, 0, 0), vec3(0, 0, 0.5F), sun_from(vec3(0, 1, 0))),
                  alpha > 0.5F);
    }
}

TEST(Rims, RaysEndAtTheLight) {
    // A point light of 0.5 m radius at 2 m: the roof above it, and what is inside of it, hide nothing.
    GnLight light;
    light.kind = GN_LIGHT_POINT;
    light.position_ws = vec4(0, 2, 0, 1);
    light.radius = 0.5F;
    light.range = 100;
    for (const auto& [height, blocks] : {std::pair{3.0F, false}, {1.8F, false}, {1.2F, true}}) {
        QuadScene quads = level_floor();
        quads.add(vec3(-1, height, 1), vec3(2, 0, 0), vec3(0, 0, -2));
        finish_scene(quads.scene);
        EXPECT_EQ(beside(Truth(quads.scene), 0.1F, vec3(0.3F, 0, 0), vec3(0, 0, 0.3F), light), blocks) << height;
    }
}

TEST(Rims, ThreadsChangeNothing) {
    QuadScene quads = level_floor();
    quads.add(vec3(0, 3, 5), vec3(5, 0, 0), vec3(0, 0, -10));
    finish_scene(quads.scene);
    const Truth truth(quads.scene);
    Samples samples;
    std::vector<Surroundings> around;
    for (int i = 0; i < 2000; ++i) {
        samples.add(vec3(-9 + 0.005F * static_cast<float>(i), 0, 0), vec3(0, 1, 0));
        around.push_back({vec3(0.5F, 0, 0), vec3(0, 0, 0.5F)});
    }
    const GnLight sun = sun_from(vec3(0, 1, 0));
    const auto one = truth.blocked_around(samples.position_ws, samples.normal_ws, around, sun, 1);
    EXPECT_EQ(one, truth.blocked_around(samples.position_ws, samples.normal_ws, around, sun, 3));
    // Half a metre beside the edge at 0 or nearer: 8.5 m of samples are too far away, but for the gaps between the rays.
    const auto first = std::find(one.begin(), one.end(), 1) - one.begin();
    EXPECT_NEAR(static_cast<double>(first), 1700, 4);
    EXPECT_EQ(std::count(one.begin() + first, one.end(), 0), 0);
}

}  // namespace
}  // namespace gn::rims_test
