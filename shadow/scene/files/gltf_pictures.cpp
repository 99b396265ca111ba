// SPDX-License-Identifier: MIT
// The pictures of a file: found behind textures and their extensions, decoded once each, kept within a bound.
#include "shadow/scene/files/gltf_pictures.h"

#include "shadow/scene/files/gltf_packed.h"

#include <algorithm>
#include <charconv>

namespace gn::gltf {

namespace {

constexpr const char* plain_surface = "the surface keeps its plain colour";

// As the parser decodes the name of a file: %20 is a blank, and so is +.
std::string decoded_uri(std::string_view uri) {
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned code = 0;
        const char* hex = uri.data() + std::min(i + 1, uri.size());
        const char* end = uri.data() + std::min(i + 3, uri.size());
        if (uri[i] == '%' && end - hex == 2 && std::from_chars(hex, end, code, 16).ptr == end) {
            name += static_cast<char>(code);
            i += 2;
        } else {
            name += uri[i] == '+' ? ' ' : uri[i];
        }
    }
    return name;
}

// The picture, then its mirror image to the right of it, below it, or both.
Image8 with_mirror_images(Image8 image, bool along_u, bool along_v) {
    if (!along_u && !along_v) {
        return image;
    }
    const int width = image.width, height = image.height;
    Image8 whole{along_u ? 2 * width : width, along_v ? 2 * height : height, {}};
    whole.rgba.reserve(4 * static_cast<std::size_t>(whole.width) * static_cast<std::size_t>(whole.height));
    for (int y = 0; y < whole.height; ++y) {
        for (int x = 0; x < whole.width; ++x) {
            const int from_x = x < width ? x : 2 * width - 1 - x, from_y = y < height ? y : 2 * height - 1 - y;
            const auto texel = image.rgba.begin() + 4 * (std::ptrdiff_t{from_y} * width + from_x);
            whole.rgba.insert(whole.rgba.end(), texel, texel + 4);
        }
    }
    return whole;
}

}  // namespace

bool Pictures::exists(int image) const {
    return image >= 0 && static_cast<std::size_t>(image) < file_.data.images.size();
}

// The pictures that stand for one texture, the preferred first: WebP is smaller and may be the only one. `otherwise` is what is
// so where there is none.
std::vector<int> Pictures::sources(int texture_index, const char* otherwise) {
    if (texture_index < 0) {
        return {};
    }
    if (static_cast<std::size_t>(texture_index) >= file_.data.textures.size()) {
        add_note(file_.notes, fmt::format("Texture {} does not exist; {}.", texture_index, otherwise));
        return {};
    }
    const tinygltf::Texture& texture = file_.data.textures[static_cast<std::size_t>(texture_index)];
    std::vector<int> found;
    const auto webp = texture.extensions.find("EXT_texture_webp");
    if (webp != texture.extensions.end()) {
        const double source = number(webp->second, "source").value_or(-1.0);
        if (source >= 0.0 && source < static_cast<double>(file_.data.images.size())) {
            found.push_back(static_cast<int>(source));
        }
    }
    if (exists(texture.source)) {
        found.push_back(texture.source);
    }
    if (found.empty()) {
        add_note(file_.notes,
                 fmt::format("Texture {} names no picture that can be read; {}.", texture_index, otherwise));
    }
    return found;
}

int Pictures::texture(int texture_index) {
    for (const int image : sources(texture_index, plain_surface)) {
        const int index = texture(texture_index, image);
        if (index >= 0) {
            say_failures(fmt::format("'{}' is taken instead", shown_name(image)));
            return index;
        }
    }
    say_failures(plain_surface);
    return -1;
}

int Pictures::shown_by_light(int texture_index) {
    constexpr const char* plain_light = "the light keeps its plain colour";
    for (const int image : sources(texture_index, plain_light)) {
        if (std::optional<Image8> picture = decode(image)) {
            say_failures(fmt::format("'{}' is taken instead", shown_name(image)));
            model_.textures.push_back({shown_name(image), std::move(*picture), false, false});
            return static_cast<int>(model_.textures.size()) - 1;
        }
    }
    say_failures(plain_light);
    return -1;
}

