// SPDX-License-Identifier: MIT
// A camera whose rays run side by side, through every stage: what it sees, and V of recipes against the truth.
#include "base/paths.h"
#include "tests/rescaled.h"

#include <filesystem>

namespace gn::orthographic_test {
namespace {

constexpr uint size = 96;

/// The same look, but by parallel rays that show as much as a perspective picture does at `distance` metres.
Scene seen_in_parallel(Scene scene, double distance) {
    scene.cameras.resize(1);
    scene.paths.clear();
    Camera& camera = scene.cameras[0];
    camera.half_height = static_cast<float>(half_height_at(camera, distance));
    camera.near = camera.far = 0;
    finish_scene(scene);
    return scene;
}

/// Seen from straight above, where that much of the ground lies in the picture.
Scene from_above(Scene scene, float half_height) {
    scene.cameras = {{.position_ws = vec3(0, 8, 0),
                      .forward_ws = vec3(0, -1, 0),
                      .up_ws = vec3(0, 0, -1),
                      .half_height = half_height,
                      .near = 0,
                      .far = 0}};
    scene.paths.clear();
    finish_scene(scene);
    return scene;
}

TEST(Orthographic, SamplesLieOnParallelRays) {
    const test::ValidationGuard guard;
    const Scene scene = seen_in_parallel(load_scene("contact"), 4);
    const Camera& camera = scene.cameras[0];
    SceneGpu gpu = upload_scene(test::device(), scene);
    const CpuSamples samples = render_samples(test::device(), gpu, camera, size, size);
    const vec3 right = glm::normalize(glm::cross(camera.forward_ws, camera.up_ws));
    const vec3 up = glm::cross(right, camera.forward_ws);
    std::size_t seen = 0;
    for (uint y = 0; y < size; ++y) {
        for (uint x = 0; x < size; ++x) {
            const vec4 p_ws = samples.position_ws[y * size + x];
            if (p_ws.w < 0.5F) {
                continue;
            }
            ++seen;
            // A hundredth of a pixel's width of some 4 cm: the rasterizer's grid has 256 steps in a pixel.
            const vec3 off = vec3(p_ws) - camera.position_ws;
            const float pixel = 2 * camera.half_height / size;
            ASSERT_NEAR(glm::dot(off, right), (static_cast<float>(x) + 0.5F - size / 2) * pixel, 0.02F * pixel);
            ASSERT_NEAR(glm::dot(off, up), (size / 2 - static_cast<float>(y) - 0.5F) * pixel, 0.02F * pixel);
            ASSERT_NEAR(samples.normal_ws[y * size + x].w, glm::dot(off, camera.forward_ws), 1e-5F);
            ASSERT_GT(glm::dot(vec3(samples.normal_ws[y * size + x]), -camera.forward_ws), 0.0F);
        }
    }
    EXPECT_GT(seen, size * size / 2);
}

/// What an error is under a perspective camera that shows about as much, and what it may be: a picture of 96 pixels has some
/// 300 at edges, so that a few more or fewer of them change the figure by a fifth.
void expect_as_usual(const Scene& perspective, const Scene& parallel, const std::string& recipe) {
    const test::ComparisonOptions small{.width = size, .height = size, .samples = 64};
    const double usual = *test::compare(perspective, recipe, small).errors.rmse;
    const double found = *test::compare(parallel, recipe, small).errors.rmse;
    EXPECT_LT(found, 1.2 * usual + 0.005) << recipe << ": in perspective " << usual;
}

TEST(OrthographicRendered, RecipesErrAsInPerspective) {
    const Scene sun = load_scene("contact:radius=1");
    for (const char* recipe :
         {"hard", "pcf", "pcf,pcf.footprint=pixel", "pcf-bilateral", "cascades",
          "cascades,cascades.fit=fitted,cascades.select=projection", "sdsm", "sdsm,cascades.split=sdsm-histogram"}) {
        expect_as_usual(sun, seen_in_parallel(sun, 4), recipe);
    }
    const Scene lamp = load_scene("contact:light=point,radius=1");
    expect_as_usual(lamp, seen_in_parallel(lamp, 4), "pcf,cube.resolution=coverage");
}

/// Where pixels do not grow with the distance no warp has anything to answer.
TEST(OrthographicRendered, WarpedMapsAreTheFittedOne) {
    const Scene scene = seen_in_parallel(load_scene("contact"), 4);
    const auto fitted = test::visibility_of(scene, "hard,placement=fit,resolution=256", size);
    for (const char* placement : {"lispsm", "tsm", "psm", "logpsm"}) {
        EXPECT_EQ(test::visibility_of(scene, fmt::format("hard,placement={},resolution=256", placement), size), fitted)
            << placement;
    }
}

/// Volumes are exact but where a pixel's centre lies within the rasterizer's grid of an edge, if nothing is blurred.
TEST(OrthographicRendered, VolumesAreTheTruth) {
    std::vector<Scene> scenes;
    for (const char* kind : {"directional", "point", "spot"}) {
        scenes.push_back(seen_in_parallel(load_scene(std::string("contact:light=") + kind), 4));
    }
    // The camera looks along the light: sides of volumes are seen edge-on, their ends alone tell what lies within.
    Scene sun = load_scene("contact");
    sun.lights[0].shape.direction_ws = vec4(0, -1, 0, 0);
    scenes.push_back(from_above(sun, 2));
    sun.lights[0].shape.direction_ws = vec4(glm::normalize(vec3(1e-4F, -1, 3e-5F)), 0);
    scenes.push_back(from_above(sun, 2));
    Scene lamp = load_scene("contact:light=point");
    lamp.lights[0].shape.position_ws = vec4(0, 3, 0, 1);
    scenes.push_back(from_above(lamp, 3));
    for (const Scene& scene : scenes) {
        for (const char* recipe : {"volumes", "volumes,volumes.mode=z-fail"}) {
            const auto c = test::compare(scene, recipe, {.width = size, .height = size, .samples = 1});
            EXPECT_LE(test::count_differing(c.visibility().values, c.truth.visibility, 0.5F), 2U) << recipe;
        }
    }
}

TEST(OrthographicRendered, TheCaseIsItsTruth) {
    const auto file = data_root() / "../shared/cases/orthographic_camera/scene.glb";
    if (!std::filesystem::exists(file)) {
        GTEST_SKIP() << "skipped: the folder of cases is not here";
    }
    const Scene scene = load_scene(file.string());
    EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
    EXPECT_EQ(scene.camera("").name, "main");
    EXPECT_EQ(scene.camera("").half_height, 2.0F);
    const auto c = test::compare(scene, "volumes", {.width = 144, .height = 96, .samples = 1});
    EXPECT_LE(test::count_differing(c.visibility().values, c.truth.visibility, 0.5F), 2U);
    // The post of 1.2 m stands upright in the picture of 4 m: a post in parallel rays is as high as its height foreshortened.
    const double slant = std::sqrt(1 - std::pow(static_cast<double>(scene.camera("").forward_ws.y), 2));
    std::array<int, 2> rows{96, 0};
    for (int y = 0; y < 96; ++y) {
        for (int x = 0; x < 144; ++x) {
            const auto i = static_cast<std::size_t>(y * 144 + x);
            if (c.frame.samples.position_ws[i].y > 0.01F && std::abs(c.frame.samples.normal_ws[i].z - 1) < 0.01F) {
                rows = {std::min(rows[0], y), std::max(rows[1], y + 1)};
            }
        }
    }
    EXPECT_NEAR(rows[1] - rows[0], 1.2 * slant / 4 * 96, 1.0);
}

}  // namespace
}  // namespace gn::orthographic_test
