// SPDX-License-Identifier: MIT
#include "shadow/placement/faces.glsl"
#include "shadow/placement/light_views.h"
#include "shadow/recipe/guard.h"
#include "tests/direct_scenes.h"
#include "tests/lookup_by_hand.h"
#include "tests/warp_scene.h"

#include <algorithm>
#include <random>

namespace gn::cube_test {
namespace {

Scene scene_around(vec3 light_ws) {
    Scene scene;
    scene.bounds_ws = Box{vec3(-10), vec3(10)};
    scene.lights.push_back({"point", {}});
    scene.lights[0].shape.kind = GN_LIGHT_POINT;
    scene.lights[0].shape.position_ws = vec4(light_ws, 1);
    return scene;
}

TEST(Cube, EveryDirectionFallsInsideItsFaceWithRoomForTheKernel) {
    const Scene scene = scene_around(vec3(1, 2, 3));
    FrameGraph graph(test::device());
    const SceneHandles handles;
    const ViewSamples samples;
    const FrameInput input{test::device(), graph, scene, handles, samples, scene.lights.data()};
    Recipe recipe = load_recipe("pcf,resolution=256,pcf.size=9");
    LightViews views;
    add_cube_views(views, input, guard_of(recipe, {}, {}), recipe.resolution);
    ASSERT_EQ(views.views.size(), 6U);

    const double reach = 2.0 * static_cast<double>(guard_of(recipe, {}, {}).texels) / 256;
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 2000; ++i) {
        const vec3 d_ws = glm::normalize(vec3(normal(random), normal(random), normal(random)));
        const auto face = static_cast<std::size_t>(glsl::gn_face_of(d_ws));
        const vec4 p_cs = views.views[face].cs_from_ws * vec4(vec3(1, 2, 3) + 4.0F * d_ws, 1);
        EXPECT_GT(p_cs.w, 0);
        EXPECT_LE(std::abs(p_cs.x / p_cs.w), 1 - reach + 1e-4) << "face " << face;
        EXPECT_LE(std::abs(p_cs.y / p_cs.w), 1 - reach + 1e-4) << "face " << face;
    }
}

/// A point light in a room with a rod that casts over face borders: no pixel may differ by more than edges explain.
TEST(Cube, NoSeamBetweenFaces) {
    const auto c = test::compare("overlap:light=point,hard=1", "hard,placement=cube,resolution=512");
    const auto fitted = test::compare("overlap:light=point,hard=1", "hard,placement=fit,resolution=512");
    // Both maps measure 0 here; four samples on the rod's edge may fall to the other side of a texel.
    const double few = 4 / static_cast<double>(c.errors.samples);
    EXPECT_LE(*c.errors.acne, few + *fitted.errors.acne);
    EXPECT_LE(*c.errors.mismatch, few + *fitted.errors.mismatch);
}

TEST(Cube, ALightFarOffSaysHowFewTexelsAreLeft) {
    const auto remarks_of = [](float distance, const char* recipe) {
        Scene scene = load_scene("contact:light=point");
        scene.lights[0].name = "star";
        scene.lights[0].shape.position_ws = vec4(glm::normalize(vec3(1, 2, 1)) * distance, 1);
        SceneGpu gpu = upload_scene(test::device(), scene);
        return render_frame(test::device(), gpu, scene.camera(""), load_recipe(recipe),
                            {.width = 32, .height = 32, .repeat = 0, .picture = false})
            .remarks;
    };
    // The placement is the automatic one, and the scene a dozen metres large: at 10 km half a texel is left of 1024.
    EXPECT_TRUE(remarks_of(10, "hard").empty());
    const auto remarks = remarks_of(1e4F, "hard");
    ASSERT_EQ(remarks.size(), 1U);
    for (const char* part : {"'cube'", "'star'", "1024", "placement=fit"}) {
        EXPECT_NE(remarks[0].find(part), std::string::npos) << remarks[0];
    }
    EXPECT_TRUE(remarks_of(1e4F, "hard,placement=fit").empty());
}

constexpr const char* equal = "pcf,pcf.size=5,placement=cube,resolution=512";
constexpr const char* by_coverage = "pcf,pcf.size=5,placement=cube,cube.resolution=coverage,resolution=512";

/// Squares of one layer do not overlap, and each leaves its kernels room inside itself.
TEST(CubeCoverage, SquaresLieApartInsideTheirLayers) {
    for (const char* name : {"overlap:light=point", "contact:light=point", "duel:light=point", "tilted:light=point"}) {
        const LightViews views = test::place(load_scene(name), by_coverage);
        ASSERT_EQ(views.views.size(), 6U);
        EXPECT_LT(views.layers, 6U) << name;
        EXPECT_TRUE(
            std::any_of(views.views.begin(), views.views.end(), [](const GnLightView& v) { return v.rect_ts.z == 1; }))
            << name << ": the face that covers most keeps all texels";
        for (std::size_t i = 0; i < 6; ++i) {
            const vec4 a = views.views[i].rect_ts;
            EXPECT_LE(std::max(a.x + a.z, a.y + a.w), 1) << name;
            EXPECT_LT(views.views[i].layer, static_cast<int>(views.layers)) << name;
            for (std::size_t j = 0; j < i; ++j) {
                const vec4 b = views.views[j].rect_ts;
                const bool apart = a.x >= b.x + b.z || b.x >= a.x + a.z || a.y >= b.y + b.w || b.y >= a.y + a.w;
                EXPECT_TRUE(apart || views.views[i].layer != views.views[j].layer) << name << " " << i << " " << j;
            }
        }
    }
}

TEST(CubeCoverage, DirectionsFallInsideTheirSquareWithRoomForTheKernel) {
    const Scene scene = load_scene("duel:light=point");
    const LightViews views = test::place(scene, by_coverage);
    const vec3 eye_ws(scene.lights[0].shape.position_ws);
    const float guard = guard_of(load_recipe(by_coverage), {}, {}).texels;
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 2000; ++i) {
        const vec3 d_ws = glm::normalize(vec3(normal(random), normal(random), normal(random)));
        const GnLightView& view = views.views[static_cast<std::size_t>(glsl::gn_face_of(d_ws))];
        const vec4 p_cs = view.cs_from_ws * vec4(eye_ws + 4.0F * d_ws, 1);
        const float room = 1 - 2 * guard / (512 * view.rect_ts.z) + 1e-4F;
        EXPECT_LE(std::max(std::abs(p_cs.x), std::abs(p_cs.y)) / p_cs.w, room);
    }
}

