// SPDX-License-Identifier: MIT
// Windows of a grid fixed to the world: still while the camera moves, kept over frames, no larger than the scene.
#include "tests/cascade_frame.h"
#include "tests/warp_scene.h"

#include <random>

namespace gn::stable_test {
namespace {

using namespace cascades;
using namespace test;
using glsl::GnChoice;
using glsl::GnProjected;
using glsl::GnReceiver;

TEST(CascadeSphere, HoldsTheSliceAndTouchesItsFarCorners) {
    for (const Interval slice : {Interval{0.1, 3}, Interval{3, 20}, Interval{100, 101}}) {
        const Camera camera{.yfov = 0.9F};
        const Sphere sphere = sphere_around(slice, 0.9F, 1.5);
        const dvec3 centre(0, 0, -sphere.centre);
        double farthest_corner = 0;
        for (const dvec3& p : body_of(camera, 1.5F, slice.near, slice.far).vertices()) {
            farthest_corner = std::max(farthest_corner, glm::length(p - centre));
        }
        EXPECT_NEAR(farthest_corner, sphere.radius, 1e-5 * sphere.radius);
    }
}

struct Placed {
    GnProjected projected;
    dvec2 texel;
};

/// The receiver's place in the window around `centre`, by the function that the shaders use.
Placed placed_at(const Grid& grid, dvec3 centre_ws, vec3 p_ws) {
    const GnLightView view = view_of(grid, window_around(grid, centre_ws));
    GnReceiver receiver{};
    receiver.p_ws = p_ws;
    receiver.n_ws = glm::normalize(vec3(0.2F, 1, 0.1F));
    const GnProjected projected = glsl::gn_project(receiver, view, GnBias{});
    return {projected, dvec2(projected.uv_ts) * static_cast<double>(grid.resolution)};
}

/// Near 0.1 m to far 10 km, at the origin and 100 km away: a point's place within its texel, and its depth, must not
/// change by a single bit while the camera moves by fractions of a texel.
TEST(CascadeStable, PlaceInTheTexelIsBitEqualWhereverTheCameraMoves) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const dvec3 origin : {dvec3(0), dvec3(100e3, 30, -70e3)}) {
        const Box scene_ws{vec3(origin) - 5000.0F, vec3(origin) + 5000.0F};
        for (const Interval slice : {Interval{0.1, 5}, Interval{5, 80}, Interval{80, 1000}, Interval{1000, 10000}}) {
            const Sphere sphere = sphere_around(slice, 0.9, 1.78);
            const Grid grid = grid_of(sphere, sun(vec3(0.4F, -1, 0.3F)), scene_ws, 1024, {.texels = 3}, 0);
            const double texel = 2 * sphere.radius / 1024;
            for (int i = 0; i < 200; ++i) {
                const dvec3 offset = 0.5 * sphere.radius * dvec3(unit(random), unit(random), unit(random));
                const vec3 p_ws(origin + offset);
                const Placed still = placed_at(grid, origin, p_ws);
                ASSERT_TRUE(still.projected.inside);
                for (const double step : {0.13, 0.5, 0.77, 1.0, 3.3}) {
                    const Placed moved = placed_at(grid, origin + step * texel * dvec3(1, 0.3, -0.6), p_ws);
                    ASSERT_EQ(still.projected.depth, moved.projected.depth);
                    ASSERT_EQ(still.projected.texel_ws, moved.projected.texel_ws);
                    ASSERT_EQ(still.projected.plane_slope, moved.projected.plane_slope);
                    const dvec2 change = moved.texel - still.texel;
                    ASSERT_EQ(change, glm::round(change)) << "slice to " << slice.far << " step " << step;
                }
            }
        }
    }
}

TEST(CascadeStable, WindowHoldsTheSphereAndItsKernel) {
    std::mt19937 random(6);
    std::normal_distribution<double> normal;
    for (const dvec3 origin : {dvec3(0), dvec3(100e3, 30, -70e3)}) {
        const Box scene_ws{vec3(origin) - 5000.0F, vec3(origin) + 5000.0F};
        const Sphere sphere = sphere_around({0.1, 20}, 0.9, 1.78);
        const Guard guard{.texels = 4, .metres = 0.1F};
        const Grid grid = grid_of(sphere, sun(vec3(0.4F, -1, 0.3F)), scene_ws, 512, guard, 0);
        for (int i = 0; i < 2000; ++i) {
            const dvec3 centre = origin + 10.0 * dvec3(normal(random), normal(random), normal(random));
            const dvec3 direction = glm::normalize(dvec3(normal(random), normal(random), normal(random)));
            const vec3 p_ws(centre + sphere.radius * direction);
            const GnLightView view = view_of(grid, window_around(grid, centre));
            const vec4 p_cs = gn_clip(view, p_ws);
            EXPECT_LE(std::abs(p_cs.x), 1 - 2 * 4.0 / 512) << i;
            EXPECT_LE(std::abs(p_cs.y), 1 - 2 * 4.0 / 512) << i;
        }
    }
}

