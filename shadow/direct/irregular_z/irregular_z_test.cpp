// SPDX-License-Identifier: MIT
// The irregular z-buffer against the traced hard shadow, and against itself through other lists and grids.
#include "shadow/direct/irregular_z/irregular_z.h"

#include "base/paths.h"
#include "reference/truth.h"
#include "shadow/geometry/occluder.glsl"
#include "tests/direct_scenes.h"
#include "tests/lent_points.h"
#include "tests/random_meshes.h"
#include "tests/thorough.h"

#include <filesystem>
#include <random>

namespace gn::irregular_z_test {
namespace {

using namespace by_hand;
using glsl::GnOccluder;

/// Whether the open segment from p to the light crosses the triangle, in double precision; nothing where rounding decides.
std::optional<bool> crosses(const std::array<dvec3, 3>& t, dvec3 p, dvec4 light) {
    const dvec3 d = dvec3(light) - p * light.w;
    const dvec3 n = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
    const double start = glm::dot(n, p - t[0]);
    const double end = light.w > 0 ? glm::dot(n, dvec3(light) - t[0]) : start + 1e9 * glm::dot(n, d);
    double least = 1e9;
    double most = -1e9;
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec3 edge = glm::cross(t[(i + 1) % 3] - p, t[(i + 2) % 3] - p);
        const double share = glm::dot(glm::normalize(d), edge) / glm::length(edge);
        least = std::min(least, share);
        most = std::max(most, share);
    }
    if (std::min({std::abs(start), std::abs(end), std::abs(least), std::abs(most)}) < 1e-4) {
        return {};
    }
    return (start > 0) != (end > 0) && (least > 0 || most < 0);
}

TEST(Occluder, HidesWhatLiesBehindItOnTheWayToTheLight) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto any = [&] { return 3.0F * vec3(unit(random), unit(random), unit(random)); };
    std::array<int, 2> found{};
    for (int i = 0; i < 40000; ++i) {
        GnOccluder t{any(), any(), any(), i % 3 == 0};
        const vec3 p = any();
        const vec4 light = i % 2 == 0 ? vec4(any(), 1) : vec4(glm::normalize(any()), 0);
        const auto exact = crosses({dvec3(t.a), dvec3(t.b), dvec3(t.c)}, dvec3(p), dvec4(light));
        const vec3 to_light = glm::normalize(glsl::gn_towards(p, light));
        const vec3 n_t = glm::cross(t.b - t.a, t.c - t.a);
        if (exact) {
            // A light that sees the back of what has one side is not hidden by it.
            const bool seen = !t.one_sided || glm::dot(n_t, to_light) > 0;
            const bool hides = glsl::gn_hidden(glsl::gn_occluder_says(t, p, to_light, light));
            EXPECT_EQ(hides, *exact && seen) << i;
            ++found.at(hides ? 1 : 0);
        }
    }
    EXPECT_GT(found[0], 10000);
    EXPECT_GT(found[1], 1000);
}

/// A view sample as shadow/view/gbuffer.glsl makes it of an interpolated position: moved into the plane of its triangle.
vec3 view_sample(const GnOccluder& t, vec3 n_ws, vec3 interpolated_ws) {
    return interpolated_ws - n_ws * glm::dot(n_ws, interpolated_ws - t.a);
}

