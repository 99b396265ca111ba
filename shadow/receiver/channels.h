// SPDX-License-Identifier: MIT
// V has one channel, or three where light passes through coloured things: what an image of it looks like, to C++ and GLSL.
#pragma once

#include "gpu/frame_graph.h"

#include <string>

namespace gn {

/// The image format of V with 1 or 3 channels, and the channels of an image of V.
VkFormat visibility_format(uint channels);
uint channels_of(const FrameGraph& graph, TextureHandle visibility);

/// GLSL that stands before what reads or writes V: GN_V, its type, float or vec3; GN_V_OF(texel), V of an image's vec4;
/// GN_V_TEXEL(v), the vec4 of V; GN_V_FORMAT, the image's layout qualifier.
std::string channels_text(uint channels);

}  // namespace gn
