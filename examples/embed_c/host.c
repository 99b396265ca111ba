/* SPDX-License-Identifier: MIT */
#include "host.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void check(VkResult result, const char* call) {
    if (result != VK_SUCCESS) {
        fprintf(stderr, "embed_c: %s failed with code %d\n", call, result);
        exit(1);
    }
}

static VKAPI_ATTR VkBool32 VKAPI_CALL count(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                            VkDebugUtilsMessageTypeFlagsEXT type,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    (void)severity;
    (void)type;
    ++((Host*)user)->messages;
    fprintf(stderr, "validation: %s\n", data->pMessage);
    return VK_FALSE;
}

static void create_instance(Host* host, bool validate) {
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
    const VkDebugUtilsMessengerCreateInfoEXT listener = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = count,
        .pUserData = host};
    const VkValidationFeatureEnableEXT hazards = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    const VkValidationFeaturesEXT checks = {.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                            .pNext = &listener,
                                            .enabledValidationFeatureCount = 1,
                                            .pEnabledValidationFeatures = &hazards};
    const char* layer = "VK_LAYER_KHRONOS_validation";
    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                       .pNext = validate ? &checks : NULL,
                                       .pApplicationInfo = &application,
                                       .enabledLayerCount = validate ? 1 : 0,
                                       .ppEnabledLayerNames = &layer,
                                       .enabledExtensionCount = validate ? 1 : 0,
                                       .ppEnabledExtensionNames = &extension};
    check(vkCreateInstance(&info, NULL, &host->instance), "vkCreateInstance");
    if (validate) {
        const PFN_vkCreateDebugUtilsMessengerEXT create = (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
            host->instance, "vkCreateDebugUtilsMessengerEXT");
        check(create(host->instance, &listener, NULL, &host->messenger), "vkCreateDebugUtilsMessengerEXT");
    }
}

/* The first device, and its first queue for graphics and compute; a real renderer chooses with more care. */
static void choose(Host* host) {
    uint32_t devices = 1;
    const VkResult found = vkEnumeratePhysicalDevices(host->instance, &devices, &host->physical);
    if (devices == 0 || (found != VK_SUCCESS && found != VK_INCOMPLETE)) {
        fprintf(stderr, "embed_c: this machine has no Vulkan device; install mesa-vulkan-drivers\n");
        exit(1);
    }
    VkQueueFamilyProperties families[16];
    uint32_t family_count = 16;
    vkGetPhysicalDeviceQueueFamilyProperties(host->physical, &family_count, families);
    const VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    while (host->queue_family < family_count && (families[host->queue_family].queueFlags & needed) != needed) {
        ++host->queue_family;
    }
    if (host->queue_family == family_count) {
        fprintf(stderr, "embed_c: the Vulkan device has no queue for both graphics and compute\n");
        exit(1);
    }
}

/* With exactly the features and the extension that Gnomon requires. */
static void create_device(Host* host) {
    host->features_13 = (VkPhysicalDeviceVulkan13Features){.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                                           .synchronization2 = VK_TRUE,
                                                           .dynamicRendering = VK_TRUE,
                                                           .maintenance4 = VK_TRUE};
    host->features_12 = (VkPhysicalDeviceVulkan12Features){.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                                           .pNext = &host->features_13,
                                                           .scalarBlockLayout = VK_TRUE};
    host->features = (VkPhysicalDeviceFeatures2){.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                                 .pNext = &host->features_12,
                                                 .features = {.imageCubeArray = VK_TRUE,
                                                              .independentBlend = VK_TRUE,
                                                              .geometryShader = VK_TRUE,
                                                              .sampleRateShading = VK_TRUE,
                                                              .logicOp = VK_TRUE,
                                                              .depthClamp = VK_TRUE,
                                                              .shaderClipDistance = VK_TRUE,
                                                              .vertexPipelineStoresAndAtomics = VK_TRUE,
                                                              .fragmentStoresAndAtomics = VK_TRUE,
                                                              .shaderStorageImageWriteWithoutFormat = VK_TRUE}};
    const float priority = 1.0F;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = host->queue_family,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    const char* extension = VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME;
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = &host->features,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue,
                                     .enabledExtensionCount = 1,
                                     .ppEnabledExtensionNames = &extension};
    check(vkCreateDevice(host->physical, &info, NULL, &host->device), "vkCreateDevice");
    vkGetDeviceQueue(host->device, host->queue_family, 0, &host->queue);
}

static void create_slot(const Host* host, Slot* slot) {
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .queueFamilyIndex = host->queue_family};
    check(vkCreateCommandPool(host->device, &pool, NULL, &slot->pool), "vkCreateCommandPool");
    const VkCommandBufferAllocateInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                  .commandPool = slot->pool,
                                                  .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                  .commandBufferCount = 1};
    check(vkAllocateCommandBuffers(host->device, &commands, &slot->commands), "vkAllocateCommandBuffers");
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, .flags = VK_FENCE_CREATE_SIGNALED_BIT};
    check(vkCreateFence(host->device, &fence, NULL, &slot->fence), "vkCreateFence");
}

