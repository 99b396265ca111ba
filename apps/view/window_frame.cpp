// SPDX-License-Identifier: MIT
#include "apps/view/window_frame.h"

namespace gn {

WindowFrame::WindowFrame(Device& device) : device_(device) {
    const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .queueFamilyIndex = device.queue_family()};
    GN_VK(vkCreateCommandPool(device.vk(), &pool, nullptr, &pool_));
    const VkCommandBufferAllocateInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .commandPool = pool_,
                                               .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                               .commandBufferCount = 1};
    GN_VK(vkAllocateCommandBuffers(device.vk(), &commands, &commands_));
    const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, .flags = VK_FENCE_CREATE_SIGNALED_BIT};
    GN_VK(vkCreateFence(device.vk(), &fence, nullptr, &fence_));
    const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    GN_VK(vkCreateSemaphore(device.vk(), &semaphore, nullptr, &acquired_));
}

WindowFrame::~WindowFrame() {
    vkDestroySemaphore(device_.vk(), acquired_, nullptr);
    vkDestroyFence(device_.vk(), fence_, nullptr);
    vkDestroyCommandPool(device_.vk(), pool_, nullptr);
}

void WindowFrame::wait() const {
    GN_VK(vkWaitForFences(device_.vk(), 1, &fence_, VK_TRUE, ~std::uint64_t{0}));
}

VkCommandBuffer WindowFrame::begin() {
    GN_VK(vkResetCommandPool(device_.vk(), pool_, 0));
    const VkCommandBufferBeginInfo once{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    GN_VK(vkBeginCommandBuffer(commands_, &once));
    return commands_;
}

void WindowFrame::submit(VkSemaphore rendered) {
    GN_VK(vkEndCommandBuffer(commands_));
    GN_VK(vkResetFences(device_.vk(), 1, &fence_));
    const VkCommandBufferSubmitInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                             .commandBuffer = commands_};
    const VkSemaphoreSubmitInfo wait{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                     .semaphore = acquired_,
                                     .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
    const VkSemaphoreSubmitInfo signal{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                       .semaphore = rendered,
                                       .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
    const std::uint32_t shows = rendered != VK_NULL_HANDLE ? 1 : 0;
    const VkSubmitInfo2 info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                             .waitSemaphoreInfoCount = shows,
                             .pWaitSemaphoreInfos = &wait,
                             .commandBufferInfoCount = 1,
                             .pCommandBufferInfos = &commands,
                             .signalSemaphoreInfoCount = shows,
                             .pSignalSemaphoreInfos = &signal};
    GN_VK(vkQueueSubmit2(device_.queue(), 1, &info, fence_));
}

}  // namespace gn
