// SPDX-License-Identifier: MIT
// The pieces of a rectangle tile it, and V of it is the mean of theirs.
#include "shadow/light/split/split.h"
#include "scenes/analytic.h"
#include "tests/rig.h"

#include <algorithm>
#include <cmath>

namespace gn::split_test {
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

/// Along each axis across the light's own, and of a sphere along any, the points of all pieces together spread as its own do.
TEST(Split, RoundPiecesSpreadAsTheLightDoes) {
    const Part& part = find_part(Stage::light, "split");
    const Recipe recipe = load_recipe("pcss,light=split,split.round=true");
    for (const uint kind : {GN_LIGHT_DIRECTIONAL, GN_LIGHT_SPOT, GN_LIGHT_POINT}) {
        Light light;
        light.shape.kind = kind;
        light.shape.direction_ws = vec4(glm::normalize(vec3(1, -2, 0.5F)), 0);
        light.shape.radius = 0.4F;
        light.shape.angular_radius = 0.01F;
        const bool sun = kind == GN_LIGHT_DIRECTIONAL;
        const double radius = sun ? 0.01 : 0.4;
        const std::vector<Light> pieces = part.split(light, recipe);
        ASSERT_EQ(pieces.size(), 4U);
        const dvec3 along(light.shape.direction_ws);
        const dvec3 across = glm::normalize(glm::cross(along, dvec3(0, 0, 1)));
        for (const dvec3& axis : {across, glm::cross(along, across)}) {
            double mean = 0, square = 0;
            for (const Light& piece : pieces) {
                const double at =
                    glm::dot(axis, dvec3(sun ? vec3(piece.shape.direction_ws) : vec3(piece.shape.position_ws)));
                const double half = sun ? piece.shape.angular_radius : piece.shape.radius;
                mean += at / 4;
                square += (at * at + half * half / 4) / 4;
            }
            EXPECT_NEAR(mean, 0, 1e-6 * radius + 1e-7) << kind;
            EXPECT_NEAR(square / (radius * radius), 0.25, 1e-3) << kind;
        }
        light.shape.radius = light.shape.angular_radius = 0;
        EXPECT_EQ(part.split(light, recipe).size(), 1U) << "a light without extent has no pieces";
    }
}

/// [EASW09] eq. 1.5, of shares of the whole light that closed forms tell of each piece.
TEST(SplitRendered, PiecesFuseByTheRuleOfTheirName) {
    const scenes::Sheet sheet{2, {-12, -12}, {0, 12}};
    for (const char* fusion : {"sum", "max", "mean", "product"}) {
        const std::string text = fmt::format("backprojection,resolution=192,light=split,split.fusion={}", fusion);
        const auto c = test::compare("half-plane", text, {.width = 40, .height = 30, .samples = 1});
        const std::vector<Light> pieces =
            find_part(Stage::light, "split").split(c.scene.lights.front(), load_recipe(text));
        double squares = 0;
        double count = 0;
        for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
            if (c.truth.counted[i] == 0) {
                continue;
            }
            double sum = 0, most = 0, left = 1;
            for (const Light& piece : pieces) {
                const dvec3 p_ws(c.frame.samples.position_ws[i]);
                const double hidden = (1 - *scenes::sheet_visibility(piece.shape, {&sheet, 1}, p_ws)) / 4;
                sum += hidden;
                most = std::max(most, hidden);
                left *= 1 - hidden;
            }
            const std::string rule(fusion);
            const double expected = rule == "sum"    ? 1 - sum
                                    : rule == "max"  ? 1 - most
                                    : rule == "mean" ? 1 - (most + sum) / 2
                                                     : left;
            const double wrong = c.visibility().values[i] - expected;
            squares += wrong * wrong;
            count += 1;
        }
        EXPECT_GT(count, 100);
        EXPECT_LE(std::sqrt(squares / count), 0.02) << fusion;
    }
}

/// What a single map has behind the upper of two sheets, the maps of the pieces see beside it.
TEST(SplitRendered, PiecesSeeMoreThanTheWhole) {
    const test::ComparisonOptions options{.width = 96, .height = 72, .samples = 64};
    const auto whole = test::compare("overlap", "backprojection,resolution=512", options);
    const auto split = test::compare("overlap", "backprojection,resolution=512,light=split", options);
    EXPECT_LT(*split.errors.rmse, 0.7 * *whole.errors.rmse);
    // A sphere of pieces that overlap errs less than as a whole, too.
    const auto round =
        test::compare("overlap:light=point", "pcss,resolution=512,light=split,split.round=true", options);
    const auto sphere = test::compare("overlap:light=point", "pcss,resolution=512", options);
    EXPECT_LT(*round.errors.rmse, 0.7 * *sphere.errors.rmse);
}

}  // namespace
}  // namespace gn::split_test
