// SPDX-License-Identifier: MIT
// gnomon bake: a whole folder or none, and a sentence for what is in its way.
#include "apps/subprocess_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace gn::bake_test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

std::size_t entries(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// Status and sentence of a bake that makes nothing.
void expect_sentence(const Words& arguments, int status, const Words& parts) {
    const CommandResult result = run_gnomon(arguments);
    const std::string asked = testing::PrintToString(arguments);
    EXPECT_EQ(result.status, status) << asked << result.err;
    EXPECT_EQ(result.out, "") << asked;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << asked << result.err;
    expect_has(result.err, parts);
}

TEST(Bake, AFolderHoldsManifestRecipesAndShaders) {
    const ScratchFolder folder;
    folder.write("mine.toml",
                 "title = \"Mine\"\nparagraph = \"Of a test.\"\ncitation = \"Wil78\"\nmap = \"depth\"\n"
                 "lookup = \"hard\"\nresolution = 512\n");
    const CommandResult baked =
        run_gnomon({"bake", folder / "mine.toml", "hard,resolution=64", "-o", folder / "baked"});
    ASSERT_EQ(baked.status, 0) << baked.err;
    expect_has(baked.out, {"baked: ", " shaders for mine hard,resolution=64"});
    const std::string manifest = file_text(folder / "baked/manifest.txt");
    expect_has(manifest, {"gnomon baked 1\nlibrary ", "\nrecipe mine\nrecipe hard,resolution=64\n", "cpu", "\nend "});
    EXPECT_EQ(file_text(folder / "baked/recipes/mine.toml"), file_text(folder / "mine.toml"));
    const auto lines = static_cast<std::size_t>(std::count(manifest.begin(), manifest.end(), '\n'));
    EXPECT_GT(lines, 30U);
    EXPECT_LT(entries(folder / "baked/shaders"), lines);
    EXPECT_GT(entries(folder / "baked/shaders") + 10, lines);

    // The same again replaces it, whatever has become of it.
    fs::remove_all(folder / "baked/shaders");
    ASSERT_EQ(run_gnomon({"bake", "hard", "-o", (folder / "baked") + "/"}).status, 0);
    EXPECT_FALSE(fs::exists(folder / "baked/recipes/mine.toml"));
    EXPECT_GT(entries(folder / "baked/shaders"), 20U);
    EXPECT_EQ(entries(folder / "."), 2U) << "nothing else stays";
}

TEST(Bake, MisuseIsOneSentence) {
    const ScratchFolder folder;
    expect_sentence({"bake", "-o", folder / "x"}, 2, {"RECIPE"});
    expect_sentence({"bake", "pcf"}, 2, {"--output"});
    expect_sentence({"bake", "pfc", "-o", folder / "x"}, 2, {"'pfc'", "did you mean 'pcf'"});
    expect_sentence({"bake", "pcf,pcf.sise=3", "-o", folder / "x"}, 2, {"pcf.sise"});
    expect_sentence({"bake", "volumes", "-o", folder / "x"}, 2, {"'volumes'"});
    folder.write("note.txt", "kept");
    expect_sentence({"bake", "pcf", "-o", folder / "."}, 2, {"was not baked"});
    expect_sentence({"bake", "pcf", "-o", folder / "note.txt"}, 2, {"was not baked"});
    folder.write("pcf.toml",
                 "title = \"x\"\nparagraph = \"y\"\ncitation = \"Wil78\"\nmap = \"depth\"\nlookup = \"hard\"\n");
    expect_sentence({"bake", "pcf", folder / "pcf.toml", "-o", folder / "x"}, 2, {"both called 'pcf'"});
    EXPECT_EQ(entries(folder / "."), 2U);
    const CommandResult help = run_gnomon({"bake", "--help"});
    EXPECT_EQ(help.status, 0);
    expect_has(help.out, {"RECIPE", "--output", "gnomon::embed", "Examples:"});
}

TEST(Bake, AFullOrUnwritableDiskLeavesNoHalfFolder) {
    const ScratchFolder folder;
    expect_sentence({"bake", "hard", "-o", "/dev/null/baked"}, 1, {"/dev/null/baked", "writable"});
    // Files may not grow beyond 4 KiB: shaders are larger.
    const std::string command = "trap '' XFSZ; ulimit -f 8; " + gnomon_executable() + " bake hard -o " +
                                (folder / "baked") + " > /dev/null 2> " + (folder / "err");
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
    expect_has(file_text(folder / "err"), {"gnomon: ", "cannot be written", "disk full"});
    EXPECT_EQ(entries(folder / "."), 1U);
}

}  // namespace
}  // namespace gn::bake_test
