// SPDX-License-Identifier: MIT
// The command line's contract: exit statuses, sentences, lists and manual pages.
#include "apps/subprocess_test.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <regex>

namespace gn::command_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

/// A misuse: status 2, nothing on standard output, one sentence on standard error that has all of `parts`.
void expect_misuse(const Words& arguments, const Words& parts) {
    const CommandResult result = run_gnomon(arguments);
    const std::string asked = testing::PrintToString(arguments);
    EXPECT_EQ(result.status, 2) << asked << result.err;
    EXPECT_EQ(result.out, "") << asked;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << asked << result.err;
    EXPECT_TRUE(result.err.starts_with("gnomon: ")) << asked << result.err;
    expect_has(result.err, parts);
}

TEST(CommandLine, MisuseIsOneSentenceThatNamesWhatIsValid) {
    expect_misuse({"rendr"}, {"'rendr'", "did you mean 'render'", "compare"});
    expect_misuse({"list", "part"}, {"'part'", "parts, recipes, scenes, metrics"});
    expect_misuse({"list", "parts", "recipes"}, {"'recipes'"});
    expect_misuse({"show"}, {"ID"});
    expect_misuse({"show", "pfc"}, {"'pfc'", "did you mean 'pcf'", "volumes"});
    expect_misuse({"render"}, {"SCENE"});
    expect_misuse({"compare"}, {"SCENE"});
    expect_misuse({"compare", "slab", "-r", "hard", "--sampels", "3"}, {"'--sampels'", "did you mean '--samples'"});
    expect_misuse({"compare", "slab", "-r", "hard", "--samples", "0"}, {"--samples"});
    expect_misuse({"compare", "slab", "-r", "hard", "--samples", "many"}, {"--samples"});
    expect_misuse({"compare", "slab", "-r", "hard", "--repeat", "-1"}, {"--repeat"});
}

TEST(CommandLine, WithoutARecipeItTakesThoseThatNeedNoTuning) {
    const CommandResult compared =
        run_gnomon({"compare", "half-plane", "--size", "16x12", "--samples", "1", "--repeat", "1", "--json", "-"});
    ASSERT_EQ(compared.status, 0) << compared.err;
    std::string names;
    const json figures = json::parse(compared.out);
    for (const json& run : figures.at("runs")) {
        names += run.at("recipe").get<std::string>() + " " + run.at("status").get<std::string>() + " ";
    }
    EXPECT_EQ(names, "soft ok soft-quality ok pcf ok hard ok ");
    expect_has(run_gnomon({"render", "--help"}).out, {"default: soft)"});
}

TEST(CommandLine, AloneItPrintsItsHelp) {
    const CommandResult alone = run_gnomon({});
    EXPECT_EQ(alone.status, 0);
    EXPECT_EQ(alone.err, "");
    EXPECT_EQ(alone.out, run_gnomon({"--help"}).out);
    expect_has(alone.out, {"list", "show", "render", "compare", "doctor", "Examples:"});
}

TEST(CommandLine, KeysThatARecipeCannotUseAreNamed) {
    // Direct parts have no placement, no map and no bias; `forward` and `auto` are the exceptions.
    expect_misuse({"compare", "nowhere", "-r", "volumes,placement=cascades,bias.normal=9"},
                  {"-r volumes", "placement", "bias.normal", "volumes"});
    expect_misuse({"compare", "nowhere", "-r", "none,resolution=64"}, {"resolution", "none"});
    expect_misuse({"compare", "nowhere", "-r", "planar,casters=front"}, {"casters", "planar"});
    expect_misuse({"compare", "nowhere", "-r", "forward,bias.cone=1"}, {"bias.cone", "forward"});
    // Parameters belong to the parts that the recipe has in the end, wherever they stand.
    expect_misuse({"compare", "nowhere", "-r", "pcf,filtered.radius=3"}, {"filtered.radius", "pcf"});
    expect_misuse({"compare", "nowhere", "-r", "pcf,cascades.count=3"}, {"cascades.count", "fit", "cube"});
    expect_misuse({"compare", "nowhere", "-r", "hard,vsm.radius=3"}, {"vsm.radius", "depth"});
    for (const char* sound :
         {"volumes,placement=auto", "forward,placement=paraboloid,resolution=256", "pcf,cube.resolution=coverage",
          "pcf,cascades.count=3,placement=cascades", "pcf,placement=cascades,cube.resolution=coverage",
          "hard,vsm.radius=3,map=vsm,lookup=filtered", "volumes,map=depth,lookup=pcf,pcf.size=5,bias.normal=1"}) {
        expect_misuse({"compare", "nowhere", "-r", sound}, {"nowhere", "courtyard"});
    }
}

