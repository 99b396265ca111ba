// SPDX-License-Identifier: MIT
// What passes share that look at every view sample through the light views: the one reader of view samples, and what its
// shaders read.
#pragma once

#include "gpu/shader_inputs.h"
#include "shadow/recipe/part.h"
#include "shadow/recipe/recipe.h"

namespace gn {

/// `#include "path"`, or "" for a part without GLSL.
std::string include_line(std::string_view path);

/// GLSL that must stand before shadow/receiver/receiver.glsl: what the recipe's bias and the placement's views let it leave out.
std::string receiver_defines(const Recipe& recipe, const LightViews& views);
/// The recipe's bias with the reach of its kernels.
GnBias applied_bias(const Recipe& recipe, const Light& light, const Box& bounds_ws);
GnBias applied_bias(const FrameInput& input, const Recipe& recipe);

/// Adds the block `Views` (GnLightView[], in declarations that count them GN_VIEW_COUNT of receiver_defines).
void add_views(ShaderInputs& inputs, const LightViews& views);
/// The block `Views` alone, a list of any length in every stage: what draws into views begins its inputs with. Its type stands
/// in shadow/light_view.h.
ShaderInputs view_list(const LightViews& views);

/// The G-buffer's positions and normals, the blocks `Views` and `Placement` (the placement's data_type), its offers and tables, and the constants u.view, u.light and u.bias.
/// Their types stand in shadow/view/view.glsl.
ShaderInputs sample_inputs(const FrameInput& input, const Recipe& recipe, const LightViews& views);

/// GLSL of the placement's choice, before the inputs' text.
std::string placement_text(const Part& placement, const Recipe& recipe);
/// GLSL: the call of the placement's function, of `receiver` and `placement`.
std::string choose_call(const LightViews& views);
/// GLSL, after the inputs' text: known_text, GN_CHOOSE(receiver, placement), what the placement's tables hold, and
/// `bool read_sample(ivec2 pixel, out GnReceiver)`, which is false where no sample counts.
std::string sample_functions(const FrameInput& input, const Recipe& recipe, const LightViews& views);

/// Adds gbuffer_position and gbuffer_normal to what a shader reads, texel by texel.
void add_gbuffer(ShaderInputs& inputs, const Device& device, const ViewSamples& samples);

/// One of the view samples' textures, called `what` in the sentence. Throws Refusal where a host's own receivers lack it.
TextureHandle lent(TextureHandle texture, std::string_view what);

/// The pixels, x, y, width and height, beyond which no sample of the view counts for the light.
ivec4 lit_pixels(const FrameInput& input);

}  // namespace gn