TEST(Occluder, OfASamplesOwnSurfaceHidesNothingHoweverItIsRounded) {
    // Triangles far away from the origin and next to it, every other one a sliver, whose normal floats hardly tell.
    std::mt19937 random(12);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto any = [&] { return vec3(unit(random), unit(random), unit(random)); };
    std::array<int, 2> asked{}, held{}, sunk{};
    for (int i = 0; i < 40000; ++i) {
        const vec3 far = std::pow(1000.0F, std::abs(unit(random))) * any();
        GnOccluder t{far + 5.0F * any(), far + 5.0F * any(), far + 5.0F * any(), false};
        if (i % 2 == 1) {
            t.c = glm::mix(t.a, t.b, unit(random)) + 0.01F * any();
        }
        const dvec3 across = glm::cross(dvec3(t.b) - dvec3(t.a), dvec3(t.c) - dvec3(t.a));
        if (glm::length(across) < 1e-3) {
            continue;
        }
        const vec3 n(glm::normalize(across));
        const float u = 0.2F + 0.1F * std::abs(unit(random));
        const float v = 0.2F + 0.1F * std::abs(unit(random));
        const vec3 magnitude = glm::max(glm::max(glm::abs(t.a), glm::abs(t.b)), glm::abs(t.c));
        const vec3 interpolated = t.a + u * (t.b - t.a) + v * (t.c - t.a) + 8.0F * glsl::gn_ulp * magnitude * any();
        const vec3 p = view_sample(t, n, interpolated);
        const vec3 to_light = glm::normalize(n + 0.8F * any());
        const vec4 light = i % 4 < 2 ? vec4(p + 40.0F * to_light, 1) : vec4(to_light, 0);
        // Of slivers some are narrower than what moves a sample along them.
        const uint said = glsl::gn_occluder_says(t, p, n, light);
        EXPECT_EQ(said & ~glsl::gn_says_holds, 0U) << i;
        held.at(static_cast<std::size_t>(i % 2)) += said != 0 ? 1 : 0;
        ++asked.at(static_cast<std::size_t>(i % 2));
        sunk.at(static_cast<std::size_t>(i % 2)) += glm::dot(dvec3(p) - dvec3(t.a), dvec3(n)) < 0 ? 1 : 0;
    }
    for (const std::size_t k : {0U, 1U}) {
        EXPECT_GT(asked.at(k), 15000);
        EXPECT_GT(held.at(k), 0.98 * asked.at(k));
        EXPECT_GT(sunk.at(k), 5000);
    }
}

/// Two sheets that share an edge: view samples lie on `on`, and `over` stands above it at an angle.
struct Hinge {
    Scene scene;
    GnOccluder on, over;
    vec3 n_ws, n_over_ws;  ///< units

    Hinge(float angle, std::mt19937& random) {
        std::uniform_real_distribution<float> unit(-1, 1);
        const auto any = [&] { return vec3(unit(random), unit(random), unit(random)); };
        const vec3 along = glm::normalize(any()), out = glm::normalize(glm::cross(along, any()));
        const vec3 up = glm::cross(along, out), middle = 30.0F * any();
        const vec3 low = middle - 2.0F * along, high = middle + 2.0F * along, end = middle + 3.0F * out;
        const vec3 end_over = middle + 3.0F * (std::cos(angle) * out + std::sin(angle) * up);
        scene = SceneBuilder().mesh({low, high, end, end_over}, {{0, 1, 2}, {0, 3, 1}}).scene();
        on = {low, high, end, false};
        over = {low, end_over, high, false};
        n_ws = unit_normal(on);
        n_over_ws = unit_normal(over);
    }
    static vec3 unit_normal(const GnOccluder& t) {
        return vec3(glm::normalize(glm::cross(dvec3(t.b) - dvec3(t.a), dvec3(t.c) - dvec3(t.a))));
    }
    /// A point of `on`, so far from the edge, as a float can have it.
    [[nodiscard]] vec3 sample(float along, float from_edge) const {
        const double share = static_cast<double>(from_edge) / 3.0;
        return vec3(glm::mix(glm::mix(dvec3(on.a), dvec3(on.b), static_cast<double>(along)), dvec3(on.c), share));
    }
    /// One unit of rounding of such a point's height over the other sheet.
    [[nodiscard]] float rounding(vec3 p_ws) const {
        const vec3 corners = glm::max(glm::max(glm::abs(over.a), glm::abs(over.b)), glm::abs(over.c));
        return glsl::gn_rounding(1, n_over_ws, glm::max(glm::abs(p_ws), corners));
    }
};

