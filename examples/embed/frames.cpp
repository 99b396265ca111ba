// SPDX-License-Identifier: MIT
#include "frames.h"

#include "check.h"

FrameSlot::FrameSlot(const HostDevice& host, VkDeviceSize transform_bytes)
    : transforms(host, transform_bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT), host_(host) {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = host.queue_family;
    check(vkCreateCommandPool(host.device, &pool, nullptr, &pool_), "vkCreateCommandPool");
    VkCommandBufferAllocateInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    commands.commandPool = pool_;
    commands.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    commands.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(host.device, &commands, &commands_), "vkAllocateCommandBuffers");
    VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
    check(vkCreateFence(host.device, &fence, nullptr, &fence_), "vkCreateFence");
}

FrameSlot::~FrameSlot() {
    vkDestroyFence(host_.device, fence_, nullptr);
    vkDestroyCommandPool(host_.device, pool_, nullptr);
}

void FrameSlot::wait() const {
    check(vkWaitForFences(host_.device, 1, &fence_, VK_TRUE, ~std::uint64_t{0}), "vkWaitForFences");
}

VkCommandBuffer FrameSlot::begin() {
    wait();
    check(vkResetCommandPool(host_.device, pool_, 0), "vkResetCommandPool");
    VkCommandBufferBeginInfo once{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    once.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands_, &once), "vkBeginCommandBuffer");
    return commands_;
}

void FrameSlot::submit() {
    check(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
    check(vkResetFences(host_.device, 1, &fence_), "vkResetFences");
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = commands_;
    VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &commands;
    check(vkQueueSubmit2(host_.queue, 1, &info, fence_), "vkQueueSubmit2");
}
