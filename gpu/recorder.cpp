// SPDX-License-Identifier: MIT
// Commands of a pass. What they may touch is checked in recorder_checks.cpp, what is bound in recorder_bind.cpp.
#include "gpu/recorder.h"

#include <algorithm>

namespace gn {

GraphRecorder::GraphRecorder(Device& device, const GraphDeclaration& declaration, GraphResources& resources,
                             UploadArena& arena)
    : device_(device),
      declaration_(declaration),
      resources_(resources),
      arena_(arena),
      push_descriptor_set_(reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(
          vkGetDeviceProcAddr(device.vk(), "vkCmdPushDescriptorSetKHR"))) {}

void GraphRecorder::begin(VkCommandBuffer commands, const DeclaredPass& pass) {
    commands_ = commands;
    pass_ = &pass;
    formats_ = {};
    pipeline_ = nullptr;
    descriptors_stale_ = push_stale_ = true;
    has_index_buffer_ = has_vertex_buffer_ = false;
    slots_.clear();
    bound_.clear();
    pending_.clear();
    push_size_ = 0;
    rendering_ = pass.draws();
    if (rendering_) {
        begin_rendering();
    }
}

void GraphRecorder::end() {
    if (rendering_) {
        vkCmdEndRendering(commands_);
    }
    rendering_ = false;
    pass_ = nullptr;
}

namespace {

VkAttachmentLoadOp load_op(Load load) {
    switch (load) {
        case Load::clear: return VK_ATTACHMENT_LOAD_OP_CLEAR;
        case Load::keep: return VK_ATTACHMENT_LOAD_OP_LOAD;
        case Load::discard: break;
    }
    return VK_ATTACHMENT_LOAD_OP_DONT_CARE;
}

bool is_integer(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R8_UINT:
        case VK_FORMAT_R8G8_UINT:
        case VK_FORMAT_R8G8B8A8_UINT:
        case VK_FORMAT_R16_UINT:
        case VK_FORMAT_R16G16_UINT:
        case VK_FORMAT_R16G16B16A16_UINT:
        case VK_FORMAT_R32_UINT:
        case VK_FORMAT_R32_SINT:
        case VK_FORMAT_R32G32_UINT:
        case VK_FORMAT_R32G32_SINT:
        case VK_FORMAT_R32G32B32A32_UINT:
        case VK_FORMAT_R32G32B32A32_SINT: return true;
        default: return false;
    }
}

VkClearValue clear_value(const Use& use, VkFormat format) {
    VkClearValue value{};
    if (use.kind != UseKind::color) {
        value.depthStencil = {use.clear.depth, use.clear_stencil.value_or(use.clear.stencil)};
    } else if (is_integer(format)) {
        for (int i = 0; i < 4; ++i) {
            value.color.uint32[i] = use.clear.bits[i];
        }
    } else {
        for (int i = 0; i < 4; ++i) {
            value.color.float32[i] = use.clear.color[i];
        }
    }
    return value;
}

}  // namespace

