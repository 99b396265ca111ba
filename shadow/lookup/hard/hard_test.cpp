// SPDX-License-Identifier: MIT
#include "tests/lookup_by_hand.h"

namespace gn::hard_test {
namespace {

TEST(Hard, MismatchHalvesAsTheResolutionDoubles) {
    double before = 0;
    for (const int resolution : {256, 512, 1024}) {
        const auto c =
            test::compare("contact", fmt::format("hard,resolution={}", resolution), {.width = 512, .height = 512});
        const double mismatch = *c.errors.mismatch;
        if (before > 0) {
            // A staircase's area is proportional to the texel; counting pixels adds the square root of their number.
            const double noise = 3 * std::sqrt(mismatch / static_cast<double>(c.errors.samples));
            EXPECT_LT(mismatch, 0.6 * before + noise) << resolution;
            EXPECT_GT(mismatch, 0.3 * before - noise) << resolution;
        }
        before = mismatch;
    }
    EXPECT_GT(before, 0);
}

TEST(Hard, ComparesWithTheTexelWhoseMiddleIsNearest) {
    // Few texels, so that the next one over is seen.
    const Scene scene = load_scene("contact");
    const Recipe recipe = load_recipe("hard,resolution=64,placement=single");
    const std::vector<float> nearest = test::visibility_by_hand(scene, recipe, R"(
    vec2 p = at.projected.uv_ts / at.projected.texel_ts;
    ivec2 best = ivec2(0);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            best = distance(vec2(x, y) + 0.5, p) < distance(vec2(best) + 0.5, p) ? ivec2(x, y) : best;
        }
    }
    return lit(best) ? 1.0 : 0.0;)",
                                                                48);
    EXPECT_EQ(test::visibility_of(scene, recipe, 48), nearest);
    EXPECT_GT(std::count(nearest.begin(), nearest.end(), 0.0F), 48);
}

}  // namespace
}  // namespace gn::hard_test
