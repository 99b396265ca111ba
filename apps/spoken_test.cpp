// SPDX-License-Identifier: MIT
// Nothing in silence: what a loader left out, what a light did not reach, and what was refused for many lights at once.
#include "apps/subprocess_test.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>

namespace gn::spoken_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

/// A floor of 8 x 8 m and a box of 1 m that floats above it.
constexpr const char* floor_obj = "v -4 0 -4\nv -4 0 4\nv 4 0 4\nv 4 0 -4\nf 1 2 3 4\n";
constexpr const char* box_obj =
    "v -0.5 1 -0.5\nv 0.5 1 -0.5\nv 0.5 2 -0.5\nv -0.5 2 -0.5\nv -0.5 1 0.5\nv 0.5 1 0.5\nv 0.5 2 0.5\nv -0.5 2 0.5\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 5 8 4\nf 2 3 7 6\nf 1 2 6 5\nf 4 8 7 3\n";
constexpr const char* files = "[[file]]\npath = \"floor.obj\"\n[[file]]\npath = \"box.obj\"\n";
constexpr const char* looking = "[[camera]]\nposition = [3, 4, 5]\nlook_at = [0, 0.5, 0]\n";
constexpr const char* sun =
    "[[light]]\nkind = \"directional\"\nname = \"sun\"\ndirection = [1, -2, 0]\nintensity = 1000\n";

/// A folder with the floor, the box and a scene of them.
struct SceneFolder : ScratchFolder {
    explicit SceneFolder(const std::string& text) {
        write("floor.obj", floor_obj);
        write("box.obj", box_obj);
        write("scene.toml", files + text);
    }
    [[nodiscard]] std::string scene() const { return *this / "scene.toml"; }
};

std::string repeated(int count, const std::function<std::string(int)>& text) {
    std::string all;
    for (int i = 0; i < count; ++i) {
        all += text(i);
    }
    return all;
}

CommandResult compare(const std::string& scene, Words more) {
    Words words{"compare", scene, "--size", "96x64", "--samples", "4", "--repeat", "1", "--json", "-", "-r"};
    words.insert(words.end(), more.begin(), more.end());
    return run_gnomon(words);
}

std::ptrdiff_t lines_with(const std::string& text, const std::string& part) {
    std::ptrdiff_t count = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        count += text.substr(at, end - at).find(part) != std::string::npos ? 1 : 0;
        at = end + 1;
    }
    return count;
}

/// Lights whose angular radius makes no sense, so that the loader repairs it and says so.
std::string odd_light(int i) {
    return "[[light]]\nkind = \"directional\"\nname = \"odd" + std::to_string(i) +
           "\"\ndirection = [1, -2, 0]\nintensity = 10\nangular_radius_deg = 120\n";
}

TEST(Spoken, NotesOfTheLoaderAreOnStandardErrorInTheReportAndInTheJson) {
    const SceneFolder folder(looking + odd_light(0));
    const std::string note = "'odd0' had an angular radius";
    const CommandResult rendered = run_gnomon({"render", folder.scene(), "--size", "96x64", "-o", folder / "out.png"});
    EXPECT_EQ(rendered.status, 0) << rendered.err;
    expect_has(rendered.err, {"note", note});
    const CommandResult quiet =
        run_gnomon({"render", folder.scene(), "--size", "96x64", "-o", folder / "out.png", "--quiet"});
    EXPECT_EQ(quiet.status, 0) << quiet.err;
    EXPECT_EQ(quiet.err, "");
    const CommandResult compared = compare(folder.scene(), {"none", "-o", folder / "report"});
    ASSERT_EQ(compared.status, 0) << compared.err;
    expect_has(compared.err, {"note", note});
    const json document = json::parse(compared.out);
    expect_has(document.at("scenes").at(0).at("notes").dump(), {note});
    expect_has(file_text(folder / "report/index.html"), {note});
}

TEST(Spoken, ManyNotesOfAKindAreOneLine) {
    const SceneFolder folder(looking + repeated(12, odd_light));
    const CommandResult compared = compare(folder.scene(), {"none"});
    ASSERT_EQ(compared.status, 0) << compared.err;
    EXPECT_EQ(lines_with(compared.err, "angular radius"), 1) << compared.err;
    expect_has(compared.err, {"11 more"});
    EXPECT_EQ(json::parse(compared.out).at("scenes").at(0).at("notes").size(), 12U);
}

TEST(Spoken, RemarksOfARecipeStandInTheJson) {
    const SceneFolder folder(looking + std::string(sun) +
                             "[[light]]\nkind = \"point\"\nname = \"lamp\"\nposition = [0, 3, 0]\nintensity = 10\n");
    const CommandResult compared = compare(folder.scene(), {"pcf,placement=cascades,resolution=64"});
    ASSERT_EQ(compared.status, 0) << compared.err;
    const json run = json::parse(compared.out).at("runs").at(0);
    expect_has(run.at("remarks").dump(), {"placement 'cascades' serves directional"});
}

TEST(Spoken, ACameraThatSeesNothingMeasuresNothing) {
    const SceneFolder folder(
        sun + std::string("[[camera]]\nname = \"sky\"\nposition = [0, 3, 0]\ndirection = [0, 1, 0.1]\n"));
    const CommandResult compared = compare(folder.scene(), {"hard", "-o", folder / "report"});
    ASSERT_EQ(compared.status, 0) << compared.err;
    expect_has(compared.err, {"'sky' sees no surface"});
    const json run = json::parse(compared.out).at("runs").at(0);
    EXPECT_EQ(run.at("status"), "empty");
    expect_has(run.at("reason").get<std::string>(), {"'sky' sees no surface"});
    EXPECT_EQ(run.at("lights").at(0).at("status"), "empty");
    EXPECT_TRUE(run.at("error").at("rmse").is_null());
    const CommandResult rendered = run_gnomon({"render", folder.scene(), "--size", "96x64", "-o", folder / "out.png"});
    EXPECT_EQ(rendered.status, 0);
    expect_has(rendered.err, {"'sky' sees no surface"});
    EXPECT_TRUE(file_text(folder / "out.png").starts_with("\x89PNG"));
}

