// SPDX-License-Identifier: MIT
#include "gpu/graph_executor.h"

#include "gpu/transfer.h"

#include <chrono>

namespace gn {
namespace {

using Clock = std::chrono::steady_clock;

void global_barrier(VkCommandBuffer commands, VkPipelineStageFlags2 stage, VkAccessFlags2 access) {
    const VkMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                   .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                   .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                   .dstStageMask = stage,
                                   .dstAccessMask = access};
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace

GraphExecutor::GraphExecutor(Device& device) : device_(device), arena_(device) {
    const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                       .queueFamilyIndex = device.queue_family()};
    GN_VK(vkCreateCommandPool(device.vk(), &pool, nullptr, &pool_));
    const VkCommandBufferAllocateInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .commandPool = pool_,
                                               .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                               .commandBufferCount = 1};
    GN_VK(vkAllocateCommandBuffers(device.vk(), &commands, &commands_));
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    GN_VK(vkCreateFence(device.vk(), &fence, nullptr, &fence_));

    // Labels are there when the instance has the extension; vkGetInstanceProcAddr answers null otherwise.
    begin_label_ = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(
        vkGetInstanceProcAddr(device.instance(), "vkCmdBeginDebugUtilsLabelEXT"));
    end_label_ = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(
        vkGetInstanceProcAddr(device.instance(), "vkCmdEndDebugUtilsLabelEXT"));
}

GraphExecutor::~GraphExecutor() {
    vkDestroyQueryPool(device_.vk(), queries_, nullptr);
    vkDestroyFence(device_.vk(), fence_, nullptr);
    vkDestroyCommandPool(device_.vk(), pool_, nullptr);
}

std::vector<double> GraphExecutor::run(const GraphDeclaration& declaration, const GraphPlan& plan,
                                       GraphResources& resources, const std::vector<Execute>& executes, bool timed) {
    arena_.reset();
    GraphRecorder recorder(device_, declaration, resources, arena_);
    if (plan.passes.empty()) {
        return {};
    }
    const bool timestamps = timed && device_.has(Feature::timestamps);
    return timed && !timestamps ? run_apart(declaration, plan, resources, executes, recorder)
                                : run_together(declaration, plan, resources, executes, recorder, timestamps);
}

std::vector<double> GraphExecutor::run_apart(const GraphDeclaration& declaration, const GraphPlan& plan,
                                             GraphResources& resources, const std::vector<Execute>& executes,
                                             GraphRecorder& recorder) {
    std::vector<double> ms;
    for (const PlannedPass& planned : plan.passes) {
        begin();
        record(declaration, planned, resources, recorder, executes[planned.declared]);
        const auto start = Clock::now();
        end_and_wait();
        ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    return ms;
}

std::vector<double> GraphExecutor::run_together(const GraphDeclaration& declaration, const GraphPlan& plan,
                                                GraphResources& resources, const std::vector<Execute>& executes,
                                                GraphRecorder& recorder, bool timestamps) {
    // A pair of timestamps a pass.
    const auto count = static_cast<std::uint32_t>(2 * plan.passes.size());
    if (timestamps && query_count_ < count) {
        vkDestroyQueryPool(device_.vk(), queries_, nullptr);
        const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                         .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                         .queryCount = count};
        queries_ = VK_NULL_HANDLE;
        GN_VK(vkCreateQueryPool(device_.vk(), &info, nullptr, &queries_));
        query_count_ = count;
    }
    begin();
    if (timestamps) {
        vkCmdResetQueryPool(commands_, queries_, 0, count);
    }
    std::uint32_t query = 0;
    const auto stamp = [&] {
        if (timestamps) {
            vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_, query++);
        }
    };
    for (const PlannedPass& planned : plan.passes) {
        stamp();
        record(declaration, planned, resources, recorder, executes[planned.declared]);
        stamp();
    }
    end_and_wait();

    std::vector<double> ms(plan.passes.size(), 0.0);
    if (timestamps) {
        std::vector<std::uint64_t> ticks(count);
        GN_VK(vkGetQueryPoolResults(device_.vk(), queries_, 0, count, ticks.size() * 8, ticks.data(), 8,
                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
        for (std::size_t i = 0; i < ms.size(); ++i) {
            const auto span = static_cast<double>(ticks[2 * i + 1] - ticks[2 * i]);
            ms[i] = span * static_cast<double>(device_.properties().limits.timestampPeriod) * 1e-6;
        }
    }
    return ms;
}

void GraphExecutor::begin() {
    GN_VK(vkResetCommandPool(device_.vk(), pool_, 0));
    const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    GN_VK(vkBeginCommandBuffer(commands_, &info));
    global_barrier(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                   VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
}

void GraphExecutor::end_and_wait() {
    global_barrier(commands_, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    GN_VK(vkEndCommandBuffer(commands_));
    const VkCommandBufferSubmitInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                           .commandBuffer = commands_};
    const VkSubmitInfo2 submit{
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &buffer};
    GN_VK(vkResetFences(device_.vk(), 1, &fence_));
    GN_VK(vkQueueSubmit2(device_.queue(), 1, &submit, fence_));
    GN_VK(vkWaitForFences(device_.vk(), 1, &fence_, VK_TRUE, ~std::uint64_t{0}));
}

void GraphExecutor::label(const std::string& name) const {
    const VkDebugUtilsLabelEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = name.c_str()};
    begin_label_(commands_, &info);
}

void GraphExecutor::record(const GraphDeclaration& declaration, const PlannedPass& planned, GraphResources& resources,
                           GraphRecorder& recorder, const Execute& execute) {
    const DeclaredPass& pass = declaration.passes[planned.declared];
    if (begin_label_ != nullptr) {
        label(pass.group.empty() ? pass.name : pass.group + "/" + pass.name);
    }
    barriers(declaration, planned, resources);
    recorder.begin(commands_, pass);
    if (execute) {
        execute(recorder);
    }
    recorder.end();
    if (end_label_ != nullptr) {
        end_label_(commands_);
    }
}

void GraphExecutor::barriers(const GraphDeclaration& declaration, const PlannedPass& planned,
                             GraphResources& resources) const {
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
            .image = resources.image(barrier.texture),
            .subresourceRange = {aspects_of(declaration.textures[barrier.texture].desc.format), range.mip, range.mips,
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
            .buffer = resources.buffer(barrier.buffer),
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
    vkCmdPipelineBarrier2(commands_, &dependency);
}

}  // namespace gn
