// SPDX-License-Identifier: MIT
// A function says within epsilon what the hard shadows of the light's points say, anywhere along its texel's ray.
#include "shadow/map/penumbra_deep/penumbra_deep.glsl"

#include "shadow/placement/light_views.h"
#include "shadow/recipe/guard.h"
#include "tests/direct_scenes.h"
#include "tests/lent_points.h"

#include <random>

namespace gn::penumbra_deep_test {
namespace {

using namespace gn::glsl;

Scene stacked(const GnLight& light) {
    return by_hand::SceneBuilder()
        .ground(4)
        .box({-0.6F, 1.6F, -0.5F}, {0.5F, 1.9F, 0.6F})
        .box({-0.9F, 0.5F, -0.3F}, {0.3F, 0.8F, 0.9F})
        .light(light)
        .camera({0.5F, 4, 5}, {0, 0.4F, 0})
        .scene();
}

TEST(PenumbraDeep, ALineErrsByNoMoreThanEpsilonAtAllThatItPasses) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::size_t ends = 0;
    for (int turn = 0; turn < 200; ++turn) {
        const float epsilon = 0.02F + 0.1F * uniform(random);
        GnPenumbraLine line = gn_penumbra_line(vec2(0, 1));
        std::vector<vec2> passed;
        float depth = 0;
        float v = 1;
        for (int i = 0; i < 40; ++i) {
            depth += 0.02F * uniform(random) + 0.001F;
            v = std::clamp(v + 0.1F * (uniform(random) - 0.6F), 0.0F, 1.0F);
            if (!gn_penumbra_passes(line, vec2(depth, v), epsilon)) {
                ++ends;
                break;
            }
            passed.emplace_back(depth, v);
        }
        const vec2 end = gn_penumbra_end(line);
        EXPECT_EQ(end.x, passed.back().x);
        for (const vec2& at : passed) {
            EXPECT_NEAR(mix(line.node.y, end.y, at.x / end.x), at.y, epsilon + 1e-5F);
        }
    }
    EXPECT_GT(ends, 100U);
}

/// Points in the air and on the ground, on the rays of a map's texels, and what the recipe says of them.
TEST(PenumbraDeep, OnTheRaysOfTexelsItIsTheSumOfItsPointsHardShadowsWithinEpsilon) {
    GnLight sun = by_hand::sun({0.4F, -1, -0.3F});
    sun.angular_radius = 0.15F;
    // No bias: the maps are asked where the ray is, and nowhere beside it.
    const std::string bias =
        ",bias.constant=0,bias.normal=0,bias.slope=0,bias.cone=0,bias.receiver_plane=false,resolution=64";
    const Scene scene = stacked(sun);
    const std::string deep = fmt::format(
        "penumbra-deep,placement=single,penumbra-deep.lights=12,penumbra-deep.nodes=32,"
        "penumbra-deep.epsilon=0.06,filtered.footprint=radius,filtered.radius=0{}",
        bias);
    const std::string summed = fmt::format("hard,light=accumulate,placement=single,accumulate.lights=12{}", bias);

    const Recipe recipe = load_recipe(deep);
    const GnLightView view = fit_orthographic(body_of(scene.bounds_ws), scene.lights.front().shape, recipe.resolution,
                                              guard_of(recipe, scene.lights.front(), scene.bounds_ws));
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<test::LentPoint> points;
    for (int i = 0; i < 64 * 64; ++i) {
        const vec2 uv_ts = (vec2(i % 64, i / 64) + 0.5F) / 64.0F;
        // Half of them just above the ground, where penumbrae are wide.
        const vec3 near_ws = gn_point_at(view, uv_ts, 0), far_ws = gn_point_at(view, uv_ts, 1);
        const float height = i % 2 == 0 ? 1.5F * uniform(random) : 0.1F * uniform(random);
        const vec3 p_ws = mix(near_ws, far_ws, (height - near_ws.y) / (far_ws.y - near_ws.y));
        if (std::max(std::abs(p_ws.x), std::abs(p_ws.z)) < 1.9F && height > 0.02F) {
            points.push_back({p_ws, -vec3(sun.direction_ws)});
        }
    }
    std::set<std::string> remarks;
    const std::vector<float> v = test::visibility_at(scene, deep, points, &remarks);
    const std::vector<float> sum = test::visibility_at(scene, summed, points);
    EXPECT_TRUE(remarks.empty()) << *remarks.begin();
    std::size_t partial = 0;
    std::size_t beyond = 0;
    float worst = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
        partial += sum[i] > 0.01F && sum[i] < 0.99F ? 1 : 0;
        beyond += std::abs(v[i] - sum[i]) > 0.06F + 1e-4F ? 1 : 0;
        worst = std::max(worst, std::abs(v[i] - sum[i]));
    }
    EXPECT_GT(partial, v.size() / 20);
    // Rounding decides which texel a point takes that lies on the border of two.
    EXPECT_LE(beyond, v.size() / 500) << "of " << v.size();
    EXPECT_GT(worst, 0.01F);
}

TEST(PenumbraDeep, AFunctionWithoutRoomErrsByMoreAndSaysSo) {
    GnLight sun = by_hand::sun({0.4F, -1, -0.3F});
    sun.angular_radius = 0.15F;
    const Scene scene = stacked(sun);
    std::set<std::string> remarks;
    const std::vector<test::LentPoint> points(8);
    test::visibility_at(scene, "penumbra-deep,penumbra-deep.nodes=2,penumbra-deep.lights=8,resolution=32", points,
                        &remarks);
    ASSERT_EQ(remarks.size(), 1U);
    EXPECT_NE(remarks.begin()->find("penumbra-deep.nodes keeps more"), std::string::npos) << *remarks.begin();
}

TEST(PenumbraDeep, OfOtherLightsItIsCloseToTheSum) {
    for (const char* light : {"directional", "rectangle", "spot"}) {
        for (const int lights : {1, 8}) {
            const std::string scene = fmt::format("slab:light={}", light);
            const auto of = [&](const char* recipe, const char* part) {
                return test::compare(scene, fmt::format("{},resolution=128,{}.lights={}", recipe, part, lights),
                                     {64, 48, 16, ""});
            };
            const auto deep = of("penumbra-deep", "penumbra-deep"), summed = of("hard,light=accumulate", "accumulate");
            // Epsilon more, in the picture and where all of the light is hidden.
            EXPECT_LT(*deep.errors.rmse, *summed.errors.rmse + 0.05) << light << ", " << lights;
            EXPECT_LT(*deep.errors.leak, *summed.errors.leak + 0.05) << light << ", " << lights;
            EXPECT_LT(*deep.errors.acne, *summed.errors.acne + 0.05) << light << ", " << lights;
        }
    }
}

TEST(PenumbraDeep, SpheresAreRefusedByName) {
    GnLight lamp = by_hand::point({-1, 3, 1});
    lamp.radius = 0.5F;
    const Scene scene = stacked(lamp);
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameResult frame = render_frame(test::device(), gpu, scene.camera(""), load_recipe("penumbra-deep"),
                                           {.width = 16, .height = 16, .only_light = 0, .picture = false});
    EXPECT_NE(frame.refused.front().find("weigh otherwise for every receiver"), std::string::npos);
}

}  // namespace
}  // namespace gn::penumbra_deep_test
