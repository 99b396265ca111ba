// SPDX-License-Identifier: MIT
// Where the view is split, which slice serves a receiver, what is culled and refused.
#include "tests/cascade_frame.h"

namespace gn::cascades_test {
namespace {

using namespace cascades;
using namespace test;
using glsl::GnChoice;
using glsl::GnProjected;
using glsl::GnReceiver;

TEST(CascadeSplits, LogarithmicEndsAreThePublishedOnes) {
    GnCascadesParams params{.count = 3, .split = GN_SPLIT_LOG};
    EXPECT_NEAR(glsl::gn_cascades_split(params, 1, 1000, 1), 10, 1e-4);
    EXPECT_NEAR(glsl::gn_cascades_split(params, 1, 1000, 2), 100, 1e-3);
    EXPECT_NEAR(glsl::gn_cascades_split(params, 0.1F, 1000, 1), 2.154, 5e-4);
    EXPECT_NEAR(glsl::gn_cascades_split(params, 0.1F, 1000, 2), 46.42, 5e-3);
}

TEST(CascadeSplits, UniformEndsAreEvenlySpaced) {
    GnCascadesParams params{.count = 4, .split = GN_SPLIT_UNIFORM};
    for (int i = 0; i <= 4; ++i) {
        EXPECT_NEAR(glsl::gn_cascades_split(params, 2, 10, i), 2 + 2 * i, 1e-5);
    }
}

TEST(CascadeSplits, PracticalRunsFromUniformToLogarithmic) {
    for (int i = 0; i <= 5; ++i) {
        GnCascadesParams practical{.count = 5, .split = GN_SPLIT_PRACTICAL};
        practical.alpha = 0;
        EXPECT_EQ(glsl::gn_cascades_split(practical, 0.5F, 300, i),
                  glsl::gn_cascades_split({.count = 5, .split = GN_SPLIT_UNIFORM}, 0.5F, 300, i));
        practical.alpha = 1;
        EXPECT_EQ(glsl::gn_cascades_split(practical, 0.5F, 300, i),
                  glsl::gn_cascades_split({.count = 5, .split = GN_SPLIT_LOG}, 0.5F, 300, i));
    }
    // Halfway: (10 + 334) / 2.
    GnCascadesParams half{.count = 3, .split = GN_SPLIT_PRACTICAL, .alpha = 0.5F};
    EXPECT_NEAR(glsl::gn_cascades_split(half, 1, 1000, 1), 172, 1e-3);
}

TEST(CascadeSplits, AdaptedNearGivesEverySliceButTheFirstTheSameRatio) {
    GnCascadesParams params{.count = 4, .split = GN_SPLIT_ADAPTED_NEAR};
    const auto end = [&](int i) { return glsl::gn_cascades_split(params, 0.001F, 512, i); };
    EXPECT_EQ(end(0), 0.001F);
    EXPECT_NEAR(end(1), 8, 1e-4);
    EXPECT_NEAR(end(2), 32, 1e-3);
    EXPECT_NEAR(end(3), 128, 1e-2);
    // A near plane given by hand: from 1 to 1000 the ratio is 1000^(1/4).
    params.adapted_near = 1;
    EXPECT_NEAR(glsl::gn_cascades_split(params, 0.001F, 1000, 1), 5.6234, 1e-3);
    // It never lies before the true one: then the scheme is the logarithmic one.
    params.adapted_near = 0.01F;
    EXPECT_EQ(glsl::gn_cascades_split(params, 1, 1000, 2),
              glsl::gn_cascades_split({.count = 4, .split = GN_SPLIT_LOG}, 1, 1000, 2));
}

TEST(CascadeSplits, EndsRiseForEveryScheme) {
    for (int split = 0; split <= GN_SPLIT_SDSM_HISTOGRAM; ++split) {
        for (int count = 1; count <= GN_CASCADES_MOST; ++count) {
            const GnCascadesParams params{.count = count, .split = split};
            float before = 0;
            for (int i = 0; i <= count; ++i) {
                const float end = glsl::gn_cascades_split(params, 0.1F, 10000, i);
                EXPECT_GT(end, before) << "split " << split << " count " << count << " end " << i;
                before = end;
            }
            EXPECT_EQ(before, 10000);
        }
    }
}

/// Three slices, ending at 10, 20 and 40 m.
GnCascadesData three_slices(int transition, float width) {
    return {.count = 3, .transition = transition, .select = GN_SELECT_DISTANCE, .width = width, .ends = {10, 20, 40}};
}

TEST(CascadeChoice, FollowsTheDistance) {
    const auto data = three_slices(GN_TRANSITION_NONE, 0.2F);
    EXPECT_EQ(glsl::gn_cascades_choose(receiver_at(0.1F), data).first, 0);
    EXPECT_EQ(glsl::gn_cascades_choose(receiver_at(10.01F), data).first, 1);
    EXPECT_EQ(glsl::gn_cascades_choose(receiver_at(39.9F), data).first, 2);
    EXPECT_EQ(glsl::gn_cascades_choose(receiver_at(1000), data).first, 2);
    EXPECT_EQ(glsl::gn_cascades_choose(receiver_at(9.99F), data).second, -1);
}

TEST(CascadeChoice, BlendRunsFromZeroToOneInTheBandAndNowhereElse) {
    const auto data = three_slices(GN_TRANSITION_BLEND, 0.2F);
    float before = 0;
    for (float z = 0.05F; z < 60; z += 0.05F) {
        const GnChoice choice = glsl::gn_cascades_choose(receiver_at(z), data);
        const bool in_band = (z > 8 && z <= 10) || (z > 18 && z <= 20);
        EXPECT_GE(choice.weight, 0) << z;
        EXPECT_LE(choice.weight, 1) << z;
        if (in_band && choice.second >= 0) {
            EXPECT_EQ(choice.second, choice.first + 1) << z;
            EXPECT_GE(choice.weight, before - 1e-6F) << z;
            before = choice.weight;
        } else {
            EXPECT_EQ(choice.second, -1) << z;
            before = 0;
        }
    }
    EXPECT_NEAR(glsl::gn_cascades_choose(receiver_at(9), data).weight, 0.5, 1e-5);
    EXPECT_NEAR(glsl::gn_cascades_choose(receiver_at(10), data).weight, 1, 1e-5);
}

TEST(CascadeChoice, DitherTakesTheNextSliceAsOftenAsBlendWeighsIt) {
    const auto data = three_slices(GN_TRANSITION_DITHER, 0.2F);
    for (const float z : {8.5F, 9.0F, 9.5F}) {
        double next = 0;
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                const GnChoice choice = glsl::gn_cascades_choose(
                    receiver_at(z, vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5F), data);
                EXPECT_EQ(choice.second, -1);
                next += choice.first;
            }
        }
        EXPECT_NEAR(next / 4096, (z - 8) / 2, 0.02) << z;
    }
    for (const float z : {5.0F, 7.99F, 12.0F, 17.9F}) {
        EXPECT_EQ(glsl::gn_cascades_choose(receiver_at(z), data).first, z < 10 ? 0 : 1);
    }
}

