// SPDX-License-Identifier: MIT
#include "gpu/pipeline.h"

#include "gpu/fixed_state.h"
#include "gpu/pipeline_cache.h"

#include <algorithm>
#include <array>
#include <utility>

namespace gn {
namespace {

constexpr std::uint32_t most_pushed_descriptors = 32;
constexpr std::uint32_t most_push_constant_bytes = 128;

VkShaderStageFlagBits stage_of(ShaderKind kind) {
    switch (kind) {
        case ShaderKind::vertex: return VK_SHADER_STAGE_VERTEX_BIT;
        case ShaderKind::fragment: return VK_SHADER_STAGE_FRAGMENT_BIT;
        case ShaderKind::geometry: return VK_SHADER_STAGE_GEOMETRY_BIT;
        case ShaderKind::compute: break;
    }
    return VK_SHADER_STAGE_COMPUTE_BIT;
}

void hash(Hasher& hasher, const ShaderSource& shader) {
    const Fingerprint own = shader.fingerprint ? *shader.fingerprint : shader.work_out();
    hasher.value(own.low).value(own.high);
}

void hash(Hasher& hasher, const SpecConstants& constants) {
    hasher.value(constants.size());
    for (const auto& [id, value] : constants) {
        hasher.value(id).value(value);
    }
}

void hash(Hasher& hasher, const VkStencilOpState& ops) {
    hasher.value(ops.failOp).value(ops.passOp).value(ops.depthFailOp).value(ops.compareOp);
    hasher.value(ops.compareMask).value(ops.writeMask);
}

/// Texts whose maker left the work to whoever binds them.
std::uint64_t open_texts(const ComputeDesc& desc) {
    return desc.shader.fingerprint ? 0 : 1;
}
std::uint64_t open_texts(const RasterDesc& desc) {
    const auto open = [](const std::optional<ShaderSource>& shader) {
        return shader && !shader->fingerprint ? 1U : 0U;
    };
    return (desc.vertex.fingerprint ? 0U : 1U) + open(desc.geometry) + open(desc.fragment);
}

Fingerprint fingerprint(const ComputeDesc& desc) {
    Hasher hasher;
    hash(hasher, desc.shader);
    hash(hasher, desc.constants);
    return hasher.finish();
}

Fingerprint fingerprint(const RasterDesc& desc, const AttachmentFormats& formats) {
    Hasher hasher;
    hash(hasher, desc.vertex);
    hasher.value(desc.geometry.has_value()).value(desc.fragment.has_value());
    if (desc.geometry) {
        hash(hasher, *desc.geometry);
    }
    if (desc.fragment) {
        hash(hasher, *desc.fragment);
    }
    hash(hasher, desc.constants);
    hasher.value(desc.topology).value(desc.cull).value(desc.depth_test).value(desc.depth_write).value(desc.depth_clamp);
    hasher.value(desc.depth_compare).value(desc.depth_bias).value(desc.blend).value(desc.color_mask);
    hasher.value(desc.stencil.has_value());
    if (desc.stencil) {
        hash(hasher, desc.stencil->front);
        hash(hasher, desc.stencil->back);
    }
    hasher.value(desc.vertex_stride).value(desc.attributes.size());
    for (const RasterDesc::Attribute& attribute : desc.attributes) {
        hasher.value(attribute.location).value(attribute.offset).value(attribute.format);
    }
    hasher.value(formats.depth).value(formats.samples).value(formats.colors.size());
    for (const VkFormat format : formats.colors) {
        hasher.value(format);
    }
    return hasher.finish();
}

/// Specialization constants in the form that Vulkan takes; must not move while in use.
struct Specialization {
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<std::uint32_t> values;
    VkSpecializationInfo info{};

    explicit Specialization(const SpecConstants& constants) {
        for (const auto& [id, value] : constants) {
            entries.push_back({id, static_cast<std::uint32_t>(values.size() * 4), 4});
            values.push_back(value);
        }
        info = {static_cast<std::uint32_t>(entries.size()), entries.data(), values.size() * 4, values.data()};
    }
    Specialization(const Specialization&) = delete;
    Specialization& operator=(const Specialization&) = delete;
};

/// A shader module that lives as long as the pipeline is being made.
class Module {
  public:
    Module(VkDevice device, const CompiledShader& shader, const Specialization& specialization)
        : device_(device), stage_(stage_of(shader.kind)), info_(&specialization.info) {
        const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                            .codeSize = shader.spirv.size() * 4,
                                            .pCode = shader.spirv.data()};
        GN_VK(vkCreateShaderModule(device, &info, nullptr, &module_));
    }
    Module(Module&& other) noexcept
        : device_(other.device_), stage_(other.stage_), info_(other.info_), module_(std::exchange(other.module_, {})) {}
    Module& operator=(Module&&) = delete;
    ~Module() { vkDestroyShaderModule(device_, module_, nullptr); }
    [[nodiscard]] VkPipelineShaderStageCreateInfo stage() const {
        return {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                .stage = stage_,
                .module = module_,
                .pName = "main",
                .pSpecializationInfo = info_};
    }

