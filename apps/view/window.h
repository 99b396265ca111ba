// SPDX-License-Identifier: MIT
// A window with a swapchain. The viewer draws into a picture of its own, which is copied to the window.
#pragma once

#include "apps/options.h"
#include "gpu/memory.h"

#include <optional>
#include <span>
#include <vector>

struct GLFWwindow;

namespace gn {

class Window {
  public:
    /// Throws Error where there is no display.
    explicit Window(const Size& size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// What its surface asks of an instance.
    [[nodiscard]] std::span<const char* const> instance_extensions() const;
    /// The device to show pictures of, which must live longer than what is attached: detach ends it. Throws Error.
    void attach(Device& device);
    void detach();

    /// Takes events. False once the window is to be closed.
    bool poll();
    /// Waits for an event: for while nothing can be drawn.
    void wait();
    /// Pixels; 0 x 0 while it is minimized.
    [[nodiscard]] uvec2 size() const;
    void close();
    [[nodiscard]] GLFWwindow* glfw() const { return window_; }

    /// The image to draw the next frame to, which `acquired` is signalled for; nothing where the swapchain had to be made anew:
    /// try again.
    std::optional<std::uint32_t> acquire(VkSemaphore acquired);
    /// Records the copy of a picture in TRANSFER_SRC_OPTIMAL.
    void copy(VkCommandBuffer commands, VkImage picture, uvec2 picture_size, std::uint32_t image);
    /// What the copy's commands must signal before present.
    [[nodiscard]] VkSemaphore rendered(std::uint32_t image) const { return rendered_.at(image); }
    void present(std::uint32_t image);

  private:
    void make_swapchain();
    void end_swapchain();

    GLFWwindow* window_ = nullptr;
    Device* device_ = nullptr;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    uvec2 extent_{0};
    std::vector<VkImage> images_;
    std::vector<VkSemaphore> rendered_;
    bool stale_ = false;
};

}  // namespace gn
