// SPDX-License-Identifier: MIT
#include "gpu/pass_writer.h"

namespace gn {

PassWriter::PassWriter(Device& device, const GraphDeclaration& declaration, GraphResources& resources,
                       UploadArena& arena)
    : declaration_(declaration), resources_(resources), recorder_(device, declaration, resources, arena) {
    // Labels are there when the instance has the extension; vkGetInstanceProcAddr answers null otherwise.
    begin_label_ = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(
        vkGetInstanceProcAddr(device.instance(), "vkCmdBeginDebugUtilsLabelEXT"));
    end_label_ = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(
        vkGetInstanceProcAddr(device.instance(), "vkCmdEndDebugUtilsLabelEXT"));
}

void PassWriter::write(VkCommandBuffer commands, const PlannedPass& planned, const Execute& execute) {
    const DeclaredPass& pass = declaration_.passes[planned.declared];
    if (begin_label_ != nullptr) {
        label(commands, pass.group.empty() ? pass.name : pass.group + "/" + pass.name);
    }
    barriers(commands, planned);
    recorder_.begin(commands, pass);
    if (execute) {
        execute(recorder_);
    }
    recorder_.end();
    if (end_label_ != nullptr) {
        end_label_(commands);
    }
}

void PassWriter::label(VkCommandBuffer commands, const std::string& name) const {
    const VkDebugUtilsLabelEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = name.c_str()};
    begin_label_(commands, &info);
}

void PassWriter::barriers(VkCommandBuffer commands, const PlannedPass& planned) const {
    std::vector<VkImageMemoryBarrier2> images;
    for (const ImageBarrier& barrier : planned.images) {
        const Range& range = barrier.range;
        images.push_back({
            .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
            .srcStageMask = barrier.src_stages,
            .srcAccessMask = barrier.src_access,
            .dstStageMask = barrier.dst_stages,
            .dstAccessMask = barrier.dst_access,
            .oldLayout = barrier.old_layout,
            .newLayout = barrier.new_layout,
            .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .image = resources_.image(barrier.texture),
            .subresourceRange = {aspects_of(declaration_.textures[barrier.texture].desc.format), range.mip, range.mips,
                                 range.layer, range.layers},
        });
    }
    std::vector<VkBufferMemoryBarrier2> buffers;
    for (const BufferBarrier& barrier : planned.buffers) {
        buffers.push_back({
            .sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2,
            .srcStageMask = barrier.src_stages,
            .srcAccessMask = barrier.src_access,
            .dstStageMask = barrier.dst_stages,
            .dstAccessMask = barrier.dst_access,
            .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
            .buffer = resources_.buffer(barrier.buffer),
            .size = VK_WHOLE_SIZE,
        });
    }
    if (images.empty() && buffers.empty()) {
        return;
    }
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
        .bufferMemoryBarrierCount = static_cast<std::uint32_t>(buffers.size()),
        .pBufferMemoryBarriers = buffers.data(),
        .imageMemoryBarrierCount = static_cast<std::uint32_t>(images.size()),
        .pImageMemoryBarriers = images.data(),
    };
    vkCmdPipelineBarrier2(commands, &dependency);
}

PassTimestamps::~PassTimestamps() {
    vkDestroyQueryPool(device_.vk(), pool_, nullptr);
}

void PassTimestamps::begin(VkCommandBuffer commands, std::uint32_t most) {
    const std::uint32_t count = 2 * most;
    if (capacity_ < count) {
        vkDestroyQueryPool(device_.vk(), pool_, nullptr);
        pool_ = VK_NULL_HANDLE;
        capacity_ = 0;
        const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                         .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                         .queryCount = count};
        GN_VK(vkCreateQueryPool(device_.vk(), &info, nullptr, &pool_));
        ++device_.counters().pools;
        capacity_ = count;
    }
    next_ = 0;
    if (count > 0) {
        vkCmdResetQueryPool(commands, pool_, 0, count);
    }
}

void PassTimestamps::stamp(VkCommandBuffer commands) {
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, next_++);
}

std::vector<double> PassTimestamps::read(bool wait) const {
    std::vector<double> ms(next_ / 2, 0.0);
    std::vector<std::uint64_t> ticks(next_);
    if (next_ == 0) {
        return ms;
    }
    const VkResult result =
        vkGetQueryPoolResults(device_.vk(), pool_, 0, next_, ticks.size() * 8, ticks.data(), 8,
                              VK_QUERY_RESULT_64_BIT | (wait ? VkFlags{VK_QUERY_RESULT_WAIT_BIT} : VkFlags{0}));
    if (result == VK_NOT_READY) {
        return ms;
    }
    GN_VK(result);
    for (std::size_t i = 0; i < ms.size(); ++i) {
        const auto span = static_cast<double>(ticks[2 * i + 1] - ticks[2 * i]);
        ms[i] = span * static_cast<double>(device_.properties().limits.timestampPeriod) * 1e-6;
    }
    return ms;
}

}  // namespace gn
