// SPDX-License-Identifier: MIT
// gnomon sweep and gnomon merge from outside: killed and resumed, in parts, with what is not there, and its page.
#include "apps/evaluation/sweep_store.h"
#include "apps/subprocess_test.h"
#include "tests/thorough.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace gn::sweep_command_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

constexpr const char* twelve_runs = R"(
title = "Twelve runs"
samples = 1
repeat = 1
[[grid]]
name = "all"
scene = "{scene}"
recipe = "{technique}"
size = "{side}x{side}"
[[grid.axis]]
name = "scene"
values = ["half-plane", "contact"]
[[grid.axis]]
name = "technique"
values = ["none", "hard", { name = "tomorrow's", text = "hard,placement=tomorrow" }]
[[grid.axis]]
name = "side"
values = [8, 16]
[[plot]]
x = "side"
y = "rmse"
by = "technique"
)";

/// What does not depend on the machine's mood: key, status, errors, bytes.
std::vector<std::string> figures_of(const std::string& path) {
    std::vector<std::string> figures;
    SweepStore store(path);
    for (const SweepRow& row : store.rows()) {
        figures.push_back(row.key + " " + row.status);
        if (!row.document.empty()) {
            const json document = json::parse(row.document);
            figures.back() += document.at("error").dump() + document.at("memory").dump();
        }
    }
    return figures;
}

/// A whole run of the small sweep, made once.
class SweepCommand : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = new ScratchFolder;
        folder_->write("small.toml", twelve_runs);
        whole_ = new CommandResult(run_gnomon(
            {"sweep", *folder_ / "small.toml", "-o", *folder_ / "whole.sqlite", "--report", *folder_ / "report"}));
    }
    static void TearDownTestSuite() {
        delete folder_;
        delete whole_;
    }
    static ScratchFolder* folder_;
    static CommandResult* whole_;
};
ScratchFolder* SweepCommand::folder_ = nullptr;
CommandResult* SweepCommand::whole_ = nullptr;

TEST_F(SweepCommand, MeasuresEveryRunAndNamesWhatIsAbsent) {
    EXPECT_EQ(whole_->status, 0) << whole_->err;
    expect_has(whole_->out, {"12 runs measured now", "4 absent", "8 ok", "12 of 12 finished"});
    // What is not there is said once, with its reason, and stands in the file.
    expect_has(whole_->err, {"hard,placement=tomorrow absent", "'tomorrow'"});
    EXPECT_EQ(std::count(whole_->err.begin(), whole_->err.end(), '\n'), 1) << whole_->err;
    EXPECT_EQ(figures_of(*folder_ / "whole.sqlite").size(), 12U);
    // The page is whole, and the table has a line a run.
    const std::string page = file_text(*folder_ / "report/index.html");
    expect_has(page, {"Twelve runs", "tomorrow's", "\"rmse\""});
    EXPECT_EQ(page.find("{{"), std::string::npos);
    const std::string table = file_text(*folder_ / "report/runs.csv");
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 13);
    expect_has(table, {"grid,scene,technique,side,", ",absent,", "rmse"});
}

TEST_F(SweepCommand, LosesAndDoublesNothingWhenItIsKilled) {
    const std::string path = *folder_ / "killed.sqlite";
    const int kills = test::thorough() ? 20 : 5;
    std::size_t before = 0;
    for (int i = 0; i < kills; ++i) {
        RunningCommand running({"sweep", *folder_ / "small.toml", "-o", path});
        std::this_thread::sleep_for(std::chrono::milliseconds(60 + (i * 389) % 700));
        running.signal(SIGKILL);
        running.wait();
        if (std::filesystem::exists(path) && std::filesystem::file_size(path) > 0) {
            const std::size_t now = figures_of(path).size();
            EXPECT_GE(now, before);
            before = now;
        }
    }
    const CommandResult last = run_gnomon({"sweep", *folder_ / "small.toml", "-o", path});
    EXPECT_EQ(last.status, 0) << last.err;
    EXPECT_EQ(figures_of(path), figures_of(*folder_ / "whole.sqlite"));
    // Asked once more, it measures only what was absent.
    expect_has(run_gnomon({"sweep", *folder_ / "small.toml", "-o", path}).out, {"4 runs measured now, 4 absent"});
}

TEST_F(SweepCommand, FourPartsMergedAreOneRunsRows) {
    // The parts are those of the job file that is shipped for arrays of jobs.
    const std::filesystem::path script = std::filesystem::path(GNOMON_SOURCE) / "examples/slurm/sweep_array.sh";
    const auto part = [&](const std::string& i) {
        const std::string command = "SLURM_ARRAY_TASK_COUNT=4 SLURM_ARRAY_TASK_ID=" + i +
                                    " GNOMON=" + gnomon_executable() + " " + script.string() + " " +
                                    (*folder_ / "small.toml") + " " + (*folder_ / "parts") + " > /dev/null 2>&1";
        return std::system(command.c_str());
    };
    Words merge{"merge", "-o", *folder_ / "merged.sqlite"};
    std::size_t rows = 0;
    for (const char* i : {"1", "2", "3", "4"}) {
        ASSERT_EQ(part(i), 0) << i;
        merge.push_back(*folder_ / ("parts/part-" + std::string(i) + ".sqlite"));
        rows += figures_of(merge.back()).size();
    }
    EXPECT_EQ(rows, 12U) << "no run is in two parts";
    const CommandResult merged = run_gnomon(merge);
    EXPECT_EQ(merged.status, 0) << merged.err;
    expect_has(merged.out, {"12 runs of 4 files"});
    EXPECT_EQ(figures_of(*folder_ / "merged.sqlite"), figures_of(*folder_ / "whole.sqlite"));
    // What is there already is not replaced.
    EXPECT_EQ(run_gnomon(merge).status, 2);
}

