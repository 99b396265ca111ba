// SPDX-License-Identifier: MIT
// What a physical device can do: what Gnomon requires, and what parts may ask for.
#pragma once

#include "gpu/device.h"

#include <array>

namespace gn {

/// The feature structs that are asked for and then passed to vkCreateDevice, chained in place: do not copy.
struct FeatureChain {
    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceFragmentShaderInterlockFeaturesEXT interlock{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FRAGMENT_SHADER_INTERLOCK_FEATURES_EXT};
    VkPhysicalDeviceShaderAtomicFloatFeaturesEXT atomic_float{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT};
    VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR};
    VkPhysicalDeviceRayQueryFeaturesKHR ray_query{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR};

    FeatureChain() = default;
    FeatureChain(const FeatureChain&) = delete;
    FeatureChain& operator=(const FeatureChain&) = delete;
};

/// A physical device as found.
struct Candidate {
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties{};
    DeviceInfo info;
    std::vector<std::string> extensions;
    std::uint32_t queue_family = ~0U;  ///< graphics and compute; ~0 when there is none
    std::uint32_t timestamp_bits = 0;
    std::string missing;  ///< what Gnomon requires and it lacks, comma-separated; empty if usable
    std::array<bool, feature_count> features{};

    [[nodiscard]] bool has_extension(std::string_view name) const;
};

Candidate examine(VkPhysicalDevice physical);
std::vector<Candidate> examine_all(VkInstance instance);
/// The index of the device to use, with info.why filled in. Throws Error when none is usable or matches `pick`.
std::size_t choose(std::vector<Candidate>& candidates, const std::string& pick);

/// Leaves of a host's device what was enabled when it was created. What Gnomon requires and is not enabled becomes `missing`.
void keep_enabled(Candidate& candidate, const AdoptedDevice& host);

/// Turns on, in an empty chain, the required features and the optional ones that the candidate has.
void enable(const Candidate& candidate, FeatureChain& chain, std::vector<const char*>& extensions);

}  // namespace gn
