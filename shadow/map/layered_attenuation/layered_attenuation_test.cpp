// SPDX-License-Identifier: MIT
// A layer says of itself what the hard shadows of the light's points say there.
#include "shadow/map/layered_attenuation/layered_attenuation.glsl"

#include "shadow/placement/light_views.h"
#include "shadow/recipe/guard.h"
#include "tests/direct_scenes.h"
#include "tests/lent_points.h"

namespace gn::layered_attenuation_test {
namespace {

using namespace gn::glsl;

/// Two boxes, one above the other, over a ground: up to three surfaces under a texel.
Scene stacked(const GnLight& light) {
    return by_hand::SceneBuilder()
        .ground(4)
        .box({-0.6F, 1.6F, -0.5F}, {0.5F, 1.9F, 0.6F})
        .box({-0.9F, 0.5F, -0.3F}, {0.3F, 0.8F, 0.9F})
        .light(light)
        .camera({0.5F, 4, 5}, {0, 0.4F, 0})
        .scene();
}

GnLight wide_sun() {
    GnLight sun = by_hand::sun({0.4F, -1, -0.3F});
    sun.angular_radius = 0.15F;
    return sun;
}

GnLightView view_of(const Scene& scene, const std::string& recipe) {
    const Recipe loaded = load_recipe(recipe);
    const Light& light = scene.lights.front();
    return fit_orthographic(body_of(scene.bounds_ws), light.shape, loaded.resolution,
                            guard_of(loaded, light, scene.bounds_ws));
}

/// Where the rays of all texels meet a horizontal plane within the ground.
std::vector<test::LentPoint> on_texels(const GnLightView& view, float height) {
    std::vector<test::LentPoint> points;
    const int side = static_cast<int>(view.resolution);
    for (int i = 0; i < side * side; ++i) {
        const vec2 uv_ts = (vec2(i % side, i / side) + 0.5F) / view.resolution;
        const vec3 from = gn_point_at(view, uv_ts, 0), to = gn_point_at(view, uv_ts, 1);
        const vec3 p_ws = mix(from, to, (height - from.y) / (to.y - from.y));
        if (std::max(std::abs(p_ws.x), std::abs(p_ws.z)) < 1.9F) {
            points.push_back({p_ws, vec3(0, 1, 0)});
        }
    }
    return points;
}

constexpr const char* maps = ",placement=single,resolution=96";
/// One texel, whatever pixels cover.
constexpr const char* alone = ",filtered.footprint=radius,filtered.radius=0";

TEST(LayeredAttenuation, OnTheRaysOfTexelsItIsTheSumOfItsPointsHardShadows) {
    const Scene scene = stacked(wide_sun());
    // Other layers are near enough, too: the receiver takes its own.
    const std::string layered = fmt::format(
        "layered-attenuation,layered-attenuation.lights=12,layered-attenuation.epsilon=16{}{}", maps, alone);
    const std::string summed = fmt::format("hard,light=accumulate,accumulate.lights=12{}", maps);
    std::vector<test::LentPoint> points = on_texels(view_of(scene, layered), 0);
    // The top of the lower box has the ground behind it, and half of it the upper box before it.
    for (const test::LentPoint& point : on_texels(view_of(scene, layered), 0.8F)) {
        if (std::abs(point.p_ws.x + 0.3F) < 0.55F && std::abs(point.p_ws.z - 0.3F) < 0.55F) {
            points.push_back(point);
        }
    }
    const std::vector<float> v = test::visibility_at(scene, layered, points);
    const std::vector<float> sum = test::visibility_at(scene, summed, points);
    std::size_t partial = 0;
    std::size_t other = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
        partial += sum[i] > 0.01F && sum[i] < 0.99F ? 1 : 0;
        // Where a receiver lies on the border of a point's texel rounding decides which one it takes: by one point.
        other += std::abs(v[i] - sum[i]) > 1e-5F ? 1 : 0;
        EXPECT_LE(std::abs(v[i] - sum[i]), 1.0F / 12 + 1e-5F) << i;
    }
    EXPECT_GT(partial, v.size() / 20);
    EXPECT_LE(other, v.size() / 500) << "of " << v.size();
}

TEST(LayeredAttenuation, WhatLiesBehindTheLastLayerIsDarkAndSaysSo) {
    // Grounds in the light's own shadow are the second surface under a texel or the third.
    const Scene scene = stacked(wide_sun());
    const auto at = [&](int layers, std::set<std::string>& remarks) {
        const std::string recipe = fmt::format(
            "layered-attenuation,layered-attenuation.lights=4,layered-attenuation.layers={}{}{}", layers, maps, alone);
        return test::visibility_at(scene, recipe, on_texels(view_of(scene, recipe), 0), &remarks);
    };
    std::set<std::string> none, some;
    const std::vector<float> three = at(3, none), one = at(1, some);
    EXPECT_TRUE(none.empty());
    ASSERT_EQ(some.size(), 1U);
    EXPECT_NE(some.begin()->find("layered-attenuation.layers keeps more"), std::string::npos) << *some.begin();
    // What finds no layer has the hard shadow of the nearest one, a border of which the bias may move a receiver past.
    std::size_t dark = 0;
    std::size_t other = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        dark += one[i] != three[i] && one[i] == 0 ? 1 : 0;
        other += one[i] != three[i] && one[i] != 0 ? 1 : 0;
    }
    EXPECT_GT(dark, one.size() / 20);
    EXPECT_LE(other, one.size() / 50);
}

