// SPDX-License-Identifier: MIT
// Fins on the silhouettes, drawn into light views.
#pragma once

#include "shadow/geometry/volume_passes.h"
#include "shadow/stages.h"

#include <string_view>

namespace gn {

/// How far off its edge a place of a fin is, in half widths of the light (lamps) or metres over the sun's tangent, and the linear
/// depth of the edge there.
///
/// GLSL in main has `float off`, `float edge_depth`, `ivec3 texel`, views[index] and what `extra` declares, and writes `result`.
struct FinPass {
    std::string_view name;      ///< of the pass
    std::string_view includes;  ///< GLSL before the inputs
    std::string_view fragment;
    std::string_view result = "float";
    ShaderInputs extra;
};
/// The least of all fins in every texel; the image has the views' layers and is cleared before.
void add_fins(const FrameInput& input, const VolumeBuffers& buffers, const LightViews& views, const FinPass& pass,
              TextureHandle image, ClearValue clear);

/// How a receiver reads a map of fins where the shadow map leaves it light.
struct FinLookup {
    std::string_view name;   ///< of the pass
    std::string_view light;  ///< GLSL: V by `vec4 fin`, the image's texel, `view` and `receiver`
};
/// V: 0 in the hard shadow of the map `depth`, beside it as the fins in the texel say.
Visibility add_fin_resolve(const FrameInput& input, const Recipe& recipe, const LightViews& views, TextureHandle depth,
                           TextureHandle fins, const FinLookup& lookup);

/// The sentence why a placement's views cannot hold fins, or "".
std::string refuses_fins(std::string_view part, const Recipe& recipe);

}  // namespace gn