void GraphRecorder::begin_rendering() {
    std::vector<VkRenderingAttachmentInfo> colors;
    VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    VkRenderingAttachmentInfo stencil{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    std::uint32_t layers = 1;
    formats_ = attachment_formats(declaration_, *pass_);
    for (const Use& use : pass_->uses) {
        if (use.kind != UseKind::color && use.kind != UseKind::depth && use.kind != UseKind::depth_read_only) {
            continue;
        }
        const TextureDesc& target = declaration_.textures[use.resource].desc;
        layers = use.range.layers;
        width_ = std::max(target.width >> use.range.mip, 1U);
        height_ = std::max(target.height >> use.range.mip, 1U);

        // One view of all layers that are drawn into.
        const VkImageViewType type = layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
        VkRenderingAttachmentInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        info.imageView = resources_.view(use.resource, use.range, type, aspects_of(target.format));
        info.imageLayout = layout_of(use.resource, use.range);
        info.loadOp = load_op(use.load);
        info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        info.clearValue = clear_value(use, target.format);
        if (use.kind == UseKind::color) {
            colors.push_back(info);
            continue;
        }

        // A depth that is only tested is loaded and left alone; its stencil has a life of its own.
        depth = stencil = info;
        if (formats_.depth_read_only) {
            depth.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
            depth.storeOp = VK_ATTACHMENT_STORE_OP_NONE;
            stencil.loadOp = use.clear_stencil ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
        }
    }
    const bool has_depth = formats_.depth != VK_FORMAT_UNDEFINED;
    const VkRenderingInfo info{
        .sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
        .renderArea = {{0, 0}, {width_, height_}},
        .layerCount = layers,
        .colorAttachmentCount = static_cast<std::uint32_t>(colors.size()),
        .pColorAttachments = colors.data(),
        .pDepthAttachment = has_depth ? &depth : nullptr,
        .pStencilAttachment = has_depth && has_stencil(formats_.depth) ? &stencil : nullptr,
    };
    vkCmdBeginRendering(commands_, &info);
    begin_state();
}

void GraphRecorder::begin_state() {
    viewport(0, 0, static_cast<float>(width_), static_cast<float>(height_));
    scissor(0, 0, width_, height_);
    vkCmdSetDepthBias(commands_, 0, 0, 0);
    vkCmdSetStencilReference(commands_, VK_STENCIL_FACE_FRONT_AND_BACK, 0);
}

void GraphRecorder::forget() {
    pipeline_ = nullptr;
    descriptors_stale_ = push_stale_ = true;
    has_index_buffer_ = has_vertex_buffer_ = false;
    if (rendering_) {
        begin_state();
    }
}

void GraphRecorder::viewport(float x, float y, float width, float height) {
    require_rendering(true, "viewport");
    const VkViewport port{x, y, width, height, 0.0F, 1.0F};
    vkCmdSetViewport(commands_, 0, 1, &port);
}

void GraphRecorder::scissor(std::int32_t x, std::int32_t y, std::uint32_t width, std::uint32_t height) {
    require_rendering(true, "scissor");
    const VkRect2D rectangle{{x, y}, {width, height}};
    vkCmdSetScissor(commands_, 0, 1, &rectangle);
}

void GraphRecorder::depth_bias(float constant, float slope, float clamp) {
    require_rendering(true, "depth_bias");
    vkCmdSetDepthBias(commands_, constant, clamp, slope);
}

void GraphRecorder::stencil_reference(std::uint32_t value) {
    require_rendering(true, "stencil_reference");
    vkCmdSetStencilReference(commands_, VK_STENCIL_FACE_FRONT_AND_BACK, value);
}

void GraphRecorder::vertex_buffer(BufferHandle buffer, VkDeviceSize offset) {
    require(buffer, {UseKind::vertices}, "vertex_buffer");
    const VkBuffer vertices = resources_.buffer(buffer.index);
    vkCmdBindVertexBuffers(commands_, 0, 1, &vertices, &offset);
    has_vertex_buffer_ = true;
}

void GraphRecorder::index_buffer(BufferHandle buffer, VkDeviceSize offset) {
    require(buffer, {UseKind::indices}, "index_buffer");
    vkCmdBindIndexBuffer(commands_, resources_.buffer(buffer.index), offset, VK_INDEX_TYPE_UINT32);
    has_index_buffer_ = true;
}

void GraphRecorder::draw(std::uint32_t vertices, std::uint32_t instances, std::uint32_t first_vertex,
                         std::uint32_t first_instance) {
    prepare(VK_PIPELINE_BIND_POINT_GRAPHICS, "draw");
    vkCmdDraw(commands_, vertices, instances, first_vertex, first_instance);
}

void GraphRecorder::draw_indexed(std::uint32_t indices, std::uint32_t instances, std::uint32_t first_index,
                                 std::int32_t vertex_offset, std::uint32_t first_instance) {
    prepare(VK_PIPELINE_BIND_POINT_GRAPHICS, "draw_indexed");
    if (!has_index_buffer_) {
        fail("pass '{}' calls draw_indexed without an index_buffer", pass_->name);
    }
    vkCmdDrawIndexed(commands_, indices, instances, first_index, vertex_offset, first_instance);
}

void GraphRecorder::draw_indexed(std::span<const VkDrawIndexedIndirectCommand> draws) {
    const std::size_t most = device_.properties().limits.maxDrawIndirectCount;
    if (draws.size() < 2 || draws.size() > most || !device_.has(Feature::multi_draw_indirect)) {
        for (const VkDrawIndexedIndirectCommand& draw : draws) {
            draw_indexed(draw.indexCount, draw.instanceCount, draw.firstIndex, draw.vertexOffset, draw.firstInstance);
        }
        return;
    }
    prepare(VK_PIPELINE_BIND_POINT_GRAPHICS, "draw_indexed");
    if (!has_index_buffer_) {
        fail("pass '{}' calls draw_indexed without an index_buffer", pass_->name);
    }
    const UploadedBytes list = arena_.put(std::as_bytes(draws));
    vkCmdDrawIndexedIndirect(commands_, list.buffer, list.offset, static_cast<std::uint32_t>(draws.size()),
                             sizeof(VkDrawIndexedIndirectCommand));
}

void GraphRecorder::draw_indirect(BufferHandle arguments, VkDeviceSize offset) {
    require(arguments, {UseKind::indirect}, "draw_indirect");
    prepare(VK_PIPELINE_BIND_POINT_GRAPHICS, "draw_indirect");
    vkCmdDrawIndirect(commands_, resources_.buffer(arguments.index), offset, 1, sizeof(VkDrawIndirectCommand));
}

void GraphRecorder::draw_indexed_indirect(BufferHandle arguments, VkDeviceSize offset, std::uint32_t draws) {
    require(arguments, {UseKind::indirect}, "draw_indexed_indirect");
    prepare(VK_PIPELINE_BIND_POINT_GRAPHICS, "draw_indexed_indirect");
    if (!has_index_buffer_) {
        fail("pass '{}' calls draw_indexed_indirect without an index_buffer", pass_->name);
    }
    vkCmdDrawIndexedIndirect(commands_, resources_.buffer(arguments.index), offset, draws,
                             sizeof(VkDrawIndexedIndirectCommand));
}

void GraphRecorder::dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    prepare(VK_PIPELINE_BIND_POINT_COMPUTE, "dispatch");
    order(bound_);
    vkCmdDispatch(commands_, x, y, z);
}

