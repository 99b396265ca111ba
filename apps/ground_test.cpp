// SPDX-License-Identifier: MIT
// A bare model: set on a ground, framed for the picture's aspect, its edges smoothed.
#include "apps/subprocess_test.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gn::ground_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

/// A box of w x h x d metres whose lowest corner lies at y = 1.
std::string box(double w, double h, double d) {
    std::string text;
    for (const double z : {0.0, d}) {
        for (const double y : {0.0, h}) {
            for (const double x : {0.0, w}) {
                text += "v " + std::to_string(x) + " " + std::to_string(1 + y) + " " + std::to_string(z) + "\n";
            }
        }
    }
    return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\n";
}

json compared(const std::string& scene, const Words& more, std::string* err = nullptr) {
    Words words{"compare", scene, "-r", "none", "--samples", "4", "--repeat", "1", "--json", "-"};
    words.insert(words.end(), more.begin(), more.end());
    const CommandResult result = run_gnomon(words);
    EXPECT_EQ(result.status, 0) << result.err;
    if (err != nullptr) {
        *err = result.err;
    }
    return json::parse(result.out);
}

TEST(Ground, ABareModelIsSetOnAGroundAndItIsSaid) {
    const ScratchFolder folder;
    folder.write("box.obj", box(1, 1, 1));
    std::string err;
    const json with = compared(folder / "box.obj", {"--size", "96x64"}, &err);
    expect_has(err, {"ground", "height 1", "--ground none"});
    const json without = compared(folder / "box.obj", {"--size", "96x64", "--ground", "none"}, &err);
    EXPECT_EQ(err.find("ground"), std::string::npos) << err;
    const int box_triangles = without.at("scenes").at(0).at("triangles");
    EXPECT_EQ(box_triangles, 12);
    EXPECT_EQ(with.at("scenes").at(0).at("triangles"), box_triangles + 2);
    // The box's shadow lies on the ground: shadow where a lone box has next to none.
    EXPECT_GT(with.at("runs").at(0).at("error").at("mismatch").get<double>(), 0.02);
    EXPECT_LT(without.at("runs").at(0).at("error").at("mismatch").get<double>(), 0.001);
    // A height is obeyed, whatever the file has.
    const json raised = compared(folder / "box.obj", {"--size", "96x64", "--ground", "-3.5"}, &err);
    expect_has(err, {"height -3.5"});
    EXPECT_EQ(raised.at("scenes").at(0).at("triangles"), box_triangles + 2);
}

TEST(Ground, AFileWithAFloorKeepsItsOwn) {
    const ScratchFolder folder;
    folder.write("room.obj", box(1, 1, 1) + "v -3 1 -3\nv -3 1 3\nv 3 1 3\nv 3 1 -3\nf 9 10 11 12\n");
    std::string err;
    const json document = compared(folder / "room.obj", {"--size", "96x64"}, &err);
    EXPECT_EQ(err.find("ground"), std::string::npos) << err;
    EXPECT_EQ(document.at("scenes").at(0).at("triangles"), 14);
    // Nor is one put under a scene of the program's own.
    compared("contact", {"--size", "96x64"}, &err);
    EXPECT_EQ(err.find("ground"), std::string::npos) << err;
}

TEST(Ground, OtherWordsAreMisuse) {
    const CommandResult result = run_gnomon({"render", "slab", "--ground", "below"});
    EXPECT_EQ(result.status, 2);
    expect_has(result.err, {"--ground", "'below'", "auto, none"});
}

TEST(Framing, ABareModelFitsThePicturesOwnAspect) {
    const ScratchFolder folder;
    folder.write("plate.obj", box(10, 0.5, 1));
    const auto seen = [&](const char* size) {
        const json document = compared(folder / "plate.obj", {"--size", size, "--ground", "none"});
        return document.at("runs").at(0).at("samples").get<double>();
    };
    // A picture four times as high as wide shows the plate as wide as a square one does, and no larger; from farther off it
    // looks up to a quarter larger, since its far end shrinks less. Framed for a square it would be cut, at four times the size.
    const double square = seen("60x60");
    EXPECT_NEAR(seen("60x240") / square, 1.0, 0.3);
    // A wide one has room for more of it.
    EXPECT_GT(seen("240x60") / square, 2.0);
}

TEST(Antialias, SmoothsThePictureAndLeavesVisibilityAlone) {
    const ScratchFolder folder;
    const auto rendered = [&](const std::string& count, const std::string& name) {
        const CommandResult result =
            run_gnomon({"render", "slab", "-r", "hard", "--size", "96x64", "--antialias", count, "-o",
                        folder / (name + ".png"), "--visibility", folder / (name + ".exr")});
        EXPECT_EQ(result.status, 0) << result.err;
    };
    rendered("1", "one");
    rendered("4", "four");
    EXPECT_NE(file_text(folder / "one.png"), file_text(folder / "four.png"));
    EXPECT_EQ(file_text(folder / "one.exr"), file_text(folder / "four.exr"));
    for (const char* count : {"0", "65", "many"}) {
        const CommandResult result = run_gnomon({"render", "slab", "--antialias", count});
        EXPECT_EQ(result.status, 2) << count;
        expect_has(result.err, {"--antialias"});
    }
}

}  // namespace
}  // namespace gn::ground_test
