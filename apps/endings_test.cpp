// SPDX-License-Identifier: MIT
// How the command ends when something is in its way: a user who stops it, a full disk, a map too large, a recipe that
// serves no light. Nothing that was there before is lost.
#include "apps/subprocess_test.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

namespace gn::endings_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

TEST(Endings, AStopWhileTracingKeepsWhatIsMeasured) {
    // The light of the second scene has an area, and a million rays a sample would take hours.
    const ScratchFolder folder;
    RunningCommand running({"compare", "contact", "slab", "-r", "none", "--size", "192x108", "--samples", "1048576",
                            "--repeat", "1", "-o", folder / "report", "--json", folder / "figures.json"});
    while (!running.finished() && !std::filesystem::exists(folder / "figures.json")) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    std::this_thread::sleep_for(std::chrono::seconds(1));
    ASSERT_FALSE(running.finished());
    running.signal(SIGINT);
    const auto asked = std::chrono::steady_clock::now();
    const CommandResult result = running.wait(60);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - asked;
    // A thread asks before every sample: a second at most on an idle machine, and this one may be busy.
    EXPECT_LT(took.count(), 5.0);
    EXPECT_EQ(result.status, 1) << result.err;
    expect_has(result.err, {"stopped", "1 finished run"});
    const json document = json::parse(file_text(folder / "figures.json"));
    ASSERT_EQ(document.at("runs").size(), 1U);
    EXPECT_EQ(document.at("runs").at(0).at("status"), "ok");
    expect_has(file_text(folder / "report/index.html"), {"contact"});
}

TEST(Endings, BadNamesLeaveAnOldReportAlone) {
    const ScratchFolder folder;
    const Words small{"--size", "96x64", "--samples", "4", "--repeat", "1", "-o", folder / "report"};
    const auto compare = [&](Words words) {
        words.insert(words.begin(), {"compare", "slab", "-r", "none"});
        words.insert(words.end(), small.begin(), small.end());
        return run_gnomon(words);
    };
    ASSERT_EQ(compare({}).status, 0);
    const std::string before = file_text(folder / "report/index.html");
    for (const Words& wrong : {Words{"--path", "nope"}, Words{"--view", "nope"}, Words{"--light", "nope"}}) {
        const CommandResult result = compare(wrong);
        EXPECT_EQ(result.status, 2) << wrong[0];
        EXPECT_EQ(file_text(folder / "report/index.html"), before) << wrong[0];
        // Where there was none, none appears.
        Words elsewhere{"compare", "slab", "-r", "none", "-o", folder / "other"};
        elsewhere.insert(elsewhere.end(), wrong.begin(), wrong.end());
        EXPECT_EQ(run_gnomon(elsewhere).status, 2);
        EXPECT_FALSE(std::filesystem::exists(folder / "other")) << wrong[0];
    }
}

TEST(Endings, AFullHomeFolderIsASentenceAndARunWithoutCache) {
    // A home of 16 KiB in a namespace of its own.
    const std::string probe = "unshare -rm sh -c 'mount -t tmpfs -o size=16k tmpfs /mnt' 2> /dev/null";
    if (std::system(probe.c_str()) != 0) {
        GTEST_SKIP() << "no small file system can be mounted here: namespaces of users are not allowed";
    }
    const ScratchFolder folder;
    const std::string command =
        "unshare -rm sh -c 'mount -t tmpfs -o size=16k tmpfs /mnt && env -u MESA_SHADER_CACHE_DIR -u GNOMON_CACHE "
        "-u XDG_CACHE_HOME HOME=/mnt " +
        gnomon_executable() + " render slab -r hard --size 96x64 -o " + (folder / "out.png") + "' > /dev/null 2> " +
        (folder / "err");
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 0) << file_text(folder / "err");
    expect_has(file_text(folder / "err"), {"/mnt", "cache"});
    EXPECT_TRUE(file_text(folder / "out.png").starts_with("\x89PNG"));
}

TEST(Endings, AMapThatDoesNotFitNamesItsLightAndWhatFits) {
    const ScratchFolder folder;
    const CommandResult rendered = run_gnomon(
        {"render", "contact:light=point", "-r", "hard,resolution=16384", "--size", "96x64", "-o", folder / "out.png"});
    EXPECT_EQ(rendered.status, 1) << rendered.err;
    expect_has(rendered.err, {"light '", "16384", "resolution", "fits"});
    EXPECT_EQ(rendered.err.find("light '"), rendered.err.rfind("light '"))
        << "its light is named once: " << rendered.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.png"));
}

TEST(Endings, ARecipeWhoseStagesDoNotFitWritesNoPicture) {
    const ScratchFolder folder;
    const CommandResult rendered =
        run_gnomon({"render", "slab", "-r", "hard,lookup=filtered", "--size", "96x64", "-o", folder / "out.png"});
    EXPECT_EQ(rendered.status, 2) << rendered.err;
    expect_has(rendered.err, {"'filtered'", "'depth'", "vsm"});
    EXPECT_FALSE(std::filesystem::exists(folder / "out.png"));
    // Nor does one that serves no light of the scene.
    const CommandResult unserved = run_gnomon({"render", "contact:light=point", "-r", "hard,placement=cascades",
                                               "--size", "96x64", "-o", folder / "out.png"});
    EXPECT_EQ(unserved.status, 1) << unserved.err;
    expect_has(unserved.err, {"'cascades'", "point"});
    EXPECT_FALSE(std::filesystem::exists(folder / "out.png"));
}

}  // namespace
}  // namespace gn::endings_test
