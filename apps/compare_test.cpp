// SPDX-License-Identifier: MIT
// gnomon compare and render from outside: the schema, the figures' sense, refusals, resuming, stopping.
#include "apps/subprocess_test.h"
#include "base/paths.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace gn::compare_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

/// Serves every light but suns: maps that are kept over frames need stable windows.
const std::string no_sun = "hard,placement=cascades,cascades.scroll=1,cascades.fit=plain,resolution=256";

/// Small enough for a software driver.
Words small(Words arguments) {
    for (const char* word : {"--size", "96x64", "--samples", "16", "--repeat", "1"}) {
        arguments.emplace_back(word);
    }
    return arguments;
}

/// Validates against apps/schema/compare.schema.json with Python's jsonschema.
void expect_valid(const json& document) {
    const ScratchFolder folder;
    folder.write("document.json", document.dump());
    const std::string script =
        "import json, sys, jsonschema; jsonschema.validate(*[json.load(open(p)) for p in sys.argv[1:]])";
    const std::string command = "python3 -W ignore -c '" + script + "' '" + (folder / "document.json") + "' '" +
                                (data_root() / "apps/schema/compare.schema.json").string() + "' > '" +
                                (folder / "said") + "' 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << file_text(folder / "said");
}

const json& run_of(const json& document, const std::string& recipe) {
    for (const json& run : document.at("runs")) {
        if (run.at("recipe") == recipe) {
            return run;
        }
    }
    throw std::runtime_error("no run of " + recipe);
}

TEST(Compare, JsonIsAloneOnStandardOutputAndFollowsTheSchema) {
    const CommandResult result =
        run_gnomon(small({"compare", "slab", "-r", "none", "hard", "--validate", "--json", "-"}));
    ASSERT_EQ(result.status, 0) << result.err;
    const json document = json::parse(result.out);
    expect_valid(document);
    ASSERT_EQ(document.at("runs").size(), 2U);
    // A shadow map is nearer to the truth than no shadow, costs time and takes its texels' memory.
    const json &none = run_of(document, "none"), &hard = run_of(document, "hard");
    EXPECT_LT(hard.at("error").at("rmse").get<double>(), none.at("error").at("rmse").get<double>());
    EXPECT_GT(none.at("error").at("leak").get<double>(), 0.5);
    EXPECT_EQ(none.at("error").at("acne").get<double>(), 0.0);
    EXPECT_EQ(none.at("memory").at("bytes").get<std::uint64_t>() < hard.at("memory").at("bytes").get<std::uint64_t>(),
              true);
    EXPECT_GE(hard.at("memory").at("bytes").get<std::uint64_t>(), 1024U * 1024U * 4U);
    EXPECT_LE(hard.at("time_ms").at("shadow").at("median").get<double>(),
              hard.at("time_ms").at("frame").at("median").get<double>());
    EXPECT_EQ(hard.at("size"), json({96, 64}));
    EXPECT_GT(hard.at("samples").get<int>(), 1000);
}

TEST(Compare, FiguresWeightedByLightStandBesideThePlainOnes) {
    // A lamp a millimetre above a floor: nearly all samples get next to none of its light.
    const ScratchFolder folder;
    folder.write("lamp.obj",
                 "v -5 0 -5\nv -5 0 5\nv 5 0 5\nv 5 0 -5\nv 0.3 0 -5\nv 0.3 0 5\nv 0.3 1 5\nv 0.3 1 -5\n"
                 "f 1 2 3 4\nf 5 6 7 8\n");
    folder.write("lamp.toml",
                 "[[file]]\npath = 'lamp.obj'\n[[camera]]\nposition = [0.5, 2.5, 0.1]\nlook_at = [0.4, 0, 0]\n"
                 "[[light]]\nkind = 'point'\nposition = [0, 0.001, 0]\nintensity = 100\n");
    const CommandResult result =
        run_gnomon(small({"compare", folder / "lamp.toml", "-r", "none", "volumes", "--json", "-"}));
    ASSERT_EQ(result.status, 0) << result.err;
    const json document = json::parse(result.out);
    expect_valid(document);
    for (const json& run : document.at("runs")) {
        for (const char* name : {"rmse", "mae", "mismatch", "leak", "acne", "penumbra"}) {
            ASSERT_TRUE(run.at("weighted").contains(name)) << name;
            EXPECT_EQ(run.at("weighted").at(name), run.at("lights").at(0).at("weighted").at(name)) << name;
        }
        EXPECT_TRUE(run.at("weighted").at("penumbra").is_null()) << "a lamp without size has no penumbra";
    }
    // Behind the wall no light is missed that anybody could see: illuminance falls with the cube of the distance, so that
    // all samples beyond 0.3 m together get less than a thousandth of what those within centimetres of the lamp get.
    const json& none = run_of(document, "none");
    EXPECT_GT(none.at("error").at("rmse").get<double>(), 0.05);
    EXPECT_LT(none.at("weighted").at("rmse").get<double>(), std::sqrt(1e-3));
    EXPECT_EQ(none.at("weighted").at("leak").get<double>(), 1.0);
}

