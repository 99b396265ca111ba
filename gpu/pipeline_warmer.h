// SPDX-License-Identifier: MIT
// Recorders that look at what passes bind and record nothing.
#pragma once

#include "gpu/graph_plan.h"
#include "gpu/pipeline_cache.h"

namespace gn {

class SilentRecorder : public Recorder {
  public:
    explicit SilentRecorder(const GraphDeclaration& declared) : declaration(declared) {}

    /// Starts a pass, whose attachments its pipelines must know.
    virtual void begin(const DeclaredPass&) {}

    [[nodiscard]] const TextureDesc& desc(TextureHandle texture) const override {
        return declaration.textures.at(texture.index).desc;
    }

    // Commands leave no trace.
    void set(std::string_view, TextureHandle, const SamplerDesc&, Range) override {}
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
    void forget() override {}

  protected:
    const GraphDeclaration& declaration;
};

/// Makes what is bound.
class PipelineWarmer final : public SilentRecorder {
  public:
    PipelineWarmer(Device& device, const GraphDeclaration& declared) : SilentRecorder(declared), device_(device) {}

    void begin(const DeclaredPass& pass) override { formats_ = attachment_formats(declaration, pass); }
    void bind(const ComputeDesc& desc) override { device_.pipelines().get(desc); }
    void bind(const RasterDesc& desc) override { device_.pipelines().get(desc, formats_); }
    using SilentRecorder::set;
    void set(std::string_view, TextureHandle, const SamplerDesc& sampler, Range) override {
        device_.pipelines().sampler(sampler);
    }

  private:
    Device& device_;
    AttachmentFormats formats_;
};

/// Tells which pipelines are bound and not there yet, each once.
class PipelineFinder final : public SilentRecorder {
  public:
    PipelineFinder(Device& device, const GraphDeclaration& declared) : SilentRecorder(declared), device_(device) {}

    void begin(const DeclaredPass& pass) override { formats_ = attachment_formats(declaration, pass); }
    void bind(const ComputeDesc& desc) override { find({.compute = desc}); }
    void bind(const RasterDesc& desc) override { find({.raster = desc, .formats = formats_}); }
    std::vector<PipelineOrder> missing;

  private:
    void find(PipelineOrder order) {
        const Fingerprint key = PipelineCache::key_of(order);
        if (!device_.pipelines().has(key) && found_.insert(key).second) {
            missing.push_back(std::move(order));
        }
    }
    std::set<Fingerprint> found_;
    Device& device_;
    AttachmentFormats formats_;
};

/// Tells which shaders are bound.
class ShaderFinder final : public SilentRecorder {
  public:
    ShaderFinder(const GraphDeclaration& declared, const std::function<void(const ShaderSource&)>& found)
        : SilentRecorder(declared), found_(found) {}

    void bind(const ComputeDesc& desc) override { found_(desc.shader); }
    void bind(const RasterDesc& desc) override {
        found_(desc.vertex);
        for (const std::optional<ShaderSource>* stage : {&desc.geometry, &desc.fragment}) {
            if (*stage) {
                found_(**stage);
            }
        }
    }

  private:
    const std::function<void(const ShaderSource&)>& found_;
};

}  // namespace gn