TEST(Spoken, ALightThatReachesNoSampleSaysSo) {
    const SceneFolder folder(looking + std::string(sun) +
                             "[[light]]\nkind = \"point\"\nname = \"far\"\nposition = [0, 90, 0]\nrange = 1\n"
                             "[[light]]\nkind = \"directional\"\nname = \"small\"\ndirection = [1, -2, 0]\n"
                             "angular_radius_deg = 0.2\n");
    const CommandResult compared = compare(folder.scene(), {"hard"});
    ASSERT_EQ(compared.status, 0) << compared.err;
    expect_has(compared.err, {"'far' reaches no sample", "less than 0.06 degrees"});
    const json run = json::parse(compared.out).at("runs").at(0);
    EXPECT_EQ(run.at("status"), "ok");
    EXPECT_EQ(run.at("lights").at(0).at("status"), "ok");
    EXPECT_EQ(run.at("lights").at(1).at("status"), "empty");
    expect_has(run.at("lights").at(1).at("reason").get<std::string>(), {"'far' reaches no sample"});
    // Nor is it told in silence that a figure is one of few samples: a penumbra of a centimetre is one of some pixels.
    const json small = run.at("lights").at(2), found = small.at("found");
    EXPECT_EQ(found.at("dark").get<int>() + found.at("lit").get<int>() + found.at("partial").get<int>(),
              small.at("samples").get<int>());
    EXPECT_GT(found.at("partial").get<int>(), 0);
    expect_has(run.at("remarks").dump(), {"'penumbra' of light 'small' is told by"});
    // Alone it leaves nothing to measure, which --strict does not pass.
    const CommandResult alone = compare(folder.scene(), {"hard", "--light", "far", "--strict"});
    EXPECT_EQ(alone.status, 1) << alone.err;
    EXPECT_EQ(json::parse(alone.out).at("runs").at(0).at("status"), "empty");
}

TEST(Spoken, ALampInsideItsShadeIsSuspected) {
    const SceneFolder folder(
        looking +
        std::string("[[light]]\nkind = \"point\"\nname = \"bulb\"\nposition = [0, 1.5, 0]\nintensity = 100\n"));
    const CommandResult compared = compare(folder.scene(), {"hard"});
    ASSERT_EQ(compared.status, 0) << compared.err;
    const json run = json::parse(compared.out).at("runs").at(0);
    EXPECT_EQ(run.at("status"), "ok");
    expect_has(run.at("remarks").dump(), {"'bulb'", "in shadow", "shade?"});
    expect_has(compared.err, {"'bulb'", "in shadow"});
    const CommandResult rendered =
        run_gnomon({"render", folder.scene(), "-r", "hard", "--size", "96x64", "-o", folder / "out.png"});
    expect_has(rendered.err, {"'bulb'", "in shadow"});
}

TEST(Spoken, MoreThanSixtyFourLightsAreServed) {
    const auto lamp = [](int i) {
        return "[[light]]\nkind = \"spot\"\nname = \"lamp" + std::to_string(i) + "\"\nposition = [" +
               std::to_string(0.05 * i - 2) + ", 3, 0]\nintensity = 10\n";
    };
    const SceneFolder folder(looking + repeated(80, lamp));
    const CommandResult compared = compare(folder.scene(), {"hard,resolution=64"});
    ASSERT_EQ(compared.status, 0) << compared.err;
    const json lights = json::parse(compared.out).at("runs").at(0).at("lights");
    ASSERT_EQ(lights.size(), 80U);
    EXPECT_EQ(lights.at(79).at("status"), "ok");
    EXPECT_GT(lights.at(79).at("samples").get<int>(), 100);
}

TEST(Spoken, RefusalsOfManyLightsAreGroupedByReason) {
    const auto lamp = [](int i) {
        return "[[light]]\nkind = \"point\"\nname = \"lamp" + std::to_string(i) + "\"\nposition = [0, 3, 0]\n";
    };
    const SceneFolder folder(looking + repeated(9, lamp));
    // The placement that serves no light of the scene is refused for each of them, with its name in the sentence.
    const CommandResult compared = compare(folder.scene(), {"hard,placement=cascades"});
    ASSERT_EQ(compared.status, 0) << compared.err;
    EXPECT_EQ(lines_with(compared.err, "does not serve point lights"), 1) << compared.err;
    const json run = json::parse(compared.out).at("runs").at(0);
    EXPECT_EQ(run.at("status"), "refused");
    const std::string reason = run.at("reason");
    expect_has(reason, {"9 lights", "'lamp0'", "does not serve point lights"});
    EXPECT_EQ(reason.find("does not serve"), reason.rfind("does not serve")) << reason;
    const CommandResult rendered = run_gnomon(
        {"render", folder.scene(), "-r", "hard,placement=cascades", "--size", "96x64", "-o", folder / "out.png"});
    EXPECT_EQ(lines_with(rendered.err, "does not serve point lights"), 1) << rendered.err;
}

}  // namespace
}  // namespace gn::spoken_test
