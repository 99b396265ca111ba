// SPDX-License-Identifier: MIT
// Shaders that ask, for each view sample and each silhouette edge between it and the light, what the edge hides.
#pragma once

#include "gpu/shader_inputs.h"
#include "shadow/geometry/volume_passes.h"
#include "shadow/recipe/part.h"

#include <string>

namespace gn {

/// The hard shadow of the light's centre, and the silhouettes that it was made of.
struct HardShadow {
    VolumeBuffers buffers;
    Visibility visibility;
    TextureHandle counts;  ///< R32F: how many volumes hold a sample
};
/// By shadow volumes that count behind the samples, and rays through masked casters, which have no silhouettes; nothing is culled,
/// since what casts no hard shadow may cast a soft one.
HardShadow add_hard_shadow(const FrameInput& input, bool closed);

/// What is drawn into an image for each silhouette edge, where it may hide part of the light.
struct EdgeRegionPass {
    std::string_view name;       ///< of the pass
    std::string_view includes;   ///< GLSL before the inputs
    std::string_view functions;  ///< GLSL after them
    /// GLSL in main: `float result`, or `vec4 result`; it has p_ws and n_ws (the sample) at `ivec2 pixel`, a_ws and b_ws (the
    /// edge, as gn_lit_side says), `uint edge_index` (of EdgeList::edges) and what `extra` declares.
    std::string_view fragment;
    std::string_view result = "float";
    ShaderInputs extra;
    Blend blend = Blend::add;
    float growth = 1;  ///< the light is taken to be so many times as large
};
/// Draws it into the image, which is cleared before.
void add_edge_regions(const FrameInput& input, const VolumeBuffers& buffers, const EdgeRegionPass& pass,
                      TextureHandle image, ClearValue clear);
/// The same over the texels of light views, in which samples may lie that an edge hides part of the light from. GLSL in main has
/// `ivec3 texel` (the layer last) instead of a sample. The image has the views' layers. Views that do not bend, without tiles.
void add_edge_texels(const FrameInput& input, const VolumeBuffers& buffers, const LightViews& views,
                     const EdgeRegionPass& pass, TextureHandle image);

/// What such parts can tell of a sample, and the image of it where the input asks.
std::vector<Side> edge_sides();
void add_edge_sides(const FrameInput& input, const VolumeBuffers& buffers, float growth, Visibility& told);

/// What such a part says of a scene with masked casters, or "".
std::string remark_masked(const Scene& scene, std::string_view part);
/// The same, and that it knows no part of a picture that a light shows, where it sums what silhouettes hide.
std::string remark_silhouettes(const Scene& scene, std::string_view part);

/// Whether the light has any extent.
bool has_extent(const GnLight& light);
/// A pass over all samples: V = GLSL expression of `hard` (0 or 1) and `float`/`vec4 soft`, clamped; 0 where none counts.
struct EdgeResolve {
    std::string_view name, includes, expression;
    uint channels = 1;     ///< of `soft`
    TextureHandle more{};  ///< valid: the expression has `vec4 more` too
};
Visibility add_edge_resolve(const FrameInput& input, TextureHandle hard, TextureHandle soft,
                            const EdgeResolve& resolve);

}  // namespace gn
