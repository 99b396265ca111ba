// SPDX-License-Identifier: MIT
// Pictures of what a recipe with a map hides: which view serves a pixel, how fine its texels are, how far the bias moves
// it, what the map holds, and what the light sees.
#pragma once

#include "shadow/frame/frame.h"

namespace gn {

enum class Hidden { view, texels, undersampling, bias, map, light_view, side };
struct HiddenPicture {
    Hidden kind = Hidden::view;
    std::string_view name, sentence;
    bool of_view = true;  ///< as large as the view, pixel by pixel; else layers of the map side by side
};
/// In the order to show them: view, texels, undersampling, bias, map, light-view.
std::span<const HiddenPicture> hidden_pictures();
/// What lookups tell beside V, as pictures of the view: "blocker-distance".
std::span<const HiddenPicture> side_pictures();
/// One of either kind. Throws Error listing the known names.
const HiddenPicture& find_hidden(std::string_view name);

/// One such picture.
struct Shown {
    std::string name;
    Image picture;       ///< display-ready RGB, sRGB-encoded in [0,1], with its scale burnt in
    std::string legend;  ///< what the colours mean, one sentence
    /// What the colours stand for. Of the view: two channels, the value (view: the index, plus the weight of the next
    /// one; texels: per pixel; undersampling: pixels per texel; bias: metres) and 1 where a light view holds the sample, 0 where none does, -1 where the
    /// sample does not count. Of layers: the tiles' own channels.
    Image values;
};

struct HiddenOptions {
    uint width = 640, height = 360;
    std::size_t light = 0;
    History* history = nullptr;  ///< as FrameOptions::history
};

/// All of `names` from one frame. Throws Error for an unknown name, Refusal for a recipe without a map, for what its lookup
/// does not tell, and where the recipe cannot serve the light.
std::vector<Shown> show_hidden(Device& device, SceneGpu& scene, const Camera& camera, const Recipe& recipe,
                               std::span<const std::string> names, const HiddenOptions& options);

/// m of C eq. 3.2 of every view sample: pixels under a map texel in the direction where it covers most
/// (shadow/receiver/undersampling.glsl), mixed where two views are; -1 where no light view holds the sample or no light
/// arrives. Empty for recipes without a map. Throws Refusal where the recipe cannot serve the light.
std::vector<float> undersampling(Device& device, SceneGpu& scene, const Camera& camera, const Recipe& recipe,
                                 const HiddenOptions& options);

/// What a recipe's kernel draws the V of a sample from: the parallelogram p + s a + t b, s and t in [-1,1], across the rays
/// to the light's eye; metres. Both null where no light view holds the sample.
struct KernelRegion {
    vec3 a_ws{0}, b_ws{0};
};
/// The regions of all view samples; nothing for recipes without a map, and for those that filter V on the screen. Throws
/// Refusal where the recipe cannot serve the light.
std::vector<KernelRegion> kernel_regions(Device& device, SceneGpu& scene, const Camera& camera, const Recipe& recipe,
                                         const HiddenOptions& options);

}  // namespace gn