/// Where a sphere is wider than the scene, the window is the scene's rectangle of least area: it touches all four borders
/// to within a texel, and no camera moves it.
TEST(CascadeStable, WindowIsNeverWiderThanTheScene) {
    const Guard guard{.texels = 3};
    for (const vec3 direction : {vec3(0, -1, 0), vec3(0.4F, -1, 0.3F), vec3(1, -0.2F, 0)}) {
        const Box scene_ws{vec3(-3, 0, -200), vec3(3, 4, 50)};
        const ConvexBody body = body_of(scene_ws);
        for (const double radius : {20.0, 1000.0}) {
            const Grid grid = grid_of({0, radius}, sun(direction), scene_ws, 1024, guard, 0);
            EXPECT_TRUE(grid.still.x || grid.still.y);
            EXPECT_EQ(grid.still.x && grid.still.y, radius == 1000.0);
            const GnLightView view = view_of(grid, window_around(grid, dvec3(1, 2, -50)));
            const GnLightView other = view_of(grid, window_around(grid, dvec3(-2, 1, -90)));
            for (int axis = 0; axis < 2; ++axis) {
                EXPECT_EQ(view.cs_from_ws[3][axis] == other.cs_from_ws[3][axis], grid.still[axis]);
                if (!grid.still[axis]) {
                    continue;
                }
                double low = 1e9;
                double high = -1e9;
                for (const dvec3& p : body.vertices()) {
                    const double at = 512 * (1 + static_cast<double>(gn_clip(view, vec3(p))[axis]));
                    low = std::min(low, at);
                    high = std::max(high, at);
                }
                // The guard, and the step by which windows move, on each side.
                EXPECT_NEAR(low, 4, 1) << direction.x << " axis " << axis;
                EXPECT_NEAR(high, 1020, 1) << direction.x << " axis " << axis;
            }
        }
    }
}

/// Inside the scene slices begin at the camera's near plane. Outside they begin where the scene can, by steps of two, and a
/// slice beyond which all spheres are wider than the scene is the last.
TEST(CascadeStable, SlicesBeginWhereTheSceneDoes) {
    Scene scene = test::long_floor(2, 40);
    scene.bounds_ws = Box{vec3(-10, -1, -10), vec3(10, 1, 10)};
    FrameGraph graph(device());
    const SceneHandles handles;
    const auto range = [&](double distance) {
        ViewSamples samples{.width = 160, .height = 90};
        samples.camera = {.position_ws = vec3(0, 0, 10 + distance), .yfov = 0.5F, .near = 0.1F, .far = 1000};
        const FrameInput input{device(), graph, scene, handles, samples, scene.lights.data()};
        return range_of(input, GnCascadesParams{});
    };
    EXPECT_EQ(range(-1).near, static_cast<double>(0.1F));
    double before = range(1).near;
    int doublings = 0;
    for (double distance = 1; distance < 500; distance *= 1.01) {
        const Interval now = range(distance);
        EXPECT_LE(now.near, distance);
        EXPECT_GE(now.near, 0.4 * distance) << distance;
        const bool doubled = now.near != before;
        EXPECT_NEAR(now.near, doubled ? 2 * before : before, 1e-9 * before) << distance;
        doublings += doubled ? 1 : 0;
        EXPECT_GT(now.far, now.near);
        before = now.near;
    }
    EXPECT_GE(doublings, 8);  // from 1 to 500 metres the distance doubles nearly nine times
    // Half the scene's larger side over the slope of the frustum's corners.
    const double slope = std::tan(0.25) * std::hypot(1, 160.0 / 90);
    EXPECT_NEAR(range(1).far, 1.001 * 10 / slope, 1e-3);
}

/// The same points, placed by a camera that stands elsewhere: not a bit of V may change, and without the grid many do.
TEST(CascadesRendered, StableVisibilityIsBitEqualWhileTheCameraMoves) {
    const Scene& scene = test::built_in("corridor");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const Camera& camera = scene.camera("");
    for (const char* lookup : {"hard", "pcf"}) {
        const std::string base = std::string(lookup) + ",resolution=512,placement=cascades,cascades.transition=none";
        const Rendered still = render(gpu, camera, camera, base);
        const Rendered loose = render(gpu, camera, camera, base + ",cascades.fit=fitted");
        std::size_t loose_changes = 0;
        for (const vec3 step : {vec3(0.003F, 0, 0), vec3(0.01F, 0.004F, -0.02F), vec3(0.11F, 0, -0.31F)}) {
            const Rendered other = render(gpu, camera, moved(camera, step), base);
            EXPECT_EQ(differing(still.visibility, other.visibility), 0U)
                << lookup << " step " << step.x << " " << step.y << " " << step.z;
            loose_changes += differing(
                loose.visibility, render(gpu, camera, moved(camera, step), base + ",cascades.fit=fitted").visibility);
        }
        EXPECT_GT(loose_changes, 50U) << lookup;
    }
}

