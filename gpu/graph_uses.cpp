// SPDX-License-Identifier: MIT
// What a pass's ports mean to Vulkan: stages, accesses and layouts.
#include "gpu/graph_plan.h"

#include <array>

namespace gn {

AttachmentFormats attachment_formats(const GraphDeclaration& declaration, const DeclaredPass& pass) {
    AttachmentFormats formats;
    for (const Use& use : pass.uses) {
        const bool depth = use.kind == UseKind::depth || use.kind == UseKind::depth_read_only;
        if (!depth && use.kind != UseKind::color) {
            continue;
        }
        const TextureDesc& target = declaration.textures[use.resource].desc;
        formats.samples = target.samples;
        if (depth) {
            formats.depth = target.format;
            formats.depth_read_only = use.kind == UseKind::depth_read_only;
        } else {
            formats.colors.push_back(target.format);
        }
    }
    return formats;
}

VkImageUsageFlags usage_of(UseKind kind) {
    switch (kind) {
        case UseKind::color: return VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
        case UseKind::depth:
        case UseKind::depth_read_only: return VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
        case UseKind::sample: return VK_IMAGE_USAGE_SAMPLED_BIT;
        case UseKind::storage_read:
        case UseKind::storage_write: return VK_IMAGE_USAGE_STORAGE_BIT;
        default: return 0;
    }
}

namespace {

constexpr VkPipelineStageFlags2 depth_stages =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkAccessFlags2 depth_both =
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
constexpr VkAccessFlags2 color_both = VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
constexpr VkAccessFlags2 storage_both = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;

VkPipelineStageFlags2 shader_stages(const DeclaredPass& pass) {
    return pass.draws() ? VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT
                        : VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
}

Access access_of_depth_read_only(VkFormat format) {
    // The stencil beside a read-only depth may still be written.
    if (has_stencil(format)) {
        return {depth_stages, depth_both, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL, true, false};
    }
    return {depth_stages, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
            VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, false, false};
}

Access texture_access(const DeclaredPass& pass, const Use& use, VkFormat format) {
    const VkPipelineStageFlags2 shaders = shader_stages(pass);
    const bool discards = use.load != Load::keep;
    switch (use.kind) {
        case UseKind::color:
            return {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, color_both,
                    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, true, discards};
        case UseKind::depth:
            return {depth_stages, depth_both, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, true, discards};
        case UseKind::depth_read_only: return access_of_depth_read_only(format);
        case UseKind::sample:
            return {shaders, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        case UseKind::storage_read: return {shaders, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
        case UseKind::storage_write: return {shaders, storage_both, VK_IMAGE_LAYOUT_GENERAL, true};
        case UseKind::copy_from:
            return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
        case UseKind::copy_to:
            return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, true};
        default: break;
    }
    GN_CHECK(false);
    return {};
}

Access buffer_access(const DeclaredPass& pass, UseKind kind) {
    const VkPipelineStageFlags2 shaders = shader_stages(pass);
    switch (kind) {
        case UseKind::storage_read:
            return {shaders, VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT};
        case UseKind::storage_write: return {.stages = shaders, .access = storage_both, .writes = true};
        case UseKind::vertices:
            return {VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT | shaders,
                    VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
        case UseKind::indices:
            return {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT | shaders,
                    VK_ACCESS_2_INDEX_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
        case UseKind::indirect: return {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT};
        case UseKind::copy_from: return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
        case UseKind::copy_to:
            return {.stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                    .access = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                    .writes = true};
        default: break;
    }
    GN_CHECK(false);
    return {};
}

bool covers(const Range& range, std::uint32_t mip, std::uint32_t layer) {
    return mip >= range.mip && mip - range.mip < range.mips && layer >= range.layer &&
           layer - range.layer < range.layers;
}

bool is_written_attachment(UseKind kind) {
    return kind == UseKind::color || kind == UseKind::depth;
}

/// The one layout in which two ports of a pass can hold the same texels.
VkImageLayout common_layout(const Access& held, UseKind held_kind, const Access& next, UseKind next_kind,
                            const std::string& pass, const std::string& texture) {
    if (held.layout == next.layout && !is_written_attachment(held_kind)) {
        return held.layout;
    }
    if (held_kind == UseKind::depth_read_only && next_kind == UseKind::sample) {
        return held.layout;
    }
    if (next_kind == UseKind::depth_read_only && held_kind == UseKind::sample) {
        return next.layout;
    }
    for (const UseKind kind : {held_kind, next_kind}) {
        if (is_written_attachment(kind) || kind == UseKind::depth_read_only) {
            fail(
                "pass '{}' uses the same texels of '{}' as {} and as {}; only a read-only depth may be sampled at once",
                pass, texture, use_name(held_kind), use_name(next_kind));
        }
    }
    return VK_IMAGE_LAYOUT_GENERAL;
}

}  // namespace

std::string_view use_name(UseKind kind) {
    static constexpr std::array<std::string_view, 11> names{
        "color",    "depth",   "depth_read_only", "sample",    "storage_read", "storage_write",
        "vertices", "indices", "indirect",        "copy_from", "copy_to"};
    return names[static_cast<std::size_t>(kind)];
}

bool writes(UseKind kind) {
    return kind == UseKind::color || kind == UseKind::depth || kind == UseKind::storage_write ||
           kind == UseKind::copy_to;
}

bool DeclaredPass::draws() const {
    for (const Use& use : uses) {
        if (use.kind == UseKind::color || use.kind == UseKind::depth || use.kind == UseKind::depth_read_only) {
            return true;
        }
    }
    return false;
}

std::optional<Access> access_of(const GraphDeclaration& declaration, const DeclaredPass& pass, std::uint32_t texture,
                                std::uint32_t mip, std::uint32_t layer) {
    const TextureDesc& desc = declaration.textures[texture].desc;
    std::optional<Access> merged;
    UseKind kind{};
    for (const Use& use : pass.uses) {
        if (!use.texture || use.resource != texture || !covers(use.range, mip, layer)) {
            continue;
        }
        const Access access = texture_access(pass, use, desc.format);
        if (!merged) {
            merged = access;
            kind = use.kind;
            continue;
        }
        merged->layout = common_layout(*merged, kind, access, use.kind, pass.name, desc.name);
        merged->stages |= access.stages;
        merged->access |= access.access;
        merged->writes = merged->writes || access.writes;
        merged->discards = merged->discards && access.discards;
        kind = use.kind == UseKind::depth_read_only ? use.kind : kind;
    }
    return merged;
}

std::optional<Access> access_of(const DeclaredPass& pass, std::uint32_t buffer) {
    std::optional<Access> merged;
    for (const Use& use : pass.uses) {
        if (use.texture || use.resource != buffer) {
            continue;
        }
        const Access access = buffer_access(pass, use.kind);
        if (!merged) {
            merged = access;
            continue;
        }
        merged->stages |= access.stages;
        merged->access |= access.access;
        merged->writes = merged->writes || access.writes;
    }
    return merged;
}

}  // namespace gn
