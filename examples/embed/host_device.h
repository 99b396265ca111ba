// SPDX-License-Identifier: MIT
// The device of the host renderer, which Gnomon borrows: nothing in this file knows of Gnomon.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>

/// An instance and a device with one queue, destroyed in the right order. Throws std::runtime_error without Vulkan 1.3.
class HostDevice {
  public:
    HostDevice();
    ~HostDevice();
    HostDevice(const HostDevice&) = delete;
    HostDevice& operator=(const HostDevice&) = delete;

    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
};