TEST(Compare, OverridesReachTheRecipe) {
    const CommandResult result = run_gnomon(small({"compare", "slab", "-r", "hard,resolution=256", "--json", "-"}));
    ASSERT_EQ(result.status, 0) << result.err;
    const json run = json::parse(result.out).at("runs").at(0);
    EXPECT_EQ(run.at("overrides"), "resolution=256");
    bool found = false;
    for (const json& resource : run.at("memory").at("resources")) {
        found = found || resource.at("bytes") == 256 * 256 * 4;
    }
    EXPECT_TRUE(found) << run.at("memory").dump();
}

TEST(Compare, WritesAReportWhosePicturesAreThere) {
    const ScratchFolder folder;
    const CommandResult result = run_gnomon(small({"compare", "slab", "-r", "hard", "-o", folder / "report"}));
    ASSERT_EQ(result.status, 0) << result.err;
    expect_has(result.out, {"rmse"});
    // Take the data out of the page as a browser does.
    const std::string page = file_text(folder / "report/index.html");
    const std::string mark = "<script type=\"application/json\" id=\"data\">";
    const std::size_t begin = page.find(mark) + mark.size();
    const json data = json::parse(page.substr(begin, page.find("</script>", begin) - begin));
    ASSERT_EQ(data.at("runs").at(0).at("inside").size(), 6U);
    for (const json& shown : data.at("runs").at(0).at("inside")) {
        EXPECT_TRUE(file_text(folder / ("report/" + shown.at("picture").get<std::string>())).starts_with("\x89PNG"));
    }
    for (const std::string& name : {data.at("runs").at(0).at("picture").get<std::string>(),
                                    data.at("runs").at(0).at("error_map").get<std::string>(),
                                    data.at("scenes").at(0).at("reference").at("picture").get<std::string>()}) {
        EXPECT_TRUE(file_text(folder / ("report/" + name)).starts_with("\x89PNG")) << name;
    }
    EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org/")) << "the page loads something from a network";
    EXPECT_EQ(page.find("https://"), std::string::npos);
    EXPECT_EQ(page.find("{{"), std::string::npos);
}

