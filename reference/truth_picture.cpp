// SPDX-License-Identifier: MIT
#include "reference/truth_picture.h"

#include "base/error.h"

namespace gn {

std::vector<std::string> truth_picture_names(int picture_channels) {
    std::vector<std::string> names;
    for (int c = 0; c < picture_channels; ++c) {
        names.push_back(fmt::format("{}", c));
    }
    return names;
}

Image picture_of_truth(const TruthResult& truth, int width, int height) {
    Image picture(width, height, truth_picture_channels(truth.channels));
    GN_CHECK_EQ(truth.counted.size(), picture.pixels());
    auto at = picture.values.begin();
    for (std::size_t p = 0; p < picture.pixels(); ++p) {
        const auto channels = static_cast<std::size_t>(truth.channels);
        for (std::size_t c = 0; c < channels; ++c) {
            *at++ = truth.visibility[channels * p + c];
        }
        *at++ = truth.standard_error[p];
        *at++ = truth.counted[p] != 0 ? 1.0F : 0.0F;
    }
    return picture;
}

TruthResult truth_of_picture(const Image& picture) {
    TruthResult truth;
    truth.channels = picture.channels - 2;
    GN_CHECK(truth.channels == 1 || truth.channels == 3);
    for (auto at = picture.values.begin(); at != picture.values.end(); at += picture.channels) {
        truth.visibility.insert(truth.visibility.end(), at, at + truth.channels);
        truth.standard_error.push_back(at[truth.channels]);
        truth.counted.push_back(at[truth.channels + 1] > 0.5F ? 1 : 0);
    }
    return truth;
}

}  // namespace gn
