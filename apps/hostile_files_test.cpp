// SPDX-License-Identifier: MIT
// Broken and hostile models through `gnomon render`: each ends in a sentence or a picture, as its index wants, within 20 s
// and 2 GiB.
#include "apps/subprocess_test.h"
#include "base/paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace gn::hostile_files_test {
namespace {

namespace fs = std::filesystem;

const fs::path bad_models = data_root().parent_path() / "shared/scenes/bad";

/// What the folder's index wants of a model.
enum class Wanted { picture, sentence, either };

Wanted wanted_of(const std::string& text) {
    const auto says = [&](const char* word) { return text.find(word) != std::string::npos; };
    if (says("any outcome") || (says("reject") && says(" or "))) {
        return Wanted::either;
    }
    return says("reject") && !says("keep") ? Wanted::sentence : Wanted::picture;
}

/// The index is a table: | file | why it is here | wanted |.
std::map<fs::path, Wanted> models() {
    std::map<fs::path, Wanted> found;
    std::ifstream index(bad_models / "INDEX.md");
    for (std::string line; std::getline(index, line);) {
        std::istringstream cells(line);
        std::string none;
        std::string file;
        std::string why;
        std::string wanted;
        std::getline(cells, none, '|');
        std::getline(cells, file, '|');
        std::getline(cells, why, '|');
        std::getline(cells, wanted, '|');
        if (file.size() > 2 && fs::is_regular_file(bad_models / file.substr(1, file.size() - 2))) {
            found.emplace(bad_models / file.substr(1, file.size() - 2), wanted_of(wanted));
        }
    }
    return found;
}

TEST(HostileFiles, EndAsTheirIndexWants) {
    if (!fs::exists(bad_models)) {
        GTEST_SKIP() << "the shared folder of broken models is not beside this checkout";
    }
    const std::map<fs::path, Wanted> all = models();
    EXPECT_GT(all.size(), 40U);
    for (const auto& [model, wanted] : all) {
        const ScratchFolder folder;
        const std::string picture = folder / "picture.png";
        RunningCommand command(
            {"render", model.string(), "-r", "hard,resolution=64", "--size", "64x64", "-o", picture});
        const CommandResult result = command.wait(20);
        if (result.status == 0) {
            EXPECT_NE(wanted, Wanted::sentence) << model << " was taken";
            EXPECT_TRUE(fs::exists(picture)) << model << result.err;
        } else {
            EXPECT_NE(wanted, Wanted::picture) << model << result.err;
            EXPECT_EQ(result.status, 2) << model << result.err;
            EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << model << result.err;
            EXPECT_FALSE(fs::exists(picture)) << model << " left half a result";
        }
        EXPECT_LT(result.peak_kilobytes, 2 * 1024 * 1024) << model;
        EXPECT_EQ(result.out.find("root:"), std::string::npos) << model << " read outside its folder";
    }
}

}  // namespace
}  // namespace gn::hostile_files_test
