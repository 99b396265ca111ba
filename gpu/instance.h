// SPDX-License-Identifier: MIT
// The Vulkan instance, with validation when asked.
#pragma once

#include "gpu/device.h"

#include <mutex>
#include <span>

namespace gn {

/// What the validation layers say, collected from any thread.
struct MessageLog {
    std::mutex mutex;
    std::vector<std::string> messages;
};

class VulkanInstance {
  public:
    /// Throws Error when there is no Vulkan loader or driver, or validation is asked for and not installed. `extensions`: further
    /// ones that must be there.
    VulkanInstance(bool validation, MessageLog& log, std::span<const char* const> extensions = {});
    ~VulkanInstance();
    VulkanInstance(const VulkanInstance&) = delete;
    VulkanInstance& operator=(const VulkanInstance&) = delete;
    [[nodiscard]] VkInstance vk() const { return instance_; }
    [[nodiscard]] bool labels() const { return labels_; }  ///< VK_EXT_debug_utils is on
    /// What goes without on this machine, one sentence each.
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  private:
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    bool labels_ = false;
    std::vector<std::string> notes_;
};

}  // namespace gn
