// SPDX-License-Identifier: MIT
// What stands for texels hides what casters hide, closed or with gaps; and halves of the light by each rule.
#include "scenes/analytic.h"
#include "scenes/mesh_builder.h"
#include "shadow/lookup/backprojection/cover.glsl"
#include "shadow/receiver/fusion.glsl"
#include "tests/rig.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace gn::occluders_test {
namespace {

/// Areas of texels side by side are those of the caster, whose edge lies within half a texel of theirs.
TEST(BackprojectionOccluders, AHalfPlanesRampIsStraightByAreas) {
    for (const char* occluder : {"micropatch,backprojection.gaps=false", "contour"}) {
        const auto c = test::compare(
            "half-plane",
            fmt::format("backprojection,resolution=64,backprojection.budget=0,backprojection.combine=area,"
                        "backprojection.occluder={}",
                        occluder),
            {.width = 24, .height = 18, .samples = 1});
        double sum = 0;
        double count = 0;
        for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
            const dvec3 p_ws(c.frame.samples.position_ws[i]);
            if (c.truth.counted[i] != 0 && p_ws.y < 0.1) {
                const double wrong = c.visibility().values[i] - c.scene.closed_form(0, p_ws).value();
                sum += wrong * wrong;
                count += 1;
            }
        }
        EXPECT_GT(count, 100);
        EXPECT_LE(std::sqrt(sum / count), 0.01) << occluder;
    }
}

/// A floor wholly under a roof of boxes, each as high as chance has it, under a lamp 1 m wide: no light arrives.
Scene rough_roof() {
    Scene scene;
    scenes::MeshBuilder builder(scene);
    const int chalk = builder.material("chalk", vec3(0.6F));
    builder.begin("floor (sheet)", chalk);
    builder.sheet({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    std::mt19937 random(13);
    builder.begin("roof", chalk);
    for (int i = 0; i < 576; ++i) {
        const vec3 low(0.25F * static_cast<float>(i % 24) - 3, 1, 0.25F * static_cast<float>(i / 24) - 3);
        const float height = 0.1F + 0.4F * static_cast<float>(random() % 1024) / 1024;
        builder.box(low, low + vec3(0.25F, height, 0.25F));
    }
    builder.finish();
    scene.lights.push_back(scenes::rectangle_light("lamp", {0, 4, 0}, {0, 0, 0}, {0.5F, 0.5F}, 1000));
    scene.cameras.push_back(scenes::look_at("main", {0, 0.8F, 1.8F}, {0, 0, 0}, 60, 0.1F, 40));
    return scene;
}

/// That all of a square is nearer than the receiver hides the light where occluders are closed. Without walls light comes through
/// the steps of the map, of which least and greatest depth do not tell.
TEST(BackprojectionOccluders, WithoutWallsTheUmbrasClassIsWrong) {
    const Scene roof = rough_roof();
    const auto values = [&](const char* settings) {
        return test::compare(
                   roof,
                   fmt::format("backprojection,resolution=64,backprojection.budget=0,backprojection.{}", settings),
                   {.width = 24, .height = 18, .samples = 1})
            .visibility()
            .values;
    };
    for (const float v : values("occluder=micropatch,backprojection.early_out=false")) {
        ASSERT_EQ(v, 0) << "walls close all";
    }
    const auto told = values("occluder=micropatch,backprojection.gaps=false"),
               full = values("occluder=micropatch,backprojection.gaps=false,backprojection.early_out=false");
    EXPECT_EQ(std::count(told.begin(), told.end(), 0.0F), static_cast<std::ptrdiff_t>(told.size())) << "all umbra";
    const auto wrong = std::count_if(full.begin(), full.end(), [](float v) { return v > 0; });
    EXPECT_GT(wrong, static_cast<std::ptrdiff_t>(full.size() / 4)) << "measured: 278 of 432, by up to 0.27";
    EXPECT_GT(*std::max_element(full.begin(), full.end()), 0.15F);
}

/// Halves of the light that one layer each hides, the same or one each: what every rule says of them.
TEST(BackprojectionOccluders, HalvesInTwoLayersAreWhatEachRuleSays) {
    const auto half = [](float left, bool bitmask, glsl::GnBackCover cover) {
        return glsl::gn_back_hide(cover, vec2(left, -1), vec2(left + 1, -1), vec2(left + 1, 1), vec2(left, 1), bitmask,
                                  false);
    };
    struct Case {
        float second;
        float united, sum, most, mean, product;
    };
    for (const Case& c : {Case{-1, 0.5F, 1, 0.5F, 0.75F, 0.75F}, Case{0, 1, 1, 0.5F, 0.75F, 0.75F}}) {
        const auto first = half(-1, true, glsl::gn_back_nothing());
        EXPECT_EQ(glsl::gn_back_hidden(half(c.second, true, first), true, false), c.united);
        glsl::GnFused fused = glsl::gn_unfused();
        for (const float left : {-1.0F, c.second}) {
            const float hidden = glsl::gn_back_hidden(half(left, false, glsl::gn_back_nothing()), false, false);
            EXPECT_EQ(hidden, 0.5F);
            fused = glsl::gn_fuse(fused, hidden);
        }
        EXPECT_EQ(glsl::gn_fused(fused, GN_FUSION_SUM), c.sum);
        EXPECT_EQ(glsl::gn_fused(fused, GN_FUSION_MAX), c.most);
        EXPECT_EQ(glsl::gn_fused(fused, GN_FUSION_MEAN), c.mean);
        EXPECT_EQ(glsl::gn_fused(fused, GN_FUSION_PRODUCT), c.product);
    }
}

/// What may be longer than a driver's loops is said.
TEST(BackprojectionOccluders, SearchesThatNothingLimitsAreRemarked) {
    const Part& part = find_part(Stage::lookup, "backprojection");
    const Scene& scene = test::built_in("slab");
    const auto remarked = [&](const char* recipe) { return !part.remark(scene, load_recipe(recipe)).empty(); };
    EXPECT_FALSE(remarked("backprojection"));
    EXPECT_TRUE(remarked("backprojection,backprojection.layers=2"));
    EXPECT_TRUE(remarked("backprojection,backprojection.budget=0"));
    EXPECT_TRUE(remarked("backprojection,backprojection.pyramid=none"));
    EXPECT_FALSE(remarked("backprojection,backprojection.layers=2,resolution=256"));
}

}  // namespace
}  // namespace gn::occluders_test
