// SPDX-License-Identifier: MIT
// Colours, scales and legends of the pictures of the hidden.
#include "shadow/show/show_passes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gn {
namespace {

constexpr vec3 paper{0.10F, 0.11F, 0.13F}, ink{0.93F, 0.93F, 0.90F};
constexpr vec3 uncounted{0.22F}, outside{0.85F, 0.10F, 0.60F};

/// Eight hues that stay apart for most eyes; views beyond take them again, darker.
vec3 hue(int index) {
    constexpr std::array<vec3, 8> hues{vec3(0.36F, 0.62F, 0.86F), vec3(0.94F, 0.62F, 0.22F), vec3(0.36F, 0.72F, 0.46F),
                                       vec3(0.88F, 0.40F, 0.42F), vec3(0.64F, 0.52F, 0.84F), vec3(0.92F, 0.84F, 0.36F),
                                       vec3(0.44F, 0.78F, 0.80F), vec3(0.86F, 0.58F, 0.76F)};
    const auto i = static_cast<std::size_t>(std::max(index, 0));
    const std::size_t round = i / hues.size();
    return hues.at(i % hues.size()) * std::pow(0.75F, static_cast<float>(round));
}

vec3 along(std::span<const vec3> stops, float t) {
    const float position = std::clamp(t, 0.0F, 1.0F) * static_cast<float>(stops.size() - 1);
    const std::size_t stop = std::min(static_cast<std::size_t>(position), stops.size() - 2);
    return glm::mix(stops[stop], stops[stop + 1], position - static_cast<float>(stop));
}

void put(Image& image, int x, int y, vec3 color) {
    if (x >= 0 && y >= 0 && x < image.width && y < image.height) {
        for (int c = 0; c < 3; ++c) {
            image.at(x, y, c) = color[c];
        }
    }
}

void fill(Image& image, int x, int y, int width, int height, vec3 color) {
    for (int j = y; j < y + height; ++j) {
        for (int i = x; i < x + width; ++i) {
            put(image, i, j, color);
        }
    }
}

/// A logarithmic scale and its labelled values.
struct Scale {
    float low = 0, high = 1;
    std::vector<vec3> colors;
    std::vector<std::pair<float, std::string>> ticks;
    [[nodiscard]] float position(float value) const {
        return std::log(std::max(value, 1e-12F) / low) / std::log(high / low);
    }
};

const Scale& texel_scale() {
    static const Scale scale{1.0F / 16,
                             16,
                             {vec3(0.45F, 0.05F, 0.16F), vec3(0.90F, 0.43F, 0.20F), vec3(0.95F, 0.92F, 0.80F),
                              vec3(0.32F, 0.62F, 0.78F), vec3(0.08F, 0.22F, 0.47F)},
                             {{1.0F / 16, "1/16"}, {0.25F, "1/4"}, {1, "1"}, {4, "4"}, {16, "16"}}};
    return scale;
}

/// The scale of texels from its other end: what is coarse stays red.
const Scale& undersampling_scale() {
    static const Scale scale = [] {
        Scale turned = texel_scale();
        std::reverse(turned.colors.begin(), turned.colors.end());
        return turned;
    }();
    return scale;
}

const Scale& bias_scale() {
    static const Scale scale{1e-4F,
                             1,
                             {vec3(0.13F, 0.07F, 0.26F), vec3(0.25F, 0.30F, 0.55F), vec3(0.14F, 0.56F, 0.55F),
                              vec3(0.48F, 0.80F, 0.33F), vec3(0.99F, 0.90F, 0.15F)},
                             {{1e-4F, "0.1mm"}, {1e-3F, "1mm"}, {1e-2F, "1cm"}, {1e-1F, "10cm"}, {1, "1m"}}};
    return scale;
}

const Scale& side_scale() {
    static const Scale scale{
        0.01F, 100, bias_scale().colors, {{0.01F, "0.01"}, {0.1F, "0.1"}, {1, "1"}, {10, "10"}, {100, "100"}}};
    return scale;
}

/// A bar with its values in the lower left corner, where the picture has room for it.
void burn_scale(Image& picture, const Scale& scale) {
    constexpr int bar = 200, tall = 8, edge = 6, text_scale = 2;
    const int label = text_height * text_scale, box = tall + label + 12;
    const int x = 4 + edge + 12, y = picture.height - box - 4 + 4;
    if (picture.width < bar + 60 || picture.height < 3 * box) {
        return;
    }
    fill(picture, 4, picture.height - box - 4, bar + 2 * edge + 36, box, paper);
    for (int i = 0; i < bar; ++i) {
        fill(picture, x + i, y, 1, tall, along(scale.colors, static_cast<float>(i) / (bar - 1)));
    }
    for (const auto& [value, text] : scale.ticks) {
        const int at = x + static_cast<int>(std::lround(scale.position(value) * (bar - 1)));
        fill(picture, at, y, 1, tall + 2, ink);
        burn_text(picture, at - text_width(text, text_scale) / 2, y + tall + 3, text, text_scale);
    }
}

/// A picture and the two channels of values: of `figures`, channel `c` is the value and 3 the state.
Shown color_figures(const Image& figures, int channel, const Scale& scale) {
    Shown shown;
    shown.picture = Image(figures.width, figures.height, 3);
    shown.values = Image(figures.width, figures.height, 2);
    for (int y = 0; y < figures.height; ++y) {
        for (int x = 0; x < figures.width; ++x) {
            const float value = figures.at(x, y, channel), state = figures.at(x, y, 3);
            shown.values.at(x, y, 0) = value;
            shown.values.at(x, y, 1) = state;
            put(shown.picture, x, y,
                state < 0      ? uncounted
                : state < 0.5F ? outside
                               : along(scale.colors, scale.position(value)));
        }
    }
    burn_scale(shown.picture, scale);
    return shown;
}

/// The least and the greatest value of a channel that texels hold.
struct Spread {
    float low = 0, high = 1;
    [[nodiscard]] float position(float value) const { return high > low ? (value - low) / (high - low) : 0.5F; }
};

/// Of the values that `counts` accepts, without the outermost half per cent on either side.
template <class Counts>
Spread spread_of_tiles(const Image& tiles, const LayerTiles& layout, int channel, const Counts& counts) {
    std::vector<float> values;
    const int pitch = layout.side + 2;
    for (int y = 0; y < tiles.height; ++y) {
        for (int x = 0; x < tiles.width; ++x) {
            const bool inside = x % pitch < layout.side && y % pitch < layout.side &&
                                y / pitch * layout.columns + x / pitch < layout.layers;
            if (inside && std::isfinite(tiles.at(x, y, channel)) && counts(x, y)) {
                values.push_back(tiles.at(x, y, channel));
            }
        }
    }
    if (values.empty()) {
        return {};
    }
    const auto at = [&values](double part) {
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
        std::nth_element(values.begin(), middle, values.end());
        return *middle;
    };
    return {at(0.005), at(0.995)};
}

/// Numbers the tiles of one block that starts at row `top`.
void number_tiles(Image& picture, const LayerTiles& layout, int top) {
    constexpr int scale = 2;
    const int pitch = layout.side + 2;
    for (int layer = 0; layer < layout.layers && layout.side >= 48; ++layer) {
        const int x = layer % layout.columns * pitch, y = top + layer / layout.columns * pitch;
        const std::string text = std::to_string(layer);
        fill(picture, x, y, text_width(text, scale) + 6, text_height * scale + 6, paper);
        burn_text(picture, x + 3, y + 3, text, scale);
    }
}

}  // namespace

