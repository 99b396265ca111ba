// SPDX-License-Identifier: MIT
// What a lookup tells beside V: its value, who gets it, and that nobody pays who does not ask.
#include "gpu/shader_inputs.h"
#include "scenes/analytic.h"
#include "shadow/show/show.h"
#include "tests/direct_scenes.h"
#include "tests/rig.h"

namespace gn::sides_test {
namespace {

constexpr uint side = 128;
const scenes::SolidBox floating{{-0.6, 0.8, -0.5}, {0.5, 1.3, 0.6}};

Scene under_sun() {
    return by_hand::SceneBuilder()
        .ground(4)
        .box(vec3(floating.low), vec3(floating.high))
        .light(by_hand::sun({0.6F, -1, -0.3F}))
        .camera({0.5F, 4, 5}, {0, 0.4F, 0})
        .scene();
}

/// Metres from p against the sun's rays to where they enter the box; 0 where they miss it.
double to_box(const GnLight& sun, dvec3 p_ws) {
    const dvec3 d = -dvec3(vec3(sun.direction_ws));
    const dvec3 t0 = (floating.low - p_ws) / d, t1 = (floating.high - p_ws) / d;
    const dvec3 near = glm::min(t0, t1), far = glm::max(t0, t1);
    const double enter = std::max({near.x, near.y, near.z}), leave = std::min({far.x, far.y, far.z});
    return enter < leave && leave > 1e-3 ? leave : 0;
}

TEST(LookupSides, TheBlockersDistanceIsTheWayToWhereLightMeetsIt) {
    const test::ValidationGuard guard;
    const Scene scene = under_sun();
    SceneGpu gpu = upload_scene(test::device(), scene);
    const std::vector<std::string> names{"blocker-distance"};
    const Shown shown = show_hidden(test::device(), gpu, scene.camera(""), load_recipe("hard,resolution=2048"), names,
                                    {.width = side, .height = side})
                            .front();
    const CpuSamples samples = render_samples(test::device(), gpu, scene.camera(""), side, side);
    std::size_t blocked = 0;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < samples.position_ws.size(); ++i) {
        const dvec3 p_ws(samples.position_ws[i]);
        if (samples.position_ws[i].w < 0.5F || std::abs(p_ws.y) > 1e-4) {
            continue;
        }
        // Two centimetres are some texels of the map: they and the change of the way over them cover edges.
        const auto told = static_cast<double>(shown.values.values[2 * i]);
        double least = 1e9;
        double most = -1e9;
        for (int x = -1; x <= 1; ++x) {
            for (int z = -1; z <= 1; ++z) {
                const double way = to_box(scene.lights.front().shape, p_ws + 0.02 * dvec3(x, 0, z));
                least = std::min(least, way);
                most = std::max(most, way);
            }
        }
        wrong += told < least - 0.02 || told > most + 0.02 ? 1 : 0;
        blocked += least > 0 ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0U);
    EXPECT_GT(blocked, 300U);
}

/// In `half-plane` the sheet hangs two metres above the ground and two below a light of a metre's width.
TEST(LookupSides, AHalfPlanesPenumbraIsAsFarFromItsBlockerAndAsWideAsItIs) {
    const test::ValidationGuard guard;
    const Scene scene = load_scene("half-plane");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const CpuSamples samples = render_samples(test::device(), gpu, scene.camera(""), 64, 48);
    const std::vector<std::string> names{"blocker-distance", "penumbra-width"};
    for (const char* recipe :
         {"pcss", "pcss,pcss.blocker=nearest", "vssm", "cssm", "sssm", "sssm,sssm.separable=false"}) {
        const std::vector<Shown> shown =
            show_hidden(test::device(), gpu, scene.camera(""), load_recipe(std::string(recipe) + ",resolution=256"),
                        names, {.width = 64, .height = 48});
        // The ramp ends at half a metre, and texels follow. A truncated series has waves beside its step, and finds a little
        // there that hides the light.
        const bool waves = std::string_view(recipe) == "cssm";
        std::size_t penumbra = 0, lit = 0;
        for (std::size_t i = 0; i < samples.position_ws.size(); ++i) {
            const vec3 p_ws(samples.position_ws[i]);
            const bool ground = samples.position_ws[i].w > 0.5F && std::abs(p_ws.y) < 1e-4F;
            const float distance = shown[0].values.values[2 * i], width = shown[1].values.values[2 * i];
            if (ground && p_ws.x > 0.6F && !waves) {
                ASSERT_EQ(distance, 0) << recipe << " at " << p_ws.x;
                ASSERT_EQ(width, 0) << recipe << " at " << p_ws.x;
                ++lit;
            } else if (ground && std::abs(p_ws.x) < 0.3F) {
                ASSERT_NEAR(distance, 2, 0.1) << recipe << " at " << p_ws.x;
                // w_l (d_r - d_o) / d_o, whose slope over the distance is 4 / d_o^2 = 1.
                ASSERT_NEAR(width, 1, 0.1) << recipe << " at " << p_ws.x;
                ++penumbra;
            }
        }
        EXPECT_GT(penumbra, 100U) << recipe;
        EXPECT_TRUE(waves || lit > 100) << recipe;
    }
}

/// In `overlap` sheets end over x = 0, two and three metres below a light at five: of both the search of pcss takes a mean, or
/// that nearer to the light.
TEST(LookupSides, OfTwoBlockersTheNearestOrAMeanTellsThePenumbrasWidth) {
    const test::ValidationGuard guard;
    const Scene scene = load_scene("overlap:arrangement=opposite");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const CpuSamples samples = render_samples(test::device(), gpu, scene.camera(""), 64, 48);
    const std::vector<std::string> names{"blocker-distance", "penumbra-width"};
    const auto told = [&](const std::string& blocker) {
        const Recipe recipe = load_recipe("pcss,resolution=256,pcss.blocker=" + blocker);
        return show_hidden(test::device(), gpu, scene.camera(""), recipe, names, {.width = 64, .height = 48});
    };
    const std::vector<Shown> nearest = told("nearest"), average = told("average");
    const float light = 2 * scene.lights.front().shape.half_size.x;
    std::size_t both = 0;
    for (std::size_t i = 0; i < samples.position_ws.size(); ++i) {
        const vec3 p_ws(samples.position_ws[i]);
        if (samples.position_ws[i].w < 0.5F || std::abs(p_ws.y) > 1e-4F || std::abs(p_ws.x) > 0.15F) {
            continue;
        }
        // The bias moves the receiver by a fifth of a texel, which is some 9 cm. w_l (d_r - d_o) / d_o, d_o = 2 or 3 of 5 m.
        ASSERT_NEAR(nearest[0].values.values[2 * i], 3, 0.02) << p_ws.x;
        ASSERT_NEAR(nearest[1].values.values[2 * i], 1.5F * light, 0.01F * light) << p_ws.x;
        ASSERT_GT(average[0].values.values[2 * i], 2.1) << p_ws.x;
        ASSERT_LT(average[0].values.values[2 * i], 2.9) << p_ws.x;
        ASSERT_LT(average[1].values.values[2 * i], 1.4F * light) << p_ws.x;
        ++both;
    }
    EXPECT_GT(both, 100U);
}

/// V from what the lookup told: half where the blocker is nearer than a metre and a quarter.
Visibility add_near(const FrameInput& input, const Recipe&, const Visibility& given) {
    const Offer* distance = given.find("blocker-distance");
    GN_CHECK(distance != nullptr);
    const Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs;
    inputs.texture("sampler2D", "given", given.image).texture("sampler2D", "distance_m", distance->texture);
    inputs.image("r32f", "writeonly", "image2D", "visibility", result.image);
    const ComputeDesc shader{{ShaderKind::compute, "near", inputs.text() + R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, imageSize(visibility)))) {
        float metres = texelFetch(distance_m, pixel, 0).r;
        float v = texelFetch(given, pixel, 0).r;
        imageStore(visibility, pixel, vec4(metres > 0.0 && metres < 1.25 ? 0.5 : v));
    }
}
)"},
                             {}};
    input.graph.add_pass(
        "near", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader](Recorder& r) {
            r.bind(shader);
            inputs.set(r);
            r.dispatch_pixels(side, side);
        });
    return result;
}