TEST(CascadeCulling, KeepsWhatCanCastAndDropsWhatCannot) {
    Scene scene;
    const auto box = [&](vec3 low, vec3 high) { scene.objects.push_back({"box", 0, 0, 0, Box{low, high}}); };
    box(vec3(-1, 0, -1), vec3(1, 1, 1));          // in the view
    box(vec3(-1, 90, -1), vec3(1, 91, 1));        // far above: before the near plane, still casts
    box(vec3(20, 0, 20), vec3(21, 1, 21));        // beside
    box(vec3(-1, -30, -1), vec3(1, -29, 1));      // behind the far plane
    box(vec3(-50, -0.1F, -50), vec3(50, 0, 50));  // larger than the view
    const ConvexBody body = body_of(Box{vec3(-5, 0, -5), vec3(5, 3, 5)});
    const GnLightView view = fit_orthographic(body, sun(vec3(0, -1, 0)), 256, {});
    EXPECT_EQ(casters_of(scene, view), (std::vector<std::uint32_t>{0, 1, 4}));
}

/// R 7.4.1: an object that spans fewer texels than asked for is left out of that map, and of no finer one.
TEST(CascadeCulling, SmallCastersAreLeftOutOfTheMapsThatAreTooCoarseForThem) {
    Scene scene;
    const auto box = [&](vec3 low, vec3 high) { scene.objects.push_back({"box", 0, 0, 0, Box{low, high}}); };
    box(vec3(0, 0, 0), vec3(0.1F, 0.1F, 0.1F));
    box(vec3(1, 0, 0), vec3(1.1F, 3, 0.1F));    // tall, but the light comes from above
    box(vec3(-3, 0, 0), vec3(-1, 0.1F, 0.1F));  // long
    box(vec3(-50, -0.1F, -50), vec3(50, 0, 50));
    const GnLight light = sun(vec3(0, -1, 0));
    const auto left = [&](float half, float least) {
        return casters_of(
            scene, fit_orthographic(body_of(Box{vec3(-half, 0, -half), vec3(half, 3, half)}), light, 256, {}), least);
    };
    // A texel of the near map measures 10 / 256 m, of the far one 80 / 256 m.
    EXPECT_EQ(left(5, 2).size(), 4U);
    EXPECT_EQ(left(5, 3), (std::vector<std::uint32_t>{2, 3}));
    EXPECT_EQ(left(40, 2), (std::vector<std::uint32_t>{2, 3}));
    EXPECT_EQ(left(40, 7), (std::vector<std::uint32_t>{3}));
    EXPECT_EQ(left(40, 0).size(), 4U);
}

TEST(CascadeData, PackedPositionsAreTheViewsOwn) {
    const GnLight light = sun(vec3(0.4F, -1, 0.3F));
    const Camera camera{.position_ws = vec3(1, 2, 3)};
    std::vector<GnLightView> views;
    for (const double far : {5.0, 20.0}) {
        views.push_back(fit_orthographic(body_of(camera, 1.5F, 0.1, far), light, 512, {}));
        views.push_back(plain_view(body_of(camera, 1.5F, 0.1, far), facing(camera, light), 512, {}));
    }
    const GnCascadesParams params{.count = 4};
    const GnCascadesData data = choice_data(params, {0.1, 20}, facing(camera, light), views, {.texels = 2});
    for (int i = 0; i < 4; ++i) {
        for (const vec3 p_ws : {vec3(1, 0, 0), vec3(-2, 1, -9), vec3(4, 3, 2)}) {
            const vec4 p_cs = views[static_cast<std::size_t>(i)].cs_from_ws * vec4(p_ws, 1);
            EXPECT_NEAR(glsl::gn_cascades_border(data, i, p_ws), std::max(std::abs(p_cs.x), std::abs(p_cs.y)), 1e-4);
        }
    }
}

TEST(CascadesRendered, RefusesToKeepWhatIsNotStable) {
    const Scene scene = load_scene("contact");
    for (const char* text : {"cascades,cascades.scroll=1,cascades.fit=fitted", "sdsm,cascades.rate=4",
                             "cascades,cascades.scroll=1,resolution=1000"}) {
        Light light = scene.lights[0];
        light.shape.kind = GN_LIGHT_DIRECTIONAL;
        EXPECT_THROW(check_recipe(load_recipe(text), scene, light, test::device()), Refusal) << text;
    }
}

}  // namespace
}  // namespace gn::cascades_test
