// SPDX-License-Identifier: MIT
// Buffers and images of the host's, each with memory of its own; a real renderer would share allocations.
#pragma once

#include "host_device.h"

#include <span>
#include <utility>

/// A buffer that the processor writes directly, for as long as it lives.
class HostBuffer {
  public:
    HostBuffer(const HostDevice& host, VkDeviceSize bytes, VkBufferUsageFlags usage);
    HostBuffer(HostBuffer&& other) noexcept;
    HostBuffer& operator=(HostBuffer&&) = delete;
    ~HostBuffer();

    [[nodiscard]] VkBuffer vk() const { return buffer_; }
    [[nodiscard]] VkDeviceSize bytes() const { return bytes_; }
    [[nodiscard]] VkDescriptorBufferInfo whole() const { return {buffer_, 0, bytes_}; }
    template <class T>
    [[nodiscard]] std::span<T> as() const {
        return {static_cast<T*>(mapped_), bytes_ / sizeof(T)};
    }

  private:
    VkDevice device_;
    VkDeviceSize bytes_;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    void* mapped_ = nullptr;
};

/// A two-dimensional image with a view of all of it.
class HostImage {
  public:
    HostImage(const HostDevice& host, VkFormat format, VkExtent2D size, VkImageUsageFlags usage);
    HostImage(HostImage&& other) noexcept;
    HostImage& operator=(HostImage&&) = delete;
    ~HostImage();

    [[nodiscard]] VkImage vk() const { return image_; }
    [[nodiscard]] VkImageView view() const { return view_; }
    [[nodiscard]] VkFormat format() const { return format_; }
    [[nodiscard]] VkExtent2D size() const { return size_; }
    [[nodiscard]] VkImageAspectFlags aspect() const;

  private:
    VkDevice device_;
    VkFormat format_;
    VkExtent2D size_;
    VkImage image_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
};

/// Takes an image of the renderer's own from one use to the next.
void change_layout(VkCommandBuffer commands, const HostImage& image, VkImageLayout from, VkImageLayout to,
                   VkPipelineStageFlags2 after, VkPipelineStageFlags2 before);
