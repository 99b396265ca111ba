// SPDX-License-Identifier: MIT
// The passes of the pictures of the hidden, and their colours.
#pragma once

#include "shadow/show/show.h"

namespace gn {

/// What one pass finds for every view sample.
struct SampleFigures {
    TextureHandle choice;  ///< RGBA32F: first view, second view or -1, its weight, state: 1 held, 0 not, -1 not counted
    TextureHandle sizes;   ///< RGBA32F: texels per pixel, bias in metres, pixels per texel, state
};
SampleFigures add_sample_figures(const FrameInput& input, const Recipe& recipe, const LightViews& views);

/// Two RGBA32F images of the view's size, `first` and `second` in the shader, that `text` (declarations and main) writes for
/// every view sample; it may call shadow/show/show.glsl and reads u.view, u.light, u.bias and the given member of u.
struct SampleImages {
    TextureHandle first, second;
};
struct SamplePass {
    const char* name;
    const char* first_name;
    const char* second_name;
    const char* member_type;  ///< "float"
    const char* member;       ///< "pixels"
    const char* text;
};
SampleImages add_sample_pass(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                             const SamplePass& pass, std::span<const std::byte> member);

/// The layers of a 2D array side by side, each reduced to at most `side` texels, RGBA32F.
struct LayerTiles {
    TextureHandle image;
    int side = 0, layers = 0, columns = 0;
};
LayerTiles add_layer_tiles(const FrameInput& input, TextureHandle layers);

/// What the light sees through its views: RGBA32F, an array as the map's: cosine of incidence, depth, 0, 1 where it
/// sees a caster.
TextureHandle add_light_picture(const FrameInput& input, const Recipe& recipe, const LightViews& views);

/// Colours. `shade` darkens by the surface's slope against the view, so that shapes stay visible.
Shown color_choice(const Image& choice, std::span<const float> shade, const LightViews& views);
Shown color_texels(const Image& sizes);
Shown color_undersampling(const Image& sizes);
Shown color_bias(const Image& sizes);
/// What a part told; `sizes` have each sample's state, and `others` says what states without a figure are.
Shown color_side(const Image& side, const Image& sizes, std::string_view sentence, std::string_view others);
Shown color_map(const Image& tiles, const LayerTiles& layout, const TextureDesc& map, bool depth);
Shown color_light(const Image& tiles, const LayerTiles& layout);

/// Writes small text, digits, units and signs only, with its upper left corner at (x, y); returns its width in pixels.
int burn_text(Image& picture, int x, int y, std::string_view text, int scale);
int text_width(std::string_view text, int scale);
inline constexpr int text_height = 5;  ///< pixels at scale 1

}  // namespace gn