void host_create(Host* host, bool validate) {
    *host = (Host){0};
    create_instance(host, validate);
    choose(host);
    create_device(host);
    for (uint32_t i = 0; i < slots; ++i) {
        create_slot(host, &host->slots[i]);
    }
}

void host_destroy(Host* host) {
    for (uint32_t i = 0; i < slots; ++i) {
        vkDestroyFence(host->device, host->slots[i].fence, NULL);
        vkDestroyCommandPool(host->device, host->slots[i].pool, NULL);
    }
    vkDestroyDevice(host->device, NULL);
    if (host->messenger != VK_NULL_HANDLE) {
        const PFN_vkDestroyDebugUtilsMessengerEXT destroy = (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
            host->instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(host->instance, host->messenger, NULL);
    }
    vkDestroyInstance(host->instance, NULL);
}

void host_wait(const Host* host, uint32_t slot) {
    check(vkWaitForFences(host->device, 1, &host->slots[slot].fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
}

VkCommandBuffer host_begin(const Host* host, uint32_t slot) {
    const Slot* own = &host->slots[slot];
    host_wait(host, slot);
    check(vkResetCommandPool(host->device, own->pool, 0), "vkResetCommandPool");
    const VkCommandBufferBeginInfo once = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    check(vkBeginCommandBuffer(own->commands, &once), "vkBeginCommandBuffer");
    return own->commands;
}

void host_submit(const Host* host, uint32_t slot) {
    const Slot* own = &host->slots[slot];
    check(vkEndCommandBuffer(own->commands), "vkEndCommandBuffer");
    check(vkResetFences(host->device, 1, &own->fence), "vkResetFences");
    const VkSubmitInfo info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &own->commands};
    check(vkQueueSubmit(host->queue, 1, &info, own->fence), "vkQueueSubmit");
}

static VkDeviceMemory allocate(const Host* host, VkMemoryRequirements needs, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties properties;
    vkGetPhysicalDeviceMemoryProperties(host->physical, &properties);
    uint32_t type = 0;
    while (type < properties.memoryTypeCount &&
           ((needs.memoryTypeBits >> type & 1U) == 0 || (properties.memoryTypes[type].propertyFlags & wanted) != wanted)) {
        ++type;
    }
    const VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs.size, .memoryTypeIndex = type};
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(type < properties.memoryTypeCount ? VK_SUCCESS : VK_ERROR_OUT_OF_DEVICE_MEMORY, "the search for memory");
    check(vkAllocateMemory(host->device, &info, NULL, &memory), "vkAllocateMemory");
    return memory;
}

Buffer buffer_create(const Host* host, VkDeviceSize bytes, VkBufferUsageFlags usage, const void* data) {
    Buffer made = {.bytes = bytes};
    const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = bytes, .usage = usage};
    check(vkCreateBuffer(host->device, &info, NULL, &made.buffer), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(host->device, made.buffer, &needs);
    made.memory = allocate(host, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    check(vkBindBufferMemory(host->device, made.buffer, made.memory, 0), "vkBindBufferMemory");
    check(vkMapMemory(host->device, made.memory, 0, VK_WHOLE_SIZE, 0, &made.mapped), "vkMapMemory");
    if (data != NULL) {
        memcpy(made.mapped, data, bytes);
    }
    return made;
}

void buffer_destroy(const Host* host, Buffer* buffer) {
    vkDestroyBuffer(host->device, buffer->buffer, NULL);
    vkFreeMemory(host->device, buffer->memory, NULL);
}

Image image_create(const Host* host, VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect) {
    Image made = {0};
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = format,
                                    .extent = {width, height, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = 1,
                                    .samples = VK_SAMPLE_COUNT_1_BIT,
                                    .usage = usage};
    check(vkCreateImage(host->device, &info, NULL, &made.image), "vkCreateImage");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(host->device, made.image, &needs);
    made.memory = allocate(host, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    check(vkBindImageMemory(host->device, made.image, made.memory, 0), "vkBindImageMemory");
    const VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = made.image,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                        .format = format,
                                        .subresourceRange = {aspect, 0, 1, 0, 1}};
    check(vkCreateImageView(host->device, &view, NULL, &made.view), "vkCreateImageView");
    return made;
}

void image_destroy(const Host* host, Image* image) {
    vkDestroyImageView(host->device, image->view, NULL);
    vkDestroyImage(host->device, image->image, NULL);
    vkFreeMemory(host->device, image->memory, NULL);
}
