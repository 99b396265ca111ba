// SPDX-License-Identifier: MIT
// The resolve pass clamps V; where the device validates, it first says what it clamps.
#include "tests/rig.h"

namespace gn {
namespace {

/// What a frame of the stack says whose lookup answers with the given expression.
std::vector<std::string> said_of(const char* expression) {
    static std::string text;
    text = fmt::format(
        "float gn_wrong_visibility(GnReceiver receiver, GnProjected projected, GnBias bias, sampler2DArray map) {{\n"
        "    return {};\n}}\n",
        expression);
    Part wrong;
    wrong.id = "wrong";
    wrong.stage = Stage::lookup;
    wrong.needs = "depth";
    wrong.prologue = [](const Recipe&) { return text; };
    Recipe recipe = load_recipe("hard,resolution=64");
    recipe.lookup = &wrong;

    const std::size_t before = test::device().messages().size();
    const Scene scene = load_scene("stack");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameResult frame = render_frame(test::device(), gpu, scene.camera(""), recipe,
                                           {.width = 32, .height = 32, .only_light = 0, .picture = false});
    EXPECT_EQ(frame.refused.front(), "");
    return {test::device().messages().begin() + static_cast<std::ptrdiff_t>(before), test::device().messages().end()};
}

TEST(ResolveRendered, SaysWhatItClampsWhereTheDeviceValidates) {
    // Not a number is made from what the compiler cannot know: the receiver's depth is never negative.
    for (const char* wrong : {"1.001", "-0.001", "sqrt(-1.0 - projected.depth)", "1.0 / (projected.depth * 0.0)"}) {
        const std::vector<std::string> said = said_of(wrong);
        ASSERT_EQ(said.size(), 1U) << wrong;
        EXPECT_NE(said.front().find("outside [0, 1] or not a number"), std::string::npos) << said.front();
        EXPECT_NE(said.front().find("hard"), std::string::npos) << said.front();
    }
}

TEST(ResolveRendered, IsSilentAboutRounding) {
    for (const char* right : {"1.0", "0.0", "1.0 + 1.0e-5", "-1.0e-5"}) {
        EXPECT_EQ(said_of(right), std::vector<std::string>{}) << right;
    }
}

}  // namespace
}  // namespace gn
