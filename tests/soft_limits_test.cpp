// SPDX-License-Identifier: MIT
// Soft shadows at their limits: a light without extent is a hard shadow's, and where light, casters and receivers meet V stays a
// share of the light.
#include "tests/direct_scenes.h"
#include "tests/rig.h"
#include "tests/thorough.h"

#include <algorithm>
#include <cmath>

namespace gn::soft_limits_test {
namespace {

std::vector<float> values_of(const Scene& scene, const Recipe& recipe, std::size_t light) {
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameResult frame =
        render_frame(test::device(), gpu, scene.camera(""), recipe,
                     {.width = 64, .height = 48, .repeat = 0, .only_light = static_cast<int>(light), .picture = false});
    EXPECT_EQ(frame.refused.at(light), "");
    return frame.visibility.at(light).values;
}

/// With a least width of nothing a kernel is the texel that a hard shadow compares with.
TEST(SoftLimits, ALightWithoutExtentIsAHardShadows) {
    const test::ValidationGuard guard;
    const Scene& scene = test::built_in("contact");
    const std::vector<float> hard = values_of(scene, load_recipe("hard,resolution=256"), 0);
    EXPECT_GT(std::count(hard.begin(), hard.end(), 1.0F), 500);
    for (const char* recipe : {"pcss,pcss.least=0", "chs,chs.least=0", "sssm,sssm.least=0", "backprojection",
                               "soft-quality,placement=auto,pcss.least=0", "fake-penumbra", "occlusion-textures"}) {
        const std::vector<float> soft = values_of(scene, load_recipe(std::string(recipe) + ",resolution=256"), 0);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < soft.size(); ++i) {
            differ += soft[i] != hard[i] ? 1 : 0;
        }
        EXPECT_EQ(differ, 0U) << recipe;
    }
}

/// What is filtered ahead is never a hard shadow at its edges, where it blends texels, and is it everywhere else.
TEST(SoftLimits, OfMomentsALightWithoutExtentIsAHardShadowsButAtEdges) {
    const test::ValidationGuard guard;
    const Scene& scene = test::built_in("contact");
    const std::vector<float> hard = values_of(scene, load_recipe("hard,resolution=512"), 0);
    const std::vector<float> soft = values_of(scene, load_recipe("vssm,vssm.least=0,resolution=512"), 0);
    std::size_t within = 0, differ = 0;
    for (int y = 2; y < 46; ++y) {
        for (int x = 2; x < 62; ++x) {
            const auto at = [&](int dx, int dy) { return static_cast<std::size_t>((y + dy) * 64 + x + dx); };
            bool edge = false;
            for (int k = 0; k < 25; ++k) {
                edge = edge || hard[at(k % 5 - 2, k / 5 - 2)] != hard[at(0, 0)];
            }
            within += edge ? 0 : 1;
            differ += !edge && std::abs(soft[at(0, 0)] - hard[at(0, 0)]) > 0.01F ? 1 : 0;
        }
    }
    EXPECT_GT(within, 1000U);
    EXPECT_EQ(differ, 0U) << "of " << within;
}

/// A recipe, and the kind of light that it meets; in a thorough sweep it meets every one.
struct Case {
    std::string recipe;
    std::size_t light;
};
class SoftLimitsOf : public testing::TestWithParam<Case> {};

/// A ball of light larger than its distance, whose middle a box goes through; a panel that stands on the ground, with a wall
/// through it; a spot whose disc the box cuts.
Scene meeting() {
    GnLight ball = by_hand::point({0, 0.8F, 0});
    ball.radius = 3;
    GnLight panel = by_hand::rectangle({-2, 0.5F, 0}, {0, 0.5F, 0});
    panel.half_size = vec2(0.5F);
    GnLight disc = by_hand::spot({0.3F, 1, 0.4F}, {1, 0, 1}, 1);
    disc.radius = 1.5F;
    return by_hand::SceneBuilder()
        .ground(5)
        .box({-0.5F, 0.4F, -0.5F}, {0.5F, 1.2F, 0.5F})
        .box({-2.2F, 0, -0.1F}, {-1.4F, 0.9F, 0.1F})
        .light(ball)
        .light(panel)
        .light(disc)
        .camera({1, 3, 4}, {-0.3F, 0.3F, 0})
        .scene();
}

TEST_P(SoftLimitsOf, WhereLightCastersAndReceiversMeetVIsAShareOfTheLight) {
    const test::ValidationGuard guard;
    const Scene scene = meeting();
    for (std::size_t light = 0; light < scene.lights.size(); ++light) {
        if (!test::thorough() && light != GetParam().light) {
            continue;
        }
        const std::vector<float> values = values_of(scene, load_recipe(GetParam().recipe), light);
        EXPECT_EQ(std::count_if(values.begin(), values.end(), [](float v) { return !(v >= 0 && v <= 1); }), 0)
            << "of light " << light;
    }
}

std::string name_of_case(const testing::TestParamInfo<Case>& given) {
    std::string name = given.param.recipe.substr(0, given.param.recipe.find(','));
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

constexpr std::size_t ball = 0, panel = 1, disc = 2;

INSTANTIATE_TEST_SUITE_P(Recipes, SoftLimitsOf,
                         testing::Values(Case{"pcss,resolution=128", disc}, Case{"chs,resolution=128", panel},
                                         Case{"vssm,resolution=128", ball}, Case{"cssm,resolution=64", panel},
                                         Case{"sssm,resolution=128", disc}, Case{"backprojection,resolution=128", ball},
                                         Case{"fake-penumbra,resolution=128", disc},
                                         Case{"occlusion-textures,resolution=64", ball},
                                         Case{"backprojection-split,resolution=64", panel},
                                         Case{"accumulate,accumulate.lights=4,resolution=128", disc},
                                         Case{"accumulate-adaptive,accumulate-adaptive.levels=1,resolution=128", disc},
                                         Case{"layered-attenuation,layered-attenuation.lights=4,resolution=64", disc},
                                         Case{"soft,resolution=128", panel}, Case{"soft-quality,resolution=128", ball}),
                         name_of_case);

}  // namespace
}  // namespace gn::soft_limits_test
