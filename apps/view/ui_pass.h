// SPDX-License-Identifier: MIT
// Draws what Dear ImGui made of a frame into a picture: one pass of a frame graph. Vertices and indices travel with the
// commands, so that nothing is made in a steady frame; ImTextureID is a place in the list of textures, counted from 1.
#pragma once

#include "gpu/frame_graph.h"

#include <span>

struct ImDrawData;

namespace gn {

/// The font atlas of the current ImGui context; its ImTextureID becomes 1.
Texture2D upload_fonts(Device& device);

/// `textures`: fonts first. `target` is cleared to `background` (sRGB-encoded, as all that ImGui draws). draw_data must live until
/// this returns.
void add_ui(FrameGraph& graph, const ImDrawData& draw_data, std::span<const TextureHandle> textures,
            TextureHandle target, vec4 background);

}  // namespace gn
