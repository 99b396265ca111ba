// SPDX-License-Identifier: MIT
// Compiled pipelines by the fingerprint of their description, and samplers by theirs.
#pragma once

#include "gpu/frame_graph.h"
#include "gpu/hash.h"
#include "gpu/pipeline.h"
#include "gpu/shader_cache.h"

#include <memory>
#include <mutex>
#include <optional>
#include <set>

namespace gn {

/// What a raster pipeline must know about the pass it is used in.
struct AttachmentFormats {
    std::vector<VkFormat> colors;
    VkFormat depth = VK_FORMAT_UNDEFINED;
    std::uint32_t samples = 1;
    bool depth_read_only = false;
};

/// A binding of all stages together.
struct PipelineBinding {
    std::string name;
    ShaderBinding shader;
    VkShaderStageFlags stages = 0;
};

struct Pipeline {
    std::string name;
    VkPipeline vk = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    VkPipelineBindPoint bind_point = VK_PIPELINE_BIND_POINT_COMPUTE;
    std::vector<PipelineBinding> bindings;
    VkShaderStageFlags stages = 0;
    std::uint32_t push_constant_bytes = 0;
};

/// One set of bindings from several stages. Throws Error naming the variable where stages disagree.
std::vector<PipelineBinding> merge_bindings(std::span<const CompiledShader* const> stages);

/// What a pipeline is made of.
struct PipelineOrder {
    std::optional<ComputeDesc> compute;  ///< one of the two
    std::optional<RasterDesc> raster;
    AttachmentFormats formats;
};

/// Everything but make is called by the thread that records.
class PipelineCache {
  public:
    /// `folder` holds what the driver compiled from run to run; empty: nothing is kept on disk.
    PipelineCache(Device& device, std::filesystem::path folder);
    ~PipelineCache();
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    const Pipeline& get(const ComputeDesc& desc);
    const Pipeline& get(const RasterDesc& desc, const AttachmentFormats& formats);
    VkSampler sampler(const SamplerDesc& desc);
    /// By what a pipeline is known, and whether get would find it.
    [[nodiscard]] static Fingerprint key_of(const PipelineOrder& order);
    [[nodiscard]] bool has(const Fingerprint& key) const { return pipelines_.contains(key); }
    /// Makes a pipeline that nobody has yet, for take. Any thread may call it; one at a time makes, and get waits for it.
    Pipeline make(const PipelineOrder& order);
    /// Keeps what make gave; what is there already stays.
    void take(const PipelineOrder& order, Pipeline pipeline);
    /// Makes the pipelines of these shaders anew, from what the device's shaders are now, and holds those of before as long as
    /// the result lives: frames in flight may still use them. Throws Error where one cannot be made; then all stay as they
    /// were. Only where shaders have sources.
    std::shared_ptr<const void> remake(const std::set<Fingerprint>& shaders);
    /// How many pipelines were made so far.
    [[nodiscard]] std::size_t size() const { return pipelines_.size(); }
    /// Writes what the driver compiled to disk, where pipelines were made since the last time; at the end this is done
    /// anyway.
    void save();

  private:
    const Pipeline& keep(const Fingerprint& key, const PipelineOrder& order, Pipeline pipeline);
    void load();
    Pipeline make(const ComputeDesc& desc);
    Pipeline make(const RasterDesc& desc, const AttachmentFormats& formats);
    class Unfinished;
    void lay_out(Pipeline& pipeline, std::span<const CompiledShader* const> stages);
    void destroy(Pipeline& pipeline) const;

    Device& device_;
    ShaderCache disk_;
    Fingerprint disk_key_;  ///< of the driver, which alone can read its own data
    VkPipelineCache vk_ = VK_NULL_HANDLE;
    std::size_t saved_ = 0;  ///< pipelines that the disk knows
    std::map<Fingerprint, Pipeline> pipelines_;
    std::mutex making_;                             ///< held by who makes: the compiler of shaders knows one thread
    std::map<Fingerprint, PipelineOrder> makings_;  ///< of all of them where shaders have sources, else empty
    std::map<Fingerprint, VkSampler> samplers_;
};

}  // namespace gn
