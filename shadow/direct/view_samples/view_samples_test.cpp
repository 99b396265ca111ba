// SPDX-License-Identifier: MIT
// Bits of light points against rays to the same points, left-sample maps against their bound, and the walk against brute force.
#include "shadow/direct/view_samples/view_samples_table.h"

#include "reference/truth.h"
#include "shadow/show/show.h"
#include "tests/direct_scenes.h"

#include <bit>
#include <random>

namespace gn::view_samples_test {
namespace {

using namespace by_hand;
using glsl::GnHider;
using glsl::GnLightLine;
using glsl::GnOccluder;
using glsl::GnSampledLight;

/// One light of each kind, wide enough for penumbrae of many pixels.
std::vector<GnLight> area_lights() {
    GnLight low_sun = sun({0.5F, -1, -0.3F});
    low_sun.angular_radius = 0.1F;
    GnLight lamp = spot({-1.5F, 4, 1.2F}, {0, 0, 0}, 0.8F);
    lamp.radius = 0.4F;
    GnLight sphere = point({0.6F, 3.2F, 0.9F});
    sphere.radius = 0.4F;
    GnLight panel = rectangle({-1, 3.7F, 1.1F}, {0, 0, 0});
    panel.half_size = vec2(0.7F, 0.3F);
    return {low_sun, lamp, sphere, panel};
}

/// A random line across the light, as an edge seen from a place would make it.
GnLightLine random_line(const GnSampledLight& light, std::mt19937& random) {
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> unit(-1.1F, 1.1F);
    GnLightLine line{};
    line.n = vec3(normal(random), normal(random), light.solid != 0 ? normal(random) : 0.0F);
    line.n = glm::normalize(line.n);
    line.size = 1;
    line.reach = light.square != 0 ? 0.5F * (std::abs(line.n.x) + std::abs(line.n.y)) : 0.5F;
    line.offset = unit(random) * line.reach;
    return line;
}

TEST(LeftSampleMap, DisplacesAnEdgeByNoMoreThanItsTexelsSay) {
    std::mt19937 random(5);
    for (const GnLight& light : area_lights()) {
        for (const auto& [angles, offsets] : {std::pair{64, 32}, {128, 64}}) {
            const LeftMapShape shape{sampled_light(light), angles, offsets, 2, 64, false};
            const std::vector<vec3> points = point_coordinates(light, 64);
            const std::vector<std::uint32_t> map = left_sample_map(shape, points);
            const float bound = glsl::gn_left_error(shape.light, angles, offsets);
            EXPECT_LE(bound, 0.71F / static_cast<float>(offsets) +
                                 (shape.light.solid != 0 ? 2.23F : 2.23F) / static_cast<float>(angles));
            int wrong = 0;
            for (int i = 0; i < 4000; ++i) {
                const GnLightLine line = random_line(shape.light, random);
                const int texel = glsl::gn_left_texel(shape.light, line, angles, offsets);
                for (std::size_t p = 0; p < 64 && std::abs(line.offset) < line.reach; ++p) {
                    const float left = glm::dot(line.n, points[p]) + line.offset;
                    const std::uint32_t word = map[p / 32 * left_map_texels(shape) + static_cast<std::size_t>(texel)];
                    if ((left >= 0) != ((word >> (p % 32) & 1U) != 0)) {
                        ++wrong;
                        EXPECT_LE(std::abs(left), bound + 1e-5F) << "kind " << light.kind << ", line " << i;
                    }
                }
            }
            EXPECT_GT(wrong, 100) << "the bound is not tried";
        }
    }
}

TEST(LeftSampleMap, BracketsWhatIsLeftOfEachOfATexelsLines) {
    std::mt19937 random(6);
    for (const GnLight& light : area_lights()) {
        const LeftMapShape shape{sampled_light(light), 32, 16, 1, 32, true};
        const std::vector<vec3> points = point_coordinates(light, 32);
        const std::vector<std::uint32_t> map = left_sample_map(shape, points);
        int sure = 0;
        int unsure = 0;
        for (int i = 0; i < 4000; ++i) {
            const GnLightLine line = random_line(shape.light, random);
            const auto texel = static_cast<std::size_t>(glsl::gn_left_texel(shape.light, line, 32, 16));
            std::uint32_t left = 0;
            for (std::size_t p = 0; p < 32; ++p) {
                left |= glm::dot(line.n, points[p]) + line.offset >= 0 ? 1U << p : 0U;
            }
            if (std::abs(line.offset) < line.reach) {
                EXPECT_EQ(map[2 * texel] & ~left, 0U) << "kind " << light.kind;
                EXPECT_EQ(left & ~map[2 * texel + 1], 0U) << "kind " << light.kind;
                sure += std::popcount(map[2 * texel]);
                unsure += std::popcount(map[2 * texel + 1] & ~map[2 * texel]);
            }
        }
        EXPECT_GT(sure, 2 * unsure);
    }
}

TEST(LightLine, SaysOnWhichSideOfAnEdgesPlaneEachPointLies) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (const GnLight& light : area_lights()) {
        const GnSampledLight sampled = sampled_light(light);
        const std::vector<vec4> points = points_ws(light_samples(light, 16));
        const std::vector<vec3> coordinates = point_coordinates(light, 16);
        int left = 0;
        int judged = 0;
        for (int i = 0; i < 2000; ++i) {
            const vec3 p(3 * unit(random), 0.2F * unit(random), 3 * unit(random));
            // An edge near the way to the light.
            const vec3 middle = p + 0.4F * glsl::gn_towards(p, sampled.centre_ws);
            const vec3 a = middle + 0.3F * vec3(unit(random), unit(random), unit(random));
            const vec3 b = middle + 0.3F * vec3(unit(random), unit(random), unit(random));
            const vec3 edge = glm::cross(a - p, b - p);
            const GnLightLine line = glsl::gn_light_line(sampled, edge, glsl::gn_towards(p, sampled.centre_ws));
            for (std::size_t k = 0; k < points.size(); ++k) {
                const float by_line = glm::dot(line.n, coordinates[k]) + line.offset;
                if (std::abs(by_line) > 1e-3F) {
                    ++judged;
                    left += by_line > 0 ? 1 : 0;
                    EXPECT_EQ(by_line > 0, glm::dot(edge, glsl::gn_towards(p, points[k])) > 0) << "kind " << light.kind;
                }
                EXPECT_LE(glm::dot(line.n, coordinates[k]), line.reach + 1e-4F);
            }
        }
        EXPECT_GT(left, judged / 3);
        EXPECT_LT(left, 2 * judged / 3);
    }
}

TEST(SampleTree, NodesStandBeforeTheirChildren) {
    constexpr uint top = 3;
    std::vector<int> found(glsl::gn_tree_nodes(top), 0);
    for (uint level = 0; level <= top; ++level) {
        for (uint first = 0; first < 1U << (2 * top); first += 1U << (2 * level)) {
            const uint at = glsl::gn_tree_node(first, level, top);
            ASSERT_LT(at, found.size());
            ++found[at];
            if (level > 0) {
                EXPECT_EQ(glsl::gn_tree_node(first, level - 1, top), at + 1);
                const uint next = first + (1U << (2 * level));
                if (next < 1U << (2 * top)) {
                    uint up = level;
                    while (up < top && next % (4U << (2 * up)) == 0) {
                        ++up;
                    }
                    EXPECT_EQ(glsl::gn_tree_node(next, up, top), at + glsl::gn_tree_nodes(level));
                }
            }
        }
    }
    EXPECT_EQ(found, std::vector<int>(found.size(), 1));
}

TEST(MayHide, LeavesOutNoBoxInWhichASampleLosesAPoint) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto any = [&] { return vec3(unit(random), unit(random), unit(random)); };
    for (const GnLight& light : area_lights()) {
        const GnSampledLight sampled = sampled_light(light);
        const std::vector<vec4> points = points_ws(light_samples(light, 16));
        std::array<int, 2> asked{};
        int hidden = 0;
        for (int i = 0; i < 6000; ++i) {
            // Boxes of all sizes, down to single samples; triangles about the way from them to the light.
            const vec3 middle = 3.0F * vec3(unit(random), 0.2F * unit(random), unit(random));
            const vec3 half = i % 4 == 0 ? vec3(0) : (i % 4 == 1 ? 0.02F : 0.4F) * glm::abs(any());
            const vec3 near = middle + unit(random) * 0.6F * glsl::gn_towards(middle, sampled.centre_ws) + 0.5F * any();
            const float size = i % 3 == 0 ? 1.5F : 0.2F;
            const GnOccluder t{near + size * any(), near + size * any(), near + size * any(), false};
            const GnHider hider = glsl::gn_hider(sampled, t.a, t.b, t.c);
            const bool may = glsl::gn_may_hide(sampled, hider, middle - half, middle + half);
            ++asked.at(may ? 1 : 0);
            bool hides = false;
            for (int k = 0; k < 24 && !hides; ++k) {
                const vec3 p = middle + half * any();
                const vec3 n = glm::normalize(glsl::gn_towards(p, sampled.centre_ws));
                const glsl::GnOcclusion o = glsl::gn_occlusion(t, p, n);
                for (const vec4& point : points) {
                    hides = hides || (o.hides && glsl::gn_in_the_way(o, t, glsl::gn_ray_origin(p, n), point));
                }
            }
            hidden += hides ? 1 : 0;
            EXPECT_TRUE(may || !hides) << "kind " << light.kind << ", try " << i;
        }
        // What is asked in vain is less than what is left out.
        EXPECT_GT(hidden, 300);
        EXPECT_LT(asked[1] - hidden, asked[0]);
    }
}

