// SPDX-License-Identifier: MIT
#include "shadow/map/silhouette_map/silhouette_map.glsl"

#include <gtest/gtest.h>

#include <random>

namespace gn::silhouette_map_test {
namespace {

using namespace gn::glsl;

TEST(SilhouetteMap, PackingKeepsTwelveBits) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int i = 0; i < 1000; ++i) {
        const vec2 p(uniform(random), uniform(random));
        const vec2 back = gn_silhouette_unpack(gn_silhouette_pack(p));
        EXPECT_NEAR(back.x, p.x, 0.51 / 4095);
        EXPECT_NEAR(back.y, p.y, 0.51 / 4095);
    }
    EXPECT_EQ(gn_silhouette_unpack(gn_silhouette_pack(vec2(1))), vec2(1));
}

TEST(SilhouetteMap, EverySegmentThroughACellHasAPointOnItWithin) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform(-1, 2);
    int hits = 0;
    for (int i = 0; i < 4000; ++i) {
        const vec2 a(uniform(random), uniform(random)), b(uniform(random), uniform(random));
        bool touches = false;
        for (int k = 0; k <= 400; ++k) {
            touches = touches || gn_silhouette_within(mix(a, b, static_cast<float>(k) / 400));
        }
        const float t = gn_silhouette_point(a, b);
        ASSERT_TRUE(!touches || t >= 0) << i;
        if (t >= 0) {
            const vec2 p = mix(a, b, t);
            ASSERT_TRUE(p.x > -1e-4F && p.x < 1.0001F && p.y > -1e-4F && p.y < 1.0001F) << i;
            ++hits;
        }
    }
    EXPECT_GT(hits, 1000);
}

}  // namespace
}  // namespace gn::silhouette_map_test