/// No view sample asks a face that nothing is drawn to.
TEST(CubeCoverage, FacesThatAreSkippedHaveNoReceivers) {
    for (const char* name : {"overlap:light=point", "contact:light=point", "duel:light=point"}) {
        const Scene scene = load_scene(name);
        SceneGpu gpu = upload_scene(test::device(), scene);
        const CpuSamples cpu = render_samples(test::device(), gpu, scene.cameras[0], 96, 96);
        const LightViews views = test::place(scene, by_coverage, 96, 96);
        std::size_t skipped = 0;
        for (const auto& casters : views.casters) {
            skipped += casters.empty() ? 1 : 0;
        }
        EXPECT_GE(skipped, 1U) << name;
        for (const vec4& p : cpu.position_ws) {
            if (p.w > 0.5F) {
                const vec3 d_ws = vec3(p) - vec3(scene.lights[0].shape.position_ws);
                ASSERT_FALSE(views.casters[static_cast<std::size_t>(glsl::gn_face_of(d_ws))].empty()) << name;
            }
        }
    }
}

/// Kernels read their own square only: where all faces that are seen are as fine, the picture is that of equal faces, bit for
/// bit.
TEST(CubeCoverage, NoSeamUnderAnyKernel) {
    for (const char* kernel :
         {"", ",pcf.size=9", ",pcf.kernel=vogel,pcf.radius=6", ",pcf.kernel=gaussian,pcf.size=7"}) {
        for (const char* scene : {"overlap:light=point,hard=1", "tilted:light=point", "tilted:light=point,angle=75"}) {
            const auto even = test::compare(scene, std::string(equal) + kernel);
            const auto uneven = test::compare(scene, std::string(by_coverage) + kernel);
            EXPECT_EQ(uneven.visibility().values, even.visibility().values) << scene << kernel;
        }
    }
}

