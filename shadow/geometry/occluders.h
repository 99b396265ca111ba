// SPDX-License-Identifier: MIT
// The scene's triangles as shaders ask them what they hide: corners, sides, and for masks the truth's own texel at the hit.
#pragma once

#include "gpu/shader_inputs.h"
#include "shadow/stages.h"

#include <string>

namespace gn {

/// Adds the scene's triangles and masks to what a shader reads, with GLSL as in occluder_functions. Throws Refusal where the
/// alpha of the scene's masks is larger than a storage block of the device.
void add_occluders(ShaderInputs& inputs, const FrameInput& input);
/// GLSL, after the inputs' text; what it includes stands before them.
///
///     GnOccluder gn_occluder(uint triangle)
///     bool gn_mask_solid(uint triangle, vec3 shares)   whether a masked triangle is there, at a hit as gn_hit_shares says it
std::string occluder_includes();
std::string occluder_functions();

}  // namespace gn
