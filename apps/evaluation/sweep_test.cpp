// SPDX-License-Identifier: MIT
// Grids, their parts, the store and what is foretold from it.
#include "apps/evaluation/limits.h"
#include "apps/evaluation/sweep_store.h"
#include "base/error.h"
#include "base/paths.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <set>
#include <sstream>

namespace gn::sweep_test {
namespace {

constexpr const char* small_sweep = R"(
title = "Small"
samples = 4
[[grid]]
name = "a"
scene = "grid:objects={objects}"
recipe = "{technique},resolution={side}"
size = "{side}x{side}"
[[grid.axis]]
name = "objects"
values = [1, 5, 10]
quick = [1]
[[grid.axis]]
name = "technique"
values = ["hard", { name = "PCF3", text = "pcf,pcf.kernel=3x3" }]
[[grid.axis]]
name = "side"
values = [25, 50]
[quick]
samples = 1
)";

std::string scratch(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / fmt::format("gnomon-{}", getpid());
    std::filesystem::create_directories(folder);
    std::filesystem::remove(folder / name);
    return folder / name;
}

std::string refusal(const std::string& text) {
    try {
        expand(parse_sweep(text, "x.toml", false), "x.toml");
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(Sweep, IsEveryCombinationOnce) {
    const auto runs = expand(parse_sweep(small_sweep, "x.toml", false), "x.toml");
    ASSERT_EQ(runs.size(), 3U * 2U * 2U);
    std::set<std::string> keys, asked;
    for (const SweepRun& run : runs) {
        keys.insert(run.key);
        asked.insert(fmt::format("{} {} {}", run.scene, run.recipe, run.width));
        EXPECT_EQ(run.samples, 4);
        EXPECT_EQ(run.width, run.height);
    }
    EXPECT_EQ(keys.size(), runs.size());
    EXPECT_TRUE(asked.count("grid:objects=5 pcf,pcf.kernel=3x3,resolution=50 50")) << testing::PrintToString(asked);
    // Runs of a view lie side by side.
    std::set<std::string> left;
    for (std::size_t i = 1; i < runs.size(); ++i) {
        if (runs[i].view_text() != runs[i - 1].view_text()) {
            EXPECT_TRUE(left.insert(runs[i - 1].view_text()).second);
            EXPECT_FALSE(left.count(runs[i].view_text()));
        }
    }
    EXPECT_EQ(expand(parse_sweep(small_sweep, "x.toml", true), "x.toml").size(), 4U);
}

TEST(Sweep, PartsAreDisjointAndWhole) {
    const auto runs = expand(parse_sweep(small_sweep, "x.toml", false), "x.toml");
    for (const int count : {1, 2, 4, 6, 7, 40}) {
        std::multiset<std::string> keys;
        for (int i = 1; i <= count; ++i) {
            for (const SweepRun& run : share_of(runs, {i, count})) {
                keys.insert(run.key);
            }
        }
        EXPECT_EQ(keys.size(), runs.size()) << count;
        EXPECT_EQ(std::set<std::string>(keys.begin(), keys.end()).size(), runs.size()) << count;
    }
    EXPECT_EQ(parse_shard("2/4").index, 2);
    for (const char* wrong : {"", "2", "0/4", "5/4", "1/0", "a/b", "1/4/2", "-1/4"}) {
        EXPECT_THROW(parse_shard(wrong), Error) << wrong;
    }
}

TEST(Sweep, MistakesAreSentencesThatNameWhatIsValid) {
    const std::string head = "[[grid]]\nscene = \"slab\"\n";
    const auto has = [](const std::string& sentence, const std::string& part) {
        EXPECT_NE(sentence.find(part), std::string::npos) << "'" << part << "' in: " << sentence;
    };
    has(refusal("grid = 3"), "grid");
    has(refusal("tilte = \"a\"\n" + head + "recipe = \"pcf\""), "did you mean 'title'");
    has(refusal(head), "recipe");
    has(refusal(head + "recipe = \"pcf,resolution={res}\""), "{res}");
    has(refusal(head + "recipe = \"pcf\"\n[[grid.axis]]\nname = \"a\"\nvalues = [1]"), "used nowhere");
    has(refusal(head + "recipe = \"pcf,resolution={a}\"\n[[grid.axis]]\nname = \"a\"\nvalues = []"), "values");
    has(refusal(head + "recipe = \"pcf,resolution={a}\"\n[[grid.axis]]\nname = \"a\"\nvalues = [1, 1]"), "twice");
    has(refusal(head + "recipe = \"pcf\"\nsize = \"12\""), "WIDTHxHEIGHT");
    has(refusal(head + "recipe = \"pcf\"\nsamples = 0"), "samples");
    has(refusal(head + "recipe = \"pcf\"\nreference = \"shady\""), "visibility, shaded");
    has(refusal("title = \n"), "line");
    has(refusal(head + "recipe = \"pcf\"\n[[plot]]\nx = \"rmse\"\nby = \"b\""), "no axis 'b'");
}

TEST(SweepStore, KeepsWhatWasMeasuredAndReplacesWhatWasAbsent) {
    const std::string path = scratch("a.sqlite");
    const SweepTitle title{"small", small_sweep, "1", false};
    {
        SweepStore store(path, title);
        EXPECT_TRUE(store.add({"k1", "v", "ok", "", "{}", 1.5, "d"}));
        EXPECT_FALSE(store.add({"k1", "v", "failed", "late", "", 1, "d"})) << "a measured run stays";
        EXPECT_TRUE(store.add({"k2", "v", "absent", "no such recipe", "", 0, "d"}));
        EXPECT_TRUE(store.add({"k2", "v", "ok", "", "{}", 2, "d"}))
            << "one that was absent is measured when it is there";
    }
    SweepStore again(path, title);
    const auto rows = again.rows();
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].status + rows[1].status, "okok");
    EXPECT_EQ(rows[0].seconds, 1.5);
    EXPECT_EQ(again.title(), title);
    // Another kind of file is refused and left as it is.
    const std::string other = scratch("b.sqlite");
    std::ofstream(other) << "not a database at all, but long enough to be looked at for a header";
    EXPECT_THROW(SweepStore(other, title), Error);
    EXPECT_THROW(SweepStore("nowhere.sqlite"), Error);
}

TEST(SweepStore, LosesAndDoublesNothingWhenItsWriterIsKilled) {
    const std::string path = scratch("killed.sqlite");
    const SweepTitle title{"small", small_sweep, "1", false};
    // A writer that says what it has written, killed at twenty moments; the next one goes on.
    std::set<std::string> said;
    for (int round = 0; round < 20; ++round) {
        int ends[2];
        ASSERT_EQ(pipe(ends), 0);
        const pid_t writer = fork();
        if (writer == 0) {
            close(ends[0]);
            SweepStore store(path, title);
            const std::string document(3000, 'x');
            for (std::uint32_t i = static_cast<std::uint32_t>(store.statuses().size()); i < 100'000; ++i) {
                const std::string key = fmt::format("{:08}", i);
                store.add({key, "v", "ok", "", document, 0.1, "d"});
                if (write(ends[1], key.data(), 8) != 8) {
                    _exit(1);
                }
            }
            _exit(0);
        }
        close(ends[1]);
        // After one to four rows, at a moment of its own.
        char key[8];
        for (int i = 0; i <= round % 4 && read(ends[0], key, 8) == 8; ++i) {
            EXPECT_TRUE(said.insert(std::string(key, 8)).second) << "written twice";
        }
        usleep(static_cast<useconds_t>(7'919 * round % 6'000));
        kill(writer, SIGKILL);
        int state = 0;
        ASSERT_EQ(waitpid(writer, &state, 0), writer);
        while (read(ends[0], key, 8) == 8) {
            EXPECT_TRUE(said.insert(std::string(key, 8)).second) << "written twice";
        }
        close(ends[0]);
        // All that was said is there; at most one more was written and not said any more.
        if (std::filesystem::exists(path) && std::filesystem::file_size(path) > 0) {
            SweepStore store(path, title);
            const auto there = store.statuses();
            for (const std::string& one : said) {
                EXPECT_TRUE(there.count(one)) << one;
            }
            EXPECT_LE(there.size(), said.size() + 1);
            for (const auto& [one, status] : there) {
                said.insert(one);
            }
        }
    }
    EXPECT_GT(said.size(), 20U);
    SweepStore store(path, title);
    for (const SweepRow& row : store.rows()) {
        EXPECT_EQ(row.document.size(), 3000U);
    }
}

TEST(SweepStore, FourPartsMergedAreOneRunsRows) {
    const auto runs = expand(parse_sweep(small_sweep, "x.toml", false), "x.toml");
    const SweepTitle title{"small", small_sweep, "1", false};
    const auto row_of = [](const SweepRun& run) { return SweepRow{run.key, "v", "ok", "", run.recipe, 1, "d"}; };
    std::vector<std::filesystem::path> parts;
    for (int i = 1; i <= 4; ++i) {
        parts.emplace_back(scratch(fmt::format("part{}.sqlite", i)));
        SweepStore store(parts.back(), title);
        for (const SweepRun& run : share_of(runs, {i, 4})) {
            store.add(row_of(run));
        }
    }
    const std::string whole = scratch("whole.sqlite"), merged = scratch("merged.sqlite");
    SweepStore one(whole, title);
    for (const SweepRun& run : runs) {
        one.add(row_of(run));
    }
    const Merged result = merge_stores(parts, merged);
    EXPECT_EQ(result.rows, runs.size());
    EXPECT_EQ(result.doubled, 0U);
    SweepStore all(merged);
    const auto a = all.rows(), b = one.rows();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].key + a[i].document, b[i].key + b[i].document);
    }
    EXPECT_THROW(merge_stores(parts, merged), Error) << "it is there already";
    SweepStore other(scratch("other.sqlite"), {"other", "x", "1", false});
    EXPECT_THROW(merge_stores({parts[0], other.path()}, scratch("never.sqlite")), Error);
    EXPECT_EQ(merge_stores({parts[0], parts[0]}, scratch("twice.sqlite")).doubled, share_of(runs, {1, 4}).size());
}

