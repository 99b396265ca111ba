// SPDX-License-Identifier: MIT
// A truth that was kept in a file is the truth that was traced, in one channel and in three.
#include "reference/truth_picture.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace gn::truth_picture_test {
namespace {

TruthResult made_up(int channels) {
    TruthResult truth;
    truth.channels = channels;
    for (int p = 0; p < 6; ++p) {
        for (int c = 0; c < channels; ++c) {
            truth.visibility.push_back(1.0F / static_cast<float>(1 + p + 7 * c));
        }
        truth.standard_error.push_back(0.01F * static_cast<float>(p));
        truth.counted.push_back(p % 2 == 0 ? 1 : 0);
    }
    return truth;
}

TEST(TruthPicture, AFileKeepsATruthOfOneChannelAndOfThree) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / fmt::format("gnomon-truth-{}.exr", ::getpid());
    for (const int channels : {1, 3}) {
        const TruthResult truth = made_up(channels);
        const Image picture = picture_of_truth(truth, 3, 2);
        ASSERT_EQ(picture.channels, truth_picture_channels(channels));
        write_exr(file, picture, truth_picture_names(picture.channels));
        const TruthResult kept = truth_of_picture(read_exr(file));
        EXPECT_EQ(kept.channels, channels);
        EXPECT_EQ(kept.visibility, truth.visibility);
        EXPECT_EQ(kept.standard_error, truth.standard_error);
        EXPECT_EQ(kept.counted, truth.counted);
    }
    std::filesystem::remove(file);
}

}  // namespace
}  // namespace gn::truth_picture_test
