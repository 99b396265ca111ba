// SPDX-License-Identifier: MIT
// Pictures of the hidden against what is known of the views: texels by arithmetic, splits by their formula.
#include "shadow/show/show.h"

#include "shadow/placement/cascades/cascades.glsl"
#include "shadow/placement/light_views.h"
#include "shadow/show/show.glsl"
#include "tests/rig.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace gn::show_test {
namespace {

using test::device;

std::vector<Shown> show(const Scene& scene, const std::string& recipe, const std::vector<std::string>& names,
                        uint width = 160, uint height = 90) {
    const test::ValidationGuard guard;
    SceneGpu gpu = upload_scene(device(), scene);
    return show_hidden(device(), gpu, scene.camera(""), load_recipe(recipe), names, {.width = width, .height = height});
}

/// A sun straight down on a level floor that a camera looks down on from `height` metres.
Scene floor_below(float height) {
    Scene scene;
    scene.name = "floor";
    scene.positions_ws = {vec3(-20, 0, 20), vec3(20, 0, 20), vec3(20, 0, -20), vec3(-20, 0, -20)};
    scene.normals_ws.assign(4, vec3(0, 1, 0));
    scene.uvs.assign(4, vec2(0));
    scene.triangles = {uvec3(0, 1, 2), uvec3(0, 2, 3)};
    scene.materials.emplace_back();
    scene.objects.push_back({"floor", 0, 2, 0, {}});
    Light sun{"sun", {}};
    sun.shape.kind = GN_LIGHT_DIRECTIONAL;
    sun.shape.direction_ws = vec4(0, -1, 0, 0);
    sun.shape.color = vec4(1);
    scene.lights.push_back(sun);
    Camera camera;
    camera.position_ws = vec3(0, height, 0);
    camera.forward_ws = vec3(0, -1, 0);
    camera.up_ws = vec3(0, 0, -1);
    camera.yfov = 1;
    scene.cameras.push_back(camera);
    finish_scene(scene);
    return scene;
}

TEST(Show, ListsItsNamesWhereOneIsUnknown) {
    EXPECT_EQ(find_hidden("texels").name, "texels");
    try {
        find_hidden("texel");
        FAIL() << "an unknown name must be refused";
    } catch (const Error& error) {
        for (const HiddenPicture& picture : hidden_pictures()) {
            EXPECT_NE(std::string(error.what()).find(picture.name), std::string::npos) << error.what();
        }
    }
}

TEST(Show, RefusesRecipesWithoutAMap) {
    const Scene scene = floor_below(5);
    for (const char* recipe : {"volumes", "none"}) {
        EXPECT_THROW(show(scene, recipe, {"view"}), Refusal) << recipe;
    }
}

TEST(Show, KernelRegionsAreTheKernelsTexelsAcrossTheRays) {
    // Over a level floor under a vertical sun a map of 256 texels covers the same square everywhere.
    const test::ValidationGuard guard;
    const Scene scene = floor_below(5);
    SceneGpu gpu = upload_scene(device(), scene);
    const auto regions = [&](const std::string& recipe) {
        return kernel_regions(device(), gpu, scene.camera(""), load_recipe(recipe), {.width = 32, .height = 18});
    };
    const auto hard = regions("hard,placement=single,resolution=256").at(300);
    const float texel = glm::length(hard.a_ws) / 1.5F;
    EXPECT_NEAR(texel, 40.0F / 256, 0.1F * 40.0F / 256);
    EXPECT_NEAR(glm::length(hard.b_ws), 1.5F * texel, 1e-4F * texel);
    EXPECT_NEAR(glm::dot(hard.a_ws, hard.b_ws), 0, 1e-6F);
    EXPECT_NEAR(hard.a_ws.y, 0, 1e-6F);
    // A disc of 6 texels reaches 6 further, one of 2 m two metres; the wider map for its guard is taken from its texels.
    const auto disc = regions("pcf,pcf.kernel=vogel,pcf.radius=6,placement=single,resolution=256").at(300);
    EXPECT_NEAR(glm::length(disc.a_ws) / glm::length(hard.a_ws), 7.5F / 1.5F, 0.5F);
    const auto metres = regions("pcf,pcf.kernel=vogel,pcf.radius_world=2,placement=single,resolution=256").at(300);
    EXPECT_NEAR(glm::length(metres.a_ws), 2 + 1.5F * texel, 0.1F);
    // A filtered fetch adds twice its pixel: 5 m above, 18 rows over one radian.
    const auto pixel = regions("vsm,placement=single,resolution=256").at(300);
    EXPECT_GT(glm::length(pixel.b_ws), 2 * 10 * std::tan(0.5F) / 18);
    // Nothing to say without a map, or with a filter on the screen.
    EXPECT_TRUE(regions("volumes").empty());
    EXPECT_TRUE(regions("pcf-bilateral").empty());
}

TEST(Show, KernelRegionsStepByTexels) {
    // A tilted receiver under a spot: each axis changes its own coordinate by the region's half side, and stays across.
    GnLight spot;
    spot.kind = GN_LIGHT_SPOT;
    spot.position_ws = vec4(1, 6, 2, 1);
    spot.direction_ws = vec4(glm::normalize(vec3(-0.2F, -1, 0.1F)), 0);
    const GnLightView view =
        square_perspective(vec3(spot.position_ws), vec3(spot.direction_ws), vec3(1, 0, 0), 0.7F, 0.1F, 20, 512);
    glsl::GnReceiver receiver{};
    receiver.p_ws = vec3(0.5F, 0.2F, 1.5F);
    receiver.n_ws = glm::normalize(vec3(0.6F, 1, -0.3F));
    receiver.ddx_ws = vec3(0.02F, -0.012F, 0);
    GnBias bias{};
    bias.reach = 2;
    const glsl::GnProjected projected = glsl::gn_project(receiver, view, bias);
    ASSERT_TRUE(projected.inside);
    for (const float pixels : {0.0F, 2.0F}) {
        vec3 a_ws, b_ws;
        glsl::gn_kernel_region(receiver, view, projected, bias, pixels, a_ws, b_ws);
        const vec3 ray_ws = glsl::gn_to_eye(view, receiver.p_ws);
        const float u_ts = 3.5F / 512 + pixels * std::abs(glm::dot(projected.du_ws, receiver.ddx_ws));
        const float v_ts = 3.5F / 512 + pixels * std::abs(glm::dot(projected.dv_ws, receiver.ddx_ws));
        EXPECT_NEAR(glm::dot(projected.du_ws, a_ws), u_ts, 1e-6F);
        EXPECT_NEAR(glm::dot(projected.dv_ws, b_ws), v_ts, 1e-6F);
        for (const float zero : {glm::dot(projected.dv_ws, a_ws), glm::dot(projected.du_ws, b_ws),
                                 glm::dot(ray_ws, a_ws), glm::dot(ray_ws, b_ws)}) {
            EXPECT_NEAR(zero, 0, 1e-6F);
        }
    }
}

TEST(Show, TexelsOfASingleMapOverAPlaneAreItsShareOfAPixel) {
    // Seen from h metres straight above, a pixel covers 2 h tan(fov / 2) / rows metres of the floor.
    constexpr float height = 5;
    constexpr uint rows = 90;
    const Scene scene = floor_below(height);
    const double pixel_ws = 2 * height * std::tan(0.5) / rows;
    for (const int resolution : {256, 1024}) {
        const Shown texels =
            show(scene, fmt::format("pcf,placement=single,resolution={}", resolution), {"texels"}, 160, rows).front();
        // The single map covers the scene: a square floor of 40 m, and the kernel's reach.
        const double expected = pixel_ws * resolution / 40;
        const double found = texels.values.at(80, 45, 0);
        EXPECT_EQ(texels.values.at(80, 45, 1), 1.0F);
        EXPECT_NEAR(found / expected, 1, 0.04) << resolution;
        // Straight above a plane every pixel covers the same square of it.
        EXPECT_NEAR(texels.values.at(10, 10, 0) / found, 1, 1e-3);
    }
}

TEST(Show, PixelsOverAFarPlaneAreEqualHoweverNearTheNearPlane) {
    // Straight above a plane every pixel covers the same square of it. Rays by points near the eye, known to the rounding of
    // its coordinates, would be off by 2e-4 of the distance here, 6 mm in a pixel of 36 cm; differences of positions of 30 m
    // know a pixel to 2e-6 / 0.36 of itself.
    Scene scene = floor_below(30);
    scene.cameras[0].near = 0.005F;
    const Shown texels = show(scene, "pcf,placement=single,resolution=256", {"texels"}, 96, 90).front();
    const double found = texels.values.at(48, 45, 0);
    for (const int x : {2, 20, 40, 60, 93}) {
        for (const int y : {3, 30, 50, 88}) {
            EXPECT_NEAR(texels.values.at(x, y, 0) / found, 1, 3e-5) << x << ", " << y;
        }
    }
}

TEST(Show, AnOrthographicCamerasPixelsAreEqualAtEveryDistance) {
    // 6 m from top to bottom over 90 rows; the worse direction is that across the slant.
    for (const bool slanted : {false, true}) {
        Scene scene = floor_below(5);
        Camera& camera = scene.cameras[0];
        camera.half_height = 3;
        camera.forward_ws = slanted ? vec3(0, -std::sqrt(0.5F), -std::sqrt(0.5F)) : camera.forward_ws;
        camera.position_ws.z = slanted ? 5.0F : 0.0F;
        const Shown texels = show(scene, "pcf,placement=single,resolution=256", {"texels"}, 90, 90).front();
        const double expected = 6.0 / 90 * 256 / 40;
        const double found = texels.values.at(45, 45, 0);
        EXPECT_NEAR(found / expected, 1, 0.04) << "the map covers the floor and the kernel's reach";
        for (const int y : {3, 30, 50, 88}) {
            EXPECT_NEAR(texels.values.at(20, y, 0) / found, 1, 1e-4) << y;
        }
    }
}

TEST(Show, TexelsAreThoseOfTheWorseDirection) {
    // By hand: a pixel of 0.1 m by 0.3 m under a map with a texel every 0.05 m and every 0.2 m.
    glsl::GnReceiver receiver{};
    receiver.ddx_ws = vec3(0.1F, 0, 0);
    receiver.ddy_ws = vec3(0, 0, 0.3F);
    glsl::GnProjected projected{};
    projected.texel_ts = 1.0F / 1024;
    projected.du_ws = vec3(projected.texel_ts / 0.05F, 0, 0);
    projected.dv_ws = vec3(0, 0, projected.texel_ts / 0.2F);
    EXPECT_NEAR(glsl::gn_texels_per_pixel(receiver, projected), 1.5, 1e-5);

    // A square map turned by 45 degrees: the pixel's sides are 2 and 6 texels whichever way the texels lie.
    const float s = std::sqrt(0.5F) / 0.05F * projected.texel_ts;
    projected.du_ws = vec3(s, 0, s);
    projected.dv_ws = vec3(-s, 0, s);
    EXPECT_NEAR(glsl::gn_texels_per_pixel(receiver, projected), 2.0, 1e-5);
}

TEST(Show, BiasIsTheDistanceThatTheRecipeAsksFor) {
    // A level floor under a vertical sun: only what points towards the light moves the receiver.
    const Scene scene = floor_below(5);
    for (const double metres : {0.01, 0.1}) {
        const Shown bias =
            show(scene,
                 fmt::format("pcf,placement=single,bias.constant=0,bias.normal=0,bias.slope=0,bias.constant_world={}",
                             metres),
                 {"bias"})
                .front();
        EXPECT_NEAR(bias.values.at(80, 45, 0), metres, 1e-3 * metres + 1e-5);
    }
}

TEST(Show, ViewIsTheCascadeByTheSplits) {
    const Scene& scene = test::built_in("corridor");
    const std::string recipe =
        "pcf,placement=cascades,resolution=256,cascades.count=4,cascades.split=uniform,cascades.distance=100,"
        "cascades.transition=none,cascades.select=distance,cascades.fit=stable";
    const Shown view = show(scene, recipe, {"view"}).front();

    // Every held sample's cascade is the one whose slice holds its distance.
    SceneGpu gpu = upload_scene(device(), scene);
    const CpuSamples samples = render_samples(device(), gpu, scene.camera(""), 160, 90);
    const GnCascadesParams params = load_recipe(recipe).of<GnCascadesParams>("cascades");
    const float near = scene.camera("").near;
    std::set<int> seen;
    for (std::size_t i = 0; i < samples.position_ws.size(); ++i) {
        if (view.values.values[2 * i + 1] < 0) {
            continue;
        }
        const float distance = samples.normal_ws[i].w;
        int expected = 0;
        while (expected + 1 < 4 && distance > glsl::gn_cascades_split(params, near, 100, expected + 1)) {
            ++expected;
        }
        ASSERT_EQ(static_cast<int>(view.values.values[2 * i]), expected) << "at " << distance << " m";
        seen.insert(expected);
    }
    EXPECT_GE(seen.size(), 3U);
}

TEST(Show, ViewNamesTheFaceOfACube) {
    const Scene scene = load_scene("slab:light=point");
    const Shown view = show(scene, "pcf", {"view"}).front();
    // The light hangs above everything that the camera sees right below it: face -y.
    int down = 0;
    for (std::size_t i = 0; i < view.values.pixels(); ++i) {
        down += view.values.values[2 * i + 1] > 0 && view.values.values[2 * i] == 3.0F ? 1 : 0;
    }
    EXPECT_GT(down, 500);
    EXPECT_NE(view.legend.find("-y"), std::string::npos);
}

/// Distinct grey values of a picture, as 8-bit colours.
std::size_t colors_of(const Image& picture) {
    std::set<int> colors;
    for (std::size_t i = 0; i < picture.pixels(); ++i) {
        colors.insert(static_cast<int>(255 * picture.values[3 * i]));
    }
    return colors.size();
}

TEST(Show, WhatAPartWithoutAMapTellsSpeaksOfNoLightView) {
    const Scene scene = load_scene("slab");
    const Shown count = show(scene, "volumes", {"volume-count"}).front();
    EXPECT_EQ(count.legend.find("light view"), std::string::npos) << count.legend;
    EXPECT_NE(count.legend.find("grey: no surface"), std::string::npos) << count.legend;
    const Shown blocker = show(scene, "pcss,resolution=64", {"blocker-distance"}).front();
    EXPECT_NE(blocker.legend.find("magenta: in no light view"), std::string::npos) << blocker.legend;
}

TEST(Show, LayersShowWhatTheMapHolds) {
    const Scene& scene = test::built_in("corridor");
    for (const char* recipe : {"pcf,placement=cascades", "vsm,placement=cascades"}) {
        const std::vector<Shown> shown = show(scene, std::string(recipe) + ",resolution=128", {"map", "light-view"});
        for (const Shown& picture : shown) {
            EXPECT_GT(colors_of(picture.picture), 20U) << recipe << " " << picture.name;
        }
        // Four layers of 128 texels, and one block of them a channel.
        const Image& map = shown[0].picture;
        EXPECT_EQ(map.width, 4 * 130 - 2) << recipe;
        EXPECT_GE(map.height, 128) << recipe;
        EXPECT_EQ(shown[1].picture.height, 128);
    }
}

TEST(Show, TheLightsViewIsBrightWhereSurfacesFaceIt) {
    const Shown seen = show(floor_below(5), "pcf,placement=single,resolution=64", {"light-view"}).front();
    // A level floor under a vertical sun: cosine 1 wherever something is seen.
    int covered = 0;
    for (std::size_t i = 0; i < seen.values.pixels(); ++i) {
        if (seen.values.values[4 * i + 3] > 0.5F) {
            EXPECT_NEAR(seen.values.values[4 * i], 1, 1e-3);
            ++covered;
        }
    }
    EXPECT_GT(covered, 3000) << "of " << 64 * 64;
}

TEST(Show, EveryPlacementHasItsPictures) {
    const std::vector<std::string> names{"view", "texels", "undersampling", "bias", "map", "light-view"};
    const Scene sun = load_scene("corridor"), point = load_scene("slab:light=point");
    for (const Part* part : all_parts()) {
        if (part->stage != Stage::placement) {
            continue;
        }
        const std::string recipe = fmt::format("hard,placement={},resolution=512", part->id);
        const Scene& scene = part->lights.directional ? sun : point;
        for (const Shown& shown : show(scene, recipe, names)) {
            EXPECT_FALSE(shown.legend.empty());
            EXPECT_GT(colors_of(shown.picture), 2U) << part->id << " " << shown.name;
            EXPECT_TRUE(std::all_of(shown.picture.values.begin(), shown.picture.values.end(),
                                    [](float v) { return v >= 0 && v <= 1; }))
                << part->id << " " << shown.name;
        }
    }
}

}  // namespace
}  // namespace gn::show_test