TEST(LayeredAttenuation, OfEveryKindOfLightItIsCloseToTheSum) {
    // Between texels' rays V is a mean of texels': it differs by what V changes over one.
    for (const char* light : {"directional", "rectangle", "spot", "point"}) {
        const std::string scene = fmt::format("slab:light={}", light);
        const std::string few = ",resolution=128,";
        const auto layered =
            test::compare(scene, "layered-attenuation" + few + "layered-attenuation.lights=16", {64, 48, 16, ""});
        const auto summed = test::compare(scene, "hard,light=accumulate" + few + "accumulate.lights=16,placement=auto",
                                          {64, 48, 16, ""});
        double squares = 0;
        for (std::size_t i = 0; i < summed.visibility().values.size(); ++i) {
            const double d = layered.visibility().values[i] - summed.visibility().values[i];
            squares += d * d;
        }
        // A step of a sixteenth, somewhere within the texel.
        EXPECT_LT(std::sqrt(squares / static_cast<double>(summed.visibility().values.size())), 1.0 / 16) << light;
        EXPECT_LT(*layered.errors.rmse, *summed.errors.rmse + 1.0 / 32) << light;
    }
}

TEST(LayeredAttenuation, ALayersNormalIsThatOfItsPlane) {
    // Of a plane in a view that looks down: how its depth changes from texel to texel is what rasterization tells.
    GnLight sun = by_hand::sun({0.2F, -1, 0.1F});
    const GnLightView view = fit_orthographic(body_of(Box{vec3(-2), vec3(2)}), sun, 64, {});
    const vec3 n_ws = normalize(vec3(0.3F, 1, -0.4F));
    const auto depth_at = [&](vec2 uv_ts) {
        const vec3 from = gn_point_at(view, uv_ts, 0), way = gn_point_at(view, uv_ts, 1) - from;
        return -dot(from, n_ws) / dot(way, n_ws);
    };
    const vec2 uv_ts(0.4F, 0.7F);
    const float depth = depth_at(uv_ts);
    const vec2 slope(depth_at(uv_ts + vec2(1 / 64.0F, 0)) - depth, depth_at(uv_ts + vec2(0, 1 / 64.0F)) - depth);
    EXPECT_NEAR(dot(gn_layer_normal(view, uv_ts, depth, slope), n_ws), 1, 1e-5);
}

TEST(LayeredAttenuation, ABoxOfOneTexelIsBilinear) {
    GnProjected projected{};
    projected.texel_ts = 1 / 16.0F;
    projected.bounds_ts = vec4(0, 0, 1, 1);
    const GnTexelBox box = gn_texel_box(projected, vec2(5.75F, 3.5F) / 16.0F, vec2(0));
    EXPECT_EQ(box.first, ivec2(5, 3));
    EXPECT_FLOAT_EQ(gn_box_weight(box, ivec2(5, 3)), 0.75F);
    EXPECT_FLOAT_EQ(gn_box_weight(box, ivec2(6, 3)), 0.25F);
    EXPECT_FLOAT_EQ(gn_box_weight(box, ivec2(5, 4)), 0);
    // No texel beyond the view, and none of a box that is wider than is read.
    const GnTexelBox border = gn_texel_box(projected, vec2(0.2F, 15.9F) / 16.0F, vec2(1));
    EXPECT_EQ(border.first, ivec2(0, 11));
    EXPECT_EQ(border.last, ivec2(4, 15));
}

TEST(LayeredAttenuation, WhatItTakesFromTheLightNobodyElseTakes) {
    const Scene scene = stacked(wide_sun());
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameResult frame =
        render_frame(test::device(), gpu, scene.camera(""), load_recipe("layered-attenuation,light=accumulate"),
                     {.width = 16, .height = 16, .only_light = 0, .picture = false});
    EXPECT_NE(frame.refused.front().find("takes the points of a light by itself"), std::string::npos);
}

}  // namespace
}  // namespace gn::layered_attenuation_test