/// The same for a camera that looks at the whole scene from outside.
TEST(CascadesRendered, StableVisibilityIsBitEqualFromOutside) {
    const Scene scene = with_hard_sun("courtyard");
    SceneGpu gpu = upload_scene(device(), scene);
    Camera camera = scene.camera("");
    const vec3 out = vec3(0.3F, 0.5F, 1);
    camera.position_ws = scene.bounds_ws.centre() + 1.2F * scene.bounds_ws.diagonal() * glm::normalize(out);
    camera.forward_ws = -glm::normalize(out);
    camera.far = 10 * scene.bounds_ws.diagonal();
    const std::string recipe = "pcf,resolution=512,placement=cascades,cascades.transition=none";
    const Rendered still = render(gpu, camera, camera, recipe);
    EXPECT_GT(std::count(still.visibility.begin(), still.visibility.end(), 1.0F), 100);
    for (const vec3 step : {vec3(0.003F, 0, 0), vec3(0.01F, 0.004F, -0.02F), vec3(0.11F, 0, -0.31F)}) {
        const Rendered other = render(gpu, camera, moved(camera, step), recipe);
        EXPECT_EQ(differing(still.visibility, other.visibility), 0U) << step.x;
    }
}

/// Four stable maps against one that is fitted anew each frame: far better where the view is long, and no worse than what
/// the fitted one gains by leaving out what the camera does not see where the scene is seen as a whole.
TEST(CascadesRendered, StableMapsAreNoWorseThanOneFittedMap) {
    const auto error = [](const Scene& scene, const char* recipe) {
        return *compare(scene, recipe, {.width = 480, .height = 270, .samples = 1}).errors.rmse;
    };
    const Scene corridor = load_scene("corridor");
    EXPECT_LE(error(corridor, "pcf,placement=cascades"), 0.35 * error(corridor, "pcf,placement=fit"));
    Scene outside = with_hard_sun("courtyard");
    Camera& camera = outside.cameras[0];
    const vec3 out = glm::normalize(vec3(0.3F, 0.5F, 1));
    camera.position_ws = outside.bounds_ws.centre() + 1.2F * outside.bounds_ws.diagonal() * out;
    camera.forward_ws = -out;
    camera.far = 10 * outside.bounds_ws.diagonal();
    EXPECT_LE(error(outside, "pcf,placement=cascades"), 1.05 * error(outside, "pcf,placement=fit"));
}

TEST(CascadesRendered, ScrolledMapEqualsOneDrawnFromNothing) {
    const Scene& scene = test::built_in("corridor");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const std::string recipe = "hard,resolution=256,placement=cascades,cascades.scroll=1";
    History kept(test::device());
    Camera camera = scene.camera("");
    for (const vec3 step : {vec3(0), vec3(0.2F, 0, -0.4F), vec3(-0.05F, 0.02F, -1.3F), vec3(0.4F, 0, 3.0F)}) {
        camera = moved(camera, step);
        const Rendered scrolled = render(gpu, camera, camera, recipe, &kept);
        History empty(test::device());
        const Rendered redrawn = render(gpu, camera, camera, recipe, &empty);
        EXPECT_EQ(differing(scrolled.map, redrawn.map), 0U) << "step " << step.x << " " << step.z;
        EXPECT_EQ(differing(scrolled.visibility, redrawn.visibility), 0U);

        // And it is the map that a frame without history draws, but for triangles that the window's border clips: the
        // rasterizer rounds the new corners to 1/256 of a texel.
        const Rendered plain = render(gpu, camera, camera, recipe);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < plain.map.size(); ++i) {
            const GnLightView& view = plain.views[i / (256 * 256)];
            const double texel = 2 / (256 * static_cast<double>(glm::length(glsl::gn_row(view.cs_from_ws, 0))));
            const double metres = std::abs(static_cast<double>(plain.map[i] - scrolled.map[i])) *
                                  static_cast<double>(view.metres_per_depth);
            wrong += metres > texel / 32 ? 1U : 0U;
        }
        EXPECT_LT(wrong, plain.map.size() / 1000);
    }
}

