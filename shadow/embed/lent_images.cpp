// SPDX-License-Identifier: MIT
#include "shadow/embed/lent_images.h"

namespace gn::embed {

void LentImages::drop(std::map<Key, Kept>::iterator& entry) {
    frames_.retire(entry->second.texture);
    entry = kept_.erase(entry);
}

void LentImages::forget() {
    for (auto entry = kept_.begin(); entry != kept_.end();) {
        drop(entry);
    }
}

void LentImages::begin(uint width, uint height) {
    ++frame_;
    used_.clear();
    const bool resized = width != width_ || height != height_;
    for (auto entry = kept_.begin(); entry != kept_.end();) {
        if (resized || entry->second.last_used + frames_.in_flight() < frame_) {
            drop(entry);
        } else {
            ++entry;
        }
    }
    width_ = width;
    height_ = height;
}

TextureHandle LentImages::import(FrameGraph& graph, const char* name, const LentImage& lent, VkImageUsageFlags usage) {
    const bool missing = lent.image == VK_NULL_HANDLE && !foreseen_;
    if (missing || lent.format == VK_FORMAT_UNDEFINED) {
        fail("the frame's image of {} has no {}; lend an image with its format", name, missing ? "handle" : "format");
    }
    Kept& kept = kept_[{lent.image, lent.format, foreseen_ ? kept_.size() : 0}];
    if (kept.texture == nullptr) {
        kept.texture = std::make_shared<Texture2D>(Texture2D::borrow(device_,
                                                                     {.name = fmt::format("{}{}", lent_mark, name),
                                                                      .format = lent.format,
                                                                      .width = width_,
                                                                      .height = height_,
                                                                      .usage = usage},
                                                                     lent.image, lent.before));
    }
    kept.texture->layouts.assign(1, lent.before);
    kept.last_used = frame_;
    used_.emplace_back(kept.texture, lent.after);
    return graph.import(*kept.texture);
}

void LentImages::give_back(VkCommandBuffer commands) {
    std::vector<VkImageMemoryBarrier2> barriers;
    for (const auto& [texture, after] : used_) {
        // A layout of UNDEFINED asks for nothing, and none can be left.
        const VkImageLayout left = texture->layouts.front();
        barriers.push_back({.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                            .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                            .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                            .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                            .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                            .oldLayout = left,
                            .newLayout = after == VK_IMAGE_LAYOUT_UNDEFINED ? left : after,
                            .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                            .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                            .image = texture->vk(),
                            .subresourceRange = {aspects_of(texture->desc().format), 0, 1, 0, 1}});
    }
    const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                      .imageMemoryBarrierCount = static_cast<std::uint32_t>(barriers.size()),
                                      .pImageMemoryBarriers = barriers.data()};
    vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace gn::embed