TEST(CommandLine, RecipeFilesNameOnlyWhatTheyUse) {
    const ScratchFolder folder;
    folder.write("mine.toml", "direct = \"volumes\"\n[bias]\nnormal = 2\n");
    expect_misuse({"compare", "nowhere", "-r", folder / "mine.toml"}, {"mine.toml", "bias.normal"});
    // What an override replaces may have had parameters in the file.
    folder.write("mine.toml", "map = \"depth\"\nlookup = \"pcf\"\n[pcf]\nsize = 5\n");
    expect_misuse({"compare", "nowhere", "-r", (folder / "mine.toml") + ",lookup=hard"}, {"nowhere", "courtyard"});
}

TEST(CommandLine, BlanksAfterCommasAreAllowed) {
    expect_misuse({"compare", "nowhere", "-r", "pcf, pcf.size = 5"}, {"nowhere", "courtyard"});
    expect_misuse({"compare", "nowhere", "-r", "pcf,", "pcf.size=5,", "resolution=64"}, {"nowhere", "courtyard"});
    expect_misuse({"render", "-r", "pcf,", "pcf.size=5", "nowhere"}, {"nowhere", "courtyard"});
    expect_misuse({"compare", "nowhere", "-r", "pcf, pcf.tabs=3"}, {"tabs", "taps"});
}

TEST(CommandLine, PicturesOfMapsNeedAMap) {
    for (const char* recipe : {"volumes", "none", "planar"}) {
        expect_misuse({"render", "slab", "-r", recipe, "--show", "map"}, {"--show map", recipe, "no map"});
    }
}

TEST(CommandLine, SizesAreWidthXHeight) {
    for (const char* size : {"10", "10x", "x10", "0x10", "10x-1", "10x10x10", "99999x10", "10 x 10", "1e2x10"}) {
        expect_misuse({"render", "slab", "--size", size}, {"--size", "WIDTHxHEIGHT"});
    }
}

TEST(CommandLine, UnknownNamesListTheKnown) {
    expect_misuse({"render", "slab", "--show", "texel"},
                  {"'texel'", "view", "texels", "undersampling", "bias", "map", "light-view"});
    expect_misuse({"render", "slab", "--light", "key"}, {"--light", "--show"});
    expect_misuse({"render", "slab", "--show", "view", "--light", "moon"}, {"'moon'", "--light"});
    expect_misuse({"render", "slap"}, {"slap", "slab", "courtyard"});
    expect_misuse({"compare", "slab", "slap", "-r", "hard"}, {"slap", "slab", "courtyard"});
    expect_misuse({"render", "slab", "-r", "pfc"}, {"'pfc'", "did you mean 'pcf'", "volumes"});
    expect_misuse({"compare", "slab", "-r", "pcf,pcf.tabs=3"}, {"tabs", "taps"});
    expect_misuse({"compare", "slab", "-r", "pcf,map=dept"}, {"'dept'", "depth"});
    expect_misuse({"compare", "-r", "hard", "slab", "contact"}, {"slab", "scenes stand before"});
    expect_misuse({"render", "slab", "--view", "attic"}, {"attic"});
}

TEST(CommandLine, UnwritableOutputIsFoundBeforeAnyWork) {
    const ScratchFolder folder;
    expect_misuse({"render", "slab", "-o", folder / "missing/out.png"}, {"missing", "does not exist"});
    expect_misuse({"render", "slab", "-o", folder / "out.gif"}, {".png or .exr"});
    expect_misuse({"render", "slab", "--visibility", folder / "v.png"}, {".exr"});
    expect_misuse({"compare", "slab", "-r", "hard", "--json", folder / "missing/out.json"},
                  {"--json", "does not exist"});
    folder.write("file", "");
    expect_misuse({"compare", "slab", "-r", "hard", "-o", folder / "file"}, {"-o", "cannot be made"});
}

TEST(CommandLine, UnreadableScenesAreOneSentence) {
    const ScratchFolder folder;
    folder.write("empty.glb", "");
    folder.write("noise.gltf", "{\"asset\": {");
    folder.write("words.toml", "this is = = no scene");
    folder.write("shape.xyz", "1 2 3");
    for (const char* name : {"empty.glb", "noise.gltf", "words.toml", "shape.xyz", "absent.glb"}) {
        expect_misuse({"render", folder / name, "-o", folder / "out.png"}, {});
        EXPECT_FALSE(std::filesystem::exists(folder / "out.png")) << name;
    }
}

TEST(CommandLine, RecipeFilesAreCheckedLikeShippedOnes) {
    const ScratchFolder folder;
    folder.write("mine.toml", "map = \"depth\"\nlookup = \"pcf\"\n[pcf]\ntabs = 3\n");
    expect_misuse({"render", "slab", "-r", folder / "mine.toml"}, {"mine.toml", "tabs", "taps"});
    folder.write("mine.toml", "map = \"depth\"\nlookup = \n");
    expect_misuse({"render", "slab", "-r", folder / "mine.toml"}, {"mine.toml", "line 2"});
    expect_misuse({"render", "slab", "-r", folder / "absent.toml"}, {"absent.toml"});
}

