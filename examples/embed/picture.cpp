// SPDX-License-Identifier: MIT
#include "picture.h"

#include <stb/stb_image_write.h>

#include <stdexcept>

void write_picture(const HostDevice& host, FrameSlot& slot, const HostImage& image, VkImageLayout layout,
                   const std::string& path) {
    const VkExtent2D size = image.size();
    const std::uint32_t channels = image.format() == VK_FORMAT_R8_UNORM ? 1 : 4;
    const HostBuffer bytes(host, VkDeviceSize{size.width} * size.height * channels, VK_BUFFER_USAGE_TRANSFER_DST_BIT);

    constexpr VkPipelineStageFlags2 all = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    const VkCommandBuffer commands = slot.begin();
    change_layout(commands, image, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, all, VK_PIPELINE_STAGE_2_TRANSFER_BIT);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {size.width, size.height, 1};
    vkCmdCopyImageToBuffer(commands, image.vk(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, bytes.vk(), 1, &copy);
    change_layout(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout, VK_PIPELINE_STAGE_2_TRANSFER_BIT, all);
    slot.submit();
    slot.wait();

    const auto pixels = bytes.as<std::uint8_t>();
    if (stbi_write_png(path.c_str(), static_cast<int>(size.width), static_cast<int>(size.height),
                       static_cast<int>(channels), pixels.data(), static_cast<int>(size.width * channels)) == 0) {
        throw std::runtime_error("the picture '" + path + "' cannot be written");
    }
}