Part near_part() {
    Part part;
    part.id = "near";
    part.stage = Stage::visibility;
    part.needs = {"blocker-distance"};
    part.add_visibility = add_near;
    return part;
}

FrameResult render(const Scene& scene, const Recipe& recipe) {
    SceneGpu gpu = upload_scene(test::device(), scene);
    return render_frame(test::device(), gpu, scene.camera(""), recipe,
                        {.width = side, .height = side, .repeat = 0, .only_light = 0, .picture = false});
}

TEST(LookupSides, LaterStagesReadWhatTheyNameAndNobodyElsePays) {
    const test::ValidationGuard guard;
    const Scene scene = under_sun();
    const Part near = near_part();
    Recipe recipe = load_recipe("hard");
    const FrameResult plain = render(scene, recipe);
    recipe.visibility = {&near};
    const FrameResult asked = render(scene, recipe);
    ASSERT_EQ(asked.refused.front(), "");
    // Rays that leave the box by a side leave it low: nearer to the ground than those that leave it at its top.
    std::size_t halved = 0;
    for (std::size_t i = 0; i < plain.visibility.front().values.size(); ++i) {
        const float before = plain.visibility.front().values[i], after = asked.visibility.front().values[i];
        EXPECT_TRUE(after == before || (after == 0.5F && before == 0)) << i;
        const double way = to_box(scene.lights.front().shape, dvec3(asked.samples.position_ws[i]));
        EXPECT_TRUE(after != 0.5F || (way > 0 ? way < 1.35 : before == 0)) << i << ": " << way;
        halved += after == 0.5F ? 1 : 0;
    }
    EXPECT_GT(halved, 20U);
    // Without the question there is no image more and no pass more.
    EXPECT_EQ(plain.statistics.passes.size() + 1, asked.statistics.passes.size());
    EXPECT_EQ(plain.statistics.resources.size() + 2, asked.statistics.resources.size());
}

TEST(LookupSides, WhatNobodyTellsIsRefusedByName) {
    const Scene scene = under_sun();
    const Part near = near_part();
    for (const char* text : {"pcf", "volumes", "hard,light=accumulate"}) {
        Recipe recipe = load_recipe(text);
        recipe.visibility = {&near};
        const std::string refused = render(scene, recipe).refused.front();
        EXPECT_NE(refused.find("'blocker-distance'"), std::string::npos) << refused;
        EXPECT_NE(refused.find("lookups that tell it: hard"), std::string::npos) << refused;
    }
    SceneGpu gpu = upload_scene(test::device(), scene);
    const std::vector<std::string> names{"blocker-distance"};
    EXPECT_THROW(static_cast<void>(show_hidden(test::device(), gpu, scene.camera(""), load_recipe("pcf"), names, {})),
                 Refusal);
}

}  // namespace
}  // namespace gn::sides_test