/// Root mean square difference of two pictures of V: of receivers within `share` of a face's edge, and of all others.
struct Differences {
    double at_edges = 0, elsewhere = 0;
    int edges = 0;
};
Differences differences(const test::Comparison& a, const test::Comparison& b, float share) {
    Differences found;
    int others = 0;
    const vec3 light_ws(a.scene.lights[0].shape.position_ws);
    for (std::size_t i = 0; i < a.truth.counted.size(); ++i) {
        if (a.truth.counted[i] == 0) {
            continue;
        }
        const vec3 d = glm::abs(vec3(a.frame.samples.position_ws[i]) - light_ws);
        const float most = std::max({d.x, d.y, d.z});
        const float second = d.x + d.y + d.z - most - std::min({d.x, d.y, d.z});
        const double change = a.visibility().values[i] - b.visibility().values[i];
        const bool edge = second > (1 - share) * most;
        (edge ? found.at_edges : found.elsewhere) += change * change;
        ++(edge ? found.edges : others);
    }
    found.at_edges = std::sqrt(found.at_edges / std::max(found.edges, 1));
    found.elsewhere = std::sqrt(found.elsewhere / std::max(others, 1));
    return found;
}

/// A lamp over a ground, and bars under it whose shadows cross the edges of the face that looks down.
Scene bars_under_a_lamp() {
    by_hand::SceneBuilder builder;
    builder.ground(6);
    for (int i = 0; i < 8; ++i) {
        const float x = -2.1F + 0.6F * static_cast<float>(i);
        builder.box({x, 0.2F, -3}, {x + 0.2F, 0.4F, 3});
    }
    builder.light(by_hand::point({0, 2, 0}));
    builder.camera({0, 6, 5}, {0, 0, 0}, 0.1F, 50);
    return builder.scene();
}

/// Faces of exactly a quarter turn have finer texels than those with a border, so that shadows differ a little everywhere.
/// Where kernels cross to the next face they differ no more than that.
TEST(CubeEdges, AKernelThatCrossesSeesWhatABorderWouldShow) {
    for (const char* recipe : {"pcf,pcf.kernel=gaussian,pcf.size=9", "pcf,pcf.kernel=vogel,pcf.taps=16,pcf.radius=5",
                               "vsm,filtered.footprint=radius,filtered.radius=7,vsm.blur=none"}) {
        const std::string text = std::string(recipe) + ",placement=cube,resolution=512";
        const auto border = test::compare(bars_under_a_lamp(), text);
        const auto crossing = test::compare(bars_under_a_lamp(), text + ",cube.edges=cross");
        const Differences d = differences(border, crossing, 2 * 6.0F / 512);
        EXPECT_GT(d.edges, 200);
        EXPECT_LT(d.at_edges, 2 * d.elsewhere) << recipe << ", edges " << d.edges;
    }
}

TEST(CubeEdges, EveryTapBeyondAFaceIsFoundInAnother) {
    // A ground under a lamp lies behind five faces; its plane meets every ray that goes down.
    by_hand::SceneBuilder builder;
    builder.ground(6);
    builder.light(by_hand::point({0, 2, 0}));
    builder.camera({0, 6, 5}, {0, 0, 0}, 0.1F, 50);
    const Scene scene = builder.scene();
    const auto found =
        test::visibility_by_hand(scene, load_recipe("pcf,placement=cube,cube.edges=cross,resolution=64"), R"(
    float found = 0.0;
    for (int k = 0; k < 4; ++k) {
        vec2 d_ts = at.projected.texel_ts * vec2(k == 0 ? 6 : k == 1 ? -6 : 0, k == 2 ? 6 : k == 3 ? -6 : 0);
        vec2 tap_ts = at.projected.uv_ts + d_ts;
        if (gn_way_ws(at.receiver, at.view, d_ts) != vec3(0.0) && !gn_within_view(at.projected, tap_ts, tap_ts)) {
            GnLookup tap = gn_at_tap(at, tap_ts);
            if (tap.projected.layer == at.projected.layer) {
                return 0.5;
            }
            found = 1.0;
        }
    }
    return found;)",
                                 64);
    EXPECT_EQ(std::count(found.begin(), found.end(), 0.5F), 0);
    EXPECT_GT(std::count(found.begin(), found.end(), 1.0F), 400);
}

TEST(CubeEdges, NothingIsDarkenedWhereNothingCasts) {
    for (const char* kernel : {"pcf.kernel=gaussian,pcf.size=5", "pcf.kernel=vogel,pcf.taps=16,pcf.radius_world=0.5"}) {
        const auto c = test::compare("tilted:light=point,angle=60",
                                     std::string("pcf,placement=cube,cube.edges=cross,resolution=256,") + kernel);
        EXPECT_LT(c.errors.acne.value_or(1), 1e-5) << kernel;
    }
}

}  // namespace
}  // namespace gn::cube_test
