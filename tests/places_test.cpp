// SPDX-License-Identifier: MIT
// A scene is the same scene wherever it lies and however large its units are.
#include "shadow/scene/testing.h"
#include "tests/direct_scenes.h"
#include "tests/rig.h"

namespace gn::places_test {
namespace {

/// A ground, a slab on posts and a lamp's worth of sun, `scale` large, with its zero at `zero`.
Scene table(float scale, vec3 zero = vec3(0)) {
    by_hand::SceneBuilder builder;
    const auto box = [&](vec3 low, vec3 high) { builder.box(zero + scale * low, zero + scale * high); };
    builder.quad(zero + scale * vec3(-6, 0, 6), zero + scale * vec3(6, 0, 6), zero + scale * vec3(6, 0, -6),
                 zero + scale * vec3(-6, 0, -6));
    box({-2, 1, -1}, {2, 1.25F, 1});
    box({-2, 0, -1}, {-1.75F, 1, -0.75F});
    box({1.75F, 0, 0.75F}, {2, 1, 1});
    builder.light(by_hand::sun({0.5F, -1, 0.25F}));
    builder.camera(zero + scale * vec3(3, 4, 7), zero + scale * vec3(0, 0.5F, 0), 0.1F * scale, 50 * scale);
    return builder.scene();
}

CpuSamples seen(Scene scene) {
    finish_scene(scene);
    SceneGpu gpu = upload_scene(test::device(), scene);
    return render_samples(test::device(), gpu, scene.cameras.front(), 128, 128);
}

TEST(Places, TheViewIsTheSameAtAnyScale) {
    const CpuSamples one = seen(table(1));
    for (const float scale : {1e-4F, 1e4F, 1e6F, 1e7F}) {
        const CpuSamples other = seen(table(scale));
        std::size_t differing = 0;
        for (std::size_t i = 0; i < one.position_ws.size(); ++i) {
            const bool same = one.position_ws[i].w == other.position_ws[i].w &&
                              glm::distance(vec3(one.position_ws[i]), vec3(other.position_ws[i]) / scale) < 1e-4F &&
                              glm::distance(vec3(one.normal_ws[i]), vec3(other.normal_ws[i])) < 1e-5F;
            differing += same ? 0U : 1U;
        }
        // A pixel whose centre lies on an edge may fall to either side: the noise of rasterization.
        EXPECT_LE(differing, 4U) << "scale " << scale;
    }
}

TEST(Places, VolumesAreTheTruthBesideAStray) {
    // Survey coordinates, and one triangle that was left at the file's zero.
    const testing_scene::TempFolder folder;
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const Scene source = table(1);
    for (const vec3 p : source.positions_ws) {
        text += fmt::format("v {:.4f} {:.4f} {:.4f}\n", 512'345.25 + double(p.x), double(p.y), 634'210.5 + double(p.z));
    }
    for (const uvec3 t : source.triangles) {
        text += fmt::format("f {} {} {}\n", t.x + 4, t.y + 4, t.z + 4);
    }
    folder.write("survey.obj", text);
    Scene scene = load_scene(
        folder.write("survey.toml",
                     "[[file]]\npath = 'survey.obj'\n[[light]]\nkind = 'directional'\ndirection = [0.5, -1, 0.25]\n"
                     "[[camera]]\nposition = [512348.25, 4, 634217.5]\nlook_at = [512345.25, 0.5, 634210.5]\n"));
    for (const char* recipe : {"volumes", "none", "pcf"}) {
        const test::Comparison c = test::compare(scene, recipe, {.width = 128, .height = 128, .samples = 1});
        const test::Comparison plain = test::compare(table(1), recipe, {.width = 128, .height = 128, .samples = 1});
        ASSERT_TRUE(c.errors.leak.has_value()) << recipe << ": the truth has no shadow";
        EXPECT_NEAR(c.errors.rmse.value(), plain.errors.rmse.value(), 0.01) << recipe;
        EXPECT_NEAR(c.errors.leak.value(), plain.errors.leak.value(), 0.01) << recipe;
        EXPECT_NEAR(double(c.errors.dark), double(plain.errors.dark), 20.0) << recipe;
    }
    EXPECT_LT(test::compare(scene, "volumes", {.width = 128, .height = 128, .samples = 1}).errors.rmse.value(), 0.02);
}

/// A slab 5 cm above a ground of 100 km, `away` from its middle; the camera's near plane is chosen.
Scene hovering(float away) {
    by_hand::SceneBuilder builder;
    builder.ground(5e4F);
    builder.box({away - 1, 0.05F, -1}, {away + 1, 0.25F, 1});
    builder.light(by_hand::sun({0.5F, -1, 0.25F}));
    builder.camera({away + 2, 1.5F, 3}, {away, 0, 0}, 0, 0);
    Scene scene = builder.scene();
    finish_scene(scene);
    return scene;
}

TEST(Places, AContactShadowFortyKilometresFromTheMiddle) {
    const test::Comparison far = test::compare(hovering(4e4F), "volumes", {.width = 128, .height = 128, .samples = 1});
    const test::Comparison home = test::compare(hovering(0), "volumes", {.width = 128, .height = 128, .samples = 1});
    ASSERT_GT(home.errors.dark, 300U);
    // Rasterization may decide the pixels on the shadow's rim, some hundred, either way.
    EXPECT_NEAR(double(far.errors.dark), double(home.errors.dark), 20.0);
    EXPECT_LT(far.errors.rmse.value(), 0.03);
}

}  // namespace
}  // namespace gn::places_test