void GraphRecorder::dispatch_indirect(BufferHandle arguments, VkDeviceSize offset) {
    require(arguments, {UseKind::indirect}, "dispatch_indirect");
    prepare(VK_PIPELINE_BIND_POINT_COMPUTE, "dispatch_indirect");
    std::vector<Touch> touches = bound_;
    touches.push_back({false, arguments.index, false});
    order(touches);
    vkCmdDispatchIndirect(commands_, resources_.buffer(arguments.index), offset);
}

void GraphRecorder::blit(TextureHandle from, Range from_range, TextureHandle to, Range to_range, VkFilter filter) {
    require_rendering(false, "blit");
    from_range = resolve(from, {from_range.mip, 1, from_range.layer, from_range.layers}, "blit");
    to_range = resolve(to, {to_range.mip, 1, to_range.layer, to_range.layers}, "blit");
    require(from, from_range, {UseKind::copy_from}, "blit");
    require(to, to_range, {UseKind::copy_to}, "blit");
    if (from_range.layers != to_range.layers) {
        fail("pass '{}' blits {} layers of '{}' to {} layers of '{}'; the counts must agree", pass_->name,
             from_range.layers, name_of(from), to_range.layers, name_of(to));
    }
    order({{true, from.index, false}, {true, to.index, true}});

    const auto corner = [&](TextureHandle texture, std::uint32_t mip) {
        const TextureDesc& texels = desc(texture);
        return VkOffset3D{static_cast<std::int32_t>(std::max(texels.width >> mip, 1U)),
                          static_cast<std::int32_t>(std::max(texels.height >> mip, 1U)), 1};
    };
    const VkImageAspectFlags aspects =
        is_depth(desc(from).format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    const VkImageBlit region{.srcSubresource = {aspects, from_range.mip, from_range.layer, from_range.layers},
                             .srcOffsets = {{0, 0, 0}, corner(from, from_range.mip)},
                             .dstSubresource = {aspects, to_range.mip, to_range.layer, to_range.layers},
                             .dstOffsets = {{0, 0, 0}, corner(to, to_range.mip)}};
    vkCmdBlitImage(commands_, resources_.image(from.index), layout_of(from.index, from_range),
                   resources_.image(to.index), layout_of(to.index, to_range), 1, &region, filter);
}

void GraphRecorder::copy(TextureHandle from, BufferHandle to, Range range) {
    require_rendering(false, "copy");
    range = resolve(from, {range.mip, 1, range.layer, range.layers}, "copy");
    require(from, range, {UseKind::copy_from}, "copy");
    require(to, {UseKind::copy_to}, "copy");
    const TextureDesc& texels = desc(from);
    const VkExtent3D extent{std::max(texels.width >> range.mip, 1U), std::max(texels.height >> range.mip, 1U), 1};
    const VkDeviceSize bytes = VkDeviceSize{extent.width} * extent.height * range.layers * format_bytes(texels.format);
    if (bytes > declaration_.buffers[to.index].desc.bytes) {
        fail("pass '{}' copies {} bytes of '{}' into '{}', which has {}", pass_->name, bytes, name_of(from),
             name_of(to), declaration_.buffers[to.index].desc.bytes);
    }
    order({{true, from.index, false}, {false, to.index, true}});
    const VkImageAspectFlags aspect = is_depth(texels.format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    const VkBufferImageCopy region{.imageSubresource = {aspect, range.mip, range.layer, range.layers},
                                   .imageExtent = extent};
    vkCmdCopyImageToBuffer(commands_, resources_.image(from.index), layout_of(from.index, range),
                           resources_.buffer(to.index), 1, &region);
}

void GraphRecorder::copy(BufferHandle from, BufferHandle to, VkDeviceSize bytes, VkDeviceSize from_offset,
                         VkDeviceSize to_offset) {
    require_rendering(false, "copy");
    require(from, {UseKind::copy_from}, "copy");
    require(to, {UseKind::copy_to}, "copy");
    const VkDeviceSize from_bytes = declaration_.buffers[from.index].desc.bytes;
    const VkDeviceSize to_bytes = declaration_.buffers[to.index].desc.bytes;
    if (from_offset > from_bytes || bytes > from_bytes - from_offset || to_offset > to_bytes ||
        bytes > to_bytes - to_offset) {
        fail("pass '{}' copies {} bytes from '{}' ({} bytes) at {} to '{}' ({} bytes) at {}, past an end", pass_->name,
             bytes, name_of(from), from_bytes, from_offset, name_of(to), to_bytes, to_offset);
    }
    if (bytes == 0) {
        return;
    }
    order({{false, from.index, false}, {false, to.index, true}});
    const VkBufferCopy region{from_offset, to_offset, bytes};
    vkCmdCopyBuffer(commands_, resources_.buffer(from.index), resources_.buffer(to.index), 1, &region);
}

void GraphRecorder::fill(BufferHandle buffer, std::uint32_t word) {
    require_rendering(false, "fill");
    require(buffer, {UseKind::copy_to}, "fill");
    order({{false, buffer.index, true}});
    vkCmdFillBuffer(commands_, resources_.buffer(buffer.index), 0, VK_WHOLE_SIZE, word);
}

}  // namespace gn