/// Whether an edge that clears a box does so as seen from each of its corners, towards each corner of a light: the edge's plane is bilinear
/// in both, so that nothing between the corners does worse.
TEST(MayHide, AnEdgeThatClearsABoxClearsItsCorners) {
    std::mt19937 random(14);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto any = [&] { return vec3(unit(random), unit(random), unit(random)); };
    const auto corner = [](int i) { return dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1); };
    GnLight small_sun = sun({0.4F, -1, 0.2F}), small = rectangle({1, 3, -0.5F}, {0, 0, 0});
    small_sun.angular_radius = 0;
    small.half_size = vec2(0);
    std::vector<GnLight> lights = area_lights();
    lights.insert(lights.end(), {small_sun, small});
    for (const GnLight& light : lights) {
        const GnSampledLight sampled = sampled_light(light);
        int clear = 0, nearly = 0;
        for (int i = 0; i < 4000; ++i) {
            // Edges on all sides of the box's middle: also behind it, as seen from the light, where other places of the box lie behind them.
            const vec3 middle = 2.0F * any(), half = 0.8F * glm::abs(any()), b = 1.5F * any(), c = b + any();
            const vec3 d = vec3(sampled.centre_ws) - middle * sampled.centre_ws.w;
            const float side = i % 2 == 0 ? 1.0F : -1.0F;
            double most = -1e30, size = 0;
            for (int k = 0; k < 8; ++k) {
                const dvec3 p = corner(k) * dvec3(half);
                for (int j = 0; j < 8; ++j) {
                    const dvec3 e = 0.5 * corner(j);
                    // A round light lies within its square, and has its own corners nowhere.
                    const double within = sampled.square != 0  ? 1
                                          : sampled.solid != 0 ? 1 / std::sqrt(3)
                                                               : std::sqrt(0.5);
                    const dvec3 l =
                        dvec3(d) +
                        within * (e.x * dvec3(sampled.x_ws) + e.y * dvec3(sampled.y_ws) + e.z * dvec3(sampled.z_ws)) -
                        p * static_cast<double>(sampled.centre_ws.w);
                    const dvec3 edge = glm::cross(dvec3(b) - p, dvec3(c) - p);
                    most = std::max(most, static_cast<double>(side) * glm::dot(l, edge));
                    size = std::max(size, glm::length(l) * glm::length(edge));
                }
            }
            const bool clears = glsl::gn_edge_clears(sampled, side, b, c, d, half, 0.0F);
            EXPECT_TRUE(!clears || most < 0) << "kind " << light.kind << ", try " << i << ": " << most;
            clear += clears ? 1 : 0;
            nearly += clears && most > -0.05 * size ? 1 : 0;
        }
        EXPECT_GT(clear, 300) << "kind " << light.kind;
        // Of a light without extent the plane is linear in the place, and the bound is attained.
        if (glm::length(sampled.x_ws) == 0) {
            EXPECT_GT(nearly, 10) << "kind " << light.kind;
        }
    }
}