TEST(Compare, APathFillsFlicker) {
    // Without a path the value is null; the corridor's first path is meant where none is named.
    const CommandResult plain = run_gnomon(small({"compare", "corridor", "-r", "hard", "--json", "-"}));
    ASSERT_EQ(plain.status, 0) << plain.err;
    EXPECT_TRUE(json::parse(plain.out).at("runs").at(0).at("error").at("flicker").is_null());
    const ScratchFolder folder;
    const std::string file = folder / "figures.json";
    const CommandResult walked = run_gnomon({"compare", "corridor", "--path", "-r", "hard,resolution=256", "-r", "none",
                                             "-r", "perceptual,resolution=512", "--size", "160x90", "--samples", "1",
                                             "--repeat", "1", "--json", file});
    ASSERT_EQ(walked.status, 0) << walked.err;
    expect_has(walked.out, {"flicker", "path rmse"});
    const json document = json::parse(file_text(file));
    expect_valid(document);
    // A map fitted to the view flickers as the view moves; no shadow at all cannot.
    EXPECT_GT(run_of(document, "hard").at("error").at("flicker").get<double>(), 0.001);
    EXPECT_EQ(run_of(document, "none").at("error").at("flicker").get<double>(), 0.0);
    EXPECT_EQ(run_of(document, "hard").at("lights").at(0).at("error").at("flicker"),
              run_of(document, "hard").at("error").at("flicker"));
    // What a placement that chooses its resolution drew in each frame, which grows and shrinks by a quarter at most.
    EXPECT_FALSE(run_of(document, "hard").at("lights").at(0).contains("path_texels"));
    const json& drawn = run_of(document, "perceptual").at("lights").at(0).at("path_texels");
    EXPECT_GT(drawn.size(), 10U);
    for (std::size_t k = 0; k < drawn.size(); ++k) {
        for (int axis = 0; axis < 2; ++axis) {
            const int texels = drawn.at(k).at(axis);
            EXPECT_TRUE(texels >= 16 && texels <= 512) << texels;
            const int before = drawn.at(k > 0 ? k - 1 : k).at(axis);
            EXPECT_LE(std::abs(texels - before), std::max(8.0, 0.25 * before)) << k;
        }
    }
}

TEST(Compare, TheErrorAlongAPathIsThatOfAllItsFrames) {
    // Two frames that are views as well, of unlike errors: their samples count alike.
    const ScratchFolder folder;
    folder.write("wall.obj",
                 "v -5 0 -5\nv -5 0 5\nv 5 0 5\nv 5 0 -5\nv 1 0 -2\nv 1 0 2\nv 1 1 2\nv 1 1 -2\n"
                 "f 1 2 3 4\nf 5 6 7 8\n");
    const std::string high = "position = [0, 9, 0.1]\nlook_at = [0, 0, 0]\n";
    const std::string low = "position = [4, 3, 0.1]\nlook_at = [2, 0, 0]\n";
    folder.write("wall.toml", "[[file]]\npath = 'wall.obj'\n[[camera]]\nname = 'high'\n" + high +
                                  "[[camera]]\nname = 'low'\n" + low +
                                  "[[light]]\nkind = 'point'\nposition = [0, 2, 0]\nintensity = 100\n"
                                  "[[path]]\nname = 'both'\n[[path.key]]\n" +
                                  high + "[[path.key]]\nframe = 1\n" + low);
    const auto measured = [&](const std::vector<std::string>& more) {
        std::vector<std::string> command{"compare", folder / "wall.toml", "-r", "hard,resolution=16", "--json", "-"};
        command.insert(command.end(), more.begin(), more.end());
        const CommandResult result = run_gnomon(small(command));
        EXPECT_EQ(result.status, 0) << result.err;
        return json::parse(result.out).at("runs").at(0);
    };
    double samples = 0;
    double squares = 0;
    std::vector<double> alone;
    for (const char* view : {"high", "low"}) {
        const json run = measured({"--view", view});
        EXPECT_TRUE(run.at("error").at("path_rmse").is_null());
        alone.push_back(run.at("error").at("rmse"));
        samples += run.at("samples").get<double>();
        squares += run.at("samples").get<double>() * alone.back() * alone.back();
    }
    const json along = measured({"--path", "both"});
    EXPECT_NEAR(along.at("error").at("path_rmse").get<double>(), std::sqrt(squares / samples), 1e-6);
    EXPECT_EQ(along.at("lights").at(0).at("error").at("path_rmse"), along.at("error").at("path_rmse"));
    EXPECT_GT(std::abs(alone[0] - alone[1]), 0.01) << "one frame for both would be seen";
}