  private:
    VkDevice device_;
    VkShaderStageFlagBits stage_;
    const VkSpecializationInfo* info_;
    VkShaderModule module_ = VK_NULL_HANDLE;
};

}  // namespace

std::vector<PipelineBinding> merge_bindings(std::span<const CompiledShader* const> stages) {
    std::vector<PipelineBinding> merged;
    for (const CompiledShader* stage : stages) {
        for (const auto& [name, shader] : stage->bindings) {
            // The same number must mean the same thing in every stage, and the same name the same number.
            const auto clash =
                std::find_if(merged.begin(), merged.end(), [&, &found = shader, &label = name](const auto& m) {
                    return m.name == label || m.shader.binding == found.binding;
                });
            if (clash == merged.end()) {
                merged.push_back({name, shader, static_cast<VkShaderStageFlags>(stage_of(stage->kind))});
                continue;
            }
            if (clash->name != name || !clash->shader.same_resource(shader)) {
                fail(
                    "shader '{}': '{}' (binding {}) disagrees with '{}' (binding {}) of an earlier stage or "
                    "declaration; one "
                    "name needs one binding and type in all stages",
                    stage->name, name, shader.binding, clash->name, clash->shader.binding);
            }
            clash->shader.block_bytes = std::max(clash->shader.block_bytes, shader.block_bytes);
            clash->stages |= static_cast<VkShaderStageFlags>(stage_of(stage->kind));
        }
    }
    if (merged.size() > most_pushed_descriptors) {
        fail("shader '{}' uses {} resources; at most {} can be bound", stages.back()->name, merged.size(),
             most_pushed_descriptors);
    }
    return merged;
}

void PipelineCache::destroy(Pipeline& pipeline) const {
    vkDestroyPipeline(device_.vk(), pipeline.vk, nullptr);
    vkDestroyPipelineLayout(device_.vk(), pipeline.layout, nullptr);
    vkDestroyDescriptorSetLayout(device_.vk(), pipeline.set_layout, nullptr);
}

/// A pipeline in the making, of which nothing is left where that fails.
class PipelineCache::Unfinished {
  public:
    Unfinished(const PipelineCache& cache, VkPipelineBindPoint bind_point) : cache_(cache) {
        pipeline.bind_point = bind_point;
    }
    Unfinished(const Unfinished&) = delete;
    Unfinished& operator=(const Unfinished&) = delete;
    ~Unfinished() { cache_.destroy(pipeline); }
    Pipeline finish() { return std::exchange(pipeline, {}); }
    Pipeline pipeline;

  private:
    const PipelineCache& cache_;
};

void PipelineCache::lay_out(Pipeline& pipeline, std::span<const CompiledShader* const> stages) {
    pipeline.name = stages.back()->name;
    pipeline.bindings = merge_bindings(stages);
    for (const CompiledShader* stage : stages) {
        pipeline.stages |= static_cast<VkShaderStageFlags>(stage_of(stage->kind));
        pipeline.push_constant_bytes = std::max(pipeline.push_constant_bytes, stage->push_constant_bytes);
    }
    if (pipeline.push_constant_bytes > most_push_constant_bytes) {
        fail("shader '{}' has {} bytes of push constants; at most {} are allowed", pipeline.name,
             pipeline.push_constant_bytes, most_push_constant_bytes);
    }

    // One set, pushed with every draw.
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const PipelineBinding& binding : pipeline.bindings) {
        bindings.push_back({binding.shader.binding, static_cast<VkDescriptorType>(binding.shader.vk_descriptor_type), 1,
                            binding.stages, nullptr});
    }
    const VkDescriptorSetLayoutCreateInfo set{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                              .flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR,
                                              .bindingCount = static_cast<std::uint32_t>(bindings.size()),
                                              .pBindings = bindings.data()};
    GN_VK(vkCreateDescriptorSetLayout(device_.vk(), &set, nullptr, &pipeline.set_layout));
    const VkPushConstantRange push{pipeline.stages, 0, (pipeline.push_constant_bytes + 3) / 4 * 4};
    const VkPipelineLayoutCreateInfo layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                            .setLayoutCount = 1,
                                            .pSetLayouts = &pipeline.set_layout,
                                            .pushConstantRangeCount = push.size > 0 ? 1U : 0U,
                                            .pPushConstantRanges = &push};
    GN_VK(vkCreatePipelineLayout(device_.vk(), &layout, nullptr, &pipeline.layout));
}

