// SPDX-License-Identifier: MIT
#include "gpu/shader_inputs.h"

#include <fmt/format.h>

#include <algorithm>

namespace gn {
namespace {

/// Mesa's software driver takes numbers that a branch depends on for constants, and compiles a shader anew for others. Wherever it takes
/// one it takes the block's first number too (seen with Mesa 22.3), which is a light's place more often than not: every light, and every
/// step of one that moves, cost a compilation. So the first number of a block is one that never changes.
constexpr std::string_view first_member = "    uvec4 unread;\n";
constexpr std::size_t first_bytes = 16;

}  // namespace

std::string_view image_format(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R32_SFLOAT: return "r32f";
        case VK_FORMAT_R32G32_SFLOAT: return "rg32f";
        case VK_FORMAT_R32G32B32A32_SFLOAT: return "rgba32f";
        case VK_FORMAT_R32G32_UINT: return "rg32ui";
        case VK_FORMAT_R16G16B16A16_SFLOAT: return "rgba16f";
        case VK_FORMAT_R16G16_SFLOAT: return "rg16f";
        case VK_FORMAT_R16G16_UNORM: return "rg16";
        case VK_FORMAT_R16G16B16A16_UNORM: return "rgba16";
        case VK_FORMAT_R8G8_UNORM: return "rg8";
        case VK_FORMAT_R8G8B8A8_UNORM: return "rgba8";
        default: return "";
    }
}

std::shared_ptr<ShaderInputs::List> ShaderInputs::nothing() {
    static const auto list = std::make_shared<List>();
    return list;
}

ShaderInputs::List& ShaderInputs::own() {
    if (list_.use_count() > 1) {
        list_ = std::make_shared<List>(*list_);
    }
    return *list_;
}

ShaderInputs& ShaderInputs::texture(std::string_view type, std::string_view name, TextureHandle handle,
                                    const SamplerDesc& sampler) {
    own().entries.push_back({.kind = Kind::texture,
                             .name = std::string(name),
                             .type = std::string(type),
                             .texture = handle,
                             .sampler = sampler});
    return *this;
}

ShaderInputs& ShaderInputs::texels(const Device& device, VkFormat format, std::string_view shape, std::string_view name,
                                   TextureHandle handle) {
    const std::string sign = image_format(format).ends_with("ui") ? "u" : "";
    // A software driver fetches texels several times faster as those of an image.
    if (device.info().cpu && !image_format(format).empty()) {
        image(image_format(format), "readonly", (sign + "image").append(shape), name, handle);
    } else {
        texture((sign + "sampler").append(shape), name, handle);
    }
    own().entries.back().texels = true;
    return *this;
}

ShaderInputs& ShaderInputs::image(std::string_view format, std::string_view access, std::string_view type,
                                  std::string_view name, TextureHandle handle) {
    own().entries.push_back({.kind = Kind::image,
                             .name = std::string(name),
                             .type = std::string(type),
                             .format = std::string(format),
                             .access = std::string(access),
                             .texture = handle,
                             .writes = access != "readonly"});
    return *this;
}

ShaderInputs& ShaderInputs::buffer(std::string_view kind, std::string_view block, std::string_view members,
                                   BufferHandle handle) {
    own().entries.push_back({.kind = Kind::buffer,
                             .name = std::string(block),
                             .type = std::string(kind),
                             .members = std::string(members),
                             .buffer = handle,
                             .writes = kind == "buffer" || kind == "writeonly buffer"});
    return *this;
}

ShaderInputs& ShaderInputs::block(std::string_view kind, std::string_view block, std::string_view members,
                                  std::span<const std::byte> bytes) {
    own().entries.push_back({.kind = Kind::bytes,
                             .name = std::string(block),
                             .type = std::string(kind),
                             .members = std::string(members),
                             .bytes = {bytes.begin(), bytes.end()}});
    return *this;
}

ShaderInputs& ShaderInputs::constant_bytes(std::string_view type, std::string_view name,
                                           std::span<const std::byte> bytes) {
    List& list = own();
    list.constants.resize(std::max(list.constants.size(), first_bytes));
    list.constant_members.append("    ").append(type).append(" ").append(name).append(";\n");
    list.constants.insert(list.constants.end(), bytes.begin(), bytes.end());
    return *this;
}

ShaderInputs& ShaderInputs::add(const ShaderInputs& others) {
    const std::shared_ptr<const List> more = others.list_;
    List& list = own();
    list.entries.insert(list.entries.end(), more->entries.begin(), more->entries.end());
    list.constant_members += more->constant_members;
    if (!more->constants.empty()) {
        list.constants.resize(std::max(list.constants.size(), first_bytes));
        list.constants.insert(list.constants.end(), more->constants.begin() + first_bytes, more->constants.end());
    }
    return *this;
}

std::string ShaderInputs::declaration(const Entry& entry, unsigned binding) {
    std::string text;
    switch (entry.kind) {
        case Kind::texture:
            text = fmt::format("layout(binding = {}) uniform {} {};\n", binding, entry.type, entry.name);
            break;
        case Kind::image:
            text = fmt::format("layout(binding = {}, {}) uniform {} {} {};\n", binding, entry.format, entry.access,
                               entry.type, entry.name);
            break;
        case Kind::buffer:
        case Kind::bytes:
            text = fmt::format("layout(binding = {}, scalar) {} {} {{ {} }};\n", binding, entry.type, entry.name,
                               entry.members);
            break;
    }
    if (entry.texels && entry.kind == Kind::image) {
        text +=
            fmt::format("#define {0}_texel(at) imageLoad({0}, at)\n#define {0}_size() imageSize({0}).xy\n", entry.name);
    } else if (entry.texels) {
        text += fmt::format("#define {0}_texel(at) texelFetch({0}, at, 0)\n#define {0}_size() textureSize({0}, 0).xy\n",
                            entry.name);
    }
    return text;
}

std::string ShaderInputs::text(unsigned first) const {
    std::string text;
    for (const Entry& entry : list_->entries) {
        text += declaration(entry, first++);
    }
    if (!list_->constants.empty()) {
        text += fmt::format("layout(binding = {}, scalar) uniform Constants {{\n{}{}}} u;\n", first, first_member,
                            list_->constant_members);
    }
    return text;
}

void ShaderInputs::hash(Hasher& hasher) const {
    hasher.value(list_->entries.size());
    for (const Entry& entry : list_->entries) {
        hasher.value(entry.kind).value(entry.texels).text(entry.name).text(entry.type).text(entry.format);
        hasher.text(entry.access).text(entry.members);
    }
    hasher.text(list_->constant_members);
}

void ShaderInputs::declare(PassBuilder& pass) const {
    for (const Entry& entry : list_->entries) {
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
    for (const Entry& entry : list_->entries) {
        switch (entry.kind) {
            case Kind::texture: r.set(entry.name, entry.texture, entry.sampler); break;
            case Kind::image: r.set_storage(entry.name, entry.texture); break;
            case Kind::buffer: r.set(entry.name, entry.buffer); break;
            case Kind::bytes: r.set_bytes(entry.name, entry.bytes); break;
        }
    }
    if (!list_->constants.empty()) {
        r.set_bytes("u", list_->constants);
    }
}

}  // namespace gn
