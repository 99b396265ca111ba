// SPDX-License-Identifier: MIT
// Materials: the base colour with its alpha, and one roughness and metalness a surface.
#include "shadow/scene/gltf_data.h"

#include <algorithm>

namespace gn::gltf {

namespace {

float to_float(double value, double low, double high) {
    return static_cast<float>(std::isnan(value) ? low : std::clamp(value, low, high));
}

vec3 to_color(const std::vector<double>& values, double most) {
    vec3 color(1.0F);
    for (std::size_t i = 0; i < std::min<std::size_t>(values.size(), 3); ++i) {
        color[static_cast<int>(i)] = to_float(values[i], 0.0, most);
    }
    return color;
}

// Decodes each picture once; a broken one is reported once and then missing.
class Pictures {
  public:
    Pictures(File& file, Model& model) : file_(file), model_(model) {}

    // Index into model.textures, or -1.
    int texture(int texture_index) {
        const tinygltf::Texture* texture = find(texture_index);
        if (texture == nullptr) {
            return -1;
        }
        bool repeat_u = true;
        bool repeat_v = true;
        if (texture->sampler >= 0 && static_cast<std::size_t>(texture->sampler) < file_.data.samplers.size()) {
            const tinygltf::Sampler& sampler = file_.data.samplers[static_cast<std::size_t>(texture->sampler)];
            repeat_u = sampler.wrapS != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
            repeat_v = sampler.wrapT != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
            if (sampler.wrapS == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ||
                sampler.wrapT == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) {
                add_note(file_.notes, "Mirrored repetition of a texture is shown as plain repetition.");
            }
        }

        const std::array key{texture->source, repeat_u ? 1 : 0, repeat_v ? 1 : 0};
        const auto known = textures_.find(key);
        if (known != textures_.end()) {
            return known->second;
        }
        int index = -1;
        if (std::optional<Image8> image = decode(texture->source)) {
            index = static_cast<int>(model_.textures.size());
            model_.textures.push_back({shown_name(texture->source), std::move(*image), repeat_u, repeat_v});
        }
        textures_[key] = index;
        return index;
    }

    // Mean green and blue of a roughness-metalness picture, (1, 1) without one.
    vec2 mean_roughness_metalness(int texture_index) {
        const tinygltf::Texture* texture = find(texture_index);
        if (texture == nullptr) {
            return vec2(1.0F);
        }
        const auto known = means_.find(texture->source);
        if (known != means_.end()) {
            return known->second;
        }
        vec2 mean(1.0F);
        if (const std::optional<Image8> image = decode(texture->source)) {
            std::uint64_t green = 0;
            std::uint64_t blue = 0;
            for (std::size_t i = 0; i < image->rgba.size(); i += 4) {
                green += image->rgba[i + 1];
                blue += image->rgba[i + 2];
            }
            const double whole = 255.0 * static_cast<double>(image->rgba.size() / 4);
            mean = vec2(static_cast<double>(green) / whole, static_cast<double>(blue) / whole);
        }
        means_[texture->source] = mean;
        return mean;
    }

  private:
    const tinygltf::Texture* find(int index) const {
        if (index < 0 || static_cast<std::size_t>(index) >= file_.data.textures.size()) {
            return nullptr;
        }
        const tinygltf::Texture& texture = file_.data.textures[static_cast<std::size_t>(index)];
        const bool exists = texture.source >= 0 && static_cast<std::size_t>(texture.source) < file_.data.images.size();
        return exists ? &texture : nullptr;
    }

    std::string shown_name(int image) const {
        const tinygltf::Image& data = file_.data.images[static_cast<std::size_t>(image)];
        const std::string& name = !data.name.empty() ? data.name : data.uri;
        return name.empty() ? fmt::format("image {}", image) : clean_text(name);
    }

    std::span<const std::byte> bytes_of(int image) const {
        const auto external = file_.external_images.find(image);
        if (external != file_.external_images.end()) {
            return external->second;
        }
        const tinygltf::Image& data = file_.data.images[static_cast<std::size_t>(image)];
        if (data.bufferView < 0) {
            fail("picture '{}' cannot be read from the model's folder", shown_name(image));
        }
        const tinygltf::BufferView& view = at(file_.data.bufferViews, data.bufferView, file_, "buffer view");
        const tinygltf::Buffer& buffer = at(file_.data.buffers, view.buffer, file_, "buffer");
        if (view.byteOffset > buffer.data.size() || view.byteLength > buffer.data.size() - view.byteOffset) {
            fail("picture '{}' does not lie inside its buffer", shown_name(image));
        }
        return {reinterpret_cast<const std::byte*>(buffer.data.data()) + view.byteOffset, view.byteLength};
    }