FrameResult render(const Scene& scene, const std::string& recipe, uint width = 96, uint height = 72) {
    const test::ValidationGuard guard;
    SceneGpu uploaded = upload_scene(device(), scene);
    FrameResult frame = render_frame(device(), uploaded, scene.cameras.front(), load_recipe(recipe),
                                     {.width = width, .height = height, .picture = false});
    for (const std::string& refused : frame.refused) {
        EXPECT_EQ(refused, "");
    }
    return frame;
}

std::vector<float> visibility(const Scene& scene, const std::string& recipe) {
    return render(scene, recipe).visibility.front().values;
}

/// Pairs of a sample and a point in which V differs from rays to the same points.
struct Pairs {
    double wrong = 0, all = 0;
    std::size_t partial = 0;
};
Pairs compare_pairs(const Scene& scene, const FrameResult& frame, int points, int side) {
    const LightSamples samples = light_samples(scene.lights.front().shape, points * side * side, side);
    const CpuSamples& seen = frame.samples;
    const TruthResult truth = Truth(scene).trace(seen.position_ws, seen.normal_ws, scene.lights.front(),
                                                 {.exactly = &samples, .width = seen.width});
    Pairs pairs;
    for (std::size_t i = 0; i < truth.counted.size(); ++i) {
        const float v = frame.visibility.front().values[i];
        if (truth.counted[i] == 0) {
            EXPECT_EQ(v, 0.0F) << i;
            continue;
        }
        // Points of a sphere weigh about two of all, or nothing: a difference within rounding is none.
        const double difference = std::abs(static_cast<double>(v) - static_cast<double>(truth.visibility[i]));
        pairs.wrong += difference > 1e-5 ? difference * points : 0;
        pairs.all += points;
        pairs.partial += truth.visibility[i] > 0 && truth.visibility[i] < 1 ? 1 : 0;
    }
    return pairs;
}

