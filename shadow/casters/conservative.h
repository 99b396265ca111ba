// SPDX-License-Identifier: MIT
// Rasterizing casters so that every texel which a triangle touches gets a fragment: the one emulation of conservative
// rasterization.
#pragma once

#include "gpu/shader_inputs.h"
#include "shadow/stages.h"

#include <string>

namespace gn {

struct ConservativePass {
    std::string name = "conservative";
    std::string includes;  ///< GLSL before main
    /// GLSL in main; reads `ivec3 texel` (the layer last), `int caster_view` (index of the light view), `uint triangle` (index into
    /// Scene::triangles), views[] and what `inputs` declare, and may write `out_color`, a vec4.
    std::string body;
    ShaderInputs inputs;
    std::string functions;  ///< GLSL that needs them
    TextureHandle color;    ///< a 2D array of the views' layers and resolution, cleared to 0
};
/// One fragment for each texel that a triangle of a caster touches, both sides, masks whole. Affine and
/// perspective views.
void add_conservative_passes(const FrameInput& input, const LightViews& views, const ConservativePass& pass);

}  // namespace gn
