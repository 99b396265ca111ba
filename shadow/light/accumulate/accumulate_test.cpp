// SPDX-License-Identifier: MIT
// The sum of the shadows of a light's points is what rays to the same points say.
#include "shadow/light/accumulate/accumulate.h"

#include "scenes/analytic.h"
#include "shadow/geometry/potential_receivers.h"
#include "shadow/scene/light_samples.h"
#include "shadow/show/show.h"
#include "tests/direct_scenes.h"
#include "tests/rig.h"

#include <random>

namespace gn::accumulate_test {
namespace {

constexpr uint side = 192;

/// A box that floats above a ground, lit from above and beside by a light of some extent.
const scenes::SolidBox floating{{-0.6, 0.8, -0.5}, {0.5, 1.3, 0.6}};

Scene scene_under(const GnLight& light) {
    return by_hand::SceneBuilder()
        .ground(6)
        .box(vec3(floating.low), vec3(floating.high))
        .light(light)
        .camera({0.5F, 4, 5}, {0, 0.4F, 0})
        .scene();
}

/// One light of each kind, wide enough for penumbrae of many pixels.
std::vector<GnLight> area_lights() {
    GnLight sun = by_hand::sun({0.4F, -1, -0.3F});
    sun.angular_radius = 0.15F;
    GnLight spot = by_hand::spot({-1.5F, 4, 1}, {0, 0, 0}, 0.8F);
    spot.radius = 0.5F;
    GnLight sphere = by_hand::point({-1, 3, 1});
    sphere.radius = 0.5F;
    GnLight panel = by_hand::rectangle({-1, 3.5F, 1.5F}, {0, 0, 0});
    panel.half_size = vec2(0.6F, 0.3F);
    return {sun, spot, sphere, panel};
}

FrameResult render(const Scene& scene, const std::string& recipe, uint size = side) {
    const test::ValidationGuard guard;
    SceneGpu gpu = upload_scene(test::device(), scene);
    FrameResult frame = render_frame(test::device(), gpu, scene.camera(""), load_recipe(recipe),
                                     {.width = size, .height = size, .repeat = 0, .only_light = 0, .picture = false});
    EXPECT_EQ(frame.refused.front(), "");
    return frame;
}

TruthResult traced(const Scene& scene, const CpuSamples& seen, const LightSamples& samples) {
    return Truth(scene).trace(seen.position_ws, seen.normal_ws, scene.lights.front(),
                              {.exactly = &samples, .width = seen.width});
}

/// Where the hard shadow of some point that the pixel takes has an edge, or a surface holds the point in its plane.
std::vector<std::uint8_t> edges_of_points(const Scene& scene, const CpuSamples& seen, const LightSamples& samples) {
    std::vector<std::uint8_t> any(seen.position_ws.size(), 0);
    const int count = static_cast<int>(samples.points.size());
    for (int k = 0; k < count; ++k) {
        const GnLight& point = samples.points[static_cast<std::size_t>(k)];
        const TruthResult one = traced(scene, seen, {{point}});
        const std::vector<std::uint8_t> edges = edge_pixels(one.visibility, one.counted, side, side);
        for (std::size_t i = 0; i < any.size(); ++i) {
            const vec3 p_ws(seen.position_ws[i]);
            const bool grazing = std::abs(glm::dot(vec3(seen.normal_ws[i]), gn_to_light(point, p_ws))) < 1e-4F;
            const bool taken = gn_point_taken(k, count, ivec2(i % side, i / side), samples.side);
            any[i] = any[i] != 0 || (taken && (edges[i] != 0 || grazing)) ? 1 : 0;
        }
    }
    return any;
}

TEST(Accumulate, VolumesOfThePointsAreTheTracedPointsOutsideEdgePixels) {
    for (const std::string& rest :
         {std::string(",accumulate.lights=5"), std::string(",accumulate.lights=16,accumulate.share=2")}) {
        for (const GnLight& light : area_lights()) {
            SCOPED_TRACE(fmt::format("{}{}", light_kind_names.at(light.kind), rest));
            const Scene scene = scene_under(light);
            const FrameResult frame = render(scene, "volumes,light=accumulate" + rest);
            const bool shared = rest.ends_with("2");
            const LightSamples samples = light_samples(light, shared ? 16 : 5, shared ? 2 : 1);
            const TruthResult truth = traced(scene, frame.samples, samples);
            const std::vector<std::uint8_t> edges = edges_of_points(scene, frame.samples, samples);
            std::size_t judged = 0;
            std::size_t partial = 0;
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < edges.size(); ++i) {
                const float v = frame.visibility.front().values[i];
                if (truth.counted[i] != 0 && edges[i] == 0) {
                    ++judged;
                    partial += truth.visibility[i] > 0.01F && truth.visibility[i] < 0.99F ? 1 : 0;
                    // Sums of sixteen weights in floats.
                    wrong += std::abs(v - truth.visibility[i]) > 1e-5F ? 1 : 0;
                }
                EXPECT_TRUE(truth.counted[i] != 0 || v == 0) << i;
            }
            EXPECT_EQ(wrong, 0U) << "of " << judged;
            EXPECT_GT(judged, side * side / 3);
            EXPECT_GT(partial, 40U);
        }
    }
}

// A point of a spot lights all around; its map holds what the spot's cone reaches and no more.
TEST(Accumulate, ReceiversOfAPointAreThoseOfTheWholeLight) {
    GnLight spot = by_hand::spot({0, 4, 0}, {0, 0, 0}, 0.3F);
    spot.radius = 0.5F;
    const Scene scene = scene_under(spot);
    const Recipe recipe = load_recipe("hard,light=accumulate,accumulate.lights=4");
    const std::vector<Light> points = recipe.light->split(scene.lights.front(), recipe);
    FrameGraph graph(test::device());
    const SceneHandles handles;
    const ViewSamples samples{.width = side, .height = side, .camera = scene.camera("")};
    FrameInput input{test::device(), graph, scene, handles, samples, &scene.lights.front()};
    const std::vector<dvec3> whole = potential_receivers(input).vertices();
    input.source = &points.front();
    EXPECT_NE(potential_receivers(input).vertices(), whole) << "a point without a cone reaches more";
    input.parent = &scene.lights.front();
    EXPECT_EQ(potential_receivers(input).vertices(), whole);
}

/// Which V of one point a receiver on the ground may be given by a map that holds the box to half a texel.
struct Range {
    float low = 1, high = 0;
};
Range within_half_a_texel(const GnLight& point, vec3 p_ws, const KernelRegion& region) {
    Range range;
    const vec3 ray_ws = gn_to_light(point, p_ws);
    for (int s = -8; s <= 8; ++s) {
        for (int t = -8; t <= 8; ++t) {
            // A region is a texel and a half about the receiver. Half a texel of it, a hundredth for rounding, and a step of
            // this grid, so that no corner of the shadow slips between; then along the ray to the ground.
            const vec3 across =
                (static_cast<float>(s) * region.a_ws + static_cast<float>(t) * region.b_ws) * (0.575F / 1.5F / 8);
            const vec3 q_ws = p_ws + across - ray_ws * (across.y / ray_ws.y);
            const auto v = static_cast<float>(*scenes::box_visibility(point, {&floating, 1}, dvec3(q_ws)));
            range.low = std::min(range.low, v);
            range.high = std::max(range.high, v);
        }
    }
    return range;
}

TEST(Accumulate, MapsOfThePointsAreTheTracedPointsToHalfATexel) {
    const int count = 8;
    constexpr uint size = 96;  // every sample asks 289 neighbours of each point
    for (const GnLight& light : area_lights()) {
        SCOPED_TRACE(light_kind_names.at(light.kind));
        // No bias moves a receiver across the light.
        const std::string rest = ",resolution=256,placement=fit,bias.normal=0";
        const Scene scene = scene_under(light);
        const FrameResult frame = render(scene, "hard,light=accumulate,accumulate.lights=8" + rest, size);
        const LightSamples samples = light_samples(light, count);
        const TruthResult truth = traced(scene, frame.samples, samples);
        const std::size_t pixels = frame.samples.position_ws.size();

        // What every point's map may say of each receiver on the ground.
        std::vector<double> low(pixels, 0), high(pixels, 0), weights(pixels, 0);
        for (const GnLight& point : samples.points) {
            const Scene hard = scene_under(point);
            SceneGpu gpu = upload_scene(test::device(), hard);
            const std::vector<KernelRegion> regions = kernel_regions(
                test::device(), gpu, hard.camera(""), load_recipe("hard" + rest), {.width = size, .height = size});
            for (std::size_t i = 0; i < pixels; ++i) {
                const vec3 p_ws(frame.samples.position_ws[i]);
                if (truth.counted[i] == 0 || std::abs(p_ws.y) > 1e-4F) {
                    continue;
                }
                const Range range = within_half_a_texel(point, p_ws, regions[i]);
                const double weight = gn_point_weight(light, point, p_ws);
                low[i] += weight * range.low;
                high[i] += weight * range.high;
                weights[i] += weight;
            }
        }
        std::size_t judged = 0;
        std::size_t beyond = 0;
        double doubt = 0;
        double error = 0;
        for (std::size_t i = 0; i < pixels; ++i) {
            if (weights[i] > 0) {
                const double v = frame.visibility.front().values[i];
                ++judged;
                beyond += v < low[i] / weights[i] - 1e-5 || v > high[i] / weights[i] + 1e-5 ? 1 : 0;
                doubt += (high[i] - low[i]) / weights[i];
                error += std::abs(v - static_cast<double>(truth.visibility[i]));
            }
        }
        EXPECT_EQ(beyond, 0U) << "of " << judged;
        EXPECT_GT(judged, size * size / 4);
        EXPECT_LT(doubt / static_cast<double>(judged), 0.05);
        EXPECT_GT(error, 0) << "a map that has no texels is no map";
    }
}

TEST(Accumulate, AnErrorTakesTheFewestPointsThatHoldIt) {
    // A straight edge crosses at most 2 * 2^k - 1 of 2^k x 2^k cells: 1, 3/4, 7/16, 15/64, 31/256.
    EXPECT_EQ(points_within(1), 1);
    EXPECT_EQ(points_within(0.75F), 4);
    EXPECT_EQ(points_within(0.74F), 16);
    EXPECT_EQ(points_within(0.25F), 64);
    EXPECT_EQ(points_within(0.125F), 256);
}

TEST(Accumulate, BehindAStraightEdgeVErrsByNoMoreThanAsked) {
    // Planes through the receiver, as any straight edge and the receiver span one: V is what lies on one side of it. Of
    // rectangles the bound is a theorem; the square's map to discs, cones and spheres bends lines, and leaves room for it.
    const vec3 p_ws(0.3F, 0, 0.1F);
    for (const GnLight& light : area_lights()) {
        SCOPED_TRACE(light_kind_names.at(light.kind));
        const std::vector<GnLight> many = light_samples(light, 1 << 14).points;
        const auto towards = [&](const GnLight& point) { return gn_to_light(point, p_ws); };
        const auto seen = [&](std::span<const GnLight> points, vec3 plane) {
            double v = 0, weights = 0;
            for (const GnLight& point : points) {
                const double weight = gn_point_weight(light, point, p_ws);
                weights += weight;
                v += dot(towards(point), plane) > 0 ? weight : 0;
            }
            return v / weights;
        };
        std::mt19937 random(7);
        std::normal_distribution<float> normal;
        const auto direction = [&] { return normalize(vec3(normal(random), normal(random), normal(random))); };
        for (const float error : {0.75F, 0.25F, 0.13F}) {
            const std::vector<GnLight> few = light_samples(light, points_within(error)).points;
            double worst = 0;
            for (int i = 0; i < 60; ++i) {
                // Through a point of the light, so that it parts the light.
                const vec3 through = towards(many[static_cast<std::size_t>(i) * 97]);
                const vec3 plane = normalize(cross(through, direction()));
                worst = std::max(worst, std::abs(seen(few, plane) - seen(many, plane)));
            }
            EXPECT_LE(worst, static_cast<double>(error)) << points_within(error) << " points";
            EXPECT_GT(worst, 0.05 * static_cast<double>(error)) << points_within(error) << " points";
        }
    }
}

TEST(Accumulate, PointsBelowTheHorizonLightNothing) {
    // Half of an upright panel is under the floor: a map's bias would let its points through.
    GnLight panel = by_hand::rectangle({-4, 0, 0}, {0, 0, 0});
    panel.position_ws.y = 0.01F;
    panel.half_size = vec2(1, 1);
    panel.right_ws = vec4(0, 0, 1, 0);
    panel.up_ws = vec4(0, 1, 0, 0);
    panel.direction_ws = vec4(1, 0, 0, 0);
    const Scene scene = by_hand::SceneBuilder().ground(3).light(panel).camera({1, 3, 4}, {0, 0, 0}).scene();
    const FrameResult frame = render(scene, "hard,light=accumulate,accumulate.lights=16");
    const TruthResult truth = traced(scene, frame.samples, light_samples(panel, 16));
    std::size_t judged = 0;
    for (std::size_t i = 0; i < truth.counted.size(); ++i) {
        if (truth.counted[i] != 0) {
            ++judged;
            EXPECT_EQ(frame.visibility.front().values[i], 0.5F) << i;
            EXPECT_EQ(truth.visibility[i], 0.5F) << i;
        }
    }
    EXPECT_GT(judged, side * side / 8);
}

TEST(Accumulate, BytesDoNotGrowWithTheNumberOfLights) {
    const std::vector<GnLight> lights = area_lights();
    for (const auto& [light, recipe] : {std::pair{lights[0], "hard,placement=fit,resolution=64"},
                                        {lights[0], "hard,placement=cascades,resolution=64"},
                                        {lights[2], "hard,placement=cube,resolution=64"},
                                        {lights[2], "vsm,placement=cube,resolution=64"},
                                        {lights[3], "hard,resolution=64,accumulate.share=2"},
                                        {lights[0], "volumes"}}) {
        const Scene scene = scene_under(light);
        const std::string text = fmt::format("{},light=accumulate,accumulate.lights=", recipe);
        const GraphStatistics few = render(scene, text + "4").statistics;
        const GraphStatistics many = render(scene, text + "64").statistics;
        EXPECT_EQ(few.transient_bytes, many.transient_bytes) << recipe;
        EXPECT_EQ(few.resources.size(), many.resources.size()) << recipe;
        EXPECT_LT(few.passes.size(), many.passes.size()) << recipe;
    }
}

TEST(Accumulate, APixelThatSharesLooksAtItsOwnPointsAlone) {
    // Sixteen suns among squares of 4 x 4 pixels, which do not divide the picture: one hard shadow a pixel.
    constexpr uint width = 90;
    constexpr uint height = 58;
    const GnLight sun = area_lights().front();
    const auto draw = [&](const Scene& scene, const char* recipe) {
        const test::ValidationGuard guard;
        SceneGpu gpu = upload_scene(test::device(), scene);
        return render_frame(test::device(), gpu, scene.camera(""), load_recipe(recipe),
                            {.width = width, .height = height, .repeat = 0, .only_light = 0, .picture = false});
    };
    const char* shared = "hard,resolution=256,light=accumulate,accumulate.lights=16,accumulate.share=4";
    const FrameResult frame = draw(scene_under(sun), shared);
    const std::vector<float>& v = frame.visibility.front().values;
    const LightSamples samples = light_samples(sun, 16, 4);
    std::size_t judged = 0;
    std::size_t dark = 0;
    for (int k = 0; k < 16; ++k) {
        const GnLight& one = samples.points[static_cast<std::size_t>(k)];
        const std::vector<float> alone = draw(scene_under(one), "hard,resolution=256").visibility.front().values;
        for (std::size_t i = 0; i < v.size(); ++i) {
            const vec3 p_ws(frame.samples.position_ws[i]);
            const vec3 n_ws(frame.samples.normal_ws[i]);
            const bool taken = gn_point_taken(k, 16, ivec2(i % width, i / width), 4);
            if (taken && frame.samples.position_ws[i].w > 0.5F && gn_counted(sun, p_ws, n_ws) &&
                gn_counted(one, p_ws, n_ws)) {
                EXPECT_EQ(v[i], alone[i]) << "point " << k << ", pixel " << i % width << ", " << i / width;
                ++judged;
                dark += v[i] == 0 ? 1 : 0;
            }
        }
    }
    EXPECT_GT(judged, v.size() / 3);
    EXPECT_GT(dark, 40U);
    // And its lookups fill an image of as many pixels.
    const auto& resources = frame.statistics.resources;
    EXPECT_TRUE(std::any_of(resources.begin(), resources.end(), [](const auto& resource) {
        return resource.name == "visibility" && resource.bytes == 23U * 15U * sizeof(float);
    }));
}

TEST(Accumulate, ALightWithoutExtentKeepsItsHardShadow) {
    const Scene scene = scene_under(by_hand::point({-1, 3, 1}));
    EXPECT_EQ(render(scene, "hard,light=accumulate,accumulate.share=4").visibility.front().values,
              render(scene, "hard").visibility.front().values);
}

TEST(Accumulate, WhatCannotBeIsRefusedByName) {
    const auto refused = [](const GnLight& light, const std::string& recipe) {
        const Scene scene = scene_under(light);
        SceneGpu gpu = upload_scene(test::device(), scene);
        return render_frame(test::device(), gpu, scene.camera(""), load_recipe(recipe),
                            {.width = 16, .height = 16, .repeat = 0, .only_light = 0, .picture = false})
            .refused.front();
    };
    EXPECT_NE(refused(area_lights()[1], "hard,light=accumulate,placement=single").find("placement=fit"),
              std::string::npos);
    EXPECT_EQ(refused(area_lights()[0], "hard,light=accumulate,placement=single,accumulate.lights=2"), "");
    EXPECT_NE(refused(area_lights()[0], "hard,light=accumulate,accumulate.lights=8,accumulate.share=3")
                  .find("accumulate.share is at most 2"),
              std::string::npos);
    EXPECT_NE(refused(area_lights()[0], "hard,light=accumulate,accumulate.error=0.01").find("at least 0.0615"),
              std::string::npos);
    EXPECT_EQ(refused(area_lights()[0], "hard,light=accumulate,accumulate.error=0.75"), "");
}

}  // namespace
}  // namespace gn::accumulate_test
