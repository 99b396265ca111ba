// SPDX-License-Identifier: MIT
// From casters to a prefiltered map: rasterize what a texel stores (with MSAA where asked), resolve, blur, mipmap. Every
// step is a pass of the graph and keeps the map's layers.
#pragma once

#include "shadow/casters/raster.h"
#include "shadow/map/prefilter_params.h"

namespace gn {

/// What rasterization makes of the casters: a colour array, one layer a view.
struct MomentMap {
    std::string name = "map";
    VkFormat format = VK_FORMAT_R32G32_SFLOAT;
    int samples = 1;          ///< 1 or 4; resolved by the mean of the stored values
    ClearValue clear;         ///< what a texel without caster stores
    CasterFragment fragment;  ///< writes `layout(location = 0) out vec4 out_moments` from `depth`
    TextureHandle depth;      ///< create_depth, for who reads it afterwards; invalid: nobody does
    std::uint32_t mips = 1;   ///< of the returned texture; filled by add_mips; 1 while it has samples
};
/// The D32 that a moment map is drawn with: its layers and samples.
TextureHandle create_depth(const FrameInput& input, const LightViews& views, const MomentMap& map);
TextureHandle add_moments(const FrameInput& input, const Recipe& recipe, const LightViews& views, const MomentMap& map);

/// A separable blur (GN_BLUR_BOX, GN_BLUR_GAUSSIAN) of every layer's mip 0, two fragment passes a layer. radius in texels: a box of 2 radius + 1, or a
/// Gaussian of sigma = radius / 2 cut at radius. radius 0 or none returns the source. The result has `mips` levels.
/// Of tiles each is blurred by itself; of other views what their layer's rectangles span. Beside them the result is 0.
TextureHandle add_blur(const FrameInput& input, const LightViews& views, TextureHandle source, int kernel, int radius,
                       std::uint32_t mips = 1);

/// Levels that a map is drawn with: those asked for, or one where a blur makes the copy that is read.
std::uint32_t drawn_mips(const GnPrefilterParams& params, std::uint32_t resolution);
/// The end that blurred maps share: blur, mipmap, and read trilinearly; the one offer has this name. `source` has drawn_mips levels.
ShadowMap filtered_map(const FrameInput& input, const LightViews& views, std::string_view name, TextureHandle source,
                       const GnPrefilterParams& params);
/// Whether the recipe's lookup reads the range of depths beside what the map stores.
bool reads_ranges(const Recipe& recipe);
/// Offers it where it does: "min-max" of what was drawn (shadow/map/derived.h). Throws Refusal where that has several samples.
void offer_ranges(const FrameInput& input, const Recipe& recipe, TextureHandle depth, ShadowMap& map);
/// How far a blurred map's texels reach.
Guard blur_guard(const GnPrefilterParams& params);
/// The sentence that refuses a count of samples that add_moments does not take, or "". `parameter`: "vsm.samples".
std::string refuse_samples(std::string_view parameter, int samples);
/// What linear filtering of a texture of 32-bit floats needs of a device; nothing for other textures.
std::vector<Feature> filtering_features(bool float32);

/// The rows that several maps have. `offset` is that of the field, or of the member `prefilter`, in the map's own struct.
std::vector<ParamRow> with_prefilter(std::vector<ParamRow> rows, std::size_t offset);
ParamRow samples_row(std::size_t offset);
ParamRow slope_moment_row(std::size_t offset);
ParamRow min_deviation_row(std::size_t offset);
ParamRow max_deviation_row(std::size_t offset);
ParamRow bleeding_row(std::size_t offset);
ParamRow reduction_row(std::size_t offset);

/// One fragment pass a layer over a whole texture. `text` reads GN_SOURCE(ivec3 texel), the texels of the source's first
/// level from GN_FIRST to GN_LAST, push_layer, gl_FragCoord and what `inputs` declare.
struct LayerPass {
    std::string name;
    std::string includes;  ///< GLSL that `inputs` need
    std::string text;      ///< must contain: layout(location = 0) out vec4 ...
    ShaderInputs inputs;
    const LightViews* tiles = nullptr;  ///< only their texels are drawn, beside them is 0; null: all texels
};
void add_layer_passes(const FrameInput& input, TextureHandle source, TextureHandle target, const LayerPass& pass);

/// The normalized weights of a blur, index 0 the centre: weights[0] + 2 sum(weights[1..radius]) = 1.
std::vector<float> blur_weights(int kernel, int radius);

}  // namespace gn
