// SPDX-License-Identifier: MIT
// What a user allows and turns from the command line: --assets, --up.
#include "apps/subprocess_test.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace gn::assets_test {
namespace {

constexpr const char* plate = "mtllib ../library/m.mtl\nv -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nusemtl m\nf 1 2 3 4\n";

CommandResult compare(const std::string& scene, std::vector<std::string> more) {
    std::vector<std::string> words{"compare",   scene, "-r",       "none", "--size", "32x32",
                                   "--samples", "1",   "--repeat", "1",    "--json", "-"};
    words.insert(words.end(), more.begin(), more.end());
    return run_gnomon(words);
}

TEST(Assets, FoldersAreAllowedOneByOne) {
    const ScratchFolder folder;
    std::filesystem::create_directories(folder / "model");
    std::filesystem::create_directories(folder / "library");
    std::filesystem::create_directories(folder / "other");
    folder.write("model/a.obj", plate);
    folder.write("library/m.mtl", "newmtl m\nKd 1 0 0\n");
    const std::string model = folder / "model/a.obj";
    const auto says = [&](const CommandResult& result) {
        EXPECT_EQ(result.status, 0) << result.err;
        return result.err.find("allow it with --assets DIR") != std::string::npos;
    };
    const std::string picture = folder / "a.png";
    EXPECT_TRUE(says(run_gnomon({"render", model, "-r", "none", "--size", "32x32", "-o", picture})));
    EXPECT_FALSE(says(run_gnomon({"render", model, "-r", "none", "--size", "32x32", "-o", picture, "--assets",
                                  folder / "other", "--assets", folder / "library"})));
    EXPECT_TRUE(says(compare(model, {})));
    EXPECT_FALSE(says(compare(model, {"--assets", folder / "library"})));
    const CommandResult missing = compare(model, {"--assets", folder / "nowhere"});
    EXPECT_EQ(missing.status, 2);
    expect_has(missing.err, {"--assets", "nowhere", "no such folder"});
}

TEST(Up, IsYOrZ) {
    const ScratchFolder folder;
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    // A plate in the plane z = 0 is a floor once it is turned, so that no ground is set under it.
    const CommandResult lying = compare(folder / "a.obj", {});
    expect_has(lying.err, {"ground"});
    const CommandResult stood = compare(folder / "a.obj", {"--up", "z"});
    EXPECT_EQ(stood.status, 0) << stood.err;
    EXPECT_EQ(stood.err.find("ground"), std::string::npos) << stood.err;
    const CommandResult wrong = compare(folder / "a.obj", {"--up", "x"});
    EXPECT_EQ(wrong.status, 2);
    expect_has(wrong.err, {"--up", "'x'", "y, z"});
    const CommandResult builtin = compare("slab", {"--up", "z"});
    EXPECT_EQ(builtin.status, 2);
    expect_has(builtin.err, {"slab", "--up"});
}

}  // namespace
}  // namespace gn::assets_test
