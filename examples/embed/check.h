// SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan.h>

#include <stdexcept>
#include <string>

/// Throws std::runtime_error naming the call that failed.
inline void check(VkResult result, const char* call) {
    if (result != VK_SUCCESS) {
        throw std::runtime_error(std::string(call) + " failed with code " + std::to_string(result));
    }
}
