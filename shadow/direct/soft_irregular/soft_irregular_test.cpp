// SPDX-License-Identifier: MIT
// Edges asked through lists of a light view, against soft-volumes, closed forms, and itself through other lists.
#include "shadow/direct/soft_irregular/soft_irregular.glsl"

#include "scenes/analytic.h"
#include "tests/direct_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace gn::soft_irregular_test {
namespace {

using namespace by_hand;

TEST(SoftIrregularLaws, SumsOfEdgesAreTheSameInAnyOrder) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(-0.5F, 0.5F);
    std::vector<float> hidden(200);
    std::generate(hidden.begin(), hidden.end(), [&] { return unit(random); });
    const auto sum = [&](int penumbra) {
        int steps = 0;
        for (const float h : hidden) {
            steps += glsl::gn_soft_irregular_steps(h, penumbra);
        }
        return steps;
    };
    const int both = sum(GN_SOFT_IRREGULAR_BOTH), outer = sum(GN_SOFT_IRREGULAR_OUTER);
    double exact = 0, exact_outer = 0;
    for (const float h : hidden) {
        exact += static_cast<double>(h);
        exact_outer += std::max(static_cast<double>(h), 0.0);
    }
    // Half a step an edge at most.
    EXPECT_NEAR(both / static_cast<double>(glsl::gn_soft_irregular_one), exact, 1e-4);
    EXPECT_NEAR(outer / static_cast<double>(glsl::gn_soft_irregular_one), exact_outer, 1e-4);
    std::shuffle(hidden.begin(), hidden.end(), random);
    EXPECT_EQ(sum(GN_SOFT_IRREGULAR_BOTH), both);
    EXPECT_EQ(glsl::gn_soft_irregular_light(false, 1 << 18), 0.75F);
    EXPECT_EQ(glsl::gn_soft_irregular_light(true, -(1 << 18)), 0.25F);
    EXPECT_EQ(glsl::gn_soft_irregular_light(true, 1 << 18), 0.0F);
}

/// Boxes, a ring and boards over a ground, under each kind of light with an extent.
Scene soft_garden() {
    SceneBuilder b;
    b.ground(10).box({-1, 0, -1}, {0, 1.3F, 0.2F}).torus({1.4F, 1, 0}, 0.7F, 0.25F, 10);
    b.quad({-2, 1.6F, -2}, {-0.6F, 1.7F, -2}, {-0.6F, 1.7F, -0.8F}, {-2, 1.6F, -0.8F});
    b.camera({3.4F, 3.6F, 4.4F}, {0, 0.4F, 0});
    GnLight far = sun({0.3F, -1, -0.2F}), bulb = point({0.5F, 2.9F, 0.4F}), disc = spot({-3, 4, 2}, {0, 0, 0}, 0.5F);
    GnLight panel = rectangle({-1, 3.6F, 0.4F}, {0, 0, 0});
    far.angular_radius = 0.1F;
    bulb.radius = 0.3F;
    disc.radius = 0.4F;
    panel.half_size = vec2(0.5F, 0.3F);
    return b.light(far).light(bulb).light(disc).light(panel).scene();
}

FrameResult render(const Scene& scene, const Recipe& recipe, uint width = 96, uint height = 72) {
    const test::ValidationGuard guard;
    SceneGpu uploaded = upload_scene(device(), scene);
    FrameResult frame = render_frame(device(), uploaded, scene.cameras.front(), recipe,
                                     {.width = width, .height = height, .picture = false});
    for (const std::string& why : frame.refused) {
        EXPECT_EQ(why, "");
    }
    return frame;
}
FrameResult render(const Scene& scene, const std::string& recipe) {
    return render(scene, load_recipe(recipe));
}

TEST(SoftIrregularRendered, GivesWhatSoftVolumesGive) {
    const Scene scene = soft_garden();
    const FrameResult listed = render(scene, "soft-irregular,resolution=128"), drawn = render(scene, "soft-volumes");
    for (std::size_t light = 0; light < scene.lights.size(); ++light) {
        const std::vector<float>&v = listed.visibility[light].values, &w = drawn.visibility[light].values;
        std::size_t unlike = 0, penumbra = 0;
        for (std::size_t i = 0; i < v.size(); ++i) {
            penumbra += v[i] > 0 && v[i] < 1 ? 1 : 0;
            unlike += std::abs(v[i] - w[i]) > 1e-4F ? 1 : 0;
        }
        EXPECT_GT(penumbra, 150U) << "light " << light;
        // The hard edge of volumes is rasterized: a sample on it takes either side.
        EXPECT_LE(unlike, 8U) << "light " << light;
    }
}

TEST(SoftIrregularRendered, SlabIsExact) {
    const test::Comparison c =
        test::compare("slab", "soft-irregular,resolution=128", {.width = 96, .height = 96, .samples = 16});
    std::size_t penumbra = 0;
    double worst = 0;
    for (std::size_t i = 0; i < c.truth.visibility.size(); ++i) {
        const dvec3 p_ws(c.frame.samples.position_ws[i]);
        if (c.truth.counted[i] == 0 || std::abs(p_ws.y) > 1e-5) {
            continue;
        }
        const double v = *c.scene.closed_form(0, p_ws);
        penumbra += v > 0 && v < 1 ? 1 : 0;
        worst = std::max(worst, std::abs(v - static_cast<double>(c.visibility().values[i])));
    }
    EXPECT_GT(penumbra, 1000U);
    EXPECT_LT(worst, 1e-3) << "no sample takes the wrong side of the hard edge";
}

TEST(SoftIrregularRendered, IsTheSameOnEveryGridAndPlacementToTheBit) {
    const Scene scene = soft_garden();
    Recipe recipe = load_recipe("soft-irregular,resolution=64");
    const FrameResult fine = render(scene, recipe, 48, 36);
    recipe.resolution = 1;
    for (const Recipe& other : {recipe, load_recipe("soft-irregular,resolution=300"),
                                load_recipe("soft-irregular,resolution=64,placement=cascades+auto")}) {
        const FrameResult again = render(scene, other, 48, 36);
        for (std::size_t light = 0; light < scene.lights.size(); ++light) {
            EXPECT_EQ(again.visibility[light].values, fine.visibility[light].values)
                << other.resolution << " texels, light " << light;
        }
    }
}

TEST(SoftIrregularRendered, OuterPenumbraeLeaveTheHardShadowDark) {
    const Scene scene = soft_garden();
    const FrameResult both = render(scene, "soft-irregular,resolution=64"),
                      outer = render(scene, "soft-irregular,resolution=64,soft-irregular.penumbra=outer"),
                      hard = render(scene, "irregular-z,resolution=64");
    for (std::size_t light = 0; light < scene.lights.size(); ++light) {
        std::size_t given = 0, beside = 0;
        for (std::size_t i = 0; i < both.visibility[light].values.size(); ++i) {
            const float v = outer.visibility[light].values[i], w = both.visibility[light].values[i];
            if (hard.visibility[light].values[i] == 0.0F) {
                ASSERT_EQ(v, 0.0F) << "light " << light << ", sample " << i;
                given += w > 0 ? 1 : 0;
            } else {
                ASSERT_LE(v, w) << "light " << light << ", sample " << i;
                beside += v < 1 ? 1 : 0;
            }
        }
        EXPECT_GT(given, 60U) << "light " << light;
        EXPECT_GT(beside, 60U) << "light " << light;
    }
}

}  // namespace
}  // namespace gn::soft_irregular_test
