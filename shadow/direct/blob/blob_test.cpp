// SPDX-License-Identifier: MIT
#include "shadow/direct/blob/blob.glsl"

#include "tests/direct_scenes.h"

#include <gtest/gtest.h>

namespace gn {
namespace parts {
const Part& direct_blob();
}
namespace blob_test {
namespace {

using namespace by_hand;

TEST(BlobLaws, a_disc_hides_its_area_whatever_its_softness) {
    for (const float softness : {0.0F, 0.25F, 0.5F, 1.0F}) {
        double sum = 0;
        constexpr double step = 1e-4;
        for (double x = 0.5 * step; x < 3; x += step) {
            sum += static_cast<double>(glsl::gn_blob_profile(static_cast<float>(x), softness)) * 2 * x * step;
        }
        EXPECT_NEAR(sum, 1, 2e-3) << softness;
    }
}

TEST(BlobLaws, the_radius_has_the_area_of_the_bounds_shadow) {
    EXPECT_NEAR(glsl::gn_blob_radius({0, 0, 0}, {2, 1, 3}, {0, 1, 0}), std::sqrt(6 / std::numbers::pi), 1e-5);
    EXPECT_NEAR(glsl::gn_blob_radius({0, 0, 0}, {2, 0, 3}, {1, 0, 0}), 0, 1e-6);
    const vec3 along = glm::normalize(vec3(1, 2, -1));
    EXPECT_NEAR(glsl::gn_blob_radius({0, 0, 0}, {2, 1, 3}, along),
                std::sqrt((along.x * 3 + along.y * 6 - along.z * 2) / std::numbers::pi), 1e-5);
}

TEST(BlobRendered, darkness_on_the_ground_is_the_area_of_the_shadow) {
    const test::ValidationGuard guard;
    SceneBuilder b;
    b.ground(8).box({-0.5F, 1.5F, -0.4F}, {0.5F, 2, 0.4F}).camera({0, 9, 0.01F}, {0, 0, 0});
    b.light(sun({-1, -1, 0.4F})).light(point({0, 6, 0}));
    SceneGpu uploaded = upload_scene(device(), b.scene());
    const FrameResult frame = render_frame(device(), uploaded, b.scene().cameras.front(),
                                           direct_recipe(parts::direct_blob(), {{"softness", "0.3"}}),
                                           {.width = 128, .height = 128, .picture = false});
    const float pixel = 2 * std::tan(0.5F * b.scene().cameras.front().yfov) * 9 / 128;
    for (int light = 0; light < 2; ++light) {
        double hidden = 0;
        for (std::size_t i = 0; i < frame.samples.position_ws.size(); ++i) {
            const vec4 p_ws = frame.samples.position_ws[i];
            if (p_ws.w > 0 && std::abs(p_ws.y) < 1e-4F) {
                hidden += static_cast<double>(1 - frame.visibility[static_cast<std::size_t>(light)].values[i]);
            } else if (p_ws.w > 0 && frame.samples.normal_ws[i].y > 0.5F) {
                EXPECT_EQ(frame.visibility[static_cast<std::size_t>(light)].values[i], 1.0F) << "the caster itself";
            }
        }
        // Of the sun: the shadow across the rays, longer on the ground by the cosine. Of the lamp right above, the box hides the
        // most of it from the camera.
        const vec3 d = glm::normalize(vec3(-1, -1, 0.4F));
        const double area = static_cast<double>(std::abs(d.x) * 0.4F + std::abs(d.y) * 0.8F + std::abs(d.z) * 0.5F) /
                            static_cast<double>(std::abs(d.y));
        if (light == 0) {
            EXPECT_NEAR(hidden * static_cast<double>(pixel) * static_cast<double>(pixel), area, 0.03 * area);
        } else {
            EXPECT_GT(hidden, 0);
        }
    }
}

}  // namespace
}  // namespace blob_test
}  // namespace gn
