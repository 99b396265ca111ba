// SPDX-License-Identifier: MIT
#include "gpu/instance.h"

#include "base/paths.h"
#include "gpu/vk_names.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace gn {
namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";
constexpr std::size_t most_messages = 1000;

VKAPI_ATTR VkBool32 VKAPI_CALL collect(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT type,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    // A hint about speed is no message about correctness.
    if ((type & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT) == 0) {
        return VK_FALSE;
    }
    auto& log = *static_cast<MessageLog*>(user);
    const std::scoped_lock lock(log.mutex);
    if (log.messages.size() < most_messages) {
        log.messages.emplace_back(data->pMessage != nullptr ? data->pMessage : "");
    }
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(MessageLog& log) {
    return {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
            .messageSeverity =
                VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT,
            .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
            .pfnUserCallback = collect,
            .pUserData = &log};
}

bool has_layer(const char* name) {
    std::uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::any_of(layers.begin(), layers.end(),
                       [&](const VkLayerProperties& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

bool has_instance_extension(const char* name) {
    std::uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data());
    return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, name) == 0;
    });
}

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
}

/// Where Mesa keeps compiled shaders; "" where that cannot be told.
std::string driver_cache() {
    const std::string named = variable("MESA_SHADER_CACHE_DIR"), xdg = variable("XDG_CACHE_HOME"),
                      home = variable("HOME");
    return !named.empty() ? named : !xdg.empty() ? xdg : !home.empty() ? home + "/.cache" : "";
}

/// Lavapipe compiles each shader for the processor; its disk cache saves a tenth of a second a pipeline. It maps its index
/// into memory: on a full disk, writing to it kills the process, so that it goes without where there is no room.
void keep_driver_cache(std::vector<std::string>& notes) {
    constexpr std::uintmax_t room = 16U << 20U;
    if (!cache_root().empty()) {
        setenv("MESA_SHADER_CACHE_DIR", (cache_root() / "mesa").c_str(), 0);
    }
    const std::string folder = driver_cache();
    if (variable("MESA_SHADER_CACHE_DISABLE").empty() && !folder.empty() && !has_room(folder, room)) {
        setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
        notes.push_back(
            fmt::format("'{}' has no room for {} MiB, so that compiled shaders go without a cache and every start "
                        "takes longer; MESA_SHADER_CACHE_DIR names another folder",
                        folder, room >> 20U));
    }
}

}  // namespace

VulkanInstance::VulkanInstance(bool validation, MessageLog& log, std::span<const char* const> extensions) {
    keep_driver_cache(notes_);
    if (validation && !has_layer(validation_layer)) {
        fail("validation was asked for, but the layer {} is not installed", validation_layer);
    }
    labels_ = validation || has_instance_extension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

    // Hazards are validated, shader instrumentation is not: it breaks push descriptors on software drivers.
    const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(log);
    const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                           .pNext = &messenger,
                                           .enabledValidationFeatureCount = 1,
                                           .pEnabledValidationFeatures = &synchronization};
    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                        .pApplicationName = "gnomon",
                                        .pEngineName = "gnomon",
                                        .apiVersion = VK_API_VERSION_1_3};
    std::vector<const char*> names(extensions.begin(), extensions.end());
    if (labels_) {
        names.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }
    const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                    .pNext = validation ? &features : nullptr,
                                    .pApplicationInfo = &application,
                                    .enabledLayerCount = validation ? 1U : 0U,
                                    .ppEnabledLayerNames = &validation_layer,
                                    .enabledExtensionCount = static_cast<std::uint32_t>(names.size()),
                                    .ppEnabledExtensionNames = names.data()};
    const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
    if (result != VK_SUCCESS) {
        fail("Vulkan cannot be used: {}; install a driver (mesa-vulkan-drivers has one for machines without a GPU)",
             result_name(result));
    }
    if (validation) {
        const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
        GN_VK(create(instance_, &messenger, nullptr, &messenger_));
    }
}

VulkanInstance::~VulkanInstance() {
    if (messenger_ != VK_NULL_HANDLE) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance_, messenger_, nullptr);
    }
    vkDestroyInstance(instance_, nullptr);
}

}  // namespace gn
