// SPDX-License-Identifier: MIT
// Views that look one way are taken by scale and offset: what is put together again is the view, and others are left alone.
#include "shadow/receiver/parallel_views.h"
#include "tests/warp_scene.h"

#include <glm/gtc/matrix_access.hpp>

#include <gtest/gtest.h>

namespace gn::parallel_views_test {
namespace {

/// Coordinates of points of the scene differ by what single precision rounds three products and their sum to.
void expect_same(const GnLightView& made, const GnLightView& view, const Box& bounds_ws, std::string_view recipe) {
    const double step = 4 * static_cast<double>(std::numeric_limits<float>::epsilon());
    for (const vec3& p_ws : {bounds_ws.min, bounds_ws.max, 0.3F * bounds_ws.min + 0.7F * bounds_ws.max}) {
        const auto size = [&](const vec4& row) {
            return step * static_cast<double>(glm::dot(glm::abs(row), vec4(glm::abs(p_ws), 1)));
        };
        for (int row = 0; row < 2; ++row) {
            const vec4 was = glm::row(view.cs_from_ws, row);
            EXPECT_NEAR(glm::dot(dvec4(glm::row(made.cs_from_ws, row)), dvec4(p_ws, 1)),
                        glm::dot(dvec4(was), dvec4(p_ws, 1)), size(was))
                << recipe;
        }
        EXPECT_NEAR(glm::dot(dvec4(made.depth_from_ws), dvec4(p_ws, 1)),
                    glm::dot(dvec4(view.depth_from_ws), dvec4(p_ws, 1)), size(view.depth_from_ws))
            << recipe;
    }
}

TEST(ParallelViews, CascadesAreTheirAxesScalesAndOffsets) {
    for (const char* scene_name : {"corridor", "courtyard"}) {
        const Scene scene = load_scene(scene_name);
        for (const char* recipe :
             {"hard,placement=cascades", "hard,placement=cascades,cascades.count=3,cascades.split=log",
              "pcss,placement=cascades,cascades.scroll=1"}) {
            const LightViews views = test::place(scene, recipe);
            const auto parallel = parallel_views(views);
            ASSERT_TRUE(parallel.has_value()) << recipe;
            ASSERT_EQ(parallel->places.size(), views.views.size());
            for (std::size_t i = 0; i < views.views.size(); ++i) {
                // All that is put together comes from axes and places.
                GnLightView blank = views.views[i];
                blank.cs_from_ws = mat4(0);
                blank.depth_from_ws = vec4(0);
                expect_same(gn_along_axes(blank, parallel->axes, parallel->places[i]), views.views[i], scene.bounds_ws,
                            recipe);
            }
        }
    }
}

TEST(ParallelViews, OthersAreTakenAsTheyAre) {
    const Scene scene = load_scene("corridor");
    EXPECT_FALSE(parallel_views(test::place(scene, "hard,placement=fit"))) << "one view";
    EXPECT_FALSE(parallel_views(test::place(scene, "hard,placement=cascades,cascades.count=6")))
        << "more than are taken";
    EXPECT_FALSE(parallel_views(test::place(scene, "hard,placement=cascades,cascades.fit=warped"))) << "not affine";
    EXPECT_FALSE(parallel_views(test::place(load_scene("courtyard"), "hard,placement=cascades,cascades.fit=fitted")))
        << "turned";
    LightViews views = test::place(scene, "hard,placement=cascades");
    GnLightView& last = views.views.back();
    for (float* number : {&last.cs_from_ws[1][0], &last.cs_from_ws[2][1], &last.depth_from_ws.x}) {
        const float was = *number;
        *number += 0.01F * std::max(1.0F, std::abs(was));
        EXPECT_FALSE(parallel_views(views)) << "one row is turned";
        *number = was;
    }
    last.cs_from_ws[0][0] *= -1;
    last.cs_from_ws[1][0] *= -1;
    last.cs_from_ws[2][0] *= -1;
    EXPECT_FALSE(parallel_views(views)) << "mirrored";
}

}  // namespace
}  // namespace gn::parallel_views_test
