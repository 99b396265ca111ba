// SPDX-License-Identifier: MIT
// Vulkan's enumerators as text, for error sentences and descriptions.
#pragma once

#include <vulkan/vulkan.h>

#include <string>

namespace gn {

std::string result_name(VkResult result);
std::string format_name(VkFormat format);
std::string layout_name(VkImageLayout layout);
std::string stages_name(VkPipelineStageFlags2 stages);
std::string access_name(VkAccessFlags2 access);

}  // namespace gn
