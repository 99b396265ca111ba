// SPDX-License-Identifier: MIT
// What the passes of view-sample mapping share in a frame, and the walk of all triangles over the samples.
#pragma once

#include "shadow/direct/view_samples/view_samples_lists.h"
#include "shadow/direct/view_samples/view_samples_table.h"

namespace gn {

/// What passes of a frame share.
struct MappedSamples {
    const FrameInput& input;
    GnViewSamplesParams params;
    SortedSamples sorted;
    BufferHandle hidden;  ///< words of 32 bits a place
    BufferHandle asked;   ///< a uint a place, where it is asked for
    LightSamples samples;
    std::vector<vec4> points;
    std::uint32_t words = 1;  ///< a place
    [[nodiscard]] std::uint32_t count() const {
        return static_cast<std::uint32_t>(points.size()) / static_cast<std::uint32_t>(samples.side * samples.side);
    }
};

/// GLSL before the inputs: what the recipe and the light's kind say, and types.
std::string mapped_defines(const MappedSamples& m, bool masked = false);
/// The light's points, and, as GLSL after the inputs, `uint pattern_of(uint pixel)`: which a pixel takes.
void add_mapped_points(const MappedSamples& m, ShaderInputs& inputs);
extern const char* const pattern_text;

/// Every triangle that casts, all masked ones or all others, sets the bits of what it hides. Throws Refusal where the left-sample
/// map would be larger than a storage block.
void add_walk(const MappedSamples& m, bool masked);

}  // namespace gn
