// SPDX-License-Identifier: MIT
#include "host_device.h"

#include "check.h"

#include <map>

namespace {

/// The first device there is; a real renderer chooses with more care.
VkPhysicalDevice first_device(VkInstance instance) {
    std::uint32_t count = 1;
    VkPhysicalDevice found = VK_NULL_HANDLE;
    const VkResult result = vkEnumeratePhysicalDevices(instance, &count, &found);
    if (count == 0 || (result != VK_SUCCESS && result != VK_INCOMPLETE)) {
        throw std::runtime_error("this machine has no Vulkan device; install mesa-vulkan-drivers");
    }
    return found;
}

std::uint32_t graphics_family(VkPhysicalDevice physical) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    constexpr VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t i = 0; i < count; ++i) {
        if ((families[i].queueFlags & needed) == needed) {
            return i;
        }
    }
    throw std::runtime_error("the Vulkan device has no queue for both graphics and compute");
}

VKAPI_ATTR VkBool32 VKAPI_CALL collect(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    static_cast<std::vector<std::string>*>(user)->emplace_back(data->pMessage != nullptr ? data->pMessage : "");
    return VK_FALSE;
}

/// Features that can be left out by name: those that Gnomon requires, then those that it uses where they are enabled.
std::map<std::string, VkBool32*> features_by_name(HostDevice& host) {
    VkPhysicalDeviceFeatures& core = host.features.features;
    return {{"dynamicRendering", &host.features_13.dynamicRendering},
            {"synchronization2", &host.features_13.synchronization2},
            {"maintenance4", &host.features_13.maintenance4},
            {"scalarBlockLayout", &host.features_12.scalarBlockLayout},
            {"geometryShader", &core.geometryShader},
            {"depthClamp", &core.depthClamp},
            {"independentBlend", &core.independentBlend},
            {"imageCubeArray", &core.imageCubeArray},
            {"samplerAnisotropy", &core.samplerAnisotropy},
            {"shaderFloat64", &core.shaderFloat64},
            {"shaderOutputLayer", &host.features_12.shaderOutputLayer},
            {"multiDrawIndirect", &core.multiDrawIndirect},
            {"drawIndirectFirstInstance", &core.drawIndirectFirstInstance},
            {"shaderDrawParameters", &host.features_11.shaderDrawParameters},
            {"shaderStorageImageReadWithoutFormat", &core.shaderStorageImageReadWithoutFormat},
            {"shaderStorageImageExtendedFormats", &core.shaderStorageImageExtendedFormats},
            {"shaderImageGatherExtended", &core.shaderImageGatherExtended},
            {"shaderClipDistance", &core.shaderClipDistance},
            {"samplerFilterMinmax", &host.features_12.samplerFilterMinmax},
            {"hostQueryReset", &host.features_12.hostQueryReset},
            {"shaderDemoteToHelperInvocation", &host.features_13.shaderDemoteToHelperInvocation}};
}

}  // namespace

HostDevice::HostDevice(const DeviceOptions& options) {
    make_instance(options.validate);
    physical = first_device(instance);
    queue_family = graphics_family(physical);

    // Turn on everything the device has in core, as many renderers do; what Gnomon needs is a part of that.
    vkGetPhysicalDeviceFeatures2(physical, &features);
    features.features.robustBufferAccess = VK_FALSE;
    const auto known = features_by_name(*this);
    for (const std::string& name : options.without) {
        const auto found = known.find(name);
        if (found == known.end()) {
            throw std::runtime_error("no feature '" + name +
                                     "' can be left out; among those that can is samplerAnisotropy");
        }
        *found->second = VK_FALSE;
    }
    make_device();
}

void HostDevice::make_instance(bool validate) {
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.apiVersion = VK_API_VERSION_1_3;
    VkDebugUtilsMessengerCreateInfoEXT listener{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    listener.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
    listener.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    listener.pfnUserCallback = collect;
    listener.pUserData = &messages;
    const VkValidationFeatureEnableEXT hazards = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT checks{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &listener};
    checks.enabledValidationFeatureCount = 1;
    checks.pEnabledValidationFeatures = &hazards;

    const char* layer = "VK_LAYER_KHRONOS_validation";
    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    if (validate) {
        info.pNext = &checks;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &layer;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &extension;
    }
    check(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
    if (validate) {
        const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
        check(create(instance, &listener, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
    }
}

void HostDevice::make_device() {
    const float priority = 1.0F;
    VkDeviceQueueCreateInfo queue_info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue_info.queueFamilyIndex = queue_family;
    queue_info.queueCount = 1;
    queue_info.pQueuePriorities = &priority;
    VkDeviceCreateInfo device_info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
    device_info.queueCreateInfoCount = 1;
    device_info.pQueueCreateInfos = &queue_info;
    device_info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    device_info.ppEnabledExtensionNames = extensions.data();
    check(vkCreateDevice(physical, &device_info, nullptr, &device), "vkCreateDevice");
    vkGetDeviceQueue(device, queue_family, 0, &queue);
}

HostDevice::~HostDevice() {
    if (device != VK_NULL_HANDLE) {
        vkDestroyDevice(device, nullptr);
    }
    if (messenger_ != VK_NULL_HANDLE) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance, messenger_, nullptr);
    }
    vkDestroyInstance(instance, nullptr);
}
