// SPDX-License-Identifier: MIT
// Float images on the CPU; PNG, JPEG, WebP and EXR files.
#pragma once

#include "base/math.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace gn {

/// width x height x channels floats, rows top to bottom, channels interleaved.
struct Image {
    int width = 0, height = 0, channels = 0;
    std::vector<float> values;

    Image() = default;
    Image(int w, int h, int c, float fill = 0.0F);
    [[nodiscard]] std::size_t pixels() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    float& at(int x, int y, int c = 0) { return values[index(x, y, c)]; }
    [[nodiscard]] float at(int x, int y, int c = 0) const { return values[index(x, y, c)]; }

  private:
    [[nodiscard]] std::size_t index(int x, int y, int c) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
                   static_cast<std::size_t>(channels) +
               static_cast<std::size_t>(c);
    }
};

/// 8-bit RGBA, for textures; colours are sRGB-encoded, alpha is linear.
struct Image8 {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

/// Decodes PNG, JPEG or WebP. Throws Error naming `what` when the bytes are not a complete picture or exceed 16384 x 16384.
Image8 decode_image(std::span<const std::byte> bytes, const std::string& what);

/// Writes values in [0,1] as 8-bit PNG without any further curve (callers tone-map and encode first).
/// 1, 3 or 4 channels. Writes to a temporary name first, so that a failure never leaves half a file. Throws Error.
void write_png(const std::filesystem::path& path, const Image& image);
std::vector<std::byte> encode_png(const Image& image);

/// Writes 32-bit float EXR; channels named Y, RGB or RGBA by count, or as given. Throws Error.
void write_exr(const std::filesystem::path& path, const Image& image, std::span<const std::string> channel_names = {});
/// Reads what write_exr wrote. Throws Error.
Image read_exr(const std::filesystem::path& path);

/// The sRGB curve and its inverse, on one channel in [0,1]. IEC 61966-2-1.
float srgb_from_linear(float linear);
float linear_from_srgb(float encoded);

}  // namespace gn
