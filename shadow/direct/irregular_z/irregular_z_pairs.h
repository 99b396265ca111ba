// SPDX-License-Identifier: MIT
// Every view sample with every triangle that may hide the light from it: the lists of an irregular z-buffer, for whatever is
// asked of such a pair.
#pragma once

#include "gpu/shader_inputs.h"
#include "shadow/casters/texel_lists.h"
#include "shadow/recipe/recipe.h"

namespace gn {

/// What is done with a pair.
struct SamplePairs {
    std::string name;      ///< of the passes, "irregular-z"
    std::string includes;  ///< GLSL before everything
    ShaderInputs inputs;   ///< beside the G-buffer and add_occluders
    /// GLSL of `void gn_pair(uint sample_index, vec3 p_ws, vec3 n_ws, uint triangle, GnOccluder t, bool masked)`: called once for
    /// each counted view sample, by row and column, and each triangle that may hide the light from it, in any order.
    std::string functions;
    std::string margin;  ///< TouchedTexels::margin; "" is none
    float reach = 0;  ///< metres from the light's centre, for one with a position, within which what hides it may lie
    int alone = 512;  ///< TouchedTexels::alone and shares: fewer and more where a pair takes long
    std::uint32_t shares = 1;
    bool list_triangles =
        false;  ///< texels list triangles, which samples walk; else they list samples, which triangles walk
};
/// Asks all pairs; `inputs` say what it writes. Gives the lists that it made. Throws Refusal.
TexelLists add_sample_pairs(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                            const SamplePairs& pairs);
/// R32F: of each view sample that counts, how many values its texel lists.
TextureHandle add_list_lengths(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                               const TexelLists& lists, const std::string& name);

/// What the light's centre is hidden from: a uint a view sample, by row and column, which gn_hidden reads
/// (shadow/geometry/occluder.glsl); and the lists of samples (or triangles) by which it was found.
struct HiddenSamples {
    BufferHandle hidden;
    TexelLists lists;
};
HiddenSamples add_hidden_samples(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                                 bool list_triangles);

/// Why texels of a light's views cannot list what a part asks of them: its placement bends straight edges. `sentence` has {} for the
/// placement's name and ends before what would do; "" where the placement serves.
std::string refuses_bent(const Light& light, const Recipe& recipe, std::string_view sentence);

}  // namespace gn
