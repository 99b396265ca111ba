// SPDX-License-Identifier: MIT
// Copies between host and device for images and buffers that exist outside of Texture2D and Buffer too.
#pragma once

#include "gpu/memory.h"

namespace gn {

/// A VkImage without memory; adds nothing to desc.usage. Throws Error for what the device cannot make.
VkImage create_image(Device& device, const TextureDesc& desc);

/// A barrier between everything before and everything after, for code outside the frame graph.
void full_image_barrier(VkCommandBuffer commands, VkImage image, const VkImageSubresourceRange& range,
                        VkImageLayout from, VkImageLayout to);

/// One mip and layer, rows tightly packed; the image ends in TRANSFER_SRC_OPTIMAL. Depth-stencil: the depth.
std::vector<std::byte> read_image(Device& device, VkImage image, const TextureDesc& desc, VkImageLayout layout,
                                  std::uint32_t mip, std::uint32_t layer);
std::vector<std::byte> read_buffer(Device& device, VkBuffer buffer, VkDeviceSize bytes);

}  // namespace gn
