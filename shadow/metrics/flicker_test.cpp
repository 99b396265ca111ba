// SPDX-License-Identifier: MIT
#include "shadow/metrics/flicker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gn::flicker_test {
namespace {

/// A wall at distance 1 m, seen straight on: a pixel is 1 cm wide, and the camera stands `shift` pixels to the right.
struct Wall {
    static constexpr int width = 40, height = 20;
    static constexpr float pixel = 0.01F;
    std::vector<vec4> points, normals;
    PathView view;

    explicit Wall(double shift, float distance = 1) {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const double x_ws = (x + 0.5 - width / 2.0 + shift) * pixel, y_ws = (y + 0.5 - height / 2.0) * pixel;
                points.emplace_back(x_ws * distance, y_ws * distance, distance, 1);
            }
        }
        mat4 cs_from_ws(0);
        cs_from_ws[0][0] = 2 / (width * pixel);
        cs_from_ws[1][1] = 2 / (height * pixel);
        cs_from_ws[2][3] = 1;
        cs_from_ws[3][0] = static_cast<float>(-shift * pixel) * cs_from_ws[0][0] * distance;
        cs_from_ws[3][2] = 0.1F;
        normals.assign(points.size(), vec4(0, 0, -1, distance));
        view = {width, height, cs_from_ws, pixel, normals, points};
    }
    Wall(const Wall&) = delete;
    Wall& operator=(const Wall&) = delete;
};

SignedError error_of(float value, std::size_t count = Wall::width * Wall::height) {
    return {std::vector<float>(count, value), std::vector<std::uint8_t>(count, 1)};
}

TEST(Flicker, AStillCameraAndAStillErrorGiveNone) {
    const Wall wall(0);
    const std::vector<int> same = same_points(wall.view, wall.view);
    for (std::size_t i = 0; i < same.size(); ++i) {
        EXPECT_EQ(same[i], static_cast<int>(i));
    }
    SignedError error = error_of(0.25F);
    for (std::size_t i = 0; i < error.values.size(); i += 3) {
        error.values[i] = -1;
    }
    const Flicker flicker = flicker_between(error, error, same);
    EXPECT_EQ(flicker.samples, error.values.size());
    EXPECT_EQ(flicker.root_mean_square(), 0.0);
}

TEST(Flicker, IsTheRootMeanSquareChangeByHand) {
    // 800 pixels: T - R changes by 0.6 on 200 of them, by -0.2 on 100: sqrt((200 * 0.36 + 100 * 0.04) / 800).
    const Wall wall(0);
    const SignedError before = error_of(0.1F);
    SignedError after = error_of(0.1F);
    std::fill_n(after.values.begin(), 200, 0.7F);
    std::fill_n(after.values.begin() + 300, 100, -0.1F);
    Flicker flicker = flicker_between(before, after, same_points(wall.view, wall.view));
    EXPECT_NEAR(flicker.root_mean_square().value(), std::sqrt(76.0 / 800), 1e-6);

    // A second step without any change halves the mean square.
    flicker += flicker_between(after, after, same_points(wall.view, wall.view));
    EXPECT_NEAR(flicker.root_mean_square().value(), std::sqrt(38.0 / 800), 1e-6);
    // 200 changes and a few that hardly matter.
    EXPECT_NEAR(flicker.told_by(), 76 * 76 / (200 * 0.1296 + 100 * 0.0016), 1e-3);

    // What counts in one frame only is left out.
    std::fill_n(after.counted.begin(), 200, std::uint8_t{0});
    const Flicker fewer = flicker_between(before, after, same_points(wall.view, wall.view));
    EXPECT_EQ(fewer.samples, 600U);
    EXPECT_NEAR(fewer.root_mean_square().value(), std::sqrt(4.0 / 600), 1e-6);
}

TEST(Flicker, FollowsPointsThroughTheMovement) {
    // Three pixels to the right: a pattern fixed to the wall does not flicker, one fixed to the picture does.
    const Wall from(0), to(3);
    const std::vector<int> same = same_points(from.view, to.view);
    SignedError before = error_of(0), moved = error_of(0);
    for (std::size_t i = 0; i < before.values.size(); ++i) {
        before.values[i] = (i % Wall::width) % 2 == 0 ? 1.0F : 0.0F;
        moved.values[i] = (i % Wall::width + 3) % 2 == 0 ? 1.0F : 0.0F;
    }
    const Flicker fixed = flicker_between(before, moved, same);
    EXPECT_EQ(fixed.samples, static_cast<std::size_t>((Wall::width - 3) * Wall::height));
    EXPECT_EQ(fixed.root_mean_square(), 0.0);
    EXPECT_EQ(flicker_between(before, before, same).root_mean_square(), 1.0);
}

TEST(Flicker, LeavesOutWhatLiesBetweenPixelsAndOtherSurfaces) {
    const Wall from(0), near_by(0.03), between(0.5), behind(0, 1.02F);
    const auto found = [&](const Wall& to) {
        const std::vector<int> same = same_points(from.view, to.view);
        return std::count_if(same.begin(), same.end(), [](int i) { return i >= 0; });
    };
    EXPECT_EQ(found(near_by), Wall::width * Wall::height);
    EXPECT_EQ(found(between), 0);
    EXPECT_EQ(found(behind), 0) << "another wall 2 cm behind, where a pixel is 1 cm wide";

    // Where two walls meet, a point of one is not the other's.
    Wall across(0);
    across.normals.assign(across.points.size(), vec4(1, 0, 0, 1));
    across.view.normal_ws = across.normals;
    EXPECT_EQ(found(across), 0);

    // Nothing in common is no figure, not a zero.
    EXPECT_FALSE(
        flicker_between(error_of(0), error_of(1), same_points(from.view, between.view)).root_mean_square().has_value());
}

TEST(Flicker, ANumberThatIsNoneIsWhollyWrong) {
    const std::vector<float> technique{NAN, 0, NAN, 0.5F, 0.5F, 0.5F}, reference{0, 0.4F, 0.6F, 0.6F, 1, 1};
    const std::vector<std::uint8_t> counted{1, 1, 1, 1, 0, 1};
    const SignedError error = signed_error(technique, reference, counted, 6, 1);
    EXPECT_EQ(error.values, (std::vector<float>{1, -0.4F, -0.6F, 0.5F - 0.6F, 0, -0.5F}));
}

TEST(Flicker, LeavesOutTheEdgesOfTheReference) {
    // R jumps between columns 2 and 3: both are left out, and nothing else.
    const std::vector<float> technique(6, 0.5F), reference{0, 0, 0, 1, 1, 1};
    const std::vector<std::uint8_t> counted(6, 1);
    EXPECT_EQ(signed_error(technique, reference, counted, 6, 1).counted, (std::vector<std::uint8_t>{1, 1, 0, 0, 1, 1}));
}

}  // namespace
}  // namespace gn::flicker_test
