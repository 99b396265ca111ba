// SPDX-License-Identifier: MIT
// The pieces of a rectangle tile it, and V of it is the mean of theirs.
#include "shadow/light/split/split.h"
#include "tests/rig.h"

#include <algorithm>

namespace gn {
namespace {

TEST(Split, PiecesTileTheRectangle) {
    const Scene scene = load_scene("slab");
    const Light& light = scene.lights.front();
    const Recipe recipe = load_recipe("backprojection,light=split,split.side=3");
    const std::vector<Light> pieces = find_part(Stage::light, "split").split(light, recipe);
    ASSERT_EQ(pieces.size(), 9U);
    vec2 low(1e9F), high(-1e9F);
    float area = 0;
    for (const Light& piece : pieces) {
        const vec3 offset = vec3(piece.shape.position_ws - light.shape.position_ws);
        const vec2 at(glm::dot(offset, vec3(light.shape.right_ws)), glm::dot(offset, vec3(light.shape.up_ws)));
        low = glm::min(low, at - piece.shape.half_size);
        high = glm::max(high, at + piece.shape.half_size);
        area += 4 * piece.shape.half_size.x * piece.shape.half_size.y;
    }
    EXPECT_NEAR(glm::length(low + light.shape.half_size), 0, 1e-6);
    EXPECT_NEAR(glm::length(high - light.shape.half_size), 0, 1e-6);
    EXPECT_NEAR(area, 4 * light.shape.half_size.x * light.shape.half_size.y, 1e-6);
}

/// What a single map has behind the upper of two sheets, the maps of the pieces see beside it.
TEST(SplitRendered, PiecesSeeMoreThanTheWhole) {
    const test::ComparisonOptions options{.width = 96, .height = 72, .samples = 64};
    const auto whole = test::compare("overlap", "backprojection,resolution=512", options);
    const auto split = test::compare("overlap", "backprojection,resolution=512,light=split", options);
    EXPECT_LT(*split.errors.rmse, 0.7 * *whole.errors.rmse);
}

}  // namespace
}  // namespace gn
