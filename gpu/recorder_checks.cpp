// SPDX-License-Identifier: MIT
// What a pass may touch, and the order of its commands outside rendering.
#include "gpu/memory_barrier.h"
#include "gpu/recorder.h"

#include <algorithm>

namespace gn {
namespace {

std::string names_of(std::initializer_list<UseKind> kinds) {
    std::string names;
    for (const UseKind kind : kinds) {
        names += (names.empty() ? "" : " or ") + std::string(use_name(kind));
    }
    return names;
}

bool contains(std::initializer_list<UseKind> kinds, UseKind kind) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

}  // namespace

const TextureDesc& GraphRecorder::desc(TextureHandle texture) const {
    if (texture.index >= declaration_.textures.size()) {
        fail("pass '{}' uses a texture handle that the graph never gave out", pass_->name);
    }
    return declaration_.textures[texture.index].desc;
}

const std::string& GraphRecorder::name_of(TextureHandle texture) const {
    return desc(texture).name;
}

const std::string& GraphRecorder::name_of(BufferHandle buffer) const {
    if (buffer.index >= declaration_.buffers.size()) {
        fail("pass '{}' uses a buffer handle that the graph never gave out", pass_->name);
    }
    return declaration_.buffers[buffer.index].desc.name;
}

Range GraphRecorder::resolve(TextureHandle texture, Range range, std::string_view what) const {
    const TextureDesc& texels = desc(texture);
    if (range.mip >= texels.mips || range.layer >= texels.layers) {
        fail("pass '{}', {}: '{}' has {} mips and {} layers; there is no mip {} of layer {}", pass_->name, what,
             texels.name, texels.mips, texels.layers, range.mip, range.layer);
    }
    range.mips = std::min(range.mips, texels.mips - range.mip);
    range.layers = std::min(range.layers, texels.layers - range.layer);
    return range;
}

void GraphRecorder::require(TextureHandle texture, const Range& range, std::initializer_list<UseKind> kinds,
                            std::string_view what) const {
    const std::string& name = name_of(texture);
    for (std::uint32_t layer = range.layer; layer < range.layer + range.layers; ++layer) {
        for (std::uint32_t mip = range.mip; mip < range.mip + range.mips; ++mip) {
            const bool declared = std::any_of(pass_->uses.begin(), pass_->uses.end(), [&](const Use& use) {
                return use.texture && use.resource == texture.index && contains(kinds, use.kind) &&
                       mip >= use.range.mip && mip - use.range.mip < use.range.mips && layer >= use.range.layer &&
                       layer - use.range.layer < use.range.layers;
            });
            if (!declared) {
                fail("pass '{}', {}: mip {} of layer {} of '{}' was not declared as {} in the pass's setup",
                     pass_->name, what, mip, layer, name, names_of(kinds));
            }
        }
    }
}

void GraphRecorder::require(BufferHandle buffer, std::initializer_list<UseKind> kinds, std::string_view what) const {
    const std::string& name = name_of(buffer);
    const bool declared = std::any_of(pass_->uses.begin(), pass_->uses.end(), [&](const Use& use) {
        return !use.texture && use.resource == buffer.index && contains(kinds, use.kind);
    });
    if (!declared) {
        fail("pass '{}', {}: buffer '{}' was not declared as {} in the pass's setup", pass_->name, what, name,
             names_of(kinds));
    }
}

void GraphRecorder::require_rendering(bool rendering, std::string_view command) const {
    if (rendering_ == rendering) {
        return;
    }
    if (rendering) {
        fail("pass '{}' calls {}, but declared no attachment to draw into", pass_->name, command);
    }
    fail("pass '{}' calls {}, which needs a pass without attachments", pass_->name, command);
}

bool GraphRecorder::declared_write(bool texture, std::uint32_t resource) const {
    return std::any_of(pass_->uses.begin(), pass_->uses.end(), [&](const Use& use) {
        return use.texture == texture && use.resource == resource && use.kind == UseKind::storage_write;
    });
}

VkImageLayout GraphRecorder::layout_of(std::uint32_t texture, const Range& range) const {
    std::optional<VkImageLayout> layout;
    for (std::uint32_t layer = range.layer; layer < range.layer + range.layers; ++layer) {
        for (std::uint32_t mip = range.mip; mip < range.mip + range.mips; ++mip) {
            const std::optional<Access> access = access_of(declaration_, *pass_, texture, mip, layer);
            GN_CHECK(access.has_value());
            if (layout && *layout != access->layout) {
                fail(
                    "pass '{}' reads mips or layers of '{}' together that it uses in different ways; give a narrower "
                    "range",
                    pass_->name, declaration_.textures[texture].desc.name);
            }
            layout = access->layout;
        }
    }
    return layout.value_or(VK_IMAGE_LAYOUT_UNDEFINED);
}

void GraphRecorder::order(const std::vector<Touch>& touches) {
    const auto conflicts = [&](const Touch& touch) {
        return std::any_of(pending_.begin(), pending_.end(), [&](const Touch& earlier) {
            return earlier.texture == touch.texture && earlier.resource == touch.resource &&
                   (earlier.writes || touch.writes);
        });
    };
    if (std::any_of(touches.begin(), touches.end(), conflicts)) {
        memory_barrier(commands_, all_writes, all_uses);
        pending_.clear();
    }
    pending_.insert(pending_.end(), touches.begin(), touches.end());
}

}  // namespace gn
