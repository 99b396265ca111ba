// SPDX-License-Identifier: MIT
// On which side of the samples volumes are counted: where z-pass is z-fail, where it is wrong and by how much, and zp+.
#include "shadow/geometry/swept_boxes.h"
#include "shadow/geometry/volume_passes.h"
#include "shadow/geometry/volumes.glsl"
#include "shadow/show/show.h"
#include "tests/direct_scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace gn {
namespace parts {
const Part& direct_volumes();
}
namespace volumes_modes_test {
namespace {

using namespace by_hand;

std::vector<std::vector<float>> visibility(const Scene& scene, const char* mode, uint width, uint height) {
    Device& gpu = device();
    SceneGpu uploaded = upload_scene(gpu, scene);
    const FrameResult frame = render_frame(gpu, uploaded, scene.cameras.front(),
                                           direct_recipe(parts::direct_volumes(), {{"mode", mode}, {"covered", "0"}}),
                                           {.width = width, .height = height, .picture = false});
    std::vector<std::vector<float>> images;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        EXPECT_EQ(frame.refused[i], "");
        images.push_back(frame.visibility[i].values);
    }
    return images;
}

// Boxes, a ring, a sheet and loose triangles, under a light of each kind, seen from the light.
Scene bright_yard() {
    SceneBuilder b;
    b.ground(10).box({-1, 0, -1}, {1, 1.5F, 1}).torus({0.3F, 2.6F, 0.2F}, 1.1F, 0.4F, 12);
    b.quad({-2.5F, 1, -1}, {-1.5F, 1.3F, -1}, {-1.5F, 1.3F, 1}, {-2.5F, 1, 1});
    b.soup({{-3, 0.2F, -3}, {1, 2, 0}}, 0.7F, 30, 3).camera({3, 4.6F, 4.2F}, {0.2F, 0.4F, 0});
    b.light(sun({-0.4F, -1, 0.33F})).light(point({2.3F, 3.8F, 3.7F})).light(spot({3, 6, 4}, {0, 0.3F, 0}, 0.6F));
    return b.light(rectangle({2.5F, 5, 4.2F}, {0, 0, 0})).scene();
}

TEST(VolumeModes, where_no_volume_holds_the_near_rectangle_z_pass_is_z_fail) {
    const Scene scene = bright_yard();
    const auto fail = visibility(scene, "z-fail", 160, 120);
    EXPECT_EQ(visibility(scene, "z-pass", 160, 120), fail);
    EXPECT_EQ(visibility(scene, "auto", 160, 120), fail);
    for (const std::vector<float>& light : fail) {
        EXPECT_GT(std::count(light.begin(), light.end(), 0.0F), 500);
        EXPECT_GT(std::count(light.begin(), light.end(), 1.0F), 500);
    }
}

// Sheets over the camera, each one metre shorter than the one below: steps of shadow on the ground ahead.
Scene stairs(int above_all, int above_some) {
    SceneBuilder b;
    b.ground(12).camera({0, 0.5F, 0}, {6, 0, 0.3F});
    for (int i = 0; i < above_all + above_some; ++i) {
        const float y = 1.5F + 0.003F * static_cast<float>(i),
                    end = i < above_all ? 9.0F : 2.0F + static_cast<float>(i - above_all);
        b.quad({i < above_all ? -1 : 1.2F, y, 9}, {end, y, 9}, {end, y, -9}, {i < above_all ? -1 : 1.2F, y, -9});
    }
    return b.light(sun({0, -1, 0})).scene();
}

TEST(VolumeModes, in_k_volumes_z_pass_counts_k_too_few) {
    // Samples in as many volumes as the camera look lit, and those in none dark.
    const Scene scene = stairs(2, 3);
    const auto fail = visibility(scene, "z-fail", 160, 96), pass = visibility(scene, "z-pass", 160, 96);
    SceneGpu uploaded = upload_scene(device(), scene);
    const FrameResult frame =
        render_frame(device(), uploaded, scene.cameras.front(), direct_recipe(parts::direct_volumes()),
                     {.width = 160, .height = 96, .picture = false});
    std::size_t in_two = 0, in_none = 0, in_more = 0;
    for (std::size_t i = 0; i < pass[0].size(); ++i) {
        const vec4 p = frame.samples.position_ws[i];
        if (p.w == 0.0F || std::abs(p.y) > 1e-3F || std::abs(p.x - std::round(p.x)) < 0.02F ||
            std::abs(p.x - 1.2F) < 0.02F) {
            continue;
        }
        int held = p.x > -1.0F && p.x < 9.0F && std::abs(p.z) < 9.0F ? 2 : 0;
        for (int i_step = 0; i_step < 3; ++i_step) {
            held += p.x > 1.2F && p.x < 2.0F + static_cast<float>(i_step) && std::abs(p.z) < 9.0F ? 1 : 0;
        }
        (held == 2 ? in_two : held == 0 ? in_none : in_more) += 1;
        EXPECT_EQ(fail[0][i], held == 0 ? 1.0F : 0.0F) << p.x << ", " << p.z;
        EXPECT_EQ(pass[0][i], held == 2 ? 1.0F : 0.0F) << p.x << ", " << p.z;
    }
    EXPECT_GT(in_two, 100U);
    EXPECT_GT(in_none, 100U);
    EXPECT_GT(in_more, 100U);
}

TEST(VolumeModes, zp_plus_is_z_fail_in_none_one_and_hundreds_of_volumes) {
    for (const int volumes : {0, 1, 300}) {
        const Scene scene = stairs(volumes, 3);
        EXPECT_EQ(visibility(scene, "zp+", 160, 96), visibility(scene, "z-fail", 160, 96)) << volumes;
    }
}

TEST(VolumeModes, zp_plus_is_z_fail_across_sides_and_under_lights_on_both_sides_of_the_near_plane) {
    // The near rectangle, half a metre wide, is cut by sheets, boxes and their shadows; one light is before the camera.
    SceneBuilder b;
    b.ground(10).box({-1, 0.5F, -1}, {1, 1.5F, 1}).quad({-2, 1, 1.8F}, {2, 1, 1.8F}, {2, 1.1F, 3.2F}, {-2, 1.1F, 3.2F});
    b.soup({{-1, 0.7F, 1}, {1, 2.4F, 4}}, 0.5F, 60, 4).camera({0.3F, 1.12F, 2.6F}, {0.1F, 0.3F, -1}, 0.4F);
    b.light(sun({-0.4F, -1, 0.33F})).light(point({0.4F, 3.1F, 3.7F})).light(point({0.2F, 2.1F, -0.7F}));
    const Scene scene = b.light(sun({0.1F, -0.5F, 1})).scene();
    EXPECT_EQ(visibility(scene, "zp+", 160, 120), visibility(scene, "z-fail", 160, 120));
    EXPECT_NE(visibility(scene, "z-pass", 160, 120), visibility(scene, "z-fail", 160, 120));
}

// The values behind `--show`, of the first light.
std::vector<float> shown(const Scene& scene, const Recipe& recipe, const char* name, uint width, uint height) {
    SceneGpu uploaded = upload_scene(device(), scene);
    const std::string asked = name;
    const Image values =
        show_hidden(device(), uploaded, scene.cameras.front(), recipe, {&asked, 1}, {.width = width, .height = height})
            .front()
            .values;
    std::vector<float> first;
    for (std::size_t i = 0; i < values.values.size(); i += static_cast<std::size_t>(values.channels)) {
        first.push_back(values.values[i]);
    }
    return first;
}

TEST(VolumeModes, the_count_that_is_shown_is_that_of_volumes) {
    // In two volumes z-pass counts two too few, at every sample.
    const Scene scene = stairs(2, 3);
    const auto recipe = [](const char* mode) {
        return direct_recipe(parts::direct_volumes(), {{"mode", mode}, {"covered", "0"}});
    };
    const auto fail = shown(scene, recipe("z-fail"), "volume-count", 160, 96);
    const auto pass = shown(scene, recipe("z-pass"), "volume-count", 160, 96);
    const auto images = visibility(scene, "z-fail", 160, 96);
    for (std::size_t i = 0; i < fail.size(); ++i) {
        if (images[0][i] == 1.0F || fail[i] > 0.0F) {
            EXPECT_EQ(fail[i] - pass[i], 2.0F) << i;
            EXPECT_EQ(images[0][i], fail[i] == 0.0F ? 1.0F : 0.0F) << i;
        }
    }
    EXPECT_EQ(*std::max_element(fail.begin(), fail.end()), 5.0F);
    // Edges of silhouettes are where sides begin.
    const auto edges = shown(scene, recipe("auto"), "volume-silhouettes", 160, 96);
    EXPECT_GT(std::count(edges.begin(), edges.end(), 0.0F), 1000);
    EXPECT_GT(edges.size() - static_cast<std::size_t>(std::count(edges.begin(), edges.end(), 0.0F)), 50U);
}

TEST(VolumeClamp, changes_no_sample_and_takes_most_fragments_away) {
    for (const char* name : {"fence", "stack", "contact:light=point", "grid:objects=25"}) {
        Scene scene = make_builtin_scene(name);
        for (Light& light : scene.lights) {
            light.shape.radius = light.shape.angular_radius = 0.0F;
        }
        std::array<double, 2> fragments{};
        std::array<std::vector<float>, 2> v;
        for (const std::size_t clamp : {0U, 1U}) {
            const Recipe recipe = direct_recipe(parts::direct_volumes(), {{"clamp", clamp == 1 ? "1" : "0"}});
            for (const float count : shown(scene, recipe, "volume-fragments", 160, 120)) {
                fragments[clamp] += static_cast<double>(count);
            }
            SceneGpu uploaded = upload_scene(device(), scene);
            const FrameResult frame = render_frame(device(), uploaded, scene.cameras.front(), recipe,
                                                   {.width = 160, .height = 120, .picture = false});
            v[clamp] = frame.visibility[0].values;
            EXPECT_EQ(judge(scene, frame, 0).wrong, 0U) << name << ", clamp " << clamp;
        }
        EXPECT_EQ(v[0], v[1]) << name;
        EXPECT_LT(fragments[1], 0.8 * fragments[0]) << name;
    }
}

TEST(VolumeClamp, ends_volumes_on_the_nearest_plane_that_all_rays_run_towards) {
    const Box region{vec3(-10, 0, -10), vec3(10, 5, 10)}, caster{vec3(-1, 1, -1), vec3(1, 2, 1)};
    EXPECT_EQ(volume_end(caster, vec4(0, 1, 0, 0), region), 3U);                                 // the ground
    EXPECT_EQ(volume_end(caster, vec4(0.999F, 0.04F, 0, 0), region), 1U);                        // along it, the wall
    EXPECT_EQ(volume_end(caster, vec4(0, 4, 0, 1), region), 3U);                                 // below the lamp
    EXPECT_EQ(volume_end(caster, vec4(-4, 1.5F, 0, 1), region), 2U);                             // beside it
    EXPECT_EQ(volume_end(caster, vec4(0.5F, 1.5F, 0.5F, 1), region), 0U);                        // within the caster
    EXPECT_EQ(volume_end(Box{vec3(-1, -9, -1), vec3(1, -8, 1)}, vec4(0, 1, 0, 0), region), 3U);  // beyond the ground
}

TEST(VolumeModes, what_shades_the_near_rectangle_is_always_told) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    const auto any = [&] { return vec3(unit(random), unit(random), unit(random)); };
    int shading = 0, apart = 0;
    for (int round = 0; round < 3000; ++round) {
        const Camera camera{.position_ws = any(),
                            .forward_ws = glm::normalize(any()),
                            .up_ws = vec3(0, 1, 0),
                            .near = 0.1F + 0.2F * std::abs(unit(random))};
        const mat4 cs_from_ws = cs_from_vs(camera, 1.5F) * vs_from_ws(camera);
        const vec4 light_ws = round % 2 == 0 ? vec4(glm::normalize(any()), 0) : vec4(3.0F * any(), 1);
        const vec3 centre = 1.5F * any(), half = vec3(0.02F) + 0.6F * glm::abs(any());
        const Box box{centre - half, centre + half};
        GnLight light = round % 2 == 0 ? sun(-vec3(light_ws)) : point(vec3(light_ws));
        const bool told = SweptBoxes(light, &cs_from_ws).may_shade_near_plane(box);
        // Follow segments from the near rectangle to the light through the box.
        bool hit = false;
        const glm::dmat4 ws_from_cs = glm::inverse(glm::dmat4(cs_from_ws));
        for (int i = 0; i < 121 && !hit; ++i) {
            const dvec4 near = ws_from_cs * dvec4(-1 + 0.2 * (i % 11), -1 + 0.2 * (i / 11), 1, 1);
            const dvec3 from = dvec3(near) / near.w, way = dvec3(light_ws) - from * static_cast<double>(light_ws.w);
            const dvec3 a = (dvec3(box.min) - from) / way, b = (dvec3(box.max) - from) / way;
            const dvec3 low = glm::min(a, b), high = glm::max(a, b);
            const double enter = std::max({low.x, low.y, low.z, 0.0}), leave = std::min({high.x, high.y, high.z});
            hit = enter <= leave && (light_ws.w == 0.0F || enter <= 1.0);
        }
        EXPECT_TRUE(told || !hit) << round;
        shading += hit ? 1 : 0;
        apart += told ? 0 : 1;
    }
    EXPECT_GT(shading, 150);
    EXPECT_GT(apart, (3000 - shading) * 9 / 10) << "boxes off the segments are known to be";
}

}  // namespace
}  // namespace volumes_modes_test
}  // namespace gn