TEST(Compare, AgainstAnotherRecipeIsADistanceOfItsOwn) {
    // On a software device both frames of one recipe are the same to the bit.
    const ScratchFolder folder;
    const auto compared = [&](const std::string& against) {
        const CommandResult result = run_gnomon(small({"compare", "slab", "-r", "none", "hard", "--against", against,
                                                       "-o", folder / "report", "--json", folder / "figures.json"}));
        EXPECT_EQ(result.status, 0) << result.err;
        expect_has(result.out, {"against"});
        const json document = json::parse(file_text(folder / "figures.json"));
        expect_valid(document);
        return document;
    };
    const json to_hard = compared("hard");
    EXPECT_EQ(run_of(to_hard, "hard").at("error").at("against"), 0.0);
    EXPECT_EQ(run_of(to_hard, "hard").at("error").at("against_mean"), 0.0);
    // Without shadows V is 1, so T - A is 1 wherever the map says dark: its mean square is its mean.
    const json& none = run_of(to_hard, "none").at("error");
    EXPECT_GT(none.at("against_mean").get<double>(), 0.05);
    EXPECT_NEAR(none.at("against").get<double>(), std::sqrt(none.at("against_mean").get<double>()), 1e-6);
    EXPECT_EQ(none.at("against"), run_of(to_hard, "none").at("lights").at(0).at("error").at("against"));
    // Results of one comparison are not those of another: the other way round the sign turns.
    const json to_none = compared("none");
    EXPECT_EQ(run_of(to_none, "none").at("error").at("against"), 0.0);
    EXPECT_EQ(run_of(to_none, "hard").at("error").at("against"), none.at("against"));
    EXPECT_EQ(run_of(to_none, "hard").at("error").at("against_mean").get<double>(),
              -none.at("against_mean").get<double>());
    EXPECT_EQ(run_of(to_none, "hard").at("error").at("rmse"), run_of(to_hard, "hard").at("error").at("rmse"));
}

TEST(Compare, AgainstLeavesOutLightsThatTheOtherRecipeRefuses) {
    const CommandResult result =
        run_gnomon(small({"compare", "courtyard", "-r", "hard", "--against", no_sun, "--json", "-"}));
    ASSERT_EQ(result.status, 0) << result.err;
    expect_has(result.err, {"'against' leaves light 'sun' out"});
    const json document = json::parse(result.out);
    expect_valid(document);
    for (const json& light : document.at("runs").at(0).at("lights")) {
        EXPECT_EQ(light.at("status"), "ok");
        EXPECT_EQ(light.at("error").at("against").is_null(), light.at("name") == "sun");
    }
    EXPECT_TRUE(document.at("runs").at(0).at("error").at("against").is_number());
    // Without the option there is nothing to tell.
    const json plain = json::parse(run_gnomon(small({"compare", "slab", "-r", "hard", "--json", "-"})).out);
    EXPECT_TRUE(plain.at("runs").at(0).at("error").at("against").is_null());
}