Shown color_choice(const Image& choice, std::span<const float> shade, const LightViews& views) {
    Shown shown;
    shown.picture = Image(choice.width, choice.height, 3);
    shown.values = Image(choice.width, choice.height, 2);
    int most = 0;
    for (int y = 0; y < choice.height; ++y) {
        for (int x = 0; x < choice.width; ++x) {
            const auto first = static_cast<int>(choice.at(x, y, 0)), second = static_cast<int>(choice.at(x, y, 1));
            const float weight = choice.at(x, y, 2), state = choice.at(x, y, 3);
            const float lit = shade[static_cast<std::size_t>(y) * static_cast<std::size_t>(choice.width) +
                                    static_cast<std::size_t>(x)];
            const vec3 color = state < 0      ? uncounted
                               : state < 0.5F ? outside
                                              : glm::mix(hue(first), hue(second), second >= 0 ? weight : 0.0F);
            put(shown.picture, x, y, color * lit);
            shown.values.at(x, y, 0) = static_cast<float>(first) + weight;
            shown.values.at(x, y, 1) = state;
            most = state >= 0 ? std::max({most, first, second}) : most;
        }
    }

    // One swatch a view.
    constexpr int swatch = 22, scale = 2;
    if (choice.width >= (most + 1) * swatch + 8 && choice.height >= 3 * swatch) {
        for (int i = 0; i <= most; ++i) {
            fill(shown.picture, 4 + i * swatch, choice.height - swatch - 4, swatch, swatch, hue(i));
            const std::string text = std::to_string(i);
            const int x = 4 + i * swatch + (swatch - text_width(text, scale)) / 2;
            fill(shown.picture, x - 2, choice.height - swatch + 1, text_width(text, scale) + 4, 14, paper);
            burn_text(shown.picture, x, choice.height - swatch + 3, text, scale);
        }
    }
    const std::vector<std::string_view>& names = views.part->view_names;
    shown.legend = fmt::format(
        "Colours number the light views 0 to {}{}; mixed where two are blended, magenta where none holds the "
        "sample, grey where no light arrives.",
        most, names.empty() ? "" : fmt::format(" ({})", fmt::join(names, ", ")));
    return shown;
}

