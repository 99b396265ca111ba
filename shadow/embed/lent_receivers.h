// SPDX-License-Identifier: MIT
// A renderer's depth and normals become view samples, and V goes back into its images.
#pragma once

#include "shadow/embed/embed.h"
#include "shadow/stages.h"

namespace gn::embed {

/// Positions and normals of what the camera sees, from depth and normals; `prepared` keeps the shader. Throws Error where the
/// matrix is no camera's.
ViewSamples add_lent_receivers(FrameGraph& graph, const ReceiverForm& form, const Receivers& lent, TextureHandle depth,
                               TextureHandle normals, const Box& bounds_ws, const PreparedRecipe* prepared = nullptr);

/// Writes V into a colour image of the same size; 1 everywhere where `visibility` is invalid.
void add_copy(FrameGraph& graph, TextureHandle visibility, TextureHandle target, const PreparedRecipe* prepared);

}  // namespace gn::embed