TEST(SweepStore, ForetellsFromTheMeanOfItsViews) {
    const auto runs = expand(parse_sweep(small_sweep, "x.toml", false), "x.toml");
    EXPECT_FALSE(estimate({}, runs).seconds.has_value()) << "nothing is foretold from nothing";
    // Two views of two runs each: means 1 and 3, eight runs left.
    std::vector<SweepRow> rows;
    for (std::size_t i = 0; i < 4; ++i) {
        rows.push_back({runs[i].key, i < 2 ? "u" : "v", "ok", "", std::string(100, 'x'), i < 2 ? 1.0 : 3.0, "d"});
    }
    const Estimate left = estimate(rows, runs);
    EXPECT_EQ(left.finished, 4U);
    EXPECT_EQ(left.left, 8U);
    EXPECT_DOUBLE_EQ(left.seconds.value(), 16.0);
    EXPECT_DOUBLE_EQ(left.deviation.value(), 8.0 * std::sqrt((4.0 + 4.0) * 2.0) / 4.0);
    EXPECT_GT(left.bytes.value(), 12 * 100.0);
    EXPECT_EQ(spoken_time(42.4), "42 s");
    EXPECT_EQ(spoken_time(600), "10 min");
    EXPECT_EQ(spoken_time(3 * 3600 + 600), "3 h 10 min");
}