TEST(ViewSamplesRendered, HideThePointsThatRaysToThemFindHidden) {
    // Many points of a large sheet make walks long, which are handed over.
    for (const GnLight& light : area_lights()) {
        for (const auto& [points, side] : {std::pair{32, 1}, {40, 2}, {256, 1}}) {
            const Scene scene = garden().light(light).scene();
            const FrameResult frame = render(
                scene, fmt::format("view-samples,view-samples.samples={},view-samples.patterns={}", points, side));
            const Pairs pairs = compare_pairs(scene, frame, points, side);
            EXPECT_LE(pairs.wrong, 1e-5 * pairs.all) << "kind " << light.kind << ", " << points << " points";
            EXPECT_GT(pairs.partial, 300U);
        }
    }
}

TEST(ViewSamplesRendered, OfALightWithoutExtentIsTheIrregularZBufferToTheBit) {
    for (GnLight light : area_lights()) {
        light.radius = light.angular_radius = 0;
        light.half_size = vec2(0);
        const Scene scene = garden().light(light).scene();
        EXPECT_EQ(visibility(scene, "view-samples"), visibility(scene, "irregular-z")) << "kind " << light.kind;
    }
}

TEST(ViewSamplesRendered, IsTheSameOnEveryGridAndInEveryOrderToTheBit) {
    for (const char* test : {"exact", "table"}) {
        const Scene scene = garden().light(area_lights()[0]).scene();
        const std::string recipe = fmt::format("view-samples,view-samples.test={}", test);
        const std::vector<float> v = visibility(scene, recipe);
        for (const char* other : {"resolution=16", "resolution=300", "placement=cascades"}) {
            EXPECT_EQ(visibility(scene, recipe + "," + other), v) << test << ", " << other;
        }
        Scene turned = scene;
        for (const Object& object : scene.objects) {
            std::reverse(turned.triangles.begin() + object.first_triangle,
                         turned.triangles.begin() + object.first_triangle + object.triangle_count);
        }
        EXPECT_EQ(visibility(turned, recipe), v) << test << ", triangles the other way round";
    }
}

TEST(ViewSamplesRendered, TheMapErrsByTheTexelsOfItsEdges) {
    const auto rms = [](const std::vector<float>& a, const std::vector<float>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            sum += (a[i] - b[i]) * (a[i] - b[i]);
        }
        return std::sqrt(sum / static_cast<double>(a.size()));
    };
    for (const GnLight& light : area_lights()) {
        const Scene scene = garden().light(light).scene();
        const std::vector<float> exact = visibility(scene, "view-samples,view-samples.samples=64");
        const std::string table = "view-samples,view-samples.samples=64,view-samples.test=table";
        const double coarse = rms(visibility(scene, table + ",view-samples.angles=16,view-samples.offsets=8"), exact);
        const double fine = rms(visibility(scene, table), exact);
        // Where one edge crosses the light its displacement is the error; penumbrae are a part of the picture.
        EXPECT_GT(coarse, 2 * fine) << "kind " << light.kind;
        EXPECT_LT(fine, 0.71 / 64 + 2.23 / 128) << "kind " << light.kind;
        EXPECT_GT(fine, 0) << "kind " << light.kind;
    }
}

