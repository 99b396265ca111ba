// SPDX-License-Identifier: MIT
// A barrier over all memory, where no single resource is meant.
#pragma once

#include <vulkan/vulkan.h>

namespace gn {

/// What some stages of the device do to memory.
struct BarrierSide {
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;
};
inline constexpr BarrierSide all_writes{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT};
inline constexpr BarrierSide all_uses{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                      VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
inline constexpr BarrierSide host_reads{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};

/// What commands before it wrote, as `written` says, is there for those behind it, as `used` says.
inline void memory_barrier(VkCommandBuffer commands, const BarrierSide& written, const BarrierSide& used) {
    const VkMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                   .srcStageMask = written.stages,
                                   .srcAccessMask = written.access,
                                   .dstStageMask = used.stages,
                                   .dstAccessMask = used.access};
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace gn
