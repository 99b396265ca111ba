// SPDX-License-Identifier: MIT
#include "shadow/direct/planar/planar.h"
#include "shadow/geometry/flattened.glsl"
#include "shadow/geometry/receiver_planes.h"
#include "tests/direct_scenes.h"

#include <gtest/gtest.h>

namespace gn {
namespace parts {
const Part& direct_planar();
}
namespace planar_test {
namespace {

using namespace by_hand;

TEST(PlanarLaws, the_projection_lies_on_the_plane_and_on_the_line_from_the_light) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> at(-1.0F, 1.0F);
    for (int round = 0; round < 1000; ++round) {
        const vec3 n = glm::normalize(vec3(at(random), at(random), at(random)));
        const vec4 plane(n, at(random));
        const vec3 foot = -plane.w * n;
        const vec3 p = foot + vec3(at(random), at(random), at(random)) + 3.0F * n;
        const bool directional = round % 2 == 0;
        const vec3 away(at(random), at(random), at(random));
        const vec4 light = directional ? vec4(glm::normalize(2.0F * n + away), 0) : vec4(p + 2.0F * n + away, 1);
        const vec4 q = gn_plane_project(plane, light, p);
        ASSERT_GT(q.w, 0.0F) << "between light and plane";
        const vec3 shadow = vec3(q) / q.w;
        EXPECT_NEAR(gn_plane_height(plane, vec4(shadow, 1)), 0.0F, 2e-5F);
        const vec3 to_light = directional ? vec3(light) : vec3(light) - p;
        EXPECT_NEAR(glm::length(glm::cross(glm::normalize(to_light), glm::normalize(p - shadow))), 0.0F, 1e-5F);
        // Above the light and below the plane the same matrix throws the antishadow: w changes its sign, or the height.
        if (!directional) {
            EXPECT_LT(gn_plane_project(plane, light, vec3(light) + 0.5F * n).w, 0.0F);
        }
    }
}

TEST(PlanarLaws, receivers_are_found_by_area_whatever_their_winding_and_tessellation) {
    // 20 x 20 ground in many triangles of both windings, a smaller table top, a ball that is flat nowhere.
    SceneBuilder b;
    for (int i = 0; i < 20; ++i) {
        const float x = static_cast<float>(i) - 10.0F;
        b.quad({x, 0, -10}, {x + 1, 0, -10}, {x + 1, 0, 10}, {x, 0, 10});
        if (i % 2 == 0) {
            b.quad({x, 0, 10}, {x + 1, 0, 10}, {x + 1, 0, 12}, {x, 0, 12});
        }
    }
    b.quad({-4, 1, -4}, {4, 1, -4}, {4, 1, 4}, {-4, 1, 4}).torus({0, 5, 0}, 3, 1, 40);
    const Scene& scene = b.scene();
    const auto found = receiver_planes(scene, {});
    ASSERT_EQ(found.planes.size(), 2U);
    const double total = 420 + 64 + 4 * std::numbers::pi * std::numbers::pi * 3;
    // The chords of the ball's 40 segments lose up to a hundredth of its area, which is a fifth of the whole.
    EXPECT_NEAR(found.planes[0].share, 420 / total, 0.01 * 0.2 * 420 / total);
    EXPECT_NEAR(found.planes[1].share, 64 / total, 0.01 * 0.2 * 64 / total);
    EXPECT_NEAR(std::abs(found.planes[0].plane_ws.y), 1.0F, 1e-6F);
    EXPECT_NEAR(found.planes[0].plane_ws.w, 0.0F, 1e-6F);
    EXPECT_NEAR(std::abs(found.planes[1].plane_ws.w), 1.0F, 1e-6F);
    EXPECT_EQ(receiver_planes(scene, {.planes = 1}).planes.size(), 1U);
    EXPECT_EQ(receiver_planes(scene, {.min_area = 0.2F}).planes.size(), 1U);
}

TEST(PlanarLaws, a_bent_ground_is_refused_with_its_figures) {
    SceneBuilder b;
    b.torus({0, 0, 0}, 3, 1, 60).light(sun({0, -1, 0}));
    const Recipe recipe = direct_recipe(parts::direct_planar());
    const auto refusal = [&] {
        SceneGpu gpu = upload_scene(device(), b.scene());
        return render_frame(device(), gpu, {}, recipe, {.width = 8, .height = 8, .picture = false}).refused.front();
    };
    const std::string sentence = refusal();
    EXPECT_NE(sentence.find("planar needs a flat receiver of at least 2 %"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("'by hand'"), std::string::npos) << sentence;
    b.ground(10);
    EXPECT_EQ(refusal(), "");
}

// ---- Rendered, against the traced hard shadow; every receiver of these scenes is flat. ----

struct Case {
    const char* name;
    Scene (*make)();
};

SceneBuilder all_kinds(SceneBuilder b) {
    b.light(sun({-0.4F, -1, 0.33F})).light(point({2.3F, 3.1F, 0.7F})).light(spot({-3, 4, 1.2F}, {0, 0.3F, 0}, 0.6F));
    b.light(rectangle({0.3F, 5, -3.2F}, {0, 0, 0}));
    return b;
}

const Case cases[] = {
    {"box_on_ground",
     [] {
         SceneBuilder b;
         b.ground(5).box({-1, 0, -1}, {1, 1.5F, 1}).camera({4, 3.3F, 5.2F}, {0.2F, 0.4F, 0});
         return all_kinds(b).scene();
     }},
    {"many_layers_darken_once",
     [] {
         SceneBuilder b;
         b.ground(3).soup({{-2, 1, -2}, {2, 2, 2}}, 0.5F, 60, 3).camera({0, 0.8F, 3.8F}, {0, 0, 0});
         return all_kinds(b).scene();
     }},
    {"the_light_from_below_and_a_caster_beyond_it",
     [] {
         // The quad above the lamp would throw an antishadow; the one below the ground a false one.
         SceneBuilder b;
         b.ground(4)
             .quad({-1, 4, -1}, {1, 4, -1}, {1, 4, 1}, {-1, 4, 1})
             .quad({-1, -2, -1}, {1, -2, -1}, {1, -2, 1}, {-1, -2, 1});
         b.quad({0.5F, 1, -1}, {1, 1, -1}, {1, 1, 1}, {0.5F, 1, 1}).camera({1, 3, 5}, {0, 0, 0});
         return b.light(point({0.2F, 2.5F, 0.1F})).light(point({0.1F, -1, 0.2F})).scene();
     }},
    {"a_caster_that_passes_through_light_height_and_ground",
     [] {
         SceneBuilder b;
         b.ground(4).quad({-1, -1, -0.5F}, {1, -1, -0.5F}, {1, 5, -0.9F}, {-1, 5, -0.9F}).camera({1, 3, 5}, {0, 0, 0});
         return b.light(point({0.2F, 2, 1.1F})).light(sun({0.2F, -1, -0.5F})).scene();
     }},
    {"a_corner_of_three_planes",
     [] {
         SceneBuilder b;
         b.ground(3)
             .quad({-3, 0, -3}, {3, 0, -3}, {3, 4, -3}, {-3, 4, -3})
             .quad({-3, 0, -3}, {-3, 4, -3}, {-3, 4, 3}, {-3, 0, 3});
         b.box({-1.8F, 0.5F, -2.2F}, {-0.5F, 1.9F, -1}).camera({2.5F, 2.7F, 2.9F}, {-1.4F, 0.8F, -1.6F});
         return b.light(point({2.4F, 2.8F, -1.7F})).light(sun({-1, -0.8F, -0.1F})).scene();
     }},
};

class PlanarRendered : public testing::TestWithParam<Case> {};

TEST_P(PlanarRendered, equals_the_traced_hard_shadow_on_flat_receivers) {
    const test::ValidationGuard guard;
    const Scene scene = GetParam().make();
    // Every flat part of these scenes is a receiver; the loose triangles of the soup are left to their share.
    const Recipe recipe = direct_recipe(parts::direct_planar(), {{"planes", "16"}, {"min_area", "0.001"}});
    const auto found = receiver_planes(scene, PlaneSearch{16, 0.001F, 1e-5F});
    SceneGpu uploaded = upload_scene(device(), scene);
    const FrameResult frame = render_frame(device(), uploaded, scene.cameras.front(), recipe,
                                           {.width = 160, .height = 120, .picture = false});
    std::size_t judged = 0, lit = 0, shadowed = 0;
    for (std::size_t light = 0; light < scene.lights.size(); ++light) {
        ASSERT_EQ(frame.refused[light], "");
        // Judge the samples that lie on a receiver: elsewhere the part promises V = 1 and no more.
        FrameResult flat = frame;
        for (std::size_t i = 0; i < flat.samples.position_ws.size(); ++i) {
            bool on_plane = false;
            for (const ReceiverPlane& p : found.planes) {
                on_plane = on_plane || gn_on_plane(p.plane_ws, found.tolerance, vec3(flat.samples.position_ws[i]),
                                                   vec3(flat.samples.normal_ws[i]));
            }
            if (!on_plane && flat.samples.position_ws[i].w > 0.0F) {
                EXPECT_EQ(frame.visibility[light].values[i],
                          gn_counted(scene.lights[light].shape, vec3(flat.samples.position_ws[i]),
                                     vec3(flat.samples.normal_ws[i]))
                              ? 1.0F
                              : 0.0F);
                flat.samples.position_ws[i].w = 0.0F;
                flat.visibility[light].values[i] = 0.0F;
            }
        }
        const Comparison result = judge(scene, flat, light);
        EXPECT_EQ(result.wrong, 0U) << scene.lights[light].name << ", " << result.judged << " judged: " << result.first;
        judged += result.judged;
        lit += result.lit;
        shadowed += result.shadowed;
    }
    EXPECT_GT(judged, 3000U);
    EXPECT_GT(lit, 500U);
    EXPECT_GT(shadowed, 50U);
}

INSTANTIATE_TEST_SUITE_P(Scenes, PlanarRendered, testing::ValuesIn(cases),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(PlanarMasked, holes_in_a_caster_are_holes_in_its_shadow) {
    SceneBuilder b;
    Texture stripes{.name = "stripes", .image = {64, 2, {}}};
    for (int i = 0; i < 128; ++i) {
        // The seam where the texture repeats lies within a stripe: at a rim of the quad alpha is never half.
        const std::uint8_t alpha = ((i + 8) / 16) % 2 == 0 ? 255 : 0;
        stripes.image.rgba.insert(stripes.image.rgba.end(), {255, 255, 255, alpha});
    }
    Material leaf{.name = "leaf", .alpha_mode = AlphaMode::mask, .alpha_cutoff = 0.5F};
    const int material = b.material(leaf, &stripes);
    b.ground(4).quad({-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}, material).camera({0.3F, 3, 3.6F}, {0, 0, 0});
    b.light(sun({0.6F, -1, 0.3F})).light(point({0.2F, 3, 0.4F}));
    const Scene& scene = b.scene();
    const std::vector<Comparison> results = render_and_judge(
        scene, direct_recipe(parts::direct_planar(), {{"planes", "1"}, {"min_area", "0.5"}}), 256, 192);
    for (const Comparison& result : results) {
        EXPECT_EQ(result.wrong, 0U) << result.first;
        EXPECT_GT(result.shadowed, 100U);
        EXPECT_GT(result.lit, 1000U);
    }
}

}  // namespace
}  // namespace planar_test
}  // namespace gn
