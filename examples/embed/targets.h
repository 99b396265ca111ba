// SPDX-License-Identifier: MIT
// The images of one picture size.
#pragma once

#include "resources.h"

#include <array>

/// The lights in the order of the host's tables.
enum LightIndex { sun = 0, lamp = 1, light_count = 2 };

struct Targets {
    Targets(const HostDevice& host, VkExtent2D extent);

    VkExtent2D size;
    HostImage depth;    ///< reversed
    HostImage normals;  ///< octahedral, signed
    HostImage albedo;
    std::array<HostImage, light_count> visibility;  ///< what Gnomon draws: V of every light
    HostImage picture;
};

/// Normals in 2 x 16 bits. Throws std::runtime_error where the device cannot draw to them.
inline constexpr VkFormat normals_format = VK_FORMAT_R16G16_SNORM;
inline constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;
inline constexpr VkFormat albedo_format = VK_FORMAT_R8G8B8A8_SRGB;
inline constexpr VkFormat visibility_format = VK_FORMAT_R8_UNORM;
inline constexpr VkFormat picture_format = VK_FORMAT_R8G8B8A8_UNORM;