TEST(Limits, AreThoseOfAPlantedTable) {
    // frame = 10 + objects * target / 1000 ms, so that 50 ms carry 40000 / target objects.
    std::vector<LimitSample> samples;
    for (const double target : {100.0, 400.0, 800.0}) {
        for (const double objects : {1.0, 10.0, 100.0, 200.0}) {
            samples.push_back({objects, target, 10 + objects * target / 1000});
        }
    }
    const Limits limits = limits_of(samples, 50);
    EXPECT_EQ(limits.most, 200.0) << "all that were tested";
    EXPECT_EQ(limits.most_at, 100.0);
    EXPECT_EQ(limits.at_largest, 50.0) << "interpolated between 10 and 100";
    EXPECT_EQ(limits.largest, 800.0);
    EXPECT_EQ(most_objects(samples, 400, 50), 100.0);
    EXPECT_FALSE(most_objects(samples, 400, 5).has_value()) << "not even one object";
}

TEST(Limits, TheMostIsAtTheLargestTargetThatStillCarriesIt) {
    // Three targets carry all 200; the largest of them is the limit.
    std::vector<LimitSample> samples;
    for (const double target : {25.0, 100.0, 400.0, 800.0}) {
        for (const double objects : {1.0, 200.0}) {
            samples.push_back({objects, target, objects * target / 2000});
        }
    }
    const Limits limits = limits_of(samples, 50);
    EXPECT_EQ(limits.most, 200.0);
    EXPECT_EQ(limits.most_at, 400.0) << "200 at 25, at 100 and at 400";
    EXPECT_NEAR(*limits.at_largest, 125.0, 1) << "0.4 ms an object";
}

TEST(ShippedSweeps, AreReadable) {
    std::map<std::string, std::size_t> sizes;
    for (const auto& entry : std::filesystem::directory_iterator(data_root() / "sweeps")) {
        if (entry.path().extension() != ".toml") {
            continue;
        }
        std::stringstream text;
        text << std::ifstream(entry.path()).rdbuf();
        const std::string name = entry.path().stem();
        sizes[name] = expand(parse_sweep(text.str(), name, false), name).size();
        EXPECT_FALSE(parse_sweep(text.str(), name, false).title.empty()) << name;
        const std::size_t quick = expand(parse_sweep(text.str(), name, true), name).size();
        EXPECT_LE(quick, 120U) << name;
        EXPECT_GT(quick, 0U) << name;
    }
    // [Sam07] section 4.1.1: 588 scenes, 12 variants.
    EXPECT_EQ(sizes["sambeek-performance"], 588U * 12U);
    EXPECT_EQ(sizes["sambeek-limits"], 140U * 12U) << "one and three lights, targets to 300";
    EXPECT_EQ(sizes.size(), 6U) << testing::PrintToString(sizes);
}

}  // namespace
}  // namespace gn::sweep_test
