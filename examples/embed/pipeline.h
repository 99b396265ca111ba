// SPDX-License-Identifier: MIT
// A graphics pipeline of the host's with one set of pushed descriptors and one block of push constants.
#pragma once

#include "host_device.h"

#include <span>
#include <vector>

struct PipelineDesc {
    std::span<const std::uint32_t> vertex, fragment;  ///< SPIR-V; an empty fragment leaves depth to the rasterizer
    std::vector<VkDescriptorType> bindings;           ///< seen by both stages
    std::uint32_t push_bytes = 0;                     ///< of push constants, at most 128
    std::vector<std::uint32_t> attributes;            ///< offsets of vec3 in a vertex, bytes; none: no vertex buffer
    std::uint32_t stride = 0;                         ///< of a vertex, bytes
    std::vector<VkFormat> colors;
    VkFormat depth = VK_FORMAT_UNDEFINED;  ///< reversed: the greater is nearer
    bool of_light = false;  ///< for views of lights: the less is nearer, and what lies before them is clamped
};

class Pipeline {
  public:
    Pipeline(const HostDevice& host, const PipelineDesc& desc);
    ~Pipeline();
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;

    void bind(VkCommandBuffer commands) const;
    void push_constants(VkCommandBuffer commands, std::span<const std::byte> bytes) const;
    void push_buffer(VkCommandBuffer commands, std::uint32_t binding, const VkDescriptorBufferInfo& buffer) const;
    void push_image(VkCommandBuffer commands, std::uint32_t binding, const VkDescriptorImageInfo& image) const;

  private:
    void make_layout(const PipelineDesc& desc);
    void make_pipeline(const PipelineDesc& desc);
    void push(VkCommandBuffer commands, VkWriteDescriptorSet write) const;

    VkDevice device_;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    PFN_vkCmdPushDescriptorSetKHR push_descriptors_ = nullptr;
};

/// Begins drawing into attachments of one size; viewport and scissor cover all of it. `depth` may be null.
void begin_drawing(VkCommandBuffer commands, VkExtent2D size, std::span<const VkRenderingAttachmentInfo> colors,
                   const VkRenderingAttachmentInfo* depth);
VkRenderingAttachmentInfo cleared(VkImageView view, VkImageLayout layout);