Pipeline PipelineCache::make(const ComputeDesc& desc) {
    const CompiledShader* shader = &device_.shaders().compile(desc.shader);
    Unfinished made(*this, VK_PIPELINE_BIND_POINT_COMPUTE);
    Pipeline& pipeline = made.pipeline;
    lay_out(pipeline, std::span(&shader, 1));
    const Specialization specialization(desc.constants);
    const Module module(device_.vk(), *shader, specialization);
    const VkComputePipelineCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO, .stage = module.stage(), .layout = pipeline.layout};
    GN_VK(vkCreateComputePipelines(device_.vk(), vk_, 1, &info, nullptr, &pipeline.vk));
    return made.finish();
}

Pipeline PipelineCache::make(const RasterDesc& desc, const AttachmentFormats& formats) {
    // Compile the stages that are there.
    std::vector<const CompiledShader*> shaders{&device_.shaders().compile(desc.vertex)};
    if (desc.geometry) {
        shaders.push_back(&device_.shaders().compile(*desc.geometry));
    }
    if (desc.fragment) {
        shaders.push_back(&device_.shaders().compile(*desc.fragment));
    }
    Unfinished made(*this, VK_PIPELINE_BIND_POINT_GRAPHICS);
    Pipeline& pipeline = made.pipeline;
    lay_out(pipeline, shaders);
    const Specialization specialization(desc.constants);
    std::vector<Module> modules;
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    stages.reserve(shaders.size());
    for (const CompiledShader* shader : shaders) {
        stages.push_back(modules.emplace_back(device_.vk(), *shader, specialization).stage());
    }

    FixedState fixed(desc, formats);
    const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                            .pNext = &fixed.rendering,
                                            .stageCount = static_cast<std::uint32_t>(stages.size()),
                                            .pStages = stages.data(),
                                            .pVertexInputState = &fixed.vertices,
                                            .pInputAssemblyState = &fixed.assembly,
                                            .pViewportState = &fixed.viewport,
                                            .pRasterizationState = &fixed.raster,
                                            .pMultisampleState = &fixed.samples,
                                            .pDepthStencilState = &fixed.depth,
                                            .pColorBlendState = &fixed.blend,
                                            .pDynamicState = &fixed.dynamic,
                                            .layout = pipeline.layout};
    GN_VK(vkCreateGraphicsPipelines(device_.vk(), vk_, 1, &info, nullptr, &pipeline.vk));
    return made.finish();
}

Pipeline PipelineCache::make(const PipelineOrder& order) {
    const std::lock_guard lock(making_);
    return order.compute ? make(*order.compute) : make(order.raster.value(), order.formats);
}

const Pipeline& PipelineCache::keep(const Fingerprint& key, const PipelineOrder& order, Pipeline pipeline) {
    ++device_.counters().pipelines;
    if (device_.shaders().has_sources()) {
        makings_.emplace(key, order.compute ? PipelineOrder{.compute = sealed(*order.compute)}
                                            : PipelineOrder{.raster = sealed(*order.raster), .formats = order.formats});
    }
    return pipelines_.emplace(key, std::move(pipeline)).first->second;
}

Fingerprint PipelineCache::key_of(const PipelineOrder& order) {
    return order.compute ? fingerprint(*order.compute) : fingerprint(order.raster.value(), order.formats);
}

void PipelineCache::take(const PipelineOrder& order, Pipeline pipeline) {
    const Fingerprint key = key_of(order);
    if (has(key)) {
        destroy(pipeline);
    } else {
        keep(key, order, std::move(pipeline));
    }
}

const Pipeline& PipelineCache::get(const ComputeDesc& desc) {
    device_.counters().texts += open_texts(desc);
    const Fingerprint key = fingerprint(desc);
    if (const auto found = pipelines_.find(key); found != pipelines_.end()) {
        return found->second;
    }
    const PipelineOrder order{.compute = desc};
    return keep(key, order, make(order));
}

const Pipeline& PipelineCache::get(const RasterDesc& desc, const AttachmentFormats& formats) {
    device_.counters().texts += open_texts(desc);
    const Fingerprint key = fingerprint(desc, formats);
    if (const auto found = pipelines_.find(key); found != pipelines_.end()) {
        return found->second;
    }
    const PipelineOrder order{.raster = desc, .formats = formats};
    return keep(key, order, make(order));
}

ShaderSource fullscreen_vertex_shader() {
    return {ShaderKind::vertex, "fullscreen", R"(
layout(location = 0) out vec2 uv;
void main() {
    uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0;
    gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0);
}
)"};
}

ComputeDesc sealed(ComputeDesc desc) {
    desc.shader.seal();
    return desc;
}

RasterDesc sealed(RasterDesc desc) {
    desc.vertex.seal();
    for (std::optional<ShaderSource>* stage : {&desc.geometry, &desc.fragment}) {
        if (*stage) {
            (*stage)->seal();
        }
    }
    return desc;
}

RasterDesc fullscreen(ShaderSource fragment) {
    return {.vertex = fullscreen_vertex_shader(), .fragment = std::move(fragment)};
}

}  // namespace gn
