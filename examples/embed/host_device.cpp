// SPDX-License-Identifier: MIT
#include "host_device.h"

#include "check.h"

#include <algorithm>
#include <cstring>

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

/// A feature that Gnomon needs, or uses where it is enabled.
struct Feature {
    const char* name;
    VkBool32* enabled;
    bool needed = false;
    const char* extension = nullptr;  ///< that it comes with; null: it is of Vulkan's own
};

std::vector<Feature> features_of(HostDevice& host) {
    VkPhysicalDeviceFeatures& core = host.features.features;
    VkPhysicalDeviceVulkan12Features& v12 = host.features_12;
    VkPhysicalDeviceVulkan13Features& v13 = host.features_13;
    constexpr bool needed = true;
    const char* atomics = VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME;
    const char* interlock = VK_EXT_FRAGMENT_SHADER_INTERLOCK_EXTENSION_NAME;
    return {{"dynamicRendering", &v13.dynamicRendering, needed},
            {"synchronization2", &v13.synchronization2, needed},
            {"maintenance4", &v13.maintenance4, needed},
            {"scalarBlockLayout", &v12.scalarBlockLayout, needed},
            {"geometryShader", &core.geometryShader, needed},
            {"depthClamp", &core.depthClamp, needed},
            {"independentBlend", &core.independentBlend, needed},
            {"logicOp", &core.logicOp, needed},
            {"sampleRateShading", &core.sampleRateShading, needed},
            {"imageCubeArray", &core.imageCubeArray, needed},
            {"fragmentStoresAndAtomics", &core.fragmentStoresAndAtomics, needed},
            {"vertexPipelineStoresAndAtomics", &core.vertexPipelineStoresAndAtomics, needed},
            {"shaderStorageImageWriteWithoutFormat", &core.shaderStorageImageWriteWithoutFormat, needed},
            {"shaderClipDistance", &core.shaderClipDistance, needed},
            {"samplerAnisotropy", &core.samplerAnisotropy},
            {"shaderFloat64", &core.shaderFloat64},
            {"shaderOutputLayer", &v12.shaderOutputLayer},
            {"multiDrawIndirect", &core.multiDrawIndirect},
            {"drawIndirectFirstInstance", &core.drawIndirectFirstInstance},
            {"shaderDrawParameters", &host.features_11.shaderDrawParameters},
            {"shaderStorageImageReadWithoutFormat", &core.shaderStorageImageReadWithoutFormat},
            {"shaderStorageImageExtendedFormats", &core.shaderStorageImageExtendedFormats},
            {"shaderImageGatherExtended", &core.shaderImageGatherExtended},
            {"samplerFilterMinmax", &v12.samplerFilterMinmax},
            {"hostQueryReset", &v12.hostQueryReset},
            {"shaderDemoteToHelperInvocation", &v13.shaderDemoteToHelperInvocation},
            {"shaderBufferFloat32AtomicAdd", &host.atomic_float.shaderBufferFloat32AtomicAdd, false, atomics},
            {"shaderImageFloat32AtomicAdd", &host.atomic_float.shaderImageFloat32AtomicAdd, false, atomics},
            {"fragmentShaderPixelInterlock", &host.interlock.fragmentShaderPixelInterlock, false, interlock}};
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// Names of the device's extensions.
std::vector<std::string> extensions_of(VkPhysicalDevice physical) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> found(count);
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, found.data());
    std::vector<std::string> names;
    for (const VkExtensionProperties& extension : found) {
        names.emplace_back(extension.extensionName);
    }
    return names;
}

}  // namespace

HostDevice::HostDevice(const DeviceOptions& options) {
    make_instance(options.validate);
    physical = first_device(instance);
    queue_family = graphics_family(physical);

    choose_features(options);
    make_device();
}

void HostDevice::choose_features(const DeviceOptions& options) {
    const std::vector<Feature> known = features_of(*this);
    for (const std::vector<std::string>* words : {&options.with, &options.without}) {
        for (const std::string& word : *words) {
            if (word != "all" && word != VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME &&
                std::none_of(known.begin(), known.end(), [&](const Feature& f) { return word == f.name; })) {
                throw std::runtime_error("no feature '" + word +
                                         "' can be chosen; among those that can is samplerAnisotropy");
            }
        }
    }

    // See what the device has; structs of extensions that it does not know stay out of the chain.
    const std::vector<std::string> present = extensions_of(physical);
    void** tail = &features_13.pNext;
    const auto chain = [&](const char* extension, auto& more) {
        if (contains(present, extension)) {
            *tail = &more;
            tail = &more.pNext;
        }
    };
    chain(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME, atomic_float);
    chain(VK_EXT_FRAGMENT_SHADER_INTERLOCK_EXTENSION_NAME, interlock);
    vkGetPhysicalDeviceFeatures2(physical, &features);

    // Turn on what is needed, and what is asked for where it is there.
    std::vector<VkBool32> on;
    for (const Feature& feature : known) {
        const bool wanted = feature.needed || contains(options.with, "all") || contains(options.with, feature.name);
        on.push_back(wanted && !contains(options.without, feature.name) ? *feature.enabled : VK_FALSE);
    }
    forget_features();
    if (!contains(options.without, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME)) {
        extensions.push_back(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    }
    for (std::size_t i = 0; i < known.size(); ++i) {
        *known[i].enabled = on[i];
        const auto same = [&](const char* name) { return std::strcmp(name, known[i].extension) == 0; };
        if (on[i] == VK_TRUE && known[i].extension != nullptr &&
            std::none_of(extensions.begin(), extensions.end(), same)) {
            extensions.push_back(known[i].extension);
        }
    }
}

void HostDevice::forget_features() {
    const auto clear = [](auto& more) { more = {.sType = more.sType, .pNext = more.pNext}; };
    features.features = {};
    clear(features_11);
    clear(features_12);
    clear(features_13);
    clear(atomic_float);
    clear(interlock);
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