TEST(Occluder, AtAHingeHidesAllThatLiesFartherFromASheetThanSamplesStray) {
    // What floats cannot tell from a sample's own surface is 2 to 12 units high, as gn_plane_rounding counts, and what a ray's origin is
    // raised by is 4: from 16 units on all is as it is traced, at any angle.
    std::mt19937 random(15);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::array<int, 2> judged{}, hidden{};
    for (int i = 0; i < 400; ++i) {
        const bool flat = i % 2 == 0;
        const float angle =
            flat ? 1e-4F * std::pow(1200.0F, std::abs(unit(random))) : 0.16F + 0.8F * std::abs(unit(random));
        const Hinge hinge(angle, random);
        const vec3 tilt(unit(random), unit(random), unit(random));
        const GnLight light = sun(-(hinge.n_ws + 0.3F * tilt));
        std::vector<vec4> positions, normals;
        for (int k = 0; k < 40; ++k) {
            // From one to a thousand units over the other sheet.
            const float units = std::pow(1000.0F, std::abs(unit(random)));
            const float from_edge = units * hinge.rounding(hinge.on.a) / std::sin(angle);
            if (from_edge < 2.5F) {
                positions.emplace_back(hinge.sample(0.5F + 0.05F * unit(random), from_edge), 1);
                normals.emplace_back(hinge.n_ws, 0);
            }
        }
        const TruthResult traced = Truth(hinge.scene).trace(positions, normals, light, {.samples = 1, .threads = 1});
        for (std::size_t k = 0; k < positions.size(); ++k) {
            const vec3 p_ws(positions[k]);
            const double height = std::abs(glm::dot(dvec3(hinge.n_over_ws), dvec3(p_ws) - dvec3(hinge.over.a)));
            if (height < 16.0 * static_cast<double>(hinge.rounding(p_ws))) {
                continue;
            }
            const vec4 light_ws(-vec3(light.direction_ws), 0);
            const bool hides = glsl::gn_hidden(glsl::gn_occluder_says(hinge.on, p_ws, hinge.n_ws, light_ws) |
                                               glsl::gn_occluder_says(hinge.over, p_ws, hinge.n_ws, light_ws));
            EXPECT_EQ(hides, traced.visibility[k] == 0.0F)
                << "angle " << angle << ", " << height / static_cast<double>(hinge.rounding(p_ws)) << " units above";
            ++judged.at(flat ? 0 : 1);
            hidden.at(flat ? 0 : 1) += hides ? 1 : 0;
        }
    }
    for (const std::size_t k : {0U, 1U}) {
        EXPECT_GT(judged.at(k), 1500);
        EXPECT_GT(hidden.at(k), judged.at(k) / 2);
    }
}

TEST(Occluder, LeavesNoGapBetweenTrianglesThatShareAnEdge) {
    // A fan around a vertex, and rays at its spokes as exactly as floats can be: one triangle or both are met, never none.
    std::mt19937 random(8);
    std::uniform_real_distribution<float> unit(-1, 1);
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
        const vec3 middle(unit(random), 2, unit(random));
        std::array<vec3, 5> rim{};
        for (std::size_t k = 0; k < rim.size(); ++k) {
            const float angle = 2 * pi * (static_cast<float>(k) + 0.4F * unit(random)) / 5;
            rim.at(k) = middle + vec3(std::cos(angle), 0.2F * unit(random), std::sin(angle));
        }
        const vec3 p(unit(random), 0, unit(random));
        const vec3 at = glm::mix(middle, rim.at(static_cast<std::size_t>(i) % 5), 0.5F * (unit(random) + 1) * 0.9F);
        const vec4 light = i % 2 == 0 ? vec4(p + 2.0F * (at - p), 1) : vec4(at - p, 0);
        int hits = 0;
        for (std::size_t k = 0; k < rim.size(); ++k) {
            // Every other triangle runs the other way round.
            const vec3 b = rim.at(k);
            const vec3 c = rim.at((k + 1) % 5);
            const GnOccluder t = k % 2 == 0 ? GnOccluder{middle, b, c, false} : GnOccluder{c, b, middle, false};
            hits += glsl::gn_hidden(glsl::gn_occluder_says(t, p, vec3(0, 1, 0), light)) ? 1 : 0;
        }
        EXPECT_GE(hits, 1) << i;
        met += hits;
    }
    EXPECT_LT(met, 2 * 20000);
}

std::vector<float> visibility(const Scene& scene, const Recipe& recipe, std::size_t light, uint width, uint height) {
    const test::ValidationGuard guard;
    SceneGpu uploaded = upload_scene(device(), scene);
    const FrameResult frame = render_frame(device(), uploaded, scene.cameras.front(), recipe,
                                           {.width = width, .height = height, .picture = false});
    EXPECT_EQ(frame.refused[light], "");
    return frame.visibility[light].values;
}

/// The garden under every kind of light.
Scene lit_garden() {
    SceneBuilder b = garden();
    b.light(sun({0.3F, -1, -0.2F})).light(point({0.5F, 2.9F, 0.4F})).light(spot({-3, 4, 2}, {0, 0, 0}, 0.5F));
    b.light(rectangle({-1, 3.6F, 0.4F}, {0, 0, 0}));
    return b.scene();
}

