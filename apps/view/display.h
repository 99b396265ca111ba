// SPDX-License-Identifier: MIT
// From radiance to what a viewport shows: exposure, tone curve and sRGB as in pictures (shadow/shading/tonemap.h), the second
// picture beside the first, and the signed error over both.
#pragma once

#include "shadow/frame/frame.h"

namespace gn {

/// One buffer of one float: the exposure, 1 / (cd/m^2), by which all viewports are shown.
BufferDesc exposure_buffer();
/// Writes the exposure that puts the picture's log-average luminance at middle grey, [RSSF02] eq. 1 and 2, of a lattice of 64 x 64
/// of its pixels.
void add_exposure(FrameGraph& graph, const PreparedRecipe& recipe, TextureHandle picture, BufferHandle exposure);

struct DisplayInputs {
    TextureHandle picture;       ///< RGBA32F radiance
    TextureHandle beside;        ///< what stands right of the split; invalid: nothing does
    TextureHandle visibility;    ///< V of one light
    TextureHandle visibility_b;  ///< what it is held against; invalid: no error is shown
    BufferHandle exposure;
    float stops = 0;
    float split = 1;         ///< share of the width left of the split
    TextureHandle target{};  ///< RGBA8, sRGB-encoded values
};
void add_display(FrameGraph& graph, const PreparedRecipe& recipe, const DisplayInputs& inputs);

/// Copies a texture's first level to where `receive` gets it once the frame has completed, rows tightly packed.
void add_answer(FrameGraph& graph, TextureHandle texture, std::function<void(std::span<const std::byte>)> receive);

}  // namespace gn
