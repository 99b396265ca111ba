// SPDX-License-Identifier: MIT
#include "gpu/transfer.h"

#include "gpu/vk_names.h"

#include <algorithm>
#include <cstring>

namespace gn {
namespace {

Buffer staging_buffer(Device& device, const std::string& name, VkDeviceSize bytes) {
    return Buffer(device, {.name = name + " (staging)", .bytes = bytes, .host_visible = true});
}

/// Halves mip after mip by blits; mip 0 is in TRANSFER_DST before, all mips in SHADER_READ_ONLY after.
void fill_mips(VkCommandBuffer commands, const Texture2D& texture) {
    const TextureDesc& desc = texture.desc();
    const auto extent = [&](std::uint32_t mip) {
        return VkOffset3D{static_cast<std::int32_t>(std::max(desc.width >> mip, 1U)),
                          static_cast<std::int32_t>(std::max(desc.height >> mip, 1U)), 1};
    };
    for (std::uint32_t mip = 1; mip < desc.mips; ++mip) {
        full_image_barrier(commands, texture.vk(), {VK_IMAGE_ASPECT_COLOR_BIT, mip - 1, 1, 0, desc.layers},
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const VkImageBlit region{.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip - 1, 0, desc.layers},
                                 .srcOffsets = {{0, 0, 0}, extent(mip - 1)},
                                 .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, desc.layers},
                                 .dstOffsets = {{0, 0, 0}, extent(mip)}};
        vkCmdBlitImage(commands, texture.vk(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, texture.vk(),
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_LINEAR);
    }
    if (desc.mips > 1) {
        full_image_barrier(commands, texture.vk(), {VK_IMAGE_ASPECT_COLOR_BIT, 0, desc.mips - 1, 0, desc.layers},
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }
    full_image_barrier(commands, texture.vk(), {VK_IMAGE_ASPECT_COLOR_BIT, desc.mips - 1, 1, 0, desc.layers},
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

}  // namespace

void full_image_barrier(VkCommandBuffer commands, VkImage image, const VkImageSubresourceRange& range,
                        VkImageLayout from, VkImageLayout to) {
    const VkImageMemoryBarrier2 barrier{
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = range,
    };
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(commands, &dependency);
}

std::vector<std::byte> read_buffer(Device& device, VkBuffer buffer, VkDeviceSize bytes) {
    const Buffer staging = staging_buffer(device, "download", bytes);
    device.run([&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, bytes};
        vkCmdCopyBuffer(commands, buffer, staging.vk(), 1, &region);
    });
    return {staging.mapped(), staging.mapped() + bytes};
}

std::vector<std::byte> read_image(Device& device, VkImage image, const TextureDesc& desc, VkImageLayout layout,
                                  std::uint32_t mip, std::uint32_t layer) {
    if (mip >= desc.mips || layer >= desc.layers || desc.samples != 1) {
        fail("texture '{}' has no mip {} of layer {} to download ({} mips, {} layers, {} samples)", desc.name, mip,
             layer, desc.mips, desc.layers, desc.samples);
    }
    if (layout == VK_IMAGE_LAYOUT_UNDEFINED) {
        fail("texture '{}' has no contents to download: nothing was drawn into mip {} of layer {}", desc.name, mip,
             layer);
    }
    const std::uint32_t width = std::max(desc.width >> mip, 1U);
    const std::uint32_t height = std::max(desc.height >> mip, 1U);
    const VkDeviceSize bytes = VkDeviceSize{width} * height * format_bytes(desc.format);
    const VkImageAspectFlags aspect = is_depth(desc.format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    const Buffer staging = staging_buffer(device, desc.name, bytes);
    device.run([&](VkCommandBuffer commands) {
        full_image_barrier(commands, image, {aspects_of(desc.format), mip, 1, layer, 1}, layout,
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const VkBufferImageCopy region{.imageSubresource = {aspect, mip, layer, 1}, .imageExtent = {width, height, 1}};
        vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging.vk(), 1, &region);
    });
    return {staging.mapped(), staging.mapped() + bytes};
}

Buffer upload_buffer(Device& device, const BufferDesc& desc, std::span<const std::byte> data) {
    BufferDesc sized = desc;
    sized.bytes = std::max<VkDeviceSize>(desc.bytes, data.size());
    sized.host_visible = desc.host_visible || device.info().cpu;
    Buffer buffer(device, sized);
    if (data.empty()) {
        return buffer;
    }
    if (buffer.mapped() != nullptr) {
        std::memcpy(buffer.mapped(), data.data(), data.size());
        return buffer;
    }
    const Buffer staging = staging_buffer(device, desc.name, data.size());
    std::memcpy(staging.mapped(), data.data(), data.size());
    device.run([&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, data.size()};
        vkCmdCopyBuffer(commands, staging.vk(), buffer.vk(), 1, &region);
    });
    return buffer;
}

void write_buffer(Device& device, const Buffer& buffer, std::span<const std::byte> data) {
    const PlacedBytes all{0, data};
    write_buffer(device, buffer, std::span(&all, 1));
}

void write_buffer(Device& device, const Buffer& buffer, std::span<const PlacedBytes> data) {
    // Lay everything out behind each other.
    std::vector<VkBufferCopy> regions;
    VkDeviceSize total = 0;
    for (const PlacedBytes& placed : data) {
        const VkDeviceSize size = placed.bytes.size();
        if (placed.offset > buffer.desc().bytes || size > buffer.desc().bytes - placed.offset) {
            fail("buffer '{}' has {} bytes, and {} were to be written at {}", buffer.desc().name, buffer.desc().bytes,
                 size, placed.offset);
        }
        if (size > 0) {
            regions.push_back({total, placed.offset, size});
            total += size;
        }
    }
    if (regions.empty()) {
        return;
    }
    const Buffer staging = staging_buffer(device, buffer.desc().name, total);
    std::byte* end = staging.mapped();
    for (const PlacedBytes& placed : data) {
        end = std::copy(placed.bytes.begin(), placed.bytes.end(), end);
    }
    device.run([&](VkCommandBuffer commands) {
        vkCmdCopyBuffer(commands, staging.vk(), buffer.vk(), static_cast<std::uint32_t>(regions.size()),
                        regions.data());
    });
}

Texture2D upload_texture(Device& device, const TextureDesc& desc, std::span<const std::byte> data) {
    const VkDeviceSize expected = VkDeviceSize{desc.width} * desc.height * desc.layers * format_bytes(desc.format);
    if (data.size() != expected) {
        fail("texture '{}' of {} x {} x {} layers, {}, takes {} bytes, not {}", desc.name, desc.width, desc.height,
             desc.layers, format_name(desc.format), expected, data.size());
    }
    TextureDesc sampled = desc;
    sampled.usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
    Texture2D texture(device, sampled);
    const Buffer staging = staging_buffer(device, desc.name, data.size());
    std::memcpy(staging.mapped(), data.data(), data.size());
    device.run([&](VkCommandBuffer commands) {
        full_image_barrier(commands, texture.vk(), {VK_IMAGE_ASPECT_COLOR_BIT, 0, desc.mips, 0, desc.layers},
                           VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, desc.layers},
                                       .imageExtent = {desc.width, desc.height, 1}};
        vkCmdCopyBufferToImage(commands, staging.vk(), texture.vk(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        fill_mips(commands, texture);
    });
    std::fill(texture.layouts.begin(), texture.layouts.end(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    return texture;
}

std::vector<std::byte> download(Device& device, const Buffer& buffer) {
    if (buffer.mapped() != nullptr) {
        return {buffer.mapped(), buffer.mapped() + buffer.desc().bytes};
    }
    return read_buffer(device, buffer.vk(), buffer.desc().bytes);
}

std::vector<std::byte> download(Device& device, Texture2D& texture, std::uint32_t mip, std::uint32_t layer) {
    const std::size_t at = mip + std::size_t{layer} * texture.desc().mips;
    const VkImageLayout layout = at < texture.layouts.size() ? texture.layouts[at] : VK_IMAGE_LAYOUT_UNDEFINED;
    std::vector<std::byte> bytes = read_image(device, texture.vk(), texture.desc(), layout, mip, layer);
    texture.layouts[at] = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    return bytes;
}

}  // namespace gn
