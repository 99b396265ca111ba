// SPDX-License-Identifier: MIT
#include "gpu/shader_inputs.h"

#include <fmt/format.h>

namespace gn {

std::string_view image_format(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R32_SFLOAT: return "r32f";
        case VK_FORMAT_R32G32_SFLOAT: return "rg32f";
        case VK_FORMAT_R32G32B32A32_SFLOAT: return "rgba32f";
        case VK_FORMAT_R16G16B16A16_SFLOAT: return "rgba16f";
        case VK_FORMAT_R16G16_SFLOAT: return "rg16f";
        case VK_FORMAT_R16G16_UNORM: return "rg16";
        case VK_FORMAT_R16G16B16A16_UNORM: return "rgba16";
        case VK_FORMAT_R8G8_UNORM: return "rg8";
        case VK_FORMAT_R8G8B8A8_UNORM: return "rgba8";
        default: return "";
    }
}

ShaderInputs& ShaderInputs::texture(std::string_view type, std::string_view name, TextureHandle handle,
                                    const SamplerDesc& sampler) {
    entries_.push_back({.kind = Kind::texture,
                        .name = std::string(name),
                        .declaration = fmt::format("layout(binding = {{}}) uniform {} {};\n", type, name),
                        .texture = handle,
                        .sampler = sampler});
    return *this;
}

ShaderInputs& ShaderInputs::texels(const Device& device, VkFormat format, std::string_view shape, std::string_view name,
                                   TextureHandle handle) {
    // A software driver fetches texels several times faster as those of an image.
    const bool image_wins = device.info().cpu && !image_format(format).empty();
    if (image_wins) {
        image(image_format(format), "readonly", fmt::format("image{}", shape), name, handle);
    } else {
        texture(fmt::format("sampler{}", shape), name, handle);
    }
    entries_.back().declaration += image_wins ? fmt::format(
                                                    "#define {0}_texel(at) imageLoad({0}, at)\n"
                                                    "#define {0}_size() imageSize({0}).xy\n",
                                                    name)
                                              : fmt::format(
                                                    "#define {0}_texel(at) texelFetch({0}, at, 0)\n"
                                                    "#define {0}_size() textureSize({0}, 0).xy\n",
                                                    name);
    return *this;
}

ShaderInputs& ShaderInputs::image(std::string_view format, std::string_view access, std::string_view type,
                                  std::string_view name, TextureHandle handle) {
    entries_.push_back(
        {.kind = Kind::image,
         .name = std::string(name),
         .declaration = fmt::format("layout(binding = {{}}, {}) uniform {} {} {};\n", format, access, type, name),
         .texture = handle,
         .reads = access != "writeonly",
         .writes = access != "readonly"});
    return *this;
}

ShaderInputs& ShaderInputs::buffer(std::string_view kind, std::string_view block, std::string_view members,
                                   BufferHandle handle) {
    entries_.push_back(
        {.kind = Kind::buffer,
         .name = std::string(block),
         .declaration = fmt::format("layout(binding = {{}}, scalar) {} {} {{{{ {} }}}};\n", kind, block, members),
         .buffer = handle,
         .writes = kind == "buffer" || kind == "writeonly buffer"});
    return *this;
}

ShaderInputs& ShaderInputs::block(std::string_view kind, std::string_view block, std::string_view members,
                                  std::span<const std::byte> bytes) {
    entries_.push_back(
        {.kind = Kind::bytes,
         .name = std::string(block),
         .declaration = fmt::format("layout(binding = {{}}, scalar) {} {} {{{{ {} }}}};\n", kind, block, members),
         .bytes = {bytes.begin(), bytes.end()}});
    return *this;
}

ShaderInputs& ShaderInputs::constant_bytes(std::string_view type, std::string_view name,
                                           std::span<const std::byte> bytes) {
    constant_members_ += fmt::format("    {} {};\n", type, name);
    constants_.insert(constants_.end(), bytes.begin(), bytes.end());
    return *this;
}

ShaderInputs& ShaderInputs::add(const ShaderInputs& others) {
    entries_.insert(entries_.end(), others.entries_.begin(), others.entries_.end());
    constant_members_ += others.constant_members_;
    constants_.insert(constants_.end(), others.constants_.begin(), others.constants_.end());
    return *this;
}

std::string ShaderInputs::text(unsigned first) const {
    std::string text;
    for (const Entry& entry : entries_) {
        text += fmt::format(fmt::runtime(entry.declaration), first++);
    }
    if (!constants_.empty()) {
        text += fmt::format("layout(binding = {}, scalar) uniform Constants {{\n{}}} u;\n", first, constant_members_);
    }
    return text;
}

void ShaderInputs::hash(Hasher& hasher) const {
    hasher.value(entries_.size());
    for (const Entry& entry : entries_) {
        hasher.text(entry.declaration);
    }
    hasher.text(constant_members_);
}

void ShaderInputs::declare(PassBuilder& pass) const {
    for (const Entry& entry : entries_) {
        if (entry.kind == Kind::texture) {
            pass.sample(entry.texture);
        } else if (entry.kind == Kind::image && entry.writes) {
            pass.storage_write(entry.texture);
        } else if (entry.kind == Kind::image) {
            pass.storage_read(entry.texture);
        } else if (entry.kind == Kind::buffer && entry.writes) {
            pass.storage_write(entry.buffer);
        } else if (entry.kind == Kind::buffer) {
            pass.storage_read(entry.buffer);
        }
    }
}

void ShaderInputs::set(Recorder& r) const {
    for (const Entry& entry : entries_) {
        switch (entry.kind) {
            case Kind::texture: r.set(entry.name, entry.texture, entry.sampler); break;
            case Kind::image: r.set_storage(entry.name, entry.texture); break;
            case Kind::buffer: r.set(entry.name, entry.buffer); break;
            case Kind::bytes: r.set_bytes(entry.name, entry.bytes); break;
        }
    }
    if (!constants_.empty()) {
        r.set_bytes("u", constants_);
    }
}

}  // namespace gn
