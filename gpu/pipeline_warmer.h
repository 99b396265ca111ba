// SPDX-License-Identifier: MIT
// A recorder that makes what passes bind and records nothing.
#pragma once

#include "gpu/graph_plan.h"
#include "gpu/pipeline_cache.h"

namespace gn {

class PipelineWarmer final : public Recorder {
  public:
    PipelineWarmer(Device& device, const GraphDeclaration& declaration) : device_(device), declaration_(declaration) {}

    /// Starts a pass, whose attachments its pipelines must know.
    void begin(const DeclaredPass& pass) { formats_ = attachment_formats(declaration_, pass); }

    void bind(const ComputeDesc& desc) override { device_.pipelines().get(desc); }
    void bind(const RasterDesc& desc) override { device_.pipelines().get(desc, formats_); }
    void set(std::string_view, TextureHandle, const SamplerDesc& sampler, Range) override {
        device_.pipelines().sampler(sampler);
    }
    [[nodiscard]] const TextureDesc& desc(TextureHandle texture) const override {
        return declaration_.textures.at(texture.index).desc;
    }

    // Commands leave no trace.
    void set_storage(std::string_view, TextureHandle, Range) override {}
    void set(std::string_view, BufferHandle) override {}
    void set_bytes(std::string_view, std::span<const std::byte>) override {}
    void push(std::span<const std::byte>) override {}
    void viewport(float, float, float, float) override {}
    void scissor(std::int32_t, std::int32_t, std::uint32_t, std::uint32_t) override {}
    void depth_bias(float, float, float) override {}
    void stencil_reference(std::uint32_t) override {}
    void vertex_buffer(BufferHandle, VkDeviceSize) override {}
    void index_buffer(BufferHandle, VkDeviceSize) override {}
    void draw(std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t) override {}
    void draw_indexed(std::uint32_t, std::uint32_t, std::uint32_t, std::int32_t, std::uint32_t) override {}
    void draw_indexed(std::span<const VkDrawIndexedIndirectCommand>) override {}
    void draw_indirect(BufferHandle, VkDeviceSize) override {}
    void draw_indexed_indirect(BufferHandle, VkDeviceSize, std::uint32_t) override {}
    void dispatch(std::uint32_t, std::uint32_t, std::uint32_t) override {}
    void dispatch_indirect(BufferHandle, VkDeviceSize) override {}
    void blit(TextureHandle, Range, TextureHandle, Range, VkFilter) override {}
    void copy(TextureHandle, BufferHandle, Range) override {}
    void copy(BufferHandle, BufferHandle, VkDeviceSize, VkDeviceSize, VkDeviceSize) override {}
    void fill(BufferHandle, std::uint32_t) override {}
    [[nodiscard]] VkCommandBuffer vk() const override { return VK_NULL_HANDLE; }

  private:
    Device& device_;
    const GraphDeclaration& declaration_;
    AttachmentFormats formats_;
};

}  // namespace gn
