// SPDX-License-Identifier: MIT
// A truth as a picture, which a file can keep: per pixel the channels of V, its standard error, and whether it counts.
#pragma once

#include "base/image.h"
#include "reference/truth.h"

namespace gn {

/// Channels of the picture of a truth with so many, and what a file calls them: in the order in which it keeps them.
constexpr int truth_picture_channels(int truth_channels) {
    return truth_channels + 2;
}
std::vector<std::string> truth_picture_names(int picture_channels);

/// The view samples row by row, as many as the picture has pixels.
Image picture_of_truth(const TruthResult& truth, int width, int height);
/// What picture_of_truth keeps of a truth.
TruthResult truth_of_picture(const Image& picture);

}  // namespace gn
