// SPDX-License-Identifier: MIT
// What the driver compiled is found again by the next process, and never harms where it was damaged.
#include "gpu/pipeline_cache.h"

#include "gpu/test_device.h"

#include <gtest/gtest.h>

#include <fstream>

namespace gn::pipeline_cache_test {
namespace {

namespace fs = std::filesystem;

class PipelinesOnDisk : public Rendered {
  protected:
    fs::path folder = fs::path(testing::TempDir()) / fmt::format("pipelines {}", getpid());
    ~PipelinesOnDisk() override { fs::remove_all(folder); }

    void make_one() {
        PipelineCache cache(device, folder);
        cache.get(ComputeDesc{{ShaderKind::compute, "nothing", "layout(local_size_x = 1) in;\nvoid main() {}\n"}, {}});
        EXPECT_EQ(cache.size(), 1U);
    }
    [[nodiscard]] std::vector<fs::path> files() const {
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(folder)) {
            found.push_back(entry.path());
        }
        return found;
    }
};

TEST_F(PipelinesOnDisk, AreWrittenOnceAndReadAgain) {
    make_one();
    ASSERT_EQ(files().size(), 1U);
    const auto bytes = fs::file_size(files().front());
    EXPECT_GE(bytes, 32U) << "Vulkan's own header alone";
    make_one();
    ASSERT_EQ(files().size(), 1U);
    EXPECT_EQ(fs::file_size(files().front()), bytes);
}

TEST_F(PipelinesOnDisk, ADamagedFileCountsAsAbsent) {
    make_one();
    const fs::path file = files().front();
    const auto bytes = fs::file_size(file);
    fs::resize_file(file, bytes / 2);
    make_one();
    EXPECT_EQ(fs::file_size(file), bytes);
    {
        std::fstream edit(file, std::ios::in | std::ios::out | std::ios::binary);
        edit.seekp(-1, std::ios::end);
        edit.put('!');
    }
    make_one();
    EXPECT_EQ(fs::file_size(file), bytes);
}

TEST_F(PipelinesOnDisk, AreNotKeptWithoutAFolder) {
    PipelineCache cache(device, {});
    cache.save();
    EXPECT_FALSE(fs::exists(folder));
}

}  // namespace
}  // namespace gn::pipeline_cache_test
