// SPDX-License-Identifier: MIT
// What of an earlier frame's shadows still stands: whether the light is the same to them, and where casters moved.
#pragma once

#include "shadow/stages.h"

namespace gn {

/// The light as far as shadows know it: without colour and intensity.
GnLight shadow_shape(const Light& light);
/// Bit by bit.
bool same_shape(const GnLight& a, const GnLight& b);

/// Boxes (ws) where casters were and are that moved since that version of the geometry; of more than `most` the one around all.
/// Unset where all may have moved.
std::optional<std::vector<Box>> moved_since(const SceneHandles& handles, std::uint64_t version, std::size_t most);

}  // namespace gn
