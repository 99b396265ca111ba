// SPDX-License-Identifier: MIT
#include "apps/view/window.h"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <algorithm>

namespace gn {
namespace {

std::string glfw_error() {
    const char* sentence = nullptr;
    glfwGetError(&sentence);
    return sentence != nullptr ? sentence : "no reason was given";
}

/// sRGB-encoded values are copied as they are, so that the format is no sRGB one.
VkSurfaceFormatKHR choose_format(VkPhysicalDevice physical, VkSurfaceKHR surface) {
    std::uint32_t count = 0;
    GN_VK(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface, &count, nullptr));
    std::vector<VkSurfaceFormatKHR> formats(count);
    GN_VK(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface, &count, formats.data()));
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}) {
        const auto found =
            std::find_if(formats.begin(), formats.end(), [&](const auto& format) { return format.format == wanted; });
        if (found != formats.end()) {
            return *found;
        }
    }
    fail("the window takes no picture of 8 bits a channel; 'gnomon view --headless' draws without one");
}

void image_barrier(VkCommandBuffer commands, VkImage image, VkImageLayout before, VkImageLayout after) {
    const VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                                        .oldLayout = before,
                                        .newLayout = after,
                                        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                        .image = image,
                                        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace

Window::Window(const Size& size) {
    // Its own complaints come as sentences of ours.
    glfwSetErrorCallback(nullptr);
    if (glfwInit() != GLFW_TRUE) {
        fail("no window can be opened: {}; 'gnomon view --headless --frames N --record FILE' draws without a display",
             glfw_error());
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(size.width, size.height, "gnomon", nullptr, nullptr);
    if (window_ == nullptr || glfwVulkanSupported() != GLFW_TRUE) {
        const std::string sentence = glfw_error();
        glfwTerminate();
        fail("no window can be opened: {}; 'gnomon view --headless --frames N --record FILE' draws without a display",
             sentence);
    }
}

Window::~Window() {
    detach();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

std::span<const char* const> Window::instance_extensions() const {
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    return {names, count};
}

void Window::attach(Device& device) {
    device_ = &device;
    try {
        GN_VK(glfwCreateWindowSurface(device.instance(), window_, nullptr, &surface_));
        VkBool32 shows = VK_FALSE;
        GN_VK(vkGetPhysicalDeviceSurfaceSupportKHR(device.physical(), device.queue_family(), surface_, &shows));
        if (shows != VK_TRUE) {
            fail("the device '{}' cannot draw to this display; GNOMON_DEVICE names another one", device.info().name);
        }
        make_swapchain();
    } catch (...) {
        detach();
        throw;
    }
}

void Window::detach() {
    if (device_ == nullptr) {
        return;
    }
    vkDeviceWaitIdle(device_->vk());
    end_swapchain();
    vkDestroySurfaceKHR(device_->instance(), std::exchange(surface_, VK_NULL_HANDLE), nullptr);
    device_ = nullptr;
}

bool Window::poll() {
    glfwPollEvents();
    return glfwWindowShouldClose(window_) == GLFW_FALSE;
}

void Window::wait() {
    glfwWaitEventsTimeout(0.25);
}

uvec2 Window::size() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {static_cast<uint>(std::max(width, 0)), static_cast<uint>(std::max(height, 0))};
}

void Window::close() {
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::make_swapchain() {
    vkDeviceWaitIdle(device_->vk());
    VkSurfaceCapabilitiesKHR can{};
    GN_VK(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_->physical(), surface_, &can));
    extent_ = can.currentExtent.width != ~0U ? uvec2(can.currentExtent.width, can.currentExtent.height) : size();
    const VkSurfaceFormatKHR format = choose_format(device_->physical(), surface_);
    end_swapchain();
    if (extent_.x == 0 || extent_.y == 0) {
        return;
    }
    const std::uint32_t most = can.maxImageCount > 0 ? can.maxImageCount : ~0U;
    const VkSwapchainCreateInfoKHR info{.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                        .surface = surface_,
                                        .minImageCount = std::min(std::max(can.minImageCount, 3U), most),
                                        .imageFormat = format.format,
                                        .imageColorSpace = format.colorSpace,
                                        .imageExtent = {extent_.x, extent_.y},
                                        .imageArrayLayers = 1,
                                        .imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                        .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
                                        .preTransform = can.currentTransform,
                                        .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
                                        .presentMode = VK_PRESENT_MODE_FIFO_KHR,
                                        .clipped = VK_TRUE};
    GN_VK(vkCreateSwapchainKHR(device_->vk(), &info, nullptr, &swapchain_));
    std::uint32_t count = 0;
    GN_VK(vkGetSwapchainImagesKHR(device_->vk(), swapchain_, &count, nullptr));
    images_.resize(count);
    GN_VK(vkGetSwapchainImagesKHR(device_->vk(), swapchain_, &count, images_.data()));
    for (std::uint32_t i = 0; i < count; ++i) {
        const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
        GN_VK(vkCreateSemaphore(device_->vk(), &semaphore, nullptr, &rendered_.emplace_back()));
    }
    stale_ = false;
}

void Window::end_swapchain() {
    for (VkSemaphore semaphore : rendered_) {
        vkDestroySemaphore(device_->vk(), semaphore, nullptr);
    }
    rendered_.clear();
    vkDestroySwapchainKHR(device_->vk(), std::exchange(swapchain_, VK_NULL_HANDLE), nullptr);
}

std::optional<std::uint32_t> Window::acquire(VkSemaphore acquired) {
    if (swapchain_ == VK_NULL_HANDLE || stale_ || size() != extent_) {
        make_swapchain();
    }
    if (swapchain_ == VK_NULL_HANDLE) {
        return std::nullopt;
    }
    std::uint32_t image = 0;
    const VkResult result =
        vkAcquireNextImageKHR(device_->vk(), swapchain_, ~std::uint64_t{0}, acquired, VK_NULL_HANDLE, &image);
    if (result == VK_ERROR_OUT_OF_DATE_KHR) {
        stale_ = true;
        return std::nullopt;
    }
    GN_VK(result);
    return image;
}

void Window::copy(VkCommandBuffer commands, VkImage picture, uvec2 picture_size, std::uint32_t image) {
    image_barrier(commands, images_[image], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const auto corner = [](uvec2 at) { return VkOffset3D{static_cast<int>(at.x), static_cast<int>(at.y), 1}; };
    const VkImageBlit region{.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                             .srcOffsets = {{0, 0, 0}, corner(picture_size)},
                             .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                             .dstOffsets = {{0, 0, 0}, corner(extent_)}};
    vkCmdBlitImage(commands, picture, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, images_[image],
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_NEAREST);
    image_barrier(commands, images_[image], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
}

void Window::present(std::uint32_t image) {
    const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                .waitSemaphoreCount = 1,
                                .pWaitSemaphores = &rendered_[image],
                                .swapchainCount = 1,
                                .pSwapchains = &swapchain_,
                                .pImageIndices = &image};
    const VkResult result = vkQueuePresentKHR(device_->queue(), &info);
    stale_ = result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR;
    if (!stale_) {
        GN_VK(result);
    }
}

}  // namespace gn
