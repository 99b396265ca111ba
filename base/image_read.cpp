// SPDX-License-Identifier: MIT
// PNG, JPEG and WebP in, with everything that a hostile file could inflate checked before memory is asked for.
#include "base/error.h"
#include "base/image.h"

#include <stb/stb_image.h>
#include <webp/decode.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

namespace gn {

namespace {

constexpr int largest_side_read = 16384;
// Deflate yields at most 1032 bytes for one, and a JPEG spends at least a bit on 64 pixels: fewer file bytes than
// this cannot hold the picture that the header promises.
constexpr std::size_t most_pixels_per_byte = std::size_t{1032} * 8;

enum class Format { png, jpeg, webp, other };

Format find_format(std::span<const std::byte> bytes) {
    const auto starts = [&](std::initializer_list<unsigned> magic) {
        return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin(),
                                                          [](unsigned m, std::byte b) { return std::byte(m) == b; });
    };
    if (starts({0x89, 'P', 'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A})) {
        return Format::png;
    }
    if (starts({'R', 'I', 'F', 'F'}) && bytes.size() >= 12 && std::memcmp(bytes.data() + 8, "WEBP", 4) == 0) {
        return Format::webp;
    }
    return starts({0xFF, 0xD8, 0xFF}) ? Format::jpeg : Format::other;
}

// Whether an end marker follows the first scan; a decoder would fill what a cut file lacks with grey.
bool jpeg_is_complete(std::span<const std::byte> bytes) {
    std::size_t at = 2;
    while (at + 4 <= bytes.size() && bytes[at] == std::byte{0xFF}) {
        const auto marker = static_cast<unsigned>(bytes[at + 1]);
        if (marker == 0xFF) {
            ++at;
            continue;
        }
        if (marker == 0xDA) {
            constexpr std::array end{std::byte{0xFF}, std::byte{0xD9}};
            return std::search(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end(), end.begin(), end.end()) !=
                   bytes.end();
        }
        at += 2 + (static_cast<std::size_t>(bytes[at + 2]) << 8U) + static_cast<std::size_t>(bytes[at + 3]);
    }
    return false;
}

void check_size(int width, int height, const std::string& what) {
    if (width <= 0 || height <= 0 || width > largest_side_read || height > largest_side_read) {
        fail("{}: a picture of {} x {} pixels; at most {} x {} are read", what, width, height, largest_side_read,
             largest_side_read);
    }
}

// A lossless WebP of one colour spends no bit on a pixel, so that its size says nothing about the file's: only the largest
// side bounds the memory.
Image8 decode_webp(std::span<const std::byte> bytes, const std::string& what) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    WebPBitstreamFeatures features{};
    if (WebPGetFeatures(data, bytes.size(), &features) != VP8_STATUS_OK) {
        fail("{}: the picture's header is damaged", what);
    }
    check_size(features.width, features.height, what);
    if (features.has_animation != 0) {
        fail("{}: the picture moves; only still WebP is read", what);
    }
    Image8 image{.width = features.width, .height = features.height, .rgba = {}};
    const std::size_t row = 4 * static_cast<std::size_t>(features.width);
    image.rgba.resize(row * static_cast<std::size_t>(features.height));
    if (WebPDecodeRGBAInto(data, bytes.size(), image.rgba.data(), image.rgba.size(), static_cast<int>(row)) ==
        nullptr) {
        fail("{}: the picture is cut off or damaged", what);
    }
    return image;
}

}  // namespace

Image8 decode_image(std::span<const std::byte> bytes, const std::string& what) {
    const Format format = find_format(bytes);
    if (format == Format::other) {
        fail("{}: not a PNG, JPEG or WebP picture", what);
    }
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        fail("{}: a picture file of {} bytes is too large", what, bytes.size());
    }
    if (format == Format::webp) {
        return decode_webp(bytes, what);
    }

    // Believe the header only as far as the file's size allows.
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    int width = 0;
    int height = 0;
    int channels = 0;
    if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0) {
        fail("{}: the picture's header is damaged", what);
    }
    check_size(width, height, what);
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (pixels / most_pixels_per_byte > bytes.size() || (format == Format::jpeg && !jpeg_is_complete(bytes))) {
        fail("{}: the picture is cut off", what);
    }

    constexpr int rgba = 4;
    const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
        stbi_load_from_memory(data, size, &width, &height, &channels, rgba), stbi_image_free);
    if (!decoded) {
        const char* reason = stbi_failure_reason();
        fail("{}: the picture cannot be decoded ({})", what, reason != nullptr ? reason : "no reason given");
    }
    Image8 image{.width = width, .height = height, .rgba = {}};
    image.rgba.assign(decoded.get(), decoded.get() + pixels * rgba);
    return image;
}

}  // namespace gn