TEST_F(SweepCommand, AnArrayOfJobsUnderSlurmIsOneRunsRows) {
    if (!test::thorough()) {
        GTEST_SKIP() << "skipped: a scheduler takes its time; make measure asks Slurm";
    }
    if (std::system("command -v sbatch > /dev/null 2>&1 && sinfo -h -o %a 2> /dev/null | grep -q up") != 0) {
        GTEST_SKIP()
            << "skipped: no Slurm is running here (slurm-wlm with one node would do); the job file itself is run "
               "by FourPartsMergedAreOneRunsRows";
    }
    const std::filesystem::path script = std::filesystem::path(GNOMON_SOURCE) / "examples/slurm/sweep_array.sh";
    const std::string command = "sbatch --wait --array=1-4 --chdir=" + (*folder_ / "") +
                                " --export=ALL,GNOMON=" + gnomon_executable() + " " + script.string() + " " +
                                (*folder_ / "small.toml") + " " + (*folder_ / "jobs") + " > /dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
    Words merge{"merge", "-o", *folder_ / "jobs.sqlite"};
    for (const char* i : {"1", "2", "3", "4"}) {
        merge.push_back(*folder_ / ("jobs/part-" + std::string(i) + ".sqlite"));
    }
    EXPECT_EQ(run_gnomon(merge).status, 0);
    EXPECT_EQ(figures_of(*folder_ / "jobs.sqlite"), figures_of(*folder_ / "whole.sqlite"));
}

TEST_F(SweepCommand, PlansInRunsHoursAndBytes) {
    const std::string path = *folder_ / "planned.sqlite";
    const CommandResult before = run_gnomon({"sweep", *folder_ / "small.toml", "-o", path, "--plan"});
    EXPECT_EQ(before.status, 0) << before.err;
    expect_has(before.out, {"12 runs on 4 views", "2 scene x 3 technique x 2 side", "absent: hard,placement=tomorrow",
                            "0 finished, 12 left", "--limit"});
    EXPECT_FALSE(std::filesystem::exists(path)) << "a plan touches nothing";
    expect_has(run_gnomon({"sweep", *folder_ / "small.toml", "-o", path, "--limit", "5"}).out,
               {"5 runs measured now", "left; the same command goes on"});
    expect_has(run_gnomon({"sweep", *folder_ / "small.toml", "-o", path, "--plan"}).out,
               {"5 finished, 7 left", "hours", "in the file when all is done"});
    expect_has(run_gnomon({"sweep", "sambeek-performance", "--plan", "-o", *folder_ / "none.sqlite"}).out,
               {"7056 runs on 588 views"});
}

TEST_F(SweepCommand, MisuseIsASentence) {
    const auto misuse = [&](Words words, const Words& parts) {
        const CommandResult result = run_gnomon(words);
        EXPECT_EQ(result.status, 2) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        expect_has(result.err, parts);
    };
    misuse({"sweep", "sambek-quality"}, {"did you mean 'sambeek-quality'"});
    misuse({"sweep", *folder_ / "nowhere.toml"}, {"nowhere.toml"});
    misuse({"sweep", *folder_ / "small.toml", "--shard", "5/4"}, {"--shard", "2/4"});
    misuse({"sweep", *folder_ / "small.toml", "-o", *folder_ / "no/where.sqlite"}, {"does not exist"});
    misuse({"sweep", *folder_ / "small.toml", "-o", *folder_ / "small.toml"}, {"small.toml"});
    misuse({"merge", *folder_ / "nowhere.sqlite", "-o", *folder_ / "x.sqlite"}, {"nowhere.sqlite"});
    EXPECT_EQ(file_text(*folder_ / "small.toml"), twelve_runs);
}

TEST(Compare, HoldsPicturesAgainstLightShadedByAllOfTheArea) {
    const auto shaded = [](const std::string& scene) {
        const CommandResult result = run_gnomon({"compare", scene, "-r", "none", "--size", "48x32", "--samples", "64",
                                                 "--repeat", "1", "--reference", "shaded", "--json", "-"});
        EXPECT_EQ(result.status, 0) << result.err;
        const json run = json::parse(result.out).at("runs").at(0);
        return std::pair(run.at("error").at("luma_rms").get<double>(), run.at("shaded").at("luma_rms").get<double>());
    };
    // A light without extent is shaded alike both ways; a wide one is not.
    const auto [usual_point, area_point] = shaded("contact:light=point");
    EXPECT_NEAR(usual_point, area_point, 0.02) << "8-bit luma; rounding of the integral";
    // Three lights of 1.5 m just above a box: 13.5 and 14.3.
    const auto [usual, area] = shaded("disco-box:size=1.5");
    EXPECT_GT(std::abs(usual - area), 0.5);
    // Unasked, the figure is not there.
    const CommandResult unasked = run_gnomon(
        {"compare", "half-plane", "-r", "none", "--size", "8x8", "--samples", "1", "--repeat", "1", "--json", "-"});
    EXPECT_FALSE(json::parse(unasked.out).at("runs").at(0).contains("shaded"));
}

}  // namespace
}  // namespace gn::sweep_command_test