TEST(ViewSamplesRendered, SolidsCastWithTheFacesThatSomeOfTheLightMissesAlone) {
    for (const GnLight& light : area_lights()) {
        const Scene scene = garden().light(light).scene();
        EXPECT_EQ(visibility(scene, "view-samples,view-samples.closed=true"), visibility(scene, "view-samples"))
            << "kind " << light.kind;
    }
}

TEST(ViewSamplesRendered, TellWhatIsHiddenListedAndAsked) {
    const Scene scene = garden().light(area_lights()[0]).scene();
    SceneGpu uploaded = upload_scene(device(), scene);
    const std::vector<std::string> names{"hidden-samples", "list-length", "asked-triangles"};
    const auto told = [&](const std::string& text, std::uint32_t resolution) {
        const test::ValidationGuard guard;
        Recipe recipe = load_recipe(text);
        recipe.resolution = resolution;
        return show_hidden(device(), uploaded, scene.cameras.front(), recipe, names, {.width = 96, .height = 72});
    };
    const FrameResult frame = render(scene, "view-samples");
    const auto shown = told("view-samples", 1);
    const auto fewer = told("view-samples", 64);
    std::size_t counted = 0;
    for (std::size_t i = 0; i < frame.samples.position_ws.size(); ++i) {
        counted += shown[1].values.values[2 * i] > 0 ? 1 : 0;
    }
    double all = 0;
    double closed = 0;
    for (std::size_t i = 0; i < frame.samples.position_ws.size(); ++i) {
        if (shown[1].values.values[2 * i] > 0) {
            // One texel lists all samples, and what is not hidden is seen.
            EXPECT_EQ(shown[1].values.values[2 * i], static_cast<float>(counted));
            EXPECT_LE(fewer[1].values.values[2 * i], 64.0F);
            EXPECT_NEAR(shown[0].values.values[2 * i], 1 - frame.visibility.front().values[i], 1e-6F);
            EXPECT_TRUE(shown[0].values.values[2 * i] == 0 || shown[2].values.values[2 * i] > 0);
            all += shown[2].values.values[2 * i];
        }
    }
    const std::vector<float> fewer_asked = told("view-samples,view-samples.closed=true", 64)[2].values.values;
    for (std::size_t i = 0; i < fewer_asked.size(); i += 2) {
        closed += fewer_asked[i];
    }
    EXPECT_GT(counted, 3000U);
    EXPECT_GT(all, static_cast<double>(counted));
    EXPECT_LT(closed, all);
}

TEST(ViewSamplesRendered, WhatCannotBeIsRefusedByName) {
    const Scene scene = garden().light(area_lights()[2]).scene();
    SceneGpu uploaded = upload_scene(device(), scene);
    const auto refused = [&](const std::string& recipe) {
        return render_frame(device(), uploaded, scene.cameras.front(), load_recipe(recipe),
                            {.width = 16, .height = 16, .picture = false})
            .refused.front();
    };
    EXPECT_NE(refused("view-samples,view-samples.samples=300,view-samples.patterns=2").find("at most 256"),
              std::string::npos);
    const FrameResult large =
        render_frame(device(), uploaded, scene.cameras.front(), load_recipe("view-samples,view-samples.samples=1024"),
                     {.width = 1200, .height = 900, .visibility = false, .picture = false});
    EXPECT_NE(large.refused.front().find("1200 x 900 view samples with 1024 points"), std::string::npos);
    EXPECT_NE(large.refused.front().find("a smaller view-samples.samples"), std::string::npos);
    EXPECT_NE(refused("view-samples,placement=paraboloid").find("use auto or cube"), std::string::npos);
    EXPECT_NE(
        refused("view-samples,view-samples.angles=1024,view-samples.offsets=1024").find("fewer view-samples.angles"),
        std::string::npos);
}

}  // namespace
}  // namespace gn::view_samples_test