Shown color_texels(const Image& sizes) {
    Shown shown = color_figures(sizes, 0, texel_scale());
    shown.legend =
        "Map texels along a pixel's side where they are fewest, from 1/16 (red: steps show) over 1 (pale) to 16 (blue: "
        "finer than the picture); magenta: in no light view, grey: no light arrives.";
    return shown;
}

Shown color_undersampling(const Image& sizes) {
    Shown shown = color_figures(sizes, 2, undersampling_scale());
    shown.legend =
        "Pixels under a map texel where it covers most, from 1/16 (blue: finer than the picture) over 1 (pale) to 16 "
        "(red: "
        "steps show); magenta: in no light view, grey: no light arrives.";
    return shown;
}

Shown color_bias(const Image& sizes) {
    Shown shown = color_figures(sizes, 1, bias_scale());
    shown.legend =
        "Metres that the bias moves a receiver, from 0.1 mm (dark) over 1 cm (green) to 1 m (yellow); magenta: in no "
        "light view, grey: no light arrives.";
    return shown;
}

Shown color_side(const Image& side, const Image& sizes, std::string_view sentence, std::string_view others) {
    Image figures = sizes;
    for (std::size_t i = 0; i < side.values.size(); ++i) {
        figures.values[4 * i] = side.values[i];
    }
    Shown shown = color_figures(figures, 0, side_scale());
    shown.legend = fmt::format("{} From 0.01 (dark) over 1 (green) to 100 (yellow); {}.", sentence, others);
    return shown;
}

Shown color_map(const Image& tiles, const LayerTiles& layout, const TextureDesc& map, bool depth) {
    Shown shown;
    shown.values = tiles;
    const int channels = channels_of(map.format);
    shown.picture = Image(tiles.width, channels * (tiles.height + 2) - 2, 3);
    std::string ranges;
    for (int c = 0; c < channels; ++c) {
        // Stretch a channel over its own values; in a depth map, over those of casters.
        const auto holds = [&](int x, int y) { return !depth || tiles.at(x, y, c) < 1.0F; };
        const Spread spread = spread_of_tiles(tiles, layout, c, holds);
        const int top = c * (tiles.height + 2);
        for (int y = 0; y < tiles.height; ++y) {
            for (int x = 0; x < tiles.width; ++x) {
                const float grey = 0.06F + 0.90F * std::clamp(spread.position(tiles.at(x, y, c)), 0.0F, 1.0F);
                put(shown.picture, x, top + y, holds(x, y) ? vec3(grey) : vec3(0.16F, 0.20F, 0.30F));
            }
        }
        number_tiles(shown.picture, layout, top);
        ranges += fmt::format("{}{:.4g} to {:.4g}", c == 0 ? "" : ", ", spread.low, spread.high);
    }
    shown.legend =
        fmt::format("{} of {} x {} texels, {} from black to white{}: {}.",
                    layout.layers == 1 ? "One layer" : fmt::format("{} layers", layout.layers), map.width, map.height,
                    depth ? "depth" : "each channel", depth ? ", blue without a caster" : "", ranges);
    return shown;
}

Shown color_light(const Image& tiles, const LayerTiles& layout) {
    constexpr vec3 clay{0.93F, 0.86F, 0.74F}, haze{0.36F, 0.44F, 0.56F}, nothing{0.07F, 0.08F, 0.11F};
    Shown shown;
    shown.values = tiles;
    shown.picture = Image(tiles.width, tiles.height, 3);
    const Spread depths = spread_of_tiles(tiles, layout, 1, [&](int x, int y) { return tiles.at(x, y, 3) > 0.5F; });
    for (int y = 0; y < tiles.height; ++y) {
        for (int x = 0; x < tiles.width; ++x) {
            const float far = std::clamp(depths.position(tiles.at(x, y, 1)), 0.0F, 1.0F);
            const vec3 lit = glm::mix(clay, haze, 0.75F * far) * (0.25F + 0.75F * tiles.at(x, y, 0));
            put(shown.picture, x, y, tiles.at(x, y, 3) > 0.5F ? lit : nothing);
        }
    }
    number_tiles(shown.picture, layout, 0);
    shown.legend = "What the light sees: bright where surfaces face it, hazy where they are far from it.";
    return shown;
}

}  // namespace gn
