// SPDX-License-Identifier: MIT
#include "shadow/placement/cascades/cascades.glsl"

#include "shadow/history.h"
#include "shadow/placement/cascades/cascade_views.h"
#include "tests/rig.h"

#include <cstring>
#include <random>

namespace gn {
namespace {

using namespace cascades;
using glsl::GnChoice;
using glsl::GnProjected;
using glsl::GnReceiver;

// ---- Splits: closed forms.

TEST(CascadeSplits, LogarithmicEndsAreThePublishedOnes) {
    GnCascadesParams params{.count = 3, .split = GN_SPLIT_LOG};
    EXPECT_NEAR(glsl::gn_cascades_split(params, 1, 1000, 1), 10, 1e-4);
    EXPECT_NEAR(glsl::gn_cascades_split(params, 1, 1000, 2), 100, 1e-3);
    EXPECT_NEAR(glsl::gn_cascades_split(params, 0.1F, 1000, 1), 2.154, 5e-4);
    EXPECT_NEAR(glsl::gn_cascades_split(params, 0.1F, 1000, 2), 46.42, 5e-3);
}

TEST(CascadeSplits, UniformEndsAreEvenlySpaced) {
    GnCascadesParams params{.count = 4, .split = GN_SPLIT_UNIFORM};
    for (int i = 0; i <= 4; ++i) {
        EXPECT_NEAR(glsl::gn_cascades_split(params, 2, 10, i), 2 + 2 * i, 1e-5);
    }
}

TEST(CascadeSplits, PracticalRunsFromUniformToLogarithmic) {
    for (int i = 0; i <= 5; ++i) {
        GnCascadesParams practical{.count = 5, .split = GN_SPLIT_PRACTICAL};
        practical.alpha = 0;
        EXPECT_EQ(glsl::gn_cascades_split(practical, 0.5F, 300, i),
                  glsl::gn_cascades_split({.count = 5, .split = GN_SPLIT_UNIFORM}, 0.5F, 300, i));
        practical.alpha = 1;
        EXPECT_EQ(glsl::gn_cascades_split(practical, 0.5F, 300, i),
                  glsl::gn_cascades_split({.count = 5, .split = GN_SPLIT_LOG}, 0.5F, 300, i));
    }
    // Halfway: (10 + 334) / 2.
    GnCascadesParams half{.count = 3, .split = GN_SPLIT_PRACTICAL, .alpha = 0.5F};
    EXPECT_NEAR(glsl::gn_cascades_split(half, 1, 1000, 1), 172, 1e-3);
}

TEST(CascadeSplits, AdaptedNearGivesEverySliceButTheFirstTheSameRatio) {
    GnCascadesParams params{.count = 4, .split = GN_SPLIT_ADAPTED_NEAR};
    const auto end = [&](int i) { return glsl::gn_cascades_split(params, 0.001F, 512, i); };
    EXPECT_EQ(end(0), 0.001F);
    EXPECT_NEAR(end(1), 8, 1e-4);
    EXPECT_NEAR(end(2), 32, 1e-3);
    EXPECT_NEAR(end(3), 128, 1e-2);
    // A near plane given by hand: from 1 to 1000 the ratio is 1000^(1/4).
    params.adapted_near = 1;
    EXPECT_NEAR(glsl::gn_cascades_split(params, 0.001F, 1000, 1), 5.6234, 1e-3);
    // It never lies before the true one: then the scheme is the logarithmic one.
    params.adapted_near = 0.01F;
    EXPECT_EQ(glsl::gn_cascades_split(params, 1, 1000, 2),
              glsl::gn_cascades_split({.count = 4, .split = GN_SPLIT_LOG}, 1, 1000, 2));
}

TEST(CascadeSplits, EndsRiseForEveryScheme) {
    for (int split = 0; split <= GN_SPLIT_SDSM_HISTOGRAM; ++split) {
        for (int count = 1; count <= GN_CASCADES_MOST; ++count) {
            const GnCascadesParams params{.count = count, .split = split};
            float before = 0;
            for (int i = 0; i <= count; ++i) {
                const float end = glsl::gn_cascades_split(params, 0.1F, 10000, i);
                EXPECT_GT(end, before) << "split " << split << " count " << count << " end " << i;
                before = end;
            }
            EXPECT_EQ(before, 10000);
        }
    }
}

// ---- The choice.

GnReceiver receiver_at(float view_depth, vec2 p_ss = vec2(7.5F, 3.5F)) {
    GnReceiver receiver{};
    receiver.view_depth = view_depth;
    receiver.p_ss = p_ss;
    return receiver;
}

/// Three slices, ending at 10, 20 and 40 m.
glsl::GnPlacementData choice_data(int transition, float width) {
    glsl::GnPlacementData data{};
    data.values[0] = vec4(3, transition, GN_SELECT_DISTANCE, width);
    data.values[1] = vec4(10, 20, 40, 0);
    return data;
}

TEST(CascadeChoice, FollowsTheDistance) {
    const auto data = choice_data(GN_TRANSITION_NONE, 0.2F);
    EXPECT_EQ(glsl::gn_cascades_choose(receiver_at(0.1F), data).first, 0);
    EXPECT_EQ(glsl::gn_cascades_choose(receiver_at(10.01F), data).first, 1);
    EXPECT_EQ(glsl::gn_cascades_choose(receiver_at(39.9F), data).first, 2);
    EXPECT_EQ(glsl::gn_cascades_choose(receiver_at(1000), data).first, 2);
    EXPECT_EQ(glsl::gn_cascades_choose(receiver_at(9.99F), data).second, -1);
}

TEST(CascadeChoice, BlendRunsFromZeroToOneInTheBandAndNowhereElse) {
    const auto data = choice_data(GN_TRANSITION_BLEND, 0.2F);
    float before = 0;
    for (float z = 0.05F; z < 60; z += 0.05F) {
        const GnChoice choice = glsl::gn_cascades_choose(receiver_at(z), data);
        const bool in_band = (z > 8 && z <= 10) || (z > 18 && z <= 20);
        EXPECT_GE(choice.weight, 0) << z;
        EXPECT_LE(choice.weight, 1) << z;
        if (in_band && choice.second >= 0) {
            EXPECT_EQ(choice.second, choice.first + 1) << z;
            EXPECT_GE(choice.weight, before - 1e-6F) << z;
            before = choice.weight;
        } else {
            EXPECT_EQ(choice.second, -1) << z;
            before = 0;
        }
    }
    EXPECT_NEAR(glsl::gn_cascades_choose(receiver_at(9), data).weight, 0.5, 1e-5);
    EXPECT_NEAR(glsl::gn_cascades_choose(receiver_at(10), data).weight, 1, 1e-5);
}

TEST(CascadeChoice, DitherTakesTheNextSliceAsOftenAsBlendWeighsIt) {
    const auto data = choice_data(GN_TRANSITION_DITHER, 0.2F);
    for (const float z : {8.5F, 9.0F, 9.5F}) {
        double next = 0;
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                const GnChoice choice = glsl::gn_cascades_choose(
                    receiver_at(z, vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5F), data);
                EXPECT_EQ(choice.second, -1);
                next += choice.first;
            }
        }
        EXPECT_NEAR(next / 4096, (z - 8) / 2, 0.02) << z;
    }
    for (const float z : {5.0F, 7.99F, 12.0F, 17.9F}) {
        EXPECT_EQ(glsl::gn_cascades_choose(receiver_at(z), data).first, z < 10 ? 0 : 1);
    }
}

