// SPDX-License-Identifier: MIT
// Rasterizing casters into light views: what every map shares. A map part gives the attachments and, where it stores
// more than depth, what a fragment writes.
#pragma once

#include "gpu/shader_inputs.h"
#include "shadow/recipe/recipe.h"
#include "shadow/stages.h"

#include <string>

namespace gn {

/// What a map's fragments write besides depth.
struct CasterFragment {
    std::string includes;  ///< GLSL before main: includes, outputs
    /// GLSL in main; reads `float depth` (linear, [0,1]), `vec2 slope` (its change from texel to texel, none where it was
    /// clamped), views[caster_view] and what `inputs` declare, and writes the outputs.
    std::string body;
    ShaderInputs inputs;
    bool reads_slope = false;  ///< `body` reads slope, which a map's depths alone do not tell
};

struct CasterPass {
    std::string name = "map";
    TextureHandle color;  ///< invalid: none
    ClearValue clear_color;
    TextureHandle depth;      ///< D32; its layers as the views'
    CasterFragment fragment;  ///< empty: depth only
    bool by_object = false;   ///< one draw an object; `body` may read int push.object; fronts win ties with backs
    bool every_side = false;  ///< backs of one-sided materials too: as what lies behind, not as what casts
};

/// One pass a view (or for all layers, or a layer of tiles), into the view's rectangle of its layer: opaque casters, then alpha-tested ones. Depth is linear:
/// cleared to 1, the nearest kept, casters before the near plane clamped to 0.
void add_caster_passes(const FrameInput& input, const Recipe& recipe, const LightViews& views, const CasterPass& pass);

}  // namespace gn
