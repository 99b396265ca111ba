// SPDX-License-Identifier: MIT
#include "gpu/graph_builder.h"

#include <algorithm>

namespace gn {
namespace {

bool is_attachment(UseKind kind) {
    return kind == UseKind::color || kind == UseKind::depth || kind == UseKind::depth_read_only;
}

struct Shape {
    std::uint32_t width, height, layers, samples;
    bool operator==(const Shape&) const = default;
};

Shape shape_of(const TextureDesc& desc, const Range& range) {
    return {std::max(desc.width >> range.mip, 1U), std::max(desc.height >> range.mip, 1U), range.layers, desc.samples};
}

}  // namespace

void DeclaredPassBuilder::color(TextureHandle target, Load load, ClearValue clear, Range range) {
    add(UseKind::color, target, range, {.load = load, .clear = clear});
}
void DeclaredPassBuilder::depth(TextureHandle target, Load load, ClearValue clear, Range range) {
    add(UseKind::depth, target, range, {.load = load, .clear = clear});
}
void DeclaredPassBuilder::depth_read_only(TextureHandle target, Range range,
                                          std::optional<std::uint32_t> clear_stencil) {
    add(UseKind::depth_read_only, target, range, {.clear_stencil = clear_stencil});
}
void DeclaredPassBuilder::sample(TextureHandle texture, Range range) {
    add(UseKind::sample, texture, range);
}
void DeclaredPassBuilder::storage_read(TextureHandle texture, Range range) {
    add(UseKind::storage_read, texture, range);
}
void DeclaredPassBuilder::storage_write(TextureHandle texture, Range range) {
    add(UseKind::storage_write, texture, range);
}
void DeclaredPassBuilder::storage_read(BufferHandle buffer) {
    add(UseKind::storage_read, buffer);
}
void DeclaredPassBuilder::storage_write(BufferHandle buffer) {
    add(UseKind::storage_write, buffer);
}
void DeclaredPassBuilder::vertices(BufferHandle buffer) {
    add(UseKind::vertices, buffer);
}
void DeclaredPassBuilder::indices(BufferHandle buffer) {
    add(UseKind::indices, buffer);
}
void DeclaredPassBuilder::indirect(BufferHandle buffer) {
    add(UseKind::indirect, buffer);
}
void DeclaredPassBuilder::copy_from(TextureHandle texture, Range range) {
    add(UseKind::copy_from, texture, range);
}
void DeclaredPassBuilder::copy_to(TextureHandle texture, Range range) {
    add(UseKind::copy_to, texture, range);
}
void DeclaredPassBuilder::copy_from(BufferHandle buffer) {
    add(UseKind::copy_from, buffer);
}
void DeclaredPassBuilder::copy_to(BufferHandle buffer) {
    add(UseKind::copy_to, buffer);
}

void DeclaredPassBuilder::add(UseKind kind, BufferHandle buffer) {
    if (buffer.index >= declaration_.buffers.size()) {
        fail("pass '{}' declares a buffer as {} that the graph never gave out", pass_.name, use_name(kind));
    }
    pass_.uses.push_back({.kind = kind, .texture = false, .resource = buffer.index});
}

void DeclaredPassBuilder::add(UseKind kind, TextureHandle texture, Range range, Use use) {
    if (texture.index >= declaration_.textures.size()) {
        fail("pass '{}' declares a texture as {} that the graph never gave out", pass_.name, use_name(kind));
    }
    const DeclaredTexture& declared = declaration_.textures[texture.index];
    const TextureDesc& desc = declared.desc;
    if (range.mip >= desc.mips || range.layer >= desc.layers || range.mips == 0 || range.layers == 0) {
        fail("pass '{}' declares mip {} of layer {} of '{}', which has {} mips and {} layers", pass_.name, range.mip,
             range.layer, desc.name, desc.mips, desc.layers);
    }
    use.kind = kind;
    use.texture = true;
    use.resource = texture.index;
    use.range = {range.mip, std::min(range.mips, desc.mips - range.mip), range.layer,
                 std::min(range.layers, desc.layers - range.layer)};
    if (const VkImageUsageFlags needed = usage_of(kind); declared.imported && (desc.usage & needed) != needed) {
        fail("pass '{}' uses the imported texture '{}' as {}, but it was made without that usage", pass_.name,
             desc.name, use_name(kind));
    }
    if (is_attachment(kind)) {
        check_attachment(use);
    }
    pass_.uses.push_back(use);
}

void DeclaredPassBuilder::check_attachment(const Use& use) const {
    const TextureDesc& desc = declaration_.textures[use.resource].desc;
    if (is_depth(desc.format) != (use.kind != UseKind::color) || use.range.mips != 1) {
        fail("pass '{}' draws into '{}' as {}: that takes one mip of a {} format", pass_.name, desc.name,
             use_name(use.kind), use.kind == UseKind::color ? "color" : "depth");
    }
    for (const Use& other : pass_.uses) {
        if (!is_attachment(other.kind)) {
            continue;
        }
        const TextureDesc& other_desc = declaration_.textures[other.resource].desc;
        if (shape_of(desc, use.range) != shape_of(other_desc, other.range)) {
            fail("pass '{}' draws into '{}' and '{}', whose sizes, layers or samples differ", pass_.name,
                 other_desc.name, desc.name);
        }
        if (use.kind != UseKind::color && other.kind != UseKind::color) {
            fail("pass '{}' has two depth attachments, '{}' and '{}'", pass_.name, other_desc.name, desc.name);
        }
    }
}

}  // namespace gn