dvec2 Pictures::share_of_period(int texture_index) const {
    if (texture_index < 0 || static_cast<std::size_t>(texture_index) >= file_.data.textures.size()) {
        return dvec2(1.0);
    }
    const int index = file_.data.textures[static_cast<std::size_t>(texture_index)].sampler;
    if (index < 0 || static_cast<std::size_t>(index) >= file_.data.samplers.size()) {
        return dvec2(1.0);
    }
    const tinygltf::Sampler& sampler = file_.data.samplers[static_cast<std::size_t>(index)];
    return {sampler.wrapS == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? 0.5 : 1.0,
            sampler.wrapT == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? 0.5 : 1.0};
}

int Pictures::texture(int texture_index, int image_index) {
    // How it is repeated.
    const tinygltf::Texture& texture = file_.data.textures[static_cast<std::size_t>(texture_index)];
    bool repeat_u = true;
    bool repeat_v = true;
    if (texture.sampler >= 0 && static_cast<std::size_t>(texture.sampler) < file_.data.samplers.size()) {
        const tinygltf::Sampler& sampler = file_.data.samplers[static_cast<std::size_t>(texture.sampler)];
        repeat_u = sampler.wrapS != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
        repeat_v = sampler.wrapT != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    }
    const dvec2 share = share_of_period(texture_index);
    const bool mirrored_u = share.x < 1.0, mirrored_v = share.y < 1.0;

    const std::array key{image_index, int(repeat_u), int(repeat_v), int(mirrored_u), int(mirrored_v)};
    const auto known = textures_.find(key);
    if (known != textures_.end()) {
        return known->second;
    }
    int index = -1;
    if (std::optional<Image8> image = decode(image_index)) {
        const std::size_t image_pixels = image->rgba.size() / 4;
        index = static_cast<int>(model_.textures.size());
        model_.textures.push_back({shown_name(image_index),
                                   with_mirror_images(std::move(*image), mirrored_u, mirrored_v), repeat_u, repeat_v});
        pixels_ += model_.textures.back().image.rgba.size() / 4 - image_pixels;
    }
    textures_[key] = index;
    return index;
}

vec2 Pictures::mean_green_blue(int texture_index) {
    for (const int source : sources(texture_index, plain_surface)) {
        const auto known = means_.find(source);
        if (known != means_.end()) {
            return known->second;
        }
        if (const std::optional<Image8> image = decode(source)) {
            std::uint64_t green = 0;
            std::uint64_t blue = 0;
            for (std::size_t i = 0; i < image->rgba.size(); i += 4) {
                green += image->rgba[i + 1];
                blue += image->rgba[i + 2];
            }
            const double whole = 255.0 * static_cast<double>(image->rgba.size() / 4);
            means_[source] = vec2(static_cast<double>(green) / whole, static_cast<double>(blue) / whole);
            say_failures(fmt::format("'{}' is taken instead", shown_name(source)));
            return means_[source];
        }
    }
    say_failures(plain_surface);
    return vec2(1.0F);
}

std::string Pictures::shown_name(int image) const {
    const tinygltf::Image& data = file_.data.images[static_cast<std::size_t>(image)];
    const std::string& name = !data.name.empty() ? data.name : data.uri;
    return name.empty() ? fmt::format("image {}", image) : clean_text(name);
}

std::span<const std::byte> Pictures::bytes_of(int image) const {
    const auto external = file_.external_images.find(image);
    if (external != file_.external_images.end()) {
        return external->second;
    }
    const tinygltf::Image& data = file_.data.images[static_cast<std::size_t>(image)];
    if (data.bufferView < 0) {
        const auto refusal = file_.refusals.find(decoded_uri(data.uri));
        if (refusal != file_.refusals.end()) {
            throw Error(refusal->second);
        }
        fail("picture '{}' cannot be read from the model's folder", shown_name(image));
    }
    return std::as_bytes(view_bytes(file_, data.bufferView));
}

std::optional<Image8> Pictures::decode(int image) {
    if (broken_.count(image) > 0) {
        return std::nullopt;
    }
    try {
        if (pixels_ > max_texture_pixels) {
            fail("picture '{}' is one too many: a scene may have {} pixels in all", shown_name(image),
                 max_texture_pixels);
        }
        Image8 decoded = decode_image(bytes_of(image), fmt::format("picture '{}'", shown_name(image)));
        pixels_ += decoded.rgba.size() / 4;
        return decoded;
    } catch (const Error& problem) {
        broken_[image] = true;
        failures_.emplace_back(problem.what());
        return std::nullopt;
    }
}

void Pictures::say_failures(const std::string& instead) {
    for (const std::string& failure : failures_) {
        add_note(file_.notes, fmt::format("{}; {}.", failure, instead));
    }
    failures_.clear();
}

}  // namespace gn::gltf
