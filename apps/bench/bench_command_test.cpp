// SPDX-License-Identifier: MIT
// gnomon bench from outside: a document that follows its schema, counts that follow from the scene, and misuse.
#include "apps/subprocess_test.h"
#include "base/paths.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>

namespace gn::bench_command_test {
namespace {

using nlohmann::json;

/// Validates against apps/schema/bench.schema.json with Python's jsonschema.
void expect_valid(const json& document) {
    const ScratchFolder folder;
    folder.write("document.json", document.dump());
    const std::string script =
        "import json, sys, jsonschema; jsonschema.validate(*[json.load(open(p)) for p in sys.argv[1:]])";
    const std::string command = "python3 -W ignore -c '" + script + "' '" + (folder / "document.json") + "' '" +
                                (data_root() / "apps/schema/bench.schema.json").string() + "' > '" + (folder / "said") +
                                "' 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << file_text(folder / "said");
}

const json& pass_of(const json& run, const std::string& name) {
    for (const json& pass : run.at("passes")) {
        if (pass.at("name") == name) {
            return pass;
        }
    }
    throw std::runtime_error("no pass " + name + " in " + run.dump());
}

TEST(BenchCommand, TimesCountsAndJudgesEveryPass) {
    // Maps that scroll need stable windows, which a plain fit is not.
    const ScratchFolder folder;
    const std::string refused = "hard,placement=cascades,cascades.scroll=1,cascades.fit=plain";
    const CommandResult result = run_gnomon({"bench", "contact", "-r", "hard,resolution=64", "-r", refused, "--size",
                                             "48x32", "--repeat", "2", "--json", folder / "bench.json"});
    ASSERT_EQ(result.status, 0) << result.err;
    expect_has(result.out, {"B/s", "madd/s", "fragments/s", "contact", "48x32", "hard,resolution=64: shadow ",
                            "waits for", "shadow/", "frame ", refused + ": refused: "});
    const json document = json::parse(file_text(folder / "bench.json"));
    expect_valid(document);
    // Probes are of this machine: nothing is free, and what does more takes longer.
    const json& rates = document.at("machine_ns");
    for (const char* rate : {"pass", "madd", "byte", "fragment", "sample"}) {
        EXPECT_GT(rates.at(rate).get<double>(), 0) << rate;
    }
    EXPECT_GT(rates.at("pass").get<double>(), rates.at("fragment").get<double>());
    ASSERT_EQ(document.at("runs").size(), 2U);
    const json &hard = document.at("runs").at(0), &none = document.at("runs").at(1);
    EXPECT_EQ(none.at("status"), "refused");
    EXPECT_NE(none.at("reason"), "");
    EXPECT_TRUE(none.at("frame_ms").is_null());
    // A frame is its passes.
    EXPECT_EQ(hard.at("status"), "ok");
    double frame = 0;
    for (const json& pass : hard.at("passes")) {
        frame += pass.at("ms").get<double>();
    }
    EXPECT_NEAR(hard.at("frame_ms").get<double>(), frame, 1e-9 + 1e-6 * frame);
    EXPECT_LE(hard.at("shadow_ms").get<double>(), frame);
    // A device that counts says so; one that does not says what, and has null for it.
    const json& shading = pass_of(hard, "shade");
    EXPECT_EQ(document.at("uncounted") == "", !shading.at("counts").is_null() && !shading.at("samples").is_null());
    if (!shading.at("counts").is_null()) {
        EXPECT_EQ(shading.at("counts").at("vertices"), 3);
        EXPECT_GE(shading.at("counts").at("fragments").get<int>(), 48 * 32);
    }
    // On standard output JSON is alone.
    const CommandResult piped = run_gnomon({"bench", "contact", "-r", refused, "--size", "8x8", "--json", "-"});
    EXPECT_EQ(json::parse(piped.out).at("runs").at(0).at("status"), "refused") << piped.err;
}

TEST(BenchCommand, MisuseIsASentence) {
    const auto misuse = [](const std::vector<std::string>& words, const std::vector<std::string>& parts) {
        const CommandResult result = run_gnomon(words);
        EXPECT_EQ(result.status, 2) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        expect_has(result.err, parts);
    };
    misuse({"bench", "courtyrd"}, {"courtyrd"});
    misuse({"bench", "contact", "-r", "hrad"}, {"-r hrad", "hard"});
    misuse({"bench", "contact", "--repeat", "0"}, {"--repeat"});
    misuse({"bench", "contact", "--json", "no/where.json"}, {"--json", "does not exist"});
    misuse({"bench", "contact", "--view", "nobody"}, {"nobody"});
}

}  // namespace
}  // namespace gn::bench_command_test
