// SPDX-License-Identifier: MIT
// Which lit samples lie beside a shadow: rays from around a sample instead of from the sample.
//
// A picture of V that is blurred, or made of coarse cells, draws a sample's value from the sample's surroundings. A lit
// sample may then be darkened by a blocker that hides the light from a place beside it (the rim of a true shadow), or by
// its own surface, which is wrong whatever the resolution. To tell them apart, the surroundings are laid on the sample's
// tangent plane, and each of their points q asks whether anything lies between it and the light's centre.
//
// The surface that the sample belongs to bends away from its tangent plane, and must not count as a blocker. It is told
// by distance: a hit nearer to q than twice the distance between q and the sample is taken for the sample's own surface,
// so that the blocker's place does not matter but how steeply it rises above the plane: by 63 degrees under a light face
// to face with the surface, by less where the light grazes it. Hits in the plane itself never count, nor do texels that
// alpha takes away.
#pragma once

#include "reference/occluders.h"
#include "reference/truth.h"

namespace gn {

/// Rays a sample at most; the first one that is blocked ends the search.
inline constexpr std::uint32_t rim_rays = 256;
/// Hits nearer to q than this many times its distance from the sample are its own surface.
inline constexpr float rim_clearance = 2;

/// Asks `stop`, where given, before every sample; once it says yes, the result is worth nothing.
/// 1 where some point around a sample is hidden from the light's centre; 0 elsewhere, and where both axes are null.
std::vector<std::uint8_t> find_rims(const Occluders& occluders, std::span<const vec4> position_ws,
                                    std::span<const vec4> normal_ws, std::span<const Surroundings> around,
                                    const Light& light, int threads, bool (*stop)() = nullptr);

}  // namespace gn
