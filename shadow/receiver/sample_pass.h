// SPDX-License-Identifier: MIT
// What passes share that look at every view sample through the light views: the head of their shaders and what it reads.
#pragma once

#include "shadow/recipe/part.h"
#include "shadow/recipe/recipe.h"

namespace gn {

/// `#include "path"`, or "" for a part without GLSL.
std::string include_line(std::string_view path);

/// GLSL: a workgroup of 8 x 8 pixels; the G-buffer, the blocks `Views` and `Placement` at bindings 0 to 3; at binding 7
/// the block `u` with view, light, bias and the given members. Stands after the includes that the members need.
std::string sample_bindings(std::string_view members);

/// GLSL, after the bindings: GN_CHOOSE(receiver, placement), and `bool read_sample(ivec2 pixel, out GnReceiver)`, which
/// is false where no sample counts.
std::string sample_functions(const Part& placement);

/// GLSL that must stand before shadow/receiver/receiver.glsl: what the recipe's bias and the placement's views let it leave out.
std::string receiver_defines(const Recipe& recipe, const LightViews& views);
/// The recipe's bias with the reach of its kernels.
GnBias applied_bias(const Recipe& recipe);

/// The bytes of u.view, u.light and u.bias; the members follow.
std::vector<std::byte> sample_constants(const FrameInput& input, const Recipe& recipe);

/// Declares and sets everything that the head reads, but for `u`.
void declare_samples(PassBuilder& pass, const ViewSamples& samples, const LightViews& views);
void set_samples(Recorder& r, const ViewSamples& samples, const LightViews& views);

}  // namespace gn
