// SPDX-License-Identifier: MIT
#include "targets.h"

#include <stdexcept>

namespace {

constexpr VkImageUsageFlags drawn = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;

VkFormat drawable(const HostDevice& host, VkFormat format) {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(host.physical, format, &properties);
    if ((properties.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT) == 0) {
        throw std::runtime_error("this device cannot draw to R16G16_SNORM, in which the normals are packed");
    }
    return format;
}

HostImage visibility_image(const HostDevice& host, VkExtent2D size) {
    return {host, visibility_format, size, drawn | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
}

}  // namespace

Targets::Targets(const HostDevice& host, VkExtent2D extent)
    : size(extent),
      depth(host, depth_format, extent, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT),
      normals(host, drawable(host, normals_format), extent, drawn),
      albedo(host, albedo_format, extent, drawn),
      visibility{visibility_image(host, extent), visibility_image(host, extent)},
      picture(host, picture_format, extent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT) {}
