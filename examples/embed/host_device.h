// SPDX-License-Identifier: MIT
// The device of the host renderer, which Gnomon borrows: nothing in this file knows of Gnomon.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <string>
#include <vector>

struct DeviceOptions {
    bool validate = false;             ///< core and synchronization checks; messages are collected
    std::vector<std::string> with;     ///< features enabled beside the needed ones, by Vulkan's names; "all" there are
    std::vector<std::string> without;  ///< features that are not enabled whatever else is said: "samplerAnisotropy"
};

/// An instance and a device with one queue, destroyed in the right order. Throws std::runtime_error without Vulkan 1.3.
class HostDevice {
  public:
    explicit HostDevice(const DeviceOptions& options = {});
    ~HostDevice();
    HostDevice(const HostDevice&) = delete;
    HostDevice& operator=(const HostDevice&) = delete;

    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
    std::vector<std::string> messages;  ///< of validation

    // What the device was made with.
    VkPhysicalDeviceShaderAtomicFloatFeaturesEXT atomic_float{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT};
    VkPhysicalDeviceFragmentShaderInterlockFeaturesEXT interlock{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FRAGMENT_SHADER_INTERLOCK_FEATURES_EXT};
    VkPhysicalDeviceVulkan13Features features_13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features features_12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &features_13};
    VkPhysicalDeviceVulkan11Features features_11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES, &features_12};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &features_11};
    std::vector<const char*> extensions;

  private:
    void make_instance(bool validate);
    void choose_features(const DeviceOptions& options);
    void forget_features();
    void make_device();
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};
