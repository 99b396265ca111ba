// SPDX-License-Identifier: MIT
// The recorder that writes Vulkan commands for one pass after another.
#pragma once

#include "gpu/graph_resources.h"
#include "gpu/pipeline_cache.h"
#include "gpu/upload_arena.h"

#include <array>

namespace gn {

class GraphRecorder final : public Recorder {
  public:
    GraphRecorder(Device& device, const GraphDeclaration& declaration, GraphResources& resources, UploadArena& arena);

    /// Starts a pass: rendering begins where it has attachments.
    void begin(VkCommandBuffer commands, const DeclaredPass& pass);
    void end();

    void bind(const ComputeDesc& desc) override;
    void bind(const RasterDesc& desc) override;
    void set(std::string_view name, TextureHandle texture, const SamplerDesc& sampler, Range range) override;
    void set_storage(std::string_view name, TextureHandle texture, Range range) override;
    void set(std::string_view name, BufferHandle buffer) override;
    void set_bytes(std::string_view name, std::span<const std::byte> bytes) override;
    void push(std::span<const std::byte> bytes) override;
    void viewport(float x, float y, float width, float height) override;
    void scissor(std::int32_t x, std::int32_t y, std::uint32_t width, std::uint32_t height) override;
    void depth_bias(float constant, float slope, float clamp) override;
    void stencil_reference(std::uint32_t value) override;
    void vertex_buffer(BufferHandle buffer, VkDeviceSize offset) override;
    void index_buffer(BufferHandle buffer, VkDeviceSize offset) override;
    void draw(std::uint32_t vertices, std::uint32_t instances, std::uint32_t first_vertex,
              std::uint32_t first_instance) override;
    void draw_indexed(std::uint32_t indices, std::uint32_t instances, std::uint32_t first_index,
                      std::int32_t vertex_offset, std::uint32_t first_instance) override;
    void draw_indexed(std::span<const VkDrawIndexedIndirectCommand> draws) override;
    void draw_indirect(BufferHandle arguments, VkDeviceSize offset) override;
    void draw_indexed_indirect(BufferHandle arguments, VkDeviceSize offset, std::uint32_t draws) override;
    void dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) override;
    void dispatch_indirect(BufferHandle arguments, VkDeviceSize offset) override;
    void blit(TextureHandle from, Range from_range, TextureHandle to, Range to_range, VkFilter filter) override;
    void copy(TextureHandle from, BufferHandle to, Range range) override;
    void copy(BufferHandle from, BufferHandle to, VkDeviceSize bytes, VkDeviceSize from_offset,
              VkDeviceSize to_offset) override;
    void fill(BufferHandle buffer, std::uint32_t word) override;
    [[nodiscard]] const TextureDesc& desc(TextureHandle texture) const override;
    [[nodiscard]] VkCommandBuffer vk() const override { return commands_; }
    void forget() override;

  private:
    enum class SlotKind { texture, storage, buffer, bytes };
    /// What a name stands for in this pass.
    struct Slot {
        std::string name{};
        SlotKind kind = SlotKind::bytes;
        std::uint32_t resource = 0;
        Range range{};
        SamplerDesc sampler{};
        UploadedBytes bytes{};
    };
    /// A resource that a command outside rendering reads or writes.
    struct Touch {
        bool texture = false;
        std::uint32_t resource = 0;
        bool writes = false;
    };

    void begin_rendering();
    /// Viewport, scissor, bias and reference as a pass with attachments begins.
    void begin_state();
    /// Lets a name stand for something; descriptors stay as they are where it already did.
    void stand_for(std::string_view name, const Slot& what);
    [[nodiscard]] Range resolve(TextureHandle texture, Range range, std::string_view what) const;
    [[nodiscard]] const std::string& name_of(TextureHandle texture) const;
    [[nodiscard]] const std::string& name_of(BufferHandle buffer) const;
    /// Throws Error unless the pass declared one of `kinds` for all of the range.
    void require(TextureHandle texture, const Range& range, std::initializer_list<UseKind> kinds,
                 std::string_view what) const;
    void require(BufferHandle buffer, std::initializer_list<UseKind> kinds, std::string_view what) const;
    void require_rendering(bool rendering, std::string_view command) const;
    [[nodiscard]] bool declared_write(bool texture, std::uint32_t resource) const;
    [[nodiscard]] VkImageLayout layout_of(std::uint32_t texture, const Range& range) const;

    /// Makes the pipeline, its descriptors and push constants current. Throws Error naming what was never set.
    void prepare(VkPipelineBindPoint bind_point, std::string_view command);
    void push_descriptors(std::vector<Touch>* touches);
    VkDescriptorImageInfo describe_image(const PipelineBinding& binding, const Slot& slot);
    VkDescriptorBufferInfo describe_buffer(const PipelineBinding& binding, const Slot& slot) const;
    [[nodiscard]] VkImageViewType view_type(const PipelineBinding& binding, const Slot& slot) const;
    /// Orders a command after those of the same pass that it depends on.
    void order(const std::vector<Touch>& touches);

    Device& device_;
    const GraphDeclaration& declaration_;
    GraphResources& resources_;
    UploadArena& arena_;
    PFN_vkCmdPushDescriptorSetKHR push_descriptor_set_;

    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    const DeclaredPass* pass_ = nullptr;
    AttachmentFormats formats_;
    bool rendering_ = false;
    std::uint32_t width_ = 0, height_ = 0;

    const Pipeline* pipeline_ = nullptr;
    bool descriptors_stale_ = true, push_stale_ = true;
    bool has_index_buffer_ = false, has_vertex_buffer_ = false, wants_vertex_buffer_ = false;
    std::vector<Slot> slots_;
    std::vector<Touch> bound_;    ///< what the current descriptors touch
    std::vector<Touch> pending_;  ///< what commands since the last barrier touched
    std::array<std::byte, 128> push_bytes_{};
    std::size_t push_size_ = 0;
};

}  // namespace gn
