// SPDX-License-Identifier: MIT
// Drawing the scene's triangles: runs of opaque objects in one draw, alpha-tested objects one by one.
#pragma once

#include "shadow/stages.h"

#include <span>

namespace gn {

/// A draw call's range of indices.
struct DrawRange {
    std::uint32_t first_index = 0, index_count = 0;
};

/// Consecutive opaque objects of `objects` (indices into Scene::objects, ascending) merged into runs.
std::vector<DrawRange> opaque_runs(const Scene& scene, std::span<const std::uint32_t> objects);
/// Alpha-tested objects of `objects`.
std::vector<std::uint32_t> masked_objects(const Scene& scene, std::span<const std::uint32_t> objects);
bool is_masked(const Scene& scene, const Object& object);

/// The handle and sampler of a material's base colour texture; white where it has none.
struct BaseColor {
    TextureHandle texture;
    SamplerDesc sampler;
};
BaseColor base_color(const Scene& scene, const SceneHandles& handles, const Material& material);
/// Declares every base colour texture of the scene as sampled.
void sample_textures(PassBuilder& pass, const SceneHandles& handles);

/// What an alpha test pushes: base alpha and cutoff.
struct AlphaTest {
    float base_alpha = 1, cutoff = 0.5F;
};
AlphaTest alpha_test(const Material& material);

}  // namespace gn
