// SPDX-License-Identifier: MIT
// Broken and hostile models through `gnomon render`: each ends in a sentence or a picture, within 20 s and 2 GiB.
#include "apps/subprocess_test.h"

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <algorithm>
#include <filesystem>

namespace gn {
namespace {

namespace fs = std::filesystem;

const fs::path bad_models = fs::path(GNOMON_SOURCE_DIR).parent_path() / "shared/scenes/bad";

std::vector<fs::path> models() {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(bad_models)) {
        const std::string extension = entry.path().extension().string();
        if (extension == ".gltf" || extension == ".glb" || extension == ".obj") {
            found.push_back(entry.path());
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

long peak_kilobytes() {
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    return usage.ru_maxrss;
}

TEST(HostileFiles, EndInASentenceOrAPicture) {
    if (!fs::exists(bad_models)) {
        GTEST_SKIP() << "the shared folder of broken models is not beside this checkout";
    }
    int pictures = 0;
    int sentences = 0;
    for (const fs::path& model : models()) {
        const ScratchFolder folder;
        const std::string picture = folder / "picture.png";
        RunningCommand command({"render", model.string(), "-r", "pcf", "--size", "64x64", "-o", picture});
        const CommandResult result = command.wait(20);
        if (result.status == 0) {
            ++pictures;
            EXPECT_TRUE(fs::exists(picture)) << model << result.err;
        } else {
            ++sentences;
            EXPECT_EQ(result.status, 2) << model << result.err;
            EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << model << result.err;
            EXPECT_FALSE(fs::exists(picture)) << model << " left half a result";
        }
        EXPECT_EQ(result.out.find("root:"), std::string::npos) << model << " read outside its folder";
    }
    EXPECT_GT(pictures, 20);
    EXPECT_GT(sentences, 5);
    EXPECT_LT(peak_kilobytes(), 2 * 1024 * 1024) << "the largest of all runs";
}

}  // namespace
}  // namespace gn
