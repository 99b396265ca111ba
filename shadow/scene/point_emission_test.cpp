// SPDX-License-Identifier: MIT
// What points of a light stand for of the picture that it shows.
#include "shadow/scene/point_emission.h"

#include "shadow/scene/light_samples.h"

#include <gtest/gtest.h>

#include <random>

namespace gn::point_emission_test {
namespace {

GnLight panel(float right = 1) {
    GnLight light;
    light.kind = GN_LIGHT_RECTANGLE;
    light.position_ws = vec4(3, -2, 1, 1);
    light.direction_ws = vec4(0, 0, 1, 0);
    light.right_ws = vec4(right, 0, 0, 0);
    light.up_ws = vec4(0, 1, 0, 0);
    light.half_size = vec2(2, 0.5F);
    return light;
}

/// Of `colour` by the texel's column and row.
template <class Colour>
Image8 picture_of(int width, int height, Colour colour) {
    Image8 picture{width, height, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const uvec3 c = colour(x, y);
            for (const uint byte : {c.r, c.g, c.b, 255U}) {
                picture.rgba.push_back(static_cast<std::uint8_t>(byte));
            }
        }
    }
    return picture;
}

TEST(PointEmission, OneColourWeighsAllPointsAlike) {
    for (const uvec3 colour : {uvec3(255), uvec3(200, 90, 0), uvec3(0)}) {
        const Image8 picture = picture_of(5, 3, [&](int, int) { return colour; });
        const vec3 mean = mean_emission(picture);
        for (const vec4& sent : emission_of_points(picture, panel(), 48, 2)) {
            for (int c = 0; c < 3; ++c) {
                // What the picture lacks, all points lack alike.
                EXPECT_NEAR(sent[c], mean[c] > 0 ? mean[c] : 1.0F, 1e-5F);
            }
        }
    }
}

TEST(PointEmission, OnePointStandsForAllOfThePicture) {
    std::mt19937 random(3);
    const Image8 picture =
        picture_of(130, 70, [&](int, int) { return uvec3(random() % 256, random() % 256, random() % 256); });
    const std::vector<vec4> sent = emission_of_points(picture, panel(), 1);
    ASSERT_EQ(sent.size(), 1U);
    const vec3 mean = mean_emission(picture);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(sent[0][c], mean[c], 0.01F * mean[c]) << "two by one sample a cell, of two by two texels and less";
    }
}

/// A half of the picture is red, the other blue: a point is of the colour of its side but where the nearest of both meet.
TEST(PointEmission, APointIsOfTheColourOfThePictureAroundIt) {
    const Image8 picture = picture_of(64, 64, [](int x, int) { return x < 32 ? uvec3(255, 0, 0) : uvec3(0, 0, 255); });
    for (const float right : {1.0F, -1.0F}) {
        const GnLight light = panel(right);
        for (const auto& [count, side] : {std::pair{64, 1}, {256, 2}}) {
            const std::vector<vec4> sent = emission_of_points(picture, light, count, side);
            const std::vector<GnLight> points = light_samples(light, count, side).points;
            int pure = 0;
            vec3 sum(0);
            for (std::size_t i = 0; i < points.size(); ++i) {
                const vec3 off = vec3(points[i].position_ws) - vec3(light.position_ws);
                const vec2 place =
                    gn_emission_place(light, vec2(glm::dot(off, vec3(light.right_ws)), off.y) / light.half_size);
                EXPECT_NEAR(sent[i].r + sent[i].b, 1.0F, 0.02F);
                // A pattern's points are an eighth of a side apart.
                if (std::abs(place.x - 0.5F) > 0.15F) {
                    EXPECT_NEAR(sent[i].r, place.x < 0.5F ? 1.0F : 0.0F, 1e-6F) << place.x;
                    ++pure;
                }
                sum += vec3(sent[i]);
            }
            EXPECT_GT(pure, count / 2);
            EXPECT_NEAR(sum.r / sum.b, 1.0F, 0.1F);
        }
    }
}

}  // namespace
}  // namespace gn::point_emission_test
