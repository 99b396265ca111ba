// SPDX-License-Identifier: MIT
// Frames in flight: while the device works on one, the next is recorded.
#pragma once

#include "resources.h"

inline constexpr std::uint32_t frames_in_flight = 2;

/// What a frame in flight has of its own.
class FrameSlot {
  public:
    FrameSlot(const HostDevice& host, VkDeviceSize transform_bytes);
    ~FrameSlot();
    FrameSlot(const FrameSlot&) = delete;
    FrameSlot& operator=(const FrameSlot&) = delete;

    /// Waits until the device has finished what was submitted with this slot last, and begins the next commands.
    VkCommandBuffer begin();
    void submit();
    void wait() const;

    HostBuffer transforms;  ///< written by the processor, read by the device: hence one a slot

  private:
    const HostDevice& host_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
};
