// SPDX-License-Identifier: MIT
// Commands of one frame in flight, and what tells when the device has finished with them.
#pragma once

#include "gpu/device.h"

namespace gn {

class WindowFrame {
  public:
    explicit WindowFrame(Device& device);
    /// The device must have finished.
    ~WindowFrame();
    WindowFrame(const WindowFrame&) = delete;
    WindowFrame& operator=(const WindowFrame&) = delete;

    /// Until what was submitted last has completed. Throws Error on a lost device.
    void wait() const;
    VkCommandBuffer begin();
    /// With a window: after `acquired()` was signalled, and signals `rendered`; without: null.
    void submit(VkSemaphore rendered);
    [[nodiscard]] VkSemaphore acquired() const { return acquired_; }

  private:
    Device& device_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    VkSemaphore acquired_ = VK_NULL_HANDLE;
};

}  // namespace gn
