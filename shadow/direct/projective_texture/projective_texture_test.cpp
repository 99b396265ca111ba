// SPDX-License-Identifier: MIT
#include "shadow/direct/projective_texture/projective_texture.glsl"

#include "tests/direct_scenes.h"
#include "tests/lent_points.h"

#include <gtest/gtest.h>

namespace gn {
namespace parts {
const Part& direct_projective_texture();
}
namespace projective_texture_test {
namespace {

using namespace by_hand;

TEST(ProjectiveTextureLaws, four_texels_are_mixed_by_their_nearness) {
    EXPECT_EQ(gn_projective_texture_light({0.3F, 1, 1, 1}, {0, 0}), 0.0F);
    EXPECT_EQ(gn_projective_texture_light({0.3F, 1, 1, 1}, {1, 0}), 1.0F);
    EXPECT_EQ(gn_projective_texture_light({0.3F, 1, 0.2F, 1}, {0.25F, 0.7F}), 0.25F);
    EXPECT_EQ(gn_projective_texture_light({1, 1, 0.2F, 0.9F}, {0.5F, 0.25F}), 0.75F);
}

TEST(ProjectiveTextureRendered, a_flat_receiver_has_the_hard_shadow_within_a_texel) {
    SceneBuilder b;
    b.ground(5).box({-1, 0.6F, -1}, {1, 1.5F, 1}).camera({4, 3.3F, 5.2F}, {0.2F, 0.4F, 0});
    const std::vector<GnLight> lights{sun({-0.4F, -1, 0.33F}), point({2.3F, 3.1F, 0.7F}),
                                      spot({-3, 4, 1.2F}, {0, 0.3F, 0}, 0.6F)};
    for (const GnLight& light : lights) {
        b.light(light);
    }
    const test::ValidationGuard guard;
    const Recipe recipe = load_recipe("projective-texture,resolution=2048");
    SceneGpu uploaded = upload_scene(device(), b.scene());
    FrameResult frame = render_frame(device(), uploaded, b.scene().cameras.front(), recipe,
                                     {.width = 96, .height = 72, .picture = false});
    for (std::size_t light = 0; light < lights.size(); ++light) {
        ASSERT_EQ(frame.refused[light], "");
        for (float& v : frame.visibility[light].values) {
            v = v > 0.5F ? 1.0F : 0.0F;  // the rim of a texel's width aside
        }
        FrameResult ground = frame;
        for (std::size_t i = 0; i < ground.samples.position_ws.size(); ++i) {
            if (std::abs(ground.samples.position_ws[i].y) > 1e-4F) {
                ground.samples.position_ws[i].w = 0;
                ground.visibility[light].values[i] = 0;
            }
        }
        const Comparison result = judge(b.scene(), ground, light);
        EXPECT_EQ(result.wrong, 0U) << result.judged << " judged: " << result.first;
        EXPECT_GT(result.shadowed, 50U);
        EXPECT_GT(result.lit, 500U);
    }
}

TEST(ProjectiveTextureRendered, scenes_of_receivers_alone_are_refused) {
    SceneBuilder b;
    b.ground(5).light(sun({0, -1, 0}));
    SceneGpu uploaded = upload_scene(device(), b.scene());
    const std::string refusal = render_frame(device(), uploaded, {}, load_recipe("projective-texture"),
                                             {.width = 8, .height = 8, .picture = false})
                                    .refused.front();
    EXPECT_NE(refusal.find("finds no occluder in 'by hand'"), std::string::npos) << refusal;
}

}  // namespace
}  // namespace projective_texture_test
}  // namespace gn