TEST(IrregularZRendered, EqualsTheTracedHardShadow) {
    const Scene scene = lit_garden();
    for (const char* lists : {"samples", "triangles"}) {
        Recipe recipe = load_recipe(fmt::format("irregular-z,resolution=64,irregular-z.lists={}", lists));
        for (const Comparison& result : render_and_judge(scene, recipe)) {
            EXPECT_EQ(result.wrong, 0U) << lists << ", " << result.judged << " judged: " << result.first;
            EXPECT_GT(result.shadowed, 300U);
            EXPECT_GT(result.lit, 500U);
        }
    }
}

TEST(IrregularZRendered, IsTheSameOnEveryGridAndPlacementToTheBit) {
    const Scene scene = lit_garden();
    for (const std::size_t light : {0U, 1U}) {
        Recipe recipe = load_recipe("irregular-z,resolution=64");
        const std::vector<float> fine = visibility(scene, recipe, light, 64, 48);
        for (const char* other : {"resolution=300", "placement=cascades+auto", "irregular-z.lists=triangles"}) {
            EXPECT_EQ(visibility(scene, load_recipe(fmt::format("irregular-z,resolution=64,{}", other)), light, 64, 48),
                      fine)
                << other;
        }
        recipe.resolution = 1;
        EXPECT_EQ(visibility(scene, recipe, light, 64, 48), fine) << "one texel";
    }
}

TEST(IrregularZRendered, AHostsSamplesMayStrayFromTheirSurface) {
    // Points of one sheet, 48 units of rounding to either side of it.
    const GnOccluder t{{702, 301, 498}, {699, 300.5F, 503}, {697, 303, 497}, false};
    const vec3 n = Hinge::unit_normal(t), middle = (t.a + t.b + t.c) / 3.0F;
    const float one = glsl::gn_rounding(1, n, glm::max(glm::max(glm::abs(t.a), glm::abs(t.b)), glm::abs(t.c)));
    const Scene scene = SceneBuilder()
                            .mesh({t.a, t.b, t.c}, {{0, 1, 2}})
                            .camera(middle + 9.0F * n, middle)
                            .light(sun(-n + vec3(0.2F, 0.1F, 0)))
                            .scene();
    std::vector<test::LentPoint> points;
    for (int i = 0; i < 256; ++i) {
        const vec3 on = glm::mix(middle, glm::mix(t.a, t.b, static_cast<float>(i % 16) / 15), 0.8F);
        points.push_back({on + n * (one * 48 * (static_cast<float>(i) / 127.5F - 1)), n});
    }
    EXPECT_EQ(test::visibility_at(scene, "irregular-z,resolution=64", points), std::vector<float>(points.size(), 1));
}

void expect_exact(Scene scene, const std::string& name, uint width, uint height) {
    for (Light& light : scene.lights) {
        light.shape.radius = light.shape.angular_radius = 0.0F;
        light.shape.half_size = vec2(0);
    }
    const std::vector<Comparison> results =
        render_and_judge(scene, load_recipe("irregular-z,resolution=512"), width, height);
    for (std::size_t i = 0; i < results.size(); ++i) {
        EXPECT_EQ(results[i].wrong, 0U) << name << ", light " << i << ", " << results[i].judged
                                        << " judged: " << results[i].first;
    }
}

TEST(IrregularZRendered, BuiltInScenesWithPointsForLightsHaveNoMismatch) {
    for (const char* name : {"slab", "tilted", "contact", "fence", "courtyard"}) {
        expect_exact(make_builtin_scene(name), name, 128, 96);
    }
}

std::string by_seed(unsigned seed) {
    return fmt::format("irregular-z,resolution=128,irregular-z.lists={}", seed % 2 == 0 ? "samples" : "triangles");
}

class IrregularZRandom : public testing::TestWithParam<unsigned> {};

TEST_P(IrregularZRandom, EqualsTheTracedHardShadowAwayFromEdges) {
    expect_random_meshes_as_traced(
        GetParam(), [](unsigned seed) { return load_recipe(by_seed(seed)); }, by_seed);
}

INSTANTIATE_TEST_SUITE_P(Kinds, IrregularZRandom, testing::Range(0U, mesh_kinds),
                         [](const auto& tested) { return std::string(mesh_kind_name(tested.param)); });