/// Geometry that moves leaves no shadow where it was, though the scene is the same and has as many triangles.
TEST(CascadesRendered, KeptMapsAreRedrawnWhereVerticesMoved) {
    for (const char* kept_by : {"scroll=1", "rate=8"}) {
        Scene scene = with_hard_sun("contact");
        SceneGpu gpu = upload_scene(test::device(), scene);
        const std::string recipe = fmt::format("hard,resolution=256,placement=cascades,cascades.{}", kept_by);
        const Camera& camera = scene.camera("");
        History kept(test::device());
        const Rendered before = render(gpu, camera, camera, recipe, &kept);
        // The same again is kept: nothing moved.
        EXPECT_EQ(differing(before.map, render(gpu, camera, camera, recipe, &kept).map), 0U);

        // A side of the box moves inwards, so that all bounds still hold.
        Object& box = scene.objects.back();
        for (uint i = 0; i < box.triangle_count; ++i) {
            for (int k = 0; k < 3; ++k) {
                float& x = scene.positions_ws[scene.triangles[box.first_triangle + i][k]].x;
                x = x > 0.25F ? x : x + 0.25F;
            }
        }
        gpu = upload_scene(test::device(), scene);
        const Rendered after = render(gpu, camera, camera, recipe, &kept);
        History empty(test::device());
        EXPECT_EQ(differing(after.map, render(gpu, camera, camera, recipe, &empty).map), 0U) << kept_by;
        EXPECT_GT(differing(after.map, before.map), 0U);
    }
}

/// What casts is told by the scene, not by its buffers: an object, a material or a lamp's bulb may change between frames.
TEST(CascadesRendered, KeptMapsAreRedrawnWhereSomethingCastsOtherwise) {
    const std::vector<std::function<void(Scene&)>> changes{
        [](Scene& scene) { scene.objects.back().casts = false; },
        [](Scene& scene) { scene.lights[0].spared = {static_cast<std::uint32_t>(scene.objects.size() - 1)}; },
        [](Scene& scene) { scene.materials[static_cast<std::size_t>(scene.objects.back().material)].casts = false; },
        [](Scene& scene) {
            Material& material = scene.materials[static_cast<std::size_t>(scene.objects.back().material)];
            material.alpha_mode = AlphaMode::mask;
            material.base_color.a = 0.25F;
        }};
    for (const char* kept_by : {"scroll=1", "rate=8"}) {
        for (std::size_t i = 0; i < changes.size(); ++i) {
            Scene scene = with_hard_sun("contact");
            SceneGpu gpu = upload_scene(test::device(), scene);
            const std::string recipe = fmt::format("hard,resolution=256,placement=cascades,cascades.{}", kept_by);
            const Camera& camera = scene.camera("");
            History kept(test::device());
            const Rendered before = render(gpu, camera, camera, recipe, &kept);
            changes[i](scene);
            const Rendered after = render(gpu, camera, camera, recipe, &kept);
            History empty(test::device());
            EXPECT_EQ(differing(after.map, render(gpu, camera, camera, recipe, &empty).map), 0U) << kept_by << " " << i;
            EXPECT_GT(differing(after.map, before.map), 0U) << kept_by << " " << i;
        }
    }
}

TEST(CascadesRendered, FarCascadesAreRedrawnAtTheirRateAndStillCoverTheirSlices) {
    const Scene& scene = test::built_in("corridor");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const std::string recipe = "hard,resolution=256,placement=cascades,cascades.rate=8,cascades.transition=none";
    History kept(test::device());
    Camera camera = scene.camera("");
    std::vector<int> moves(4, 0);
    Rendered before = render(gpu, camera, camera, recipe, &kept);
    for (int frame = 0; frame < 8; ++frame) {
        camera = moved(camera, vec3(0, 0, -0.35F));
        const Rendered now = render(gpu, camera, camera, recipe, &kept);
        for (std::size_t i = 0; i < 4; ++i) {
            moves[i] += now.views[i].cs_from_ws != before.views[i].cs_from_ws ? 1 : 0;
        }
        for (std::size_t p = 0; p < now.samples.position_ws.size(); ++p) {
            if (now.samples.position_ws[p].w > 0) {
                GnReceiver receiver = receiver_at(now.samples.normal_ws[p].w);
                receiver.p_ws = vec3(now.samples.position_ws[p]);
                const auto view = static_cast<std::size_t>(glsl::gn_cascades_choose(receiver, now.data).first);
                const vec4 p_cs = gn_clip(now.views[view], receiver.p_ws);
                ASSERT_LT(std::max(std::abs(p_cs.x), std::abs(p_cs.y)), 1) << "frame " << frame << " cascade " << view;
            }
        }
        before = now;
    }
    EXPECT_EQ(moves[0], 8);
    EXPECT_LE(moves[3], 1);
}

}  // namespace
}  // namespace gn::stable_test
