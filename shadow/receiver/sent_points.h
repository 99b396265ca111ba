// SPDX-License-Identifier: MIT
// What the points of a light send that shows a picture, for parts that know which of them a sample sees.
#pragma once

#include "gpu/shader_inputs.h"
#include "shadow/stages.h"

#include <memory>
#include <vector>

namespace gn {

/// emission_of_points of the input's light, kept with the scene; null where it shows no picture. A piece of a light (`split`) shows none.
using SentPoints = std::shared_ptr<const std::vector<vec4>>;
SentPoints sent_by_points(const FrameInput& input, int count, int side = 1);

/// Channels of V: three where the points send colours.
inline uint channels_of(const SentPoints& sent) {
    return sent != nullptr ? 3 : 1;
}
/// `vec4 sent_points[]` for shaders, where there are any.
void add_sent_points(ShaderInputs& inputs, const SentPoints& sent);
/// GLSL before the inputs: channels_text, and GN_SENT(i), the GN_V that point i sends.
std::string sent_text(const SentPoints& sent);

/// What a part says that knows how much of a light is hidden, and not which part of it, where a light of the scene shows a picture; or "".
std::string remark_pictures(const Scene& scene, std::string_view part);

}  // namespace gn