TEST(CommandLine, HelpAndVersionAnswerOnStandardOutput) {
    const CommandResult version = run_gnomon({"--version"});
    EXPECT_EQ(version.status, 0);
    EXPECT_TRUE(std::regex_match(version.out, std::regex("gnomon [0-9]+\\.[0-9]+\\.[0-9]+\n"))) << version.out;
    for (const Words& arguments : {Words{"--help"}, Words{"compare", "--help"}}) {
        const CommandResult help = run_gnomon(arguments);
        EXPECT_EQ(help.status, 0);
        EXPECT_EQ(help.err, "");
        expect_has(help.out, {"Examples:"});
    }
    for (const char* command : {"list", "show", "render", "doctor"}) {
        EXPECT_EQ(run_gnomon({command, "--help"}).status, 0) << command;
    }
}

TEST(CommandLine, AFullDiskIsAFailure) {
    const std::string command = gnomon_executable() + " list > /dev/full 2> /dev/null";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
}

TEST(List, TextAndJsonNameTheSame) {
    for (const char* what : {"parts", "recipes", "scenes", "metrics"}) {
        const CommandResult text = run_gnomon({"list", what});
        const CommandResult machine = run_gnomon({"list", what, "--json"});
        ASSERT_EQ(text.status, 0);
        ASSERT_EQ(machine.status, 0);
        const json entries = json::parse(machine.out).at(what);
        EXPECT_GT(entries.size(), 3U);
        for (const json& entry : entries) {
            expect_has(text.out, {entry.at(entry.contains("id") ? "id" : "name").get<std::string>()});
        }
    }
    EXPECT_EQ(json::parse(run_gnomon({"list", "--json"}).out).size(), 4U);
}

TEST(List, HasWhatIsPromised) {
    const json all = json::parse(run_gnomon({"list", "--json"}).out);
    const auto has = [&](const char* kind, const std::string& name) {
        const json& entries = all.at(kind);
        return std::any_of(entries.begin(), entries.end(), [&](const json& entry) { return entry.at("name") == name; });
    };
    for (const char* recipe : {"hard", "pcf", "pcf-poisson", "volumes", "planar", "none"}) {
        EXPECT_TRUE(has("recipes", recipe)) << recipe;
    }
    for (const char* scene :
         {"courtyard", "half-plane", "slab", "stack", "overlap", "tilted", "contact", "fence", "corridor", "duel"}) {
        EXPECT_TRUE(has("scenes", scene)) << scene;
    }
    for (const char* metric : {"rmse", "mae", "max", "mismatch", "leak", "acne", "self_shadow", "penumbra", "edge",
                               "undersampled", "undersampling", "luma_rms", "flip", "against"}) {
        EXPECT_TRUE(has("metrics", metric)) << metric;
    }
}

TEST(Show, EveryPartHasAPageThatNamesItsParameters) {
    const json parts = json::parse(run_gnomon({"list", "parts", "--json"}).out).at("parts");
    for (const json& part : parts) {
        const std::string id = part.at("id");
        const CommandResult page = run_gnomon({"show", part.at("stage").get<std::string>() + "/" + id});
        ASSERT_EQ(page.status, 0) << id << page.err;
        expect_has(page.out, {part.at("title").get<std::string>()});
        expect_has(page.out, {"[" + part.at("citation").get<std::string>() + "]"});
        EXPECT_GT(page.out.size(), 600U) << id << " has no manual page beside its source";
        EXPECT_EQ(page.out.find("!["), std::string::npos) << id << " shows a picture as markup";
        for (const json& parameter : part.at("parameters")) {
            expect_has(page.out, {id + "." + parameter.get<std::string>()});
        }
    }
}

TEST(Show, RecipesScenesMetricsAndBiasHavePages) {
    const json all = json::parse(run_gnomon({"list", "--json"}).out);
    for (const char* kind : {"recipes", "scenes", "metrics"}) {
        for (const json& entry : all.at(kind)) {
            const CommandResult page = run_gnomon({"show", entry.at("name").get<std::string>()});
            EXPECT_EQ(page.status, 0) << page.err;
            expect_has(page.out, {entry.at(entry.contains("title") ? "title" : "sentence").get<std::string>()});
        }
    }
    expect_has(run_gnomon({"show", "bias"}).out, {"bias.receiver_plane"});
    EXPECT_EQ(run_gnomon({"show", "pcf_poisson"}).out, run_gnomon({"show", "pcf-poisson"}).out);
}

}  // namespace
}  // namespace gn::command_test
