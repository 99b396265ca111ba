// SPDX-License-Identifier: MIT
// Maps of what did not change, kept over the frames of a sequence with all that is made of them: a lamp that stands still
// among still casters is drawn once.
#pragma once

#include "gpu/hash.h"
#include "shadow/recipe/recipe.h"
#include "shadow/stages.h"

namespace gn {

/// What casts, and how, that is told by the scene and not by its buffers.
Fingerprint casting_of(const Scene& scene, const Light& light);

/// The map that `draw` declares; or, where a frame before left it and its views, casters, geometry and parameters are the
/// same, that one again, to the bit and without a pass. Views that the GPU makes, maps that follow earlier frames by
/// themselves, and those of a light's samples are always drawn.
ShadowMap add_kept_map(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                       const std::function<ShadowMap()>& draw);

}  // namespace gn