    std::optional<Image8> decode(int image) {
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
            add_note(file_.notes, fmt::format("{}; the surface keeps its plain colour.", problem.what()));
            return std::nullopt;
        }
    }

    File& file_;
    Model& model_;
    std::map<std::array<int, 3>, int> textures_;
    std::map<int, vec2> means_;
    std::map<int, bool> broken_;
    std::size_t pixels_ = 0;
};

// KHR_texture_transform: scale, then rotate, then move.
UvUse read_uv_use(const tinygltf::TextureInfo& info) {
    UvUse use{.set = info.texCoord};
    const auto found = info.extensions.find("KHR_texture_transform");
    if (found == info.extensions.end() || !found->second.IsObject()) {
        return use;
    }
    const tinygltf::Value& transform = found->second;
    const auto pair = [&](const char* key, dvec2 otherwise) {
        if (!transform.Has(key) || transform.Get(key).ArrayLen() != 2) {
            return otherwise;
        }
        const tinygltf::Value& values = transform.Get(key);
        return values.Get(0).IsNumber() && values.Get(1).IsNumber()
                   ? dvec2(values.Get(0).GetNumberAsDouble(), values.Get(1).GetNumberAsDouble())
                   : otherwise;
    };
    const dvec2 scale = pair("scale", dvec2(1.0));
    const dvec2 offset = pair("offset", dvec2(0.0));
    const double angle = number(transform, "rotation").value_or(0.0);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    use.uv_from_file =
        glm::dmat3(dvec3(c * scale.x, -s * scale.x, 0.0), dvec3(s * scale.y, c * scale.y, 0.0), dvec3(offset, 1.0));
    if (const std::optional<double> set = number(transform, "texCoord"); set && *set >= 0.0 && *set < 1000.0) {
        use.set = static_cast<int>(*set);
    }
    return use;
}

Material read_material(const tinygltf::Material& data, Pictures& pictures) {
    // Surface.
    const tinygltf::PbrMetallicRoughness& pbr = data.pbrMetallicRoughness;
    Material material{.name = clean_text(data.name)};
    const double alpha = pbr.baseColorFactor.size() == 4 ? pbr.baseColorFactor[3] : 1.0;
    material.base_color = vec4(to_color(pbr.baseColorFactor, 1.0), to_float(alpha, 0.0, 1.0));
    material.base_color_texture = pictures.texture(pbr.baseColorTexture.index);
    const vec2 mean = pictures.mean_roughness_metalness(pbr.metallicRoughnessTexture.index);
    material.roughness = mean.x * to_float(pbr.roughnessFactor, 0.0, 1.0);
    material.metallic = mean.y * to_float(pbr.metallicFactor, 0.0, 1.0);

    // Light of its own.
    double strength = 1.0;
    const auto found = data.extensions.find("KHR_materials_emissive_strength");
    if (found != data.extensions.end()) {
        strength = std::clamp(number(found->second, "emissiveStrength").value_or(1.0), 0.0, 1e9);
    }
    material.emissive = data.emissiveFactor.size() == 3 ? to_color(data.emissiveFactor, 1.0) : vec3(0.0F);
    material.emissive *= static_cast<float>(strength);

    // Coverage.
    material.alpha_mode = data.alphaMode == "MASK"    ? AlphaMode::mask
                          : data.alphaMode == "BLEND" ? AlphaMode::blend
                                                      : AlphaMode::opaque;
    material.alpha_cutoff = material.alpha_mode == AlphaMode::mask ? to_float(data.alphaCutoff, 0.0, 1e6) : 0.5F;
    material.double_sided = data.doubleSided;
    const auto through = data.extensions.find("KHR_materials_transmission");
    if (through != data.extensions.end()) {
        material.transmission = to_float(number(through->second, "transmissionFactor").value_or(0.0), 0.0, 1.0);
    }
    return material;
}

}  // namespace

std::vector<UvUse> load_materials(File& file, Model& model) {
    Pictures pictures(file, model);
    std::vector<UvUse> uses;
    for (const tinygltf::Material& data : file.data.materials) {
        model.materials.push_back(read_material(data, pictures));
        uses.push_back(read_uv_use(data.pbrMetallicRoughness.baseColorTexture));
    }
    model.materials.push_back({.name = "default"});
    uses.emplace_back();
    return uses;
}

}  // namespace gn::gltf
