/* SPDX-License-Identifier: MIT */
/* The C host's device, buffers, images and its one pass; nothing in here knows of Gnomon. What fails ends the program with a
 * sentence and status 1. */
#ifndef HOST_H
#define HOST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan.h>

enum { width = 320, height = 240, slots = 2 };

/* What a frame in flight has of its own. */
typedef struct Slot {
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkFence fence; /* open where nothing of the slot is under way */
} Slot;

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
    Slot slots[slots];
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
/* Waits until the device has finished with what the slot submitted last, and begins the slot's commands anew. */
VkCommandBuffer host_begin(const Host* host, uint32_t slot);
void host_submit(const Host* host, uint32_t slot);
/* Waits for one slot. */
void host_wait(const Host* host, uint32_t slot);

Buffer buffer_create(const Host* host, VkDeviceSize bytes, VkBufferUsageFlags usage, const void* data);
void buffer_destroy(const Host* host, Buffer* buffer);
Image image_create(const Host* host, VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect);
void image_destroy(const Host* host, Image* image);

/* Draws positions of three floats into D32, near is 0, with a mat4 as push constants. */
Pipeline depth_pipeline_create(const Host* host);
void pipeline_destroy(const Host* host, Pipeline* pipeline);

#endif
