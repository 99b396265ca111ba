// SPDX-License-Identifier: MIT
// PNG through stb, EXR through tinyexr. A file appears under its name only when it is whole.
#include "base/error.h"
#include "base/image.h"

#include <stb/stb_image_write.h>
#include <tinyexr.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <numeric>
#include <string>

namespace gn {
namespace {

/// The largest side of a picture that is read, as for textures.
constexpr int largest_side_written = 16384;

/// Writes bytes beside `path`, then gives them its name in one step.
void write_whole(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    std::filesystem::path temporary = path;
    temporary += fmt::format(".{}.part", ::getpid());
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    file.close();

    // Withdraw the part on any failure, so that nothing half-written remains.
    std::error_code code = file ? std::error_code{} : std::make_error_code(std::errc::io_error);
    if (!code) {
        std::filesystem::rename(temporary, path, code);
    }
    if (code) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        fail("cannot write '{}'; the folder must exist, be writable and have space", path.string());
    }
}

std::uint8_t byte_from_unit(float value) {
    const float clamped = value > 0.0F ? std::min(value, 1.0F) : 0.0F;  // not a number becomes 0
    return static_cast<std::uint8_t>(std::lround(clamped * 255.0F));
}

void require_shape(const Image& image, const char* format, std::initializer_list<int> channels) {
    const bool known = std::find(channels.begin(), channels.end(), image.channels) != channels.end();
    if (image.pixels() == 0 || !known) {
        fail(
            "cannot write a {} x {} picture of {} channels as {}; valid are pictures of at least one pixel with {} "
            "channels",
            image.width, image.height, image.channels, format, fmt::join(channels, ", "));
    }
    GN_CHECK_EQ(image.values.size(), image.pixels() * static_cast<std::size_t>(image.channels));
}

/// "Y", "RGB", "RGBA" by count.
std::vector<std::string> default_channel_names(int channels) {
    switch (channels) {
        case 1: return {"Y"};
        case 3: return {"R", "G", "B"};
        case 4: return {"R", "G", "B", "A"};
        default:
            fail("an EXR of {} channels needs {} channel names; only 1, 3 and 4 have their own", channels, channels);
    }
}

/// The order in which the file keeps channels: by name.
std::vector<std::size_t> file_order(std::span<const std::string> names) {
    std::vector<std::size_t> order(names.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return names[a] < names[b]; });
    return order;
}

std::vector<float> plane(const Image& image, std::size_t channel) {
    std::vector<float> values(image.pixels());
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = image.values[i * static_cast<std::size_t>(image.channels) + channel];
    }
    return values;
}

/// The library's sentence, freed.
std::string take_message(const char* message) {
    std::string text = message != nullptr ? message : "unknown fault";
    if (message != nullptr) {
        FreeEXRErrorMessage(message);
    }
    return text;
}

std::vector<std::byte> encode_exr(const Image& image, std::span<const std::string> names, const std::string& what) {
    // Lay the channels out as planes in the file's order.
    const std::vector<std::size_t> order = file_order(names);
    std::vector<std::vector<float>> planes;
    std::vector<unsigned char*> pointers;
    std::vector<EXRChannelInfo> channels(names.size());
    for (std::size_t c = 0; c < names.size(); ++c) {
        planes.push_back(plane(image, order[c]));
        pointers.push_back(reinterpret_cast<unsigned char*>(planes.back().data()));
        std::strncpy(channels[c].name, names[order[c]].c_str(), sizeof channels[c].name - 1);
    }

    // Ask for 32-bit floats in and out, in ZIP blocks.
    std::vector<int> types(names.size(), TINYEXR_PIXELTYPE_FLOAT);
    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = image.channels;
    header.channels = channels.data();
    header.pixel_types = types.data();
    header.requested_pixel_types = types.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
    EXRImage planar;
    InitEXRImage(&planar);
    planar.num_channels = image.channels;
    planar.images = pointers.data();
    planar.width = image.width;
    planar.height = image.height;

    unsigned char* memory = nullptr;
    const char* message = nullptr;
    const std::size_t size = SaveEXRImageToMemory(&planar, &header, &memory, &message);
    const std::unique_ptr<unsigned char, decltype(&std::free)> owner(memory, &std::free);
    if (size == 0) {
        fail("cannot encode '{}' as EXR: {}", what, take_message(message));
    }
    const auto* first = reinterpret_cast<const std::byte*>(memory);
    return {first, first + size};
}

