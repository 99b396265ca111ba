// SPDX-License-Identifier: MIT
// The environment is a light: what it gives is in the scene, and pictures without one keep their pale sky.
#include "tests/direct_scenes.h"
#include "tests/rig.h"

namespace gn::environment_test {
namespace {

/// The ground seen from above under the open sky, with nothing of its sun.
Image ambient_of(const Scene& scene) {
    const test::ValidationGuard guard;
    SceneGpu gpu = upload_scene(test::device(), scene);
    return shade(test::device(), gpu, scene.camera(""), 32, 32, std::vector<Image>(1, Image(32, 32, 1, 0.0F)));
}

void expect_color(const Image& picture, int x, int y, vec3 color) {
    for (int c = 0; c < 3; ++c) {
        // Base colours are stored in eight bits: half a step of the sRGB curve at 0.8 is a quarter per cent.
        EXPECT_NEAR(picture.at(x, y, c), color[c], 0.004F * color[c] + 1e-6F) << x << ", " << y << " channel " << c;
    }
}

TEST(Environment, GivesAnUpwardSurfaceItsLightFromAbove) {
    GnLight sun = by_hand::sun({0, -1, 0.2F});
    sun.intensity = 100;
    Scene scene = by_hand::SceneBuilder().ground(1).light(sun).camera({0, 2, 2.5F}, {0, 0, 0}).scene();
    EXPECT_EQ(environment_of(scene).shape.kind, uint(GN_LIGHT_ENVIRONMENT));

    // Without one of its own, 8 % of what the lights give, a pale sky.
    const Image made = ambient_of(scene);
    expect_color(made, 16, 16, 0.8F * 8.0F / pi * vec3(0.85F, 0.95F, 1.1F));
    expect_color(made, 0, 0, 1.5F * 8.0F / pi * vec3(0.55F, 0.75F, 1.1F));

    // A scene's own says colour and strength.
    scene.environment = Light{.name = "night", .shape = {}};
    scene.environment->shape.kind = GN_LIGHT_ENVIRONMENT;
    scene.environment->shape.intensity = 3;
    scene.environment->sky.above = vec4(0.5F, 0.25F, 1, 0);
    scene.environment->sky.zenith = vec4(1, 0.5F, 0.25F, 0);
    const Image own = ambient_of(scene);
    expect_color(own, 16, 16, 0.8F * 3.0F / pi * vec3(0.5F, 0.25F, 1));
    expect_color(own, 0, 0, 1.5F * 3.0F / pi * vec3(1, 0.5F, 0.25F));
}

TEST(Environment, NoPartServesItsShadowYet) {
    for (const Part* part : all_parts()) {
        EXPECT_FALSE(part->lights.has(GN_LIGHT_ENVIRONMENT)) << part->id;
    }
}

}  // namespace
}  // namespace gn::environment_test
