// SPDX-License-Identifier: MIT
// Sessions, command lines and recipes come back as they were.
#include "apps/view/setup.h"
#include "apps/view/recipe_text.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

namespace gn::setup_test {
namespace {

std::string error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

Camera odd_camera() {
    Camera camera;
    camera.position_ws = {0.1F, -3.7F, 1e5F / 3.0F};
    camera.forward_ws = glm::normalize(vec3(0.3F, -0.2F, 0.7F));
    camera.yfov = 0.7371F;
    camera.near = 0.0123F;
    camera.far = 1234.5F;
    return camera;
}

TEST(ViewSetup, CamerasComeBackBitForBitFromTheirWords) {
    const Camera camera = odd_camera();
    const Camera again = parse_camera(text_of(camera), Camera{});
    EXPECT_EQ(again.position_ws, camera.position_ws);
    EXPECT_EQ(again.forward_ws, camera.forward_ws);
    EXPECT_EQ(again.yfov, camera.yfov);
    EXPECT_EQ(again.near, camera.near);
    EXPECT_EQ(again.far, camera.far);
    EXPECT_EQ(text_of(again), text_of(camera));
}

TEST(ViewSetup, LightsSayWhatOfThemDiffers) {
    GnLight before, now;
    EXPECT_EQ(text_of(now, before), "");
    now.intensity = 12.5F;
    now.direction_ws = vec4(glm::normalize(vec3(1, -2, 3)), 0);
    const GnLight again = parse_light(text_of(now, before), before);
    EXPECT_EQ(again.intensity, now.intensity);
    EXPECT_EQ(again.direction_ws, now.direction_ws);
    EXPECT_EQ(text_of(again, now), "");
}

TEST(ViewSetup, WrongWordsAreSentencesThatNameTheKnownOnes) {
    EXPECT_NE(error_of([] { parse_camera("positon=1/2/3", Camera{}); }).find("position"), std::string::npos);
    EXPECT_NE(error_of([] { parse_camera("position=1/2", Camera{}); }).find("x/y/z"), std::string::npos);
    EXPECT_NE(error_of([] { parse_camera("near=5,far=2", Camera{}); }).find("near < far"), std::string::npos);
    EXPECT_NE(error_of([] { parse_light("intensity=-1", GnLight{}); }).find("0 or more"), std::string::npos);
}

ViewSetup full_setup() {
    ViewSetup setup;
    setup.scene = "courtyard";
    setup.viewports.resize(2);
    setup.viewports[0].recipe = "pcf,pcf.size=5";
    setup.viewports[0].camera = text_of(odd_camera());
    setup.viewports[1].recipe = "hard";
    setup.viewports[1].view = "main";
    setup.viewports[1].show = "map";
    setup.lights = {"sun,intensity=3"};
    setup.linked = false;
    setup.against = Against::truth;
    setup.split = 0.25F;
    setup.error = true;
    setup.stops = 1.5F;
    setup.picture = Size{160, 90};
    return setup;
}

TEST(ViewSetup, SessionsComeBackFromTheirFiles) {
    const std::filesystem::path path = std::filesystem::temp_directory_path() / "gnomon-session-test.toml";
    std::ofstream(path) << toml_of(full_setup());
    const ViewSetup again = read_session(path.string());
    EXPECT_EQ(toml_of(again), toml_of(full_setup()));
    EXPECT_EQ(command_of(again), command_of(full_setup()));
    std::ofstream(path) << "scene = \"slab\"\nspilt = 0.5\n";
    EXPECT_NE(error_of([&] { read_session(path.string()); }).find("'split'"), std::string::npos);
    std::ofstream(path) << "scene = \"slab\"\n";
    EXPECT_NE(error_of([&] { read_session(path.string()); }).find("[[viewport]]"), std::string::npos);
    std::filesystem::remove(path);
}

TEST(ViewSetup, CommandLinesSayAllThatIsUnusual) {
    ViewSetup plain;
    plain.scene = "slab";
    plain.viewports.resize(1);
    EXPECT_EQ(command_of(plain), "gnomon view slab -r soft");
    const std::string line = command_of(full_setup());
    for (const char* part : {"-r pcf,pcf.size=5 -r hard", "--camera none", "--show none --show map", "--own-cameras",
                             "--move-light sun,intensity=3", "--against truth", "--split 0.25", "--error",
                             "--stops 1.5", "--size 160x90"}) {
        EXPECT_NE(line.find(part), std::string::npos) << line << "\nlacks " << part;
    }
}

TEST(RecipeText, ChangesOneKeyAndKeepsTheOthers) {
    RecipeText text = RecipeText::parse("pcf,resolution=512,pcf.size=5");
    text.set("resolution", "256");
    text.set("bias.normal", "2");
    EXPECT_EQ(text.text(), "pcf,resolution=256,pcf.size=5,bias.normal=2");
}

TEST(RecipeText, LosesTheParametersOfPartsThatGo) {
    const ChangedRecipe changed = change_recipe(RecipeText::parse("pcf,resolution=512,pcf.size=5"), "lookup", "hard");
    EXPECT_EQ(changed.text.text(), "pcf,resolution=512,lookup=hard");
    EXPECT_EQ(value_of(changed.recipe, "lookup"), "hard");
    EXPECT_NE(error_of([] { change_recipe(RecipeText::parse("pcf"), "pcf.size", "1000"); }), "");
    EXPECT_NE(error_of([] { change_recipe(RecipeText::parse("pcf"), "lookup", "filtered"); }), "");
}

TEST(RecipeText, TellsWhatEveryKeyIs) {
    const Recipe recipe = load_recipe("pcf,resolution=512,bias.normal=1.5,placement=cascades,cascades.count=3");
    EXPECT_EQ(value_of(recipe, "resolution"), "512");
    EXPECT_EQ(value_of(recipe, "bias.normal"), "1.5");
    EXPECT_EQ(value_of(recipe, "placement"), "cascades");
    EXPECT_EQ(value_of(recipe, "cascades.count"), "3");
    EXPECT_EQ(value_of(recipe, "direct"), "none");
}

}  // namespace
}  // namespace gn::setup_test
