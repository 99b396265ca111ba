// SPDX-License-Identifier: MIT
#include "shadow/direct/planar_soft/planar_soft.glsl"

#include "shadow/scene/light_samples.h"
#include "tests/direct_scenes.h"

#include <gtest/gtest.h>

namespace gn {
namespace parts {
const Part& direct_planar();
const Part& direct_planar_soft();
}  // namespace parts
namespace planar_soft_test {
namespace {

using namespace by_hand;

Scene board_over_ground(GnLight light) {
    SceneBuilder b;
    b.ground(4).quad({-0.7F, 1, -0.5F}, {0.6F, 1, -0.5F}, {0.6F, 1, 0.4F}, {-0.7F, 1.2F, 0.4F});
    b.camera({1, 3, 3.5F}, {0, 0, 0});
    return b.light(light).scene();
}

FrameResult render(const Scene& scene, const Recipe& recipe, uint width = 96, uint height = 72) {
    const test::ValidationGuard guard;
    SceneGpu uploaded = upload_scene(device(), scene);
    FrameResult frame = render_frame(device(), uploaded, scene.cameras.front(), recipe,
                                     {.width = width, .height = height, .picture = false});
    EXPECT_EQ(frame.refused.front(), "");
    return frame;
}

TEST(PlanarSoftLaws, a_box_filter_of_any_width_weighs_one) {
    for (const float width : {0.0F, 0.5F, 1.0F, 1.3F, 2.0F, 5.7F, 31.0F}) {
        double sum = 0, variance = 0;
        const int reach = glsl::gn_planar_soft_reach(width);
        for (int i = -reach; i <= reach; ++i) {
            sum += static_cast<double>(glsl::gn_planar_soft_weight(i, width));
            variance += static_cast<double>(glsl::gn_planar_soft_weight(i, width)) * i * i;
        }
        EXPECT_NEAR(sum, 1, 1e-5) << width;
        // A box of w texels has w^2 / 12; texels are boxes of one themselves, whose centres here stand for them.
        const double w = std::max(width, 1.0F);
        EXPECT_NEAR(variance, w * w / 12, 0.17) << width;
    }
}

TEST(PlanarSoftRendered, accumulation_is_the_trace_of_the_same_points) {
    GnLight lamp = point({0.3F, 3, -0.4F}), disc = spot({-1, 3.2F, 0.6F}, {0, 0, 0}, 0.9F),
            day = sun({-0.3F, -1, 0.2F});
    lamp.radius = 0.4F;
    disc.radius = 0.4F;
    day.angular_radius = 0.1F;
    GnLight window = rectangle({0.6F, 3, 0.7F}, {0, 0, 0});
    window.half_size = {0.5F, 0.3F};
    for (const GnLight& light : {lamp, disc, day, window}) {
        const Scene scene = board_over_ground(light);
        const Recipe recipe = direct_recipe(parts::direct_planar_soft(), {{"samples", "16"}, {"planes", "1"}});
        const FrameResult frame = render(scene, recipe);
        const LightSamples samples = light_samples(light, 16);
        const TruthResult traced = Truth(scene).trace(frame.samples.position_ws, frame.samples.normal_ws, light,
                                                      {.exactly = &samples, .width = frame.samples.width});
        double off = 0, penumbra = 0;
        std::size_t counted = 0;
        for (std::size_t i = 0; i < traced.visibility.size(); ++i) {
            if (traced.counted[i] != 0 && std::abs(frame.samples.position_ws[i].y) < 1e-4F) {
                const float v = frame.visibility[0].values[i];
                off += static_cast<double>(std::abs(v - traced.visibility[i]));
                penumbra += v > 0.01F && v < 0.99F ? 1 : 0;
                ++counted;
            }
        }
        EXPECT_GT(penumbra, 100);
        // The rasterizer moves an edge by 1/256 of a pixel: some 100 pixels of edge a point, of 4,000 pixels.
        EXPECT_LT(off / static_cast<double>(counted), 100.0 / 256 / 4000 * 2) << light.kind;
    }
}

TEST(PlanarSoftRendered, a_light_without_extent_is_planar) {
    const Scene scene = board_over_ground(point({0.3F, 3, -0.4F}));
    const FrameResult hard = render(scene, direct_recipe(parts::direct_planar()));
    EXPECT_EQ(render(scene, direct_recipe(parts::direct_planar_soft())).visibility[0].values,
              hard.visibility[0].values);
    // Of a picture of the plane the same, but for the texels at the rim.
    const FrameResult drop =
        render(scene, direct_recipe(parts::direct_planar_soft(), {{"mode", "blur"}, {"texels", "2048"}}));
    double off = 0, dark = 0;
    for (std::size_t i = 0; i < hard.visibility[0].values.size(); ++i) {
        off += static_cast<double>(std::abs(hard.visibility[0].values[i] - drop.visibility[0].values[i]));
        dark += hard.visibility[0].values[i] == 0.0F && hard.samples.position_ws[i].w > 0 ? 1 : 0;
    }
    EXPECT_GT(dark, 200);
    EXPECT_LT(off, 40);  // a pixel and a half a row of the rim at most
}

TEST(PlanarSoftRendered, one_caster_of_one_height_has_the_right_drop_shadow) {
    // Of the half-plane the blur is the penumbra itself: the closed form, but for the picture's texels.
    const test::Comparison c =
        test::compare("half-plane", "planar-soft,planar-soft.mode=blur,planar-soft.height=1,planar-soft.texels=1024",
                      {.width = 96, .height = 96, .samples = 16});
    double worst = 0;
    for (std::size_t i = 0; i < c.truth.visibility.size(); ++i) {
        const dvec3 p_ws(c.frame.samples.position_ws[i]);
        if (c.truth.counted[i] != 0 && std::abs(p_ws.y) < 1e-5) {
            worst = std::max(
                worst, std::abs(*c.scene.closed_form(0, p_ws) - static_cast<double>(c.frame.visibility[0].values[i])));
        }
    }
    // Two texels of the 15 m that the picture holds, over a penumbra half a metre wide.
    EXPECT_LT(worst, 0.06);
}

}  // namespace
}  // namespace planar_soft_test
}  // namespace gn
