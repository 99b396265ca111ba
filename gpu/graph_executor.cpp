// SPDX-License-Identifier: MIT
#include "gpu/graph_executor.h"

#include "gpu/memory_barrier.h"

#include <chrono>

namespace gn {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

GraphExecutor::GraphExecutor(Device& device) : device_(device), arena_(device), timestamps_(device) {
    const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                       .queueFamilyIndex = device.queue_family()};
    GN_VK(vkCreateCommandPool(device.vk(), &pool, nullptr, &pool_));
    const auto made = [&](VkResult result, const char* call) {
        if (result != VK_SUCCESS) {
            destroy();
        }
        vk_check(result, call, __FILE__, __LINE__);
    };
    const VkCommandBufferAllocateInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .commandPool = pool_,
                                               .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                               .commandBufferCount = 1};
    made(vkAllocateCommandBuffers(device.vk(), &commands, &commands_), "vkAllocateCommandBuffers");
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    made(vkCreateFence(device.vk(), &fence, nullptr, &fence_), "vkCreateFence");
    ++device.counters().pools;
}

GraphExecutor::~GraphExecutor() {
    destroy();
}

void GraphExecutor::destroy() {
    vkDestroyFence(device_.vk(), fence_, nullptr);
    vkDestroyCommandPool(device_.vk(), pool_, nullptr);
}

std::vector<double> GraphExecutor::run(const GraphDeclaration& declaration, const GraphPlan& plan,
                                       GraphResources& resources, const std::vector<Execute>& executes, bool timed) {
    arena_.reset();
    PassWriter writer(device_, declaration, resources, arena_);
    if (plan.passes.empty()) {
        return {};
    }
    const std::vector<Turn> turns = turns_of(declaration, plan);
    const bool timestamps = timed && device_.has(Feature::timestamps);
    if (timed && !timestamps) {
        return run_apart(turns, executes, writer);
    }
    PassCounters* const counters = timed ? nullptr : PassCounters::of(device_);
    std::vector<double> ms = run_together(turns, executes, writer, timestamps, counters);
    if (counters != nullptr) {
        counters->finish(declaration, turns);
    }
    return ms;
}

std::vector<double> GraphExecutor::run_apart(std::span<const Turn> turns, const std::vector<Execute>& executes,
                                             PassWriter& writer) {
    std::vector<double> ms;
    for (const Turn& turn : turns) {
        begin();
        writer.write(commands_, *turn.pass, executes[turn.call]);
        const auto start = Clock::now();
        end_and_wait();
        ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    return ms;
}

std::vector<double> GraphExecutor::run_together(std::span<const Turn> turns, const std::vector<Execute>& executes,
                                                PassWriter& writer, bool timestamps, PassCounters* counters) {
    begin();
    const auto passes = static_cast<std::uint32_t>(turns.size());
    if (timestamps) {
        timestamps_.begin(commands_, passes);
    }
    if (counters != nullptr) {
        counters->begin(commands_, passes);
    }
    for (const Turn& turn : turns) {
        if (timestamps) {
            timestamps_.stamp(commands_);
        }
        if (counters != nullptr) {
            counters->open(commands_);
        }
        writer.write(commands_, *turn.pass, executes[turn.call]);
        if (counters != nullptr) {
            counters->close(commands_);
        }
        if (timestamps) {
            timestamps_.stamp(commands_);
        }
    }
    end_and_wait();
    return timestamps ? timestamps_.read(true) : std::vector<double>(turns.size(), 0.0);
}

void GraphExecutor::begin() {
    GN_VK(vkResetCommandPool(device_.vk(), pool_, 0));
    const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    GN_VK(vkBeginCommandBuffer(commands_, &info));
    memory_barrier(commands_, all_writes, all_uses);
}

void GraphExecutor::end_and_wait() {
    memory_barrier(commands_, all_writes, host_reads);
    GN_VK(vkEndCommandBuffer(commands_));
    const VkCommandBufferSubmitInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                           .commandBuffer = commands_};
    const VkSubmitInfo2 submit{
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &buffer};
    GN_VK(vkResetFences(device_.vk(), 1, &fence_));
    GN_VK(vkQueueSubmit2(device_.queue(), 1, &submit, fence_));
    GN_VK(vkWaitForFences(device_.vk(), 1, &fence_, VK_TRUE, ~std::uint64_t{0}));
}

}  // namespace gn