/// Where a file's channel goes in the picture: R, G, B, A in that order, all others as the file has them.
std::vector<std::size_t> picture_order(const EXRHeader& header) {
    std::vector<std::string> names;
    names.reserve(static_cast<std::size_t>(header.num_channels));
    for (int c = 0; c < header.num_channels; ++c) {
        names.emplace_back(header.channels[c].name);
    }
    const std::array<std::string, 4> colours{"R", "G", "B", "A"};
    std::vector<std::size_t> order;
    for (std::size_t c = 0; c < names.size() && c < colours.size(); ++c) {
        const auto found = std::find(names.begin(), names.end(), colours[c]);
        if (found == names.end()) {
            break;
        }
        order.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    if (order.size() != names.size()) {
        order.resize(names.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
    }
    return order;
}

struct ExrHeader : EXRHeader {
    ExrHeader() { InitEXRHeader(this); }
    ~ExrHeader() { FreeEXRHeader(this); }
    ExrHeader(const ExrHeader&) = delete;
    ExrHeader& operator=(const ExrHeader&) = delete;
};

struct ExrImage : EXRImage {
    ExrImage() { InitEXRImage(this); }
    ~ExrImage() { FreeEXRImage(this); }
    ExrImage(const ExrImage&) = delete;
    ExrImage& operator=(const ExrImage&) = delete;
};

std::vector<unsigned char> read_bytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file.good() && !file.eof()) {
        fail("cannot read '{}'; it must be a readable EXR file", path.string());
    }
    return bytes;
}

/// Reads the header and refuses what write_exr never writes, before anything large is allocated.
void parse_header(std::span<const unsigned char> bytes, const std::filesystem::path& path, ExrHeader& header) {
    EXRVersion version{};
    const char* message = nullptr;
    if (ParseEXRVersionFromMemory(&version, bytes.data(), bytes.size()) != TINYEXR_SUCCESS) {
        fail("'{}' is not an EXR file", path.string());
    }
    if (version.tiled != 0 || version.multipart != 0 || version.non_image != 0) {
        fail("'{}' is a tiled, deep or multi-part EXR; valid is one part of scanlines", path.string());
    }
    if (ParseEXRHeaderFromMemory(&header, &version, bytes.data(), bytes.size(), &message) != TINYEXR_SUCCESS) {
        fail("'{}' is not a complete EXR file: {}", path.string(), take_message(message));
    }
    const auto& window = header.data_window;
    const long long width = static_cast<long long>(window.max_x) - window.min_x + 1;
    const long long height = static_cast<long long>(window.max_y) - window.min_y + 1;
    if (width < 1 || height < 1 || width > largest_side_written || height > largest_side_written) {
        fail("'{}' has {} x {} pixels; valid is 1 to {} a side", path.string(), width, height, largest_side_written);
    }
    for (int c = 0; c < header.num_channels; ++c) {
        header.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;
    }
}

}  // namespace

std::vector<std::byte> encode_png(const Image& image) {
    require_shape(image, "PNG", {1, 3, 4});
    std::vector<std::uint8_t> bytes(image.values.size());
    std::transform(image.values.begin(), image.values.end(), bytes.begin(), byte_from_unit);

    std::vector<std::byte> png;
    const auto append = [](void* context, void* data, int size) {
        const auto* first = static_cast<const std::byte*>(data);
        auto& out = *static_cast<std::vector<std::byte>*>(context);
        out.insert(out.end(), first, first + size);
    };
    const int stride = image.width * image.channels;
    if (stbi_write_png_to_func(append, &png, image.width, image.height, image.channels, bytes.data(), stride) == 0) {
        fail("cannot encode a {} x {} picture as PNG; there is not enough memory", image.width, image.height);
    }
    return png;
}

void write_png(const std::filesystem::path& path, const Image& image) {
    write_whole(path, encode_png(image));
}

void write_exr(const std::filesystem::path& path, const Image& image, std::span<const std::string> channel_names) {
    const std::vector<std::string> names = channel_names.empty()
                                               ? default_channel_names(image.channels)
                                               : std::vector<std::string>(channel_names.begin(), channel_names.end());
    require_shape(image, "EXR", {static_cast<int>(names.size())});
    write_whole(path, encode_exr(image, names, path.string()));
}

Image read_exr(const std::filesystem::path& path) {
    const std::vector<unsigned char> bytes = read_bytes(path);
    ExrHeader header;
    parse_header(bytes, path, header);
    ExrImage planar;
    const char* message = nullptr;
    if (LoadEXRImageFromMemory(&planar, &header, bytes.data(), bytes.size(), &message) != TINYEXR_SUCCESS) {
        fail("'{}' is not a complete EXR file: {}", path.string(), take_message(message));
    }

    // Interleave the planes.
    Image image(planar.width, planar.height, planar.num_channels);
    const std::vector<std::size_t> order = picture_order(header);
    for (std::size_t c = 0; c < order.size(); ++c) {
        const auto* values = reinterpret_cast<const float*>(planar.images[order[c]]);
        for (std::size_t i = 0; i < image.pixels(); ++i) {
            image.values[i * order.size() + c] = values[i];
        }
    }
    return image;
}

}  // namespace gn