TEST(Compare, AgainstAnUnknownRecipeIsOneSentence) {
    for (const char* against : {"pfc", "pcf,pcf.kernal=3", "slab"}) {
        const CommandResult result =
            run_gnomon(small({"compare", "slab", "-r", "hard", "--against", against, "--json", "-"}));
        EXPECT_EQ(result.status, 2) << against;
        EXPECT_EQ(result.out, "");
        expect_has(result.err, {"--against", std::string(against).substr(0, 3)});
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
}

TEST(Compare, SelfShadowIsToldFromTheRimsOfShadows) {
    const std::string no_bias = "bias.constant=0,bias.normal=0,bias.receiver_plane=0,bias.cone=0";
    const auto errors = [](const std::string& scene, const std::string& recipe) {
        const CommandResult result = run_gnomon(
            {"compare", scene, "-r", recipe, "--size", "240x135", "--samples", "1", "--repeat", "1", "--json", "-"});
        EXPECT_EQ(result.status, 0) << result.err;
        return json::parse(result.out).at("runs").at(0).at("error");
    };
    // Half of an unbiased plane shadows itself, and nothing else is there; the default bias leaves nothing.
    const json plane = errors("tilted:angle=60", "hard,resolution=256," + no_bias);
    EXPECT_GT(plane.at("self_shadow").get<double>(), 0.4);
    EXPECT_EQ(plane.at("self_shadow"), plane.at("acne"));
    EXPECT_LT(errors("tilted:angle=60", "hard,resolution=256").at("self_shadow").get<double>(), 1e-3);
    // Coarse texels put shadow on the lit side of a box's edges: false, but none of it its own.
    const json box = errors("contact", "pcf,resolution=256");
    EXPECT_GT(box.at("acne").get<double>(), 0.004);
    EXPECT_LT(box.at("self_shadow").get<double>(), 0.1 * box.at("acne").get<double>());
    // Where no map is looked up nobody can say, nor where a filter spreads V over the screen.
    const json unmapped = errors("contact", "volumes");
    EXPECT_TRUE(unmapped.at("self_shadow").is_null());
    // Without a map there is no texel to be judged either; the coarse one above has many.
    EXPECT_TRUE(unmapped.at("undersampled").is_null());
    EXPECT_TRUE(unmapped.at("undersampling").is_null());
    EXPECT_GT(box.at("undersampled").get<double>(), 0.0);
    EXPECT_GT(box.at("undersampling").get<double>(), 0.0);
    EXPECT_TRUE(errors("contact", "pcf-bilateral,resolution=256").at("self_shadow").is_null());
}

TEST(Compare, AnUnknownPathIsRefusedWithTheKnownOnes) {
    for (const auto& [scene, words] : {std::pair<std::string, Words>{"corridor", {"'stroll'", "walk"}},
                                       std::pair<std::string, Words>{"slab", {"no camera path"}}}) {
        const CommandResult result =
            run_gnomon(small({"compare", scene, "-r", "hard", "--path", "stroll", "--json", "-"}));
        EXPECT_EQ(result.status, 2) << scene;
        expect_has(result.err, words);
    }
}

TEST(Compare, TheSameCommandGoesOnWhereItStopped) {
    const ScratchFolder folder;
    const Words first =
        small({"compare", "slab", "-r", "hard", "-o", folder / "report", "--json", folder / "first.json"});
    const Words second =
        small({"compare", "slab", "-r", "hard", "none", "-o", folder / "report", "--json", folder / "second.json"});
    ASSERT_EQ(run_gnomon(first).status, 0);
    ASSERT_EQ(run_gnomon(second).status, 0);
    const json one = json::parse(file_text(folder / "first.json")),
               two = json::parse(file_text(folder / "second.json"));
    // A measured time never repeats to the last digit: equal ones were kept, the truth's included.
    EXPECT_EQ(one.at("runs").at(0), two.at("runs").at(0));
    EXPECT_EQ(one.at("reference").at("seconds"), two.at("reference").at("seconds"));
    EXPECT_EQ(two.at("runs").size(), 2U);
    // Asked for fresh figures, it measures: errors repeat, times do not.
    Words fresh = first;
    fresh.emplace_back("--fresh");
    ASSERT_EQ(run_gnomon(fresh).status, 0);
    const json three = json::parse(file_text(folder / "first.json"));
    EXPECT_EQ(one.at("runs").at(0).at("error"), three.at("runs").at(0).at("error"));
    EXPECT_NE(one.at("runs").at(0).at("time_ms"), three.at("runs").at(0).at("time_ms"));
}

TEST(Compare, ABadSceneLeavesTheOthersMeasured) {
    const ScratchFolder folder;
    folder.write("noise.glb", "glTF but not really");
    const CommandResult result =
        run_gnomon(small({"compare", folder / "noise.glb", "slab", "-r", "none", "--json", "-"}));
    EXPECT_EQ(result.status, 2);
    expect_has(result.err, {"noise.glb"});
    const json document = json::parse(result.out);
    expect_valid(document);
    EXPECT_EQ(document.at("runs").at(0).at("status"), "failed");
    EXPECT_TRUE(document.at("runs").at(0).at("error").at("rmse").is_null());
    EXPECT_EQ(document.at("runs").at(1).at("status"), "ok");
}

TEST(Compare, UnknownLightsListTheKnown) {
    const CommandResult result = run_gnomon(small({"compare", "slab", "-r", "none", "--light", "moon", "--json", "-"}));
    EXPECT_EQ(result.status, 2);
    expect_has(result.err, {"moon", "valid names are"});
}

TEST(Compare, RefusedIsNoFailureUnlessStrict) {
    const Words asked = small({"compare", "courtyard", "-r", no_sun, "--light", "sun", "--json", "-"});
    const CommandResult lenient = run_gnomon(asked);
    EXPECT_EQ(lenient.status, 0) << lenient.err;
    const json document = json::parse(lenient.out);
    expect_valid(document);
    const json& run = document.at("runs").at(0);
    EXPECT_EQ(run.at("status"), "refused");
    expect_has(run.at("reason").get<std::string>(), {"cascades.scroll", "stable"});
    EXPECT_EQ(run.at("lights").at(0).at("status"), "refused");
    EXPECT_TRUE(run.at("time_ms").at("shadow").at("median").is_null());
    Words strict = asked;
    strict.emplace_back("--strict");
    EXPECT_EQ(run_gnomon(strict).status, 1);
}

TEST(Compare, ARunThatServedSomeLightsSaysWhichItDidNot) {
    const ScratchFolder folder;
    const Words asked = small({"compare", "courtyard", "-r", no_sun, "--json", "-", "-o", folder / "report"});
    const CommandResult result = run_gnomon(asked);
    EXPECT_EQ(result.status, 0) << result.err;
    expect_has(result.err, {"light 'sun' refused", "cascades.scroll"});
    const json document = json::parse(result.out);
    expect_valid(document);
    const json& run = document.at("runs").at(0);
    EXPECT_EQ(run.at("status"), "ok");
    int samples = 0;
    for (const json& light : run.at("lights")) {
        const bool sun = light.at("name") == "sun";
        EXPECT_EQ(light.at("status"), sun ? "refused" : "ok");
        EXPECT_EQ(light.at("error").at("rmse").is_null(), sun);
        samples += light.at("samples").get<int>();
    }
    // Only the lights that were served are pooled.
    EXPECT_EQ(run.at("samples"), samples);
    // A run that is taken from the cache is judged like one that was just measured.
    Words strict = asked;
    strict.emplace_back("--strict");
    EXPECT_EQ(run_gnomon(strict).status, 1);
}

TEST(Compare, AStoppedComparisonKeepsWhatItHas) {
    const ScratchFolder folder;
    Words arguments = small({"compare", "slab", "-o", folder / "report", "--json", folder / "figures.json", "-r"});
    for (int resolution = 64; resolution < 264; ++resolution) {
        arguments.insert(arguments.end() - 6, "-r");
        arguments.insert(arguments.end() - 6, "hard,resolution=" + std::to_string(resolution));
    }
    arguments.erase(std::find(arguments.begin(), arguments.end(), "-r"));
    // Ask to stop once the first run is on disk.
    RunningCommand running(arguments);
    while (!running.finished() && !std::filesystem::exists(folder / "figures.json")) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    running.signal(SIGTERM);
    const CommandResult result = running.wait();
    EXPECT_EQ(result.status, 1) << result.err;
    expect_has(result.err, {"stopped"});
    const json document = json::parse(file_text(folder / "figures.json"));
    expect_valid(document);
    EXPECT_GE(document.at("runs").size(), 1U);
    EXPECT_LT(document.at("runs").size(), 200U);
    expect_has(file_text(folder / "report/index.html"), {"resolution=64"});
}

TEST(Render, WritesAPictureAndTheVisibilityOfEveryLight) {
    const ScratchFolder folder;
    const CommandResult result = run_gnomon({"render", "disco-box", "-r", "pcf", "--size", "96x64", "-o",
                                             folder / "out.png", "--visibility", folder / "v.exr", "--validate"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_TRUE(file_text(folder / "out.png").starts_with("\x89PNG"));
    const std::string layers = file_text(folder / "v.exr");
    EXPECT_TRUE(layers.starts_with("\x76\x2f\x31\x01"));
    expect_has(layers.substr(0, 400), {"V.0.", "V.2."});
}

TEST(Doctor, SaysWhatThisMachineCanDo) {
    const CommandResult result = run_gnomon({"doctor"});
    EXPECT_EQ(result.status, 0) << result.err;
    expect_has(result.out, {"recipes and shaders: ", "ruled out"});
}

}  // namespace
}  // namespace gn::compare_test
