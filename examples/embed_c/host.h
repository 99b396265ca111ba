/* SPDX-License-Identifier: MIT */
/* The C host's device, buffers, images and its one pass; nothing in here knows of Gnomon. What fails ends the program with a
 * sentence and status 1. */
#ifndef HOST_H
#define HOST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan.h>

enum { width = 320, height = 240 };

typedef struct Host {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    uint32_t queue_family;
    VkPhysicalDeviceFeatures2 features; /* what the device was made with */
    VkPhysicalDeviceVulkan12Features features_12;
    VkPhysicalDeviceVulkan13Features features_13;
    unsigned messages; /* of validation, printed as they come */
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkFence fence;
} Host;

typedef struct Buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    VkDeviceSize bytes;
    void* mapped;
} Buffer;

typedef struct Image {
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;
} Image;

typedef struct Pipeline {
    VkPipelineLayout layout;
    VkPipeline pipeline;
} Pipeline;

void check(VkResult result, const char* call);
/* `host` stays where it is: the device's features are chained in it. */
void host_create(Host* host, bool validate);
void host_destroy(Host* host);
/* Begins the frame's commands; submits them and waits. */
void host_begin(Host* host);
void host_submit(Host* host);

Buffer buffer_create(const Host* host, VkDeviceSize bytes, VkBufferUsageFlags usage, const void* data);
void buffer_destroy(const Host* host, Buffer* buffer);
Image image_create(const Host* host, VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect);
void image_destroy(const Host* host, Image* image);

/* Draws positions of three floats into D32, near is 0, with a mat4 as push constants. */
Pipeline depth_pipeline_create(const Host* host);
void pipeline_destroy(const Host* host, Pipeline* pipeline);

#endif