// ---- Stable windows.

GnLight sun(vec3 direction_ws) {
    GnLight light;
    light.direction_ws = vec4(glm::normalize(direction_ws), 0);
    return light;
}

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
Placed place(const Grid& grid, dvec3 centre_ws, vec3 p_ws) {
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
                const Placed still = place(grid, origin, p_ws);
                ASSERT_TRUE(still.projected.inside);
                for (const double step : {0.13, 0.5, 0.77, 1.0, 3.3}) {
                    const Placed moved = place(grid, origin + step * texel * dvec3(1, 0.3, -0.6), p_ws);
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

TEST(CascadeCulling, KeepsWhatCanCastAndDropsWhatCannot) {
    Scene scene;
    const auto box = [&](vec3 low, vec3 high) { scene.objects.push_back({"box", 0, 0, 0, Box{low, high}}); };
    box(vec3(-1, 0, -1), vec3(1, 1, 1));          // in the view
    box(vec3(-1, 90, -1), vec3(1, 91, 1));        // far above: before the near plane, still casts
    box(vec3(20, 0, 20), vec3(21, 1, 21));        // beside
    box(vec3(-1, -30, -1), vec3(1, -29, 1));      // behind the far plane
    box(vec3(-50, -0.1F, -50), vec3(50, 0, 50));  // larger than the view
    const ConvexBody body = body_of(Box{vec3(-5, 0, -5), vec3(5, 3, 5)});
    const GnLightView view = fit_orthographic(body, sun(vec3(0, -1, 0)), 256, {});
    EXPECT_EQ(casters_of(scene, view), (std::vector<std::uint32_t>{0, 1, 4}));
}

TEST(CascadeData, PackedPositionsAreTheViewsOwn) {
    const GnLight light = sun(vec3(0.4F, -1, 0.3F));
    const Camera camera{.position_ws = vec3(1, 2, 3)};
    std::vector<GnLightView> views;
    for (const double far : {5.0, 20.0}) {
        views.push_back(fit_orthographic(body_of(camera, 1.5F, 0.1, far), light, 512, {}));
        views.push_back(plain_view(body_of(camera, 1.5F, 0.1, far), facing(camera, light), 512, {}));
    }
    const GnCascadesParams params{.count = 4};
    const auto packed = pack(params, {0.1, 20}, facing(camera, light), views, {.texels = 2});
    glsl::GnPlacementData data{};
    std::copy(packed.begin(), packed.end(), data.values);
    for (int i = 0; i < 4; ++i) {
        for (const vec3 p_ws : {vec3(1, 0, 0), vec3(-2, 1, -9), vec3(4, 3, 2)}) {
            const vec4 p_cs = views[static_cast<std::size_t>(i)].cs_from_ws * vec4(p_ws, 1);
            EXPECT_NEAR(glsl::gn_cascades_border(data, i, p_ws), std::max(std::abs(p_cs.x), std::abs(p_cs.y)), 1e-4);
        }
    }
}

// ---- Rendered.

/// A frame built by hand, so that tests can look at the views and the map, and place by another camera than the samples'.
struct Rendered {
    std::vector<float> visibility, map;
    std::vector<GnLightView> views;
    glsl::GnPlacementData data{};
    CpuSamples samples;
};

template <class T>
void copy_bytes(const std::vector<std::byte>& bytes, std::vector<T>& values) {
    values.resize(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
}

Rendered render(SceneGpu& gpu, const Camera& camera, const Camera& placed_by, const std::string& recipe_text,
                History* history = nullptr) {
    const test::ValidationGuard guard;
    const Scene& scene = *gpu.scene;
    const Recipe recipe = load_recipe(recipe_text);
    check_recipe(recipe, scene, scene.lights[0], test::device());
    FrameGraph graph(test::device());
    const SceneHandles handles = import_scene(graph, gpu);
    ViewSamples samples = add_view_samples(graph, gpu, handles, camera, 160, 120);
    samples.camera = placed_by;
    const FrameInput input{test::device(), graph, scene, handles, samples, nullptr, 0, history};
    LightViews views = recipe.placement->place(input, recipe);
    views.part = recipe.placement;
    ShadowMap map = recipe.map->add_map(input, recipe, views);
    map.part = recipe.map;
    const Visibility visibility = add_resolve(input, recipe, views, map);
    for (const TextureHandle texture : {map.texture, visibility.image, samples.position, samples.normal}) {
        graph.keep(texture);
    }
    if (views.buffer.valid()) {
        graph.keep(views.buffer);
        graph.keep(views.data_buffer);
    }
    graph.execute(false);
    if (history != nullptr) {
        history->advance();
    }

    Rendered result{.views = views.views};
    copy_bytes(graph.download(visibility.image), result.visibility);
    for (std::uint32_t layer = 0; layer < views.layers; ++layer) {
        std::vector<float> texels;
        copy_bytes(graph.download(map.texture, 0, layer), texels);
        result.map.insert(result.map.end(), texels.begin(), texels.end());
    }
    std::copy(views.data.begin(), views.data.end(), result.data.values);
    if (views.buffer.valid()) {
        copy_bytes(graph.download(views.buffer), result.views);
        const std::vector<std::byte> data = graph.download(views.data_buffer);
        std::memcpy(&result.data, data.data(), sizeof result.data);
    }
    copy_bytes(graph.download(samples.position), result.samples.position_ws);
    copy_bytes(graph.download(samples.normal), result.samples.normal_ws);
    return result;
}

Camera moved(Camera camera, vec3 by_ws) {
    camera.position_ws += by_ws;
    return camera;
}

std::size_t differing(const std::vector<float>& a, const std::vector<float>& b) {
    EXPECT_EQ(a.size(), b.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        count += std::memcmp(&a[i], &b[i], sizeof(float)) != 0 ? 1U : 0U;
    }
    return count;
}

/// The same points, placed by a camera that stands elsewhere: not a bit of V may change, and without the grid many do.
TEST(CascadesRendered, StableVisibilityIsBitEqualWhileTheCameraMoves) {
    const Scene scene = load_scene("corridor");
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

TEST(CascadesRendered, ScrolledMapEqualsOneDrawnFromNothing) {
    const Scene scene = load_scene("corridor");
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

TEST(CascadesRendered, FarCascadesAreRedrawnAtTheirRateAndStillCoverTheirSlices) {
    const Scene scene = load_scene("corridor");
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

/// Every counted sample lies inside the view that serves it, kernel included, with a depth inside its range.
TEST(CascadesRendered, SampleDistributionViewsHoldEverySample) {
    const Scene scene = load_scene("corridor");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const Camera& camera = scene.camera("");
    for (const char* split : {"sdsm-minmax", "sdsm-histogram", "sdsm-minmax,cascades.select=projection"}) {
        const std::string text = std::string("pcf,resolution=256,placement=cascades,cascades.split=") + split;
        const Rendered frame = render(gpu, camera, camera, text);
        const float limit = 1 - 2 * guard_of(load_recipe(text)).texels / 256 + 1e-4F;
        std::vector<int> served(4, 0);
        for (std::size_t p = 0; p < frame.samples.position_ws.size(); ++p) {
            const vec3 p_ws(frame.samples.position_ws[p]);
            const vec3 n_ws(frame.samples.normal_ws[p]);
            if (frame.samples.position_ws[p].w == 0 || !gn_counted(scene.lights[0].shape, p_ws, n_ws)) {
                continue;
            }
            GnReceiver receiver = receiver_at(frame.samples.normal_ws[p].w);
            receiver.p_ws = p_ws;
            const GnChoice choice = glsl::gn_cascades_choose(receiver, frame.data);
            for (const int view : {choice.first, choice.second}) {
                if (view >= 0) {
                    const GnLightView& chosen = frame.views[static_cast<std::size_t>(view)];
                    const vec4 p_cs = gn_clip(chosen, p_ws);
                    ASSERT_LE(std::max(std::abs(p_cs.x), std::abs(p_cs.y)), limit) << split << " view " << view;
                    const float depth = glm::dot(chosen.depth_from_ws, vec4(p_ws, 1));
                    ASSERT_GT(depth, 0) << split << " view " << view;
                    ASSERT_LT(depth, 1) << split << " view " << view;
                    ++served[static_cast<std::size_t>(view)];
                }
            }
        }
        EXPECT_GT(*std::min_element(served.begin(), served.end()), 0) << split;
    }
}

TEST(CascadesRendered, LayeredPassDrawsTheSameMaps) {
    if (!test::device().has(Feature::layer_from_vertex_shader)) {
        GTEST_SKIP() << "the device writes no layer from the vertex stage";
    }
    const Scene scene = load_scene("corridor");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const Camera& camera = scene.camera("");
    for (const char* split : {"practical", "sdsm-minmax"}) {
        const std::string recipe =
            std::string("hard,resolution=256,placement=cascades,cascades.split=") + split + ",cascades.passes=";
        const Rendered layered = render(gpu, camera, camera, recipe + "layered");
        const Rendered separate = render(gpu, camera, camera, recipe + "separate");
        EXPECT_EQ(differing(layered.map, separate.map), 0U) << split;
    }
}

/// A small roof high above, far outside of what the camera sees, between the sun and the near plane of every tight fit.
TEST(CascadesRendered, CasterBeforeTheNearPlaneStillCasts) {
    Scene scene;
    const auto square = [&](const char* name, float y, float half) {
        const auto base = static_cast<uint>(scene.positions_ws.size());
        const auto first = static_cast<std::uint32_t>(scene.triangles.size());
        for (const vec2 corner : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)}) {
            scene.positions_ws.emplace_back(half * corner.x, y, half * corner.y);
            scene.normals_ws.emplace_back(0, 1, 0);
            scene.uvs.emplace_back(0);
        }
        scene.triangles.emplace_back(base, base + 2, base + 1);
        scene.triangles.emplace_back(base, base + 3, base + 2);
        scene.objects.push_back({name, first, 2, 0, Box{vec3(-half, y, -half), vec3(half, y, half)}});
    };
    scene.materials.emplace_back();
    square("ground", 0, 40);
    square("roof", 90, 1.5F);
    Light light{"sun", {}};
    light.shape.kind = GN_LIGHT_DIRECTIONAL;
    light.shape.direction_ws = vec4(0, -1, 0, 0);
    scene.lights = {light};
    scene.cameras = {Camera{.position_ws = vec3(0, 2, 8), .forward_ws = glm::normalize(vec3(0, -2, -8)), .far = 60}};
    finish_scene(scene);
    for (const char* fit : {"fit=plain", "fit=fitted", "fit=stable", "split=sdsm-minmax"}) {
        const auto c = test::compare(scene, std::string("hard,placement=cascades,cascades.") + fit);
        EXPECT_LT(*c.errors.leak, 0.03) << fit;
        EXPECT_LT(*c.errors.mismatch, 0.004) << fit;
        EXPECT_GT(std::count(c.truth.visibility.begin(), c.truth.visibility.end(), 0.0F), 500) << fit;
    }
}

Scene with_hard_sun(const char* name) {
    Scene scene = load_scene(name);
    scene.lights[0].shape.angular_radius = 0;
    return scene;
}

/// With the default bias, lit samples that are not beside a shadow's edge are lit.
TEST(CascadesRendered, DefaultBiasLeavesNoAcne) {
    for (const char* name : {"corridor", "courtyard"}) {
        for (const char* recipe : {"pcf,resolution=2048,placement=cascades",
                                   "pcf,resolution=2048,placement=cascades,cascades.split=sdsm-minmax"}) {
            const auto c = test::compare(with_hard_sun(name), recipe);
            const std::size_t w = c.frame.samples.width;
            dvec2 acne(0);
            for (std::size_t y = 4; y + 4 < c.frame.samples.height; ++y) {
                for (std::size_t x = 4; x + 4 < w; ++x) {
                    bool lit = true;
                    for (std::size_t i = 0; i < 81 && lit; ++i) {
                        const std::size_t p = (y - 4 + i / 9) * w + x - 4 + i % 9;
                        lit = c.truth.counted[p] != 0 && c.truth.visibility[p] == 1;
                    }
                    acne += lit ? dvec2(1 - static_cast<double>(c.visibility().values[y * w + x]), 1) : dvec2(0);
                }
            }
            ASSERT_GT(acne.y, 500) << name;
            EXPECT_LE(acne.x / acne.y, 1e-3) << name << " " << recipe << " of " << acne.y;
        }
    }
}

/// The mean error in a band of 3 pixels around a change of cascade is no higher than elsewhere, by more than a fifth.
TEST(CascadesRendered, NoSeamWhereCascadesMeet) {
    for (const char* transition : {"blend", "dither"}) {
        const std::string recipe =
            std::string("pcf,placement=cascades,cascades.distance=60,cascades.transition=") + transition;
        const auto c = test::compare(with_hard_sun("courtyard"), recipe);
        const auto params = load_recipe(recipe).of<GnCascadesParams>("cascades");
        glsl::GnPlacementData data = choice_data(GN_TRANSITION_NONE, 0);
        data.values[0].x = static_cast<float>(params.count);
        const Camera& camera = c.scene.camera("");
        for (int i = 0; i < params.count; ++i) {
            data.values[1 + static_cast<unsigned>(i) / 4][i % 4] =
                glsl::gn_cascades_split(params, camera.near, 30, i + 1);
        }
        const auto cascade = [&](std::size_t pixel) {
            return glsl::gn_cascades_choose(receiver_at(c.frame.samples.normal_ws[pixel].w), data).first;
        };
        dvec2 band(0);
        dvec2 rest(0);
        const std::size_t w = c.frame.samples.width;
        for (std::size_t y = 3; y + 3 < c.frame.samples.height; ++y) {
            for (std::size_t x = 3; x + 3 < w; ++x) {
                const std::size_t p = y * w + x;
                if (c.truth.counted[p] == 0) {
                    continue;
                }
                const bool near_split = cascade(p - 3 * w) != cascade(p + 3 * w) || cascade(p - 3) != cascade(p + 3);
                const double error = std::abs(static_cast<double>(c.visibility().values[p]) -
                                              static_cast<double>(c.truth.visibility[p]));
                (near_split ? band : rest) += dvec2(error, 1);
            }
        }
        ASSERT_GT(band.y, 200) << transition;
        EXPECT_LE(band.x / band.y, 1.2 * rest.x / rest.y) << transition;
    }
}

/// At the size that pictures are compared at; a coarser picture blurs the finer maps' lead.
TEST(CascadesRendered, SampleDistributionHalvesTheErrorOfPracticalSplits) {
    const test::ComparisonOptions options{.width = 640, .height = 360, .samples = 1};
    const auto practical = test::compare("corridor", "pcf,placement=cascades", options);
    for (const char* split : {"sdsm-minmax", "sdsm-histogram"}) {
        const auto sdsm =
            test::compare("corridor", std::string("pcf,placement=cascades,cascades.split=") + split, options);
        EXPECT_LE(*sdsm.errors.rmse, 0.5 * *practical.errors.rmse) << split;
    }
}

TEST(CascadesRendered, RefusesToKeepWhatIsNotStable) {
    const Scene scene = load_scene("contact");
    for (const char* text : {"cascades,cascades.scroll=1,cascades.fit=fitted", "sdsm,cascades.rate=4",
                             "cascades,cascades.scroll=1,resolution=1000"}) {
        Light light = scene.lights[0];
        light.shape.kind = GN_LIGHT_DIRECTIONAL;
        EXPECT_THROW(check_recipe(load_recipe(text), scene, light, test::device()), Refusal) << text;
    }
}

}  // namespace
}  // namespace gn
