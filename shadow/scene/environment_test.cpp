// SPDX-License-Identifier: MIT
// Files may say what light comes from everywhere.
#include "shadow/scene/testing.h"

namespace gn::environment_test {
namespace {

using namespace testing_scene;

Scene load_toml_text(const std::string& text) {
    const TempFolder folder;
    return load_scene(folder.write("s.toml", text));
}

Scene load_gltf_extras(const std::string& gnomon) {
    const TempFolder folder;
    GltfText gltf;
    gltf.add_points(triangle);
    gltf.scene = R"("scene":0,"scenes":[{"nodes":[0],"extras":{"gnomon":)" + gnomon + "}}],";
    return load_scene(folder.write("a.gltf", gltf.text()));
}

void expect_uniform(const Scene& scene) {
    ASSERT_TRUE(scene.environment.has_value());
    const Light& light = *scene.environment;
    EXPECT_EQ(light.shape.kind, static_cast<uint>(GN_LIGHT_ENVIRONMENT));
    // 100 cd/m^2 from the whole hemisphere are 100 pi lux.
    EXPECT_FLOAT_EQ(light.shape.intensity, 100 * pi);
    for (const vec4& color : {light.sky.above, light.sky.below, light.sky.zenith, light.sky.horizon}) {
        EXPECT_EQ(vec3(color), vec3(0.5F, 1, 0.25F));
    }
    EXPECT_EQ(light.sky.seen, 1.0F);
}

TEST(EnvironmentFile, AUniformRadianceIsTheSameEverywhere) {
    expect_uniform(load_toml_text("[environment]\nradiance = 100\ncolor = [0.5, 1, 0.25]\n"));
    expect_uniform(load_gltf_extras(R"({"environment":{"radiance":100,"color":[0.5,1,0.25]}})"));
}

TEST(EnvironmentFile, ASkyHasColoursAboveAndBelow) {
    const std::string toml = "[environment]\nname = \"dusk\"\nilluminance = 300\nabove = [1, 0.5, 0.25]\nseen = 2\n";
    const std::string gltf = R"({"environment":{"name":"dusk","illuminance":300,"above":[1,0.5,0.25],"seen":2}})";
    for (const Scene& scene : {load_toml_text(toml), load_gltf_extras(gltf)}) {
        ASSERT_TRUE(scene.environment.has_value());
        EXPECT_EQ(scene.environment->name, "dusk");
        EXPECT_EQ(environment_of(scene).shape.intensity, 300.0F);
        EXPECT_EQ(vec3(scene.environment->sky.above), vec3(1, 0.5F, 0.25F));
        // What is not said is the pale sky's.
        EXPECT_EQ(scene.environment->sky.below, GnSky().below);
        EXPECT_EQ(scene.environment->sky.seen, 2.0F);
    }
}

TEST(EnvironmentFile, WithoutOneLightsGiveTheSky) {
    EXPECT_FALSE(load_toml_text("").environment.has_value());
    EXPECT_FALSE(load_gltf_extras("{}").environment.has_value());
}

TEST(EnvironmentFile, ASceneOfFilesHasItsOwnBeforeTheirs) {
    const TempFolder folder;
    GltfText gltf;
    gltf.add_points(triangle);
    gltf.scene = R"("scene":0,"scenes":[{"nodes":[0],"extras":{"gnomon":{"environment":{"illuminance":7}}}}],)";
    folder.write("a.gltf", gltf.text());
    const std::string file = "[[file]]\npath = \"a.gltf\"\n";
    EXPECT_EQ(load_scene(folder.write("s.toml", file)).environment->shape.intensity, 7.0F);
    EXPECT_EQ(
        load_scene(folder.write("s.toml", file + "[environment]\nilluminance = 9\n")).environment->shape.intensity,
        9.0F);
}

TEST(EnvironmentFile, MistakesAreNamed) {
    const TempFolder folder;
    const std::vector<std::pair<std::string, std::string>> cases{
        {"[environment]\ncolor = [1, 1, 1]\n", "[environment]: needs either radiance (cd/m^2) or illuminance (lux)"},
        {"[environment]\nradiance = 1\nilluminance = 1\n", "needs either radiance"},
        {"[environment]\nradiance = -1\n", "radiance must be from 0 to 1e+09"},
        {"[environment]\nilluminance = 1e20\n", "illuminance must be from 0 to 1e+09"},
        {"[environment]\nradiance = \"bright\"\n", "key 'radiance' must be a finite number"},
        {"[environment]\nradiance = 1\nbelow = [0, -1, 0]\n", "below must be 3 numbers from 0 to 1000"},
        {"[environment]\nradiance = 1\ncolor = [1, 1]\n", "key 'color' must be a list of 3 finite numbers"},
        {"[environment]\nradiance = 1\nseen = -2\n", "seen must be from 0 to 1000"},
        {"[environment]\nradiance = 1\nsun = 2\n", "unknown key 'sun'; known are name, radiance"},
        {"[[environment]]\nradiance = 1\n", "written [environment]"}};
    for (const auto& [text, expected] : cases) {
        const std::string error = error_of(folder.write("s.toml", text));
        EXPECT_NE(error.find(expected), std::string::npos) << text << "\n" << error;
    }
    for (const auto& [gnomon, expected] :
         {std::pair{R"({"environment":{"radiance":-1}})", "radiance must be from 0"},
          {R"({"environment":{"radiance":"much"}})", "radiance must be from 0"},
          {R"({"environment":{"radiance":1,"above":[1,2]}})", "above must be 3 numbers"},
          {R"({"environment":{"radiance":1,"above":[1,2,"x"]}})", "above must be 3 numbers"},
          {R"({"environment":{"seen":1}})", "needs either radiance"},
          {R"({"environment":7})", "is no object"}}) {
        const Scene scene = load_gltf_extras(gnomon);
        EXPECT_TRUE(has_note(scene, expected)) << gnomon;
        EXPECT_FALSE(scene.environment.has_value()) << gnomon;
    }
    const Scene scene = load_gltf_extras(R"({"environment":{"radiance":1,"sun":2}})");
    EXPECT_TRUE(has_note(scene, "no key 'sun'"));
    EXPECT_TRUE(scene.environment.has_value());
}

}  // namespace
}  // namespace gn::environment_test