TEST(IrregularZRendered, SamplesBeyondTheBorderOfTheirTriangleLieOnTheNext) {
    // A ring's facets: a sample with the plane of one that ends before the pixel's centre, 4.7 units of rounding below the next.
    for (const Comparison& result : render_and_judge(random_meshes(1, 7), load_recipe(by_seed(7)), 120, 90)) {
        EXPECT_EQ(result.wrong, 0U) << result.judged << " judged: " << result.first;
        EXPECT_GT(result.lit, 500U);
    }
}

TEST(IrregularZRendered, SamplesBesideTheEdgeOfTwoSheetsLieInTheShadowOfTheOther) {
    // At such an angle the other sheet is 64 units of rounding high some pixels from the edge, 0.19 m, and 12 within one.
    std::size_t shadowed = 0;
    for (const float angle : {2e-5F, -2e-5F}) {
        for (const Comparison& result :
             render_and_judge(hinge(angle), load_recipe("irregular-z,resolution=64"), 120, 90)) {
            EXPECT_EQ(result.wrong, 0U) << angle << ", " << result.judged << " judged: " << result.first;
            shadowed += result.shadowed;
        }
    }
    EXPECT_GT(shadowed, 1000U);
}

TEST(IrregularZRendered, SaysWhereADriverEndsAList) {
    // One texel lists more triangles than some drivers go round a loop, and the first of them, a roof, comes last.
    SceneBuilder b;
    b.ground(10).quad({-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1});
    b.mesh({{5, 1, 5}, {5.1F, 1, 5}, {5, 1, 5.1F}}, std::vector<uvec3>(70000, uvec3(0, 1, 2)));
    const Scene scene = b.camera({2, 4, 3}, {0, 0, 0}).light(sun({0.1F, -1, 0.1F})).scene();
    const test::ValidationGuard guard;
    SceneGpu uploaded = upload_scene(device(), scene);
    const auto render = [&](const char* text, int resolution) {
        Recipe recipe = load_recipe(text);
        recipe.resolution = resolution;
        return render_frame(device(), uploaded, scene.cameras.front(), recipe,
                            {.width = 12, .height = 12, .picture = false});
    };
    const FrameResult right = render("irregular-z", 64);
    const FrameResult listed = render("irregular-z,irregular-z.lists=triangles", 1);
    const bool said = std::any_of(listed.remarks.begin(), listed.remarks.end(), [](const std::string& remark) {
        return remark.find("ended a loop of pass 'irregular-z: samples'") != std::string::npos;
    });
    EXPECT_GT(std::count(right.visibility[0].values.begin(), right.visibility[0].values.end(), 0.0F), 10);
    EXPECT_TRUE(said || listed.visibility[0].values == right.visibility[0].values);
}

// Models made by others, where they lie beside the source tree: open, thin and of many parts.
struct Model {
    const char* name;
    const char* file;
    bool slow = false;  ///< more than a second or two
};

class IrregularZOfModels : public testing::TestWithParam<Model> {};

TEST_P(IrregularZOfModels, HaveNoMismatch) {
    const auto file = data_root() / "../shared/scenes" / GetParam().file;
    if (!std::filesystem::exists(file)) {
        GTEST_SKIP() << "skipped: " << GetParam().file << " is not here";
    }
    if (GetParam().slow && !test::thorough()) {
        GTEST_SKIP() << "skipped: " << GetParam().file << " takes long";
    }
    expect_exact(load_scene(file.string(), {.ground = {Ground::automatic}}), GetParam().file, 128, 96);
}

const Model models[] = {{"courtyard_zdm2", "courtyard_zdm2/courtyard_zdm2.glb", true},
                        {"kenney_city", "kenney_city/kenney_city.glb", true},
                        {"monobloc_chair", "chairs_table/plastic_monobloc_chair.glb", true},
                        {"oak_chair", "chairs_table/oakChair/oakChair.obj"},
                        {"fence", "thin_structures/fence/fence.obj"},
                        {"clothes_horse", "thin_structures/clothes-horse/clothes-horse.obj"},
                        {"iron_railing", "thin_structures/iron-railing-1/iron-railing-1.obj"},
                        {"teapot", "classic/teapot.obj"},
                        {"rooms_grid", "rooms_grid/rooms_grid.glb", true}};
INSTANTIATE_TEST_SUITE_P(Models, IrregularZOfModels, testing::ValuesIn(models),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace gn::irregular_z_test
