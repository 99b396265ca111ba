// SPDX-License-Identifier: MIT
// Materials: the base colour with its alpha, and one roughness and metalness a surface.
#include "shadow/scene/files/gltf_pictures.h"

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

const tinygltf::Value* specular_glossiness(const tinygltf::Material& data) {
    const auto found = data.extensions.find("KHR_materials_pbrSpecularGlossiness");
    return found != data.extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

// Where the base colour's picture is named: the diffuse texture goes before that of metalness and roughness.
tinygltf::TextureInfo color_texture(const tinygltf::Material& data) {
    const tinygltf::Value* specular = specular_glossiness(data);
    if (specular == nullptr) {
        return data.pbrMetallicRoughness.baseColorTexture;
    }
    tinygltf::TextureInfo info;
    if (!specular->Has("diffuseTexture") || !specular->Get("diffuseTexture").IsObject()) {
        return info;
    }
    const tinygltf::Value& texture = specular->Get("diffuseTexture");
    const auto whole = [&](const char* key, int otherwise) {
        const double value = number(texture, key).value_or(otherwise);
        return value >= 0.0 && value < 1e9 ? static_cast<int>(value) : otherwise;
    };
    info.index = whole("index", -1);
    info.texCoord = whole("texCoord", 0);
    if (texture.Has("extensions") && texture.Get("extensions").IsObject()) {
        for (const std::string& key : texture.Get("extensions").Keys()) {
            info.extensions[key] = texture.Get("extensions").Get(key);
        }
    }
    return info;
}

// Diffuse colour and coverage take the place of the base colour; a glossy dielectric stands for the specular lobe.
void read_specular_glossiness(const tinygltf::Value& data, Material& material) {
    std::vector<double> diffuse{1.0, 1.0, 1.0, 1.0};
    if (data.Has("diffuseFactor") && data.Get("diffuseFactor").ArrayLen() == 4) {
        for (std::size_t i = 0; i < 4; ++i) {
            const tinygltf::Value& value = data.Get("diffuseFactor").Get(static_cast<int>(i));
            diffuse[i] = value.IsNumber() ? value.GetNumberAsDouble() : 1.0;
        }
    }
    material.base_color = vec4(to_color(diffuse, 1.0), to_float(diffuse[3], 0.0, 1.0));
    material.metallic = 0.0F;
    material.roughness = 1.0F - to_float(number(data, "glossinessFactor").value_or(1.0), 0.0, 1.0);
}

Material read_material(File& file, const tinygltf::Material& data, Pictures& pictures) {
    // Surface.
    const tinygltf::PbrMetallicRoughness& pbr = data.pbrMetallicRoughness;
    Material material{.name = clean_text(data.name)};
    const double alpha = pbr.baseColorFactor.size() == 4 ? pbr.baseColorFactor[3] : 1.0;
    material.base_color = vec4(to_color(pbr.baseColorFactor, 1.0), to_float(alpha, 0.0, 1.0));
    material.base_color_texture = pictures.texture(color_texture(data).index);
    const vec2 mean = pictures.mean_green_blue(pbr.metallicRoughnessTexture.index);
    material.roughness = mean.x * to_float(pbr.roughnessFactor, 0.0, 1.0);
    material.metallic = mean.y * to_float(pbr.metallicFactor, 0.0, 1.0);
    if (const tinygltf::Value* specular = specular_glossiness(data)) {
        read_specular_glossiness(*specular, material);
    }

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
    if (material.alpha_mode != AlphaMode::opaque && color_texture(data).index >= 0 && material.base_color_texture < 0) {
        note_lost_mask(file.notes, material.name);
    }
    const auto through = data.extensions.find("KHR_materials_transmission");
    if (through != data.extensions.end()) {
        material.transmission = to_float(number(through->second, "transmissionFactor").value_or(0.0), 0.0, 1.0);
    }
    return material;
}

}  // namespace

std::vector<UvUse> load_materials(File& file, Model& model, Pictures& pictures) {
    std::vector<UvUse> uses;
    for (const tinygltf::Material& data : file.data.materials) {
        model.materials.push_back(read_material(file, data, pictures));
        const tinygltf::TextureInfo color = color_texture(data);
        uses.push_back(read_uv_use(color));
        const dvec2 share = pictures.share_of_period(color.index);
        // After the file's own transform: repetition begins where its coordinates are whole.
        uses.back().uv_from_file = glm::dmat3(glm::dmat2(share.x, 0, 0, share.y)) * uses.back().uv_from_file;
    }
    model.materials.push_back({.name = "default"});
    uses.emplace_back();
    return uses;
}

}  // namespace gn::gltf
