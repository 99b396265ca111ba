// SPDX-License-Identifier: MIT
// Pipelines and resources by name: what set() collects becomes one push of descriptors before a draw.
#include "gpu/recorder.h"

#include <algorithm>
#include <cstring>

namespace gn {

void GraphRecorder::bind(const ComputeDesc& desc) {
    require_rendering(false, "bind of a compute shader");
    const Pipeline& pipeline = device_.pipelines().get(desc);
    if (pipeline_ != &pipeline) {
        vkCmdBindPipeline(commands_, pipeline.bind_point, pipeline.vk);
        pipeline_ = &pipeline;
        descriptors_stale_ = push_stale_ = true;
    }
}

void GraphRecorder::bind(const RasterDesc& desc) {
    require_rendering(true, "bind of a raster pipeline");
    if (formats_.depth_read_only && desc.depth_write) {
        fail("pass '{}' draws '{}' with depth_write, but declared its depth read-only", pass_->name, desc.vertex.name);
    }
    const Pipeline& pipeline = device_.pipelines().get(desc, formats_);
    if (pipeline_ != &pipeline) {
        vkCmdBindPipeline(commands_, pipeline.bind_point, pipeline.vk);
        pipeline_ = &pipeline;
        descriptors_stale_ = push_stale_ = true;
    }
    wants_vertex_buffer_ = !desc.attributes.empty();
    if (desc.stencil) {
        vkCmdSetStencilReference(commands_, VK_STENCIL_FACE_FRONT_BIT, desc.stencil->front.reference);
        vkCmdSetStencilReference(commands_, VK_STENCIL_FACE_BACK_BIT, desc.stencil->back.reference);
    }
}

void GraphRecorder::stand_for(std::string_view name, const Slot& what) {
    const auto found = std::find_if(slots_.begin(), slots_.end(), [&](const Slot& held) { return held.name == name; });
    if (found != slots_.end() && what.kind != SlotKind::bytes && found->kind == what.kind &&
        found->resource == what.resource && found->range == what.range && found->sampler == what.sampler) {
        return;
    }
    descriptors_stale_ = true;
    Slot& held = found != slots_.end() ? *found : slots_.emplace_back(Slot{.name = std::string(name)});
    held.kind = what.kind;
    held.resource = what.resource;
    held.range = what.range;
    held.sampler = what.sampler;
    held.bytes = what.bytes;
}

void GraphRecorder::set(std::string_view name, TextureHandle texture, const SamplerDesc& sampler, Range range) {
    range = resolve(texture, range, name);
    stand_for(name, {.kind = SlotKind::texture, .resource = texture.index, .range = range, .sampler = sampler});
}

void GraphRecorder::set_storage(std::string_view name, TextureHandle texture, Range range) {
    range = resolve(texture, range, name);
    stand_for(name, {.kind = SlotKind::storage, .resource = texture.index, .range = range});
}

void GraphRecorder::set(std::string_view name, BufferHandle buffer) {
    static_cast<void>(name_of(buffer));
    stand_for(name, {.kind = SlotKind::buffer, .resource = buffer.index});
}

void GraphRecorder::set_bytes(std::string_view name, std::span<const std::byte> bytes) {
    stand_for(name, {.kind = SlotKind::bytes, .bytes = arena_.put(bytes)});
}

void GraphRecorder::push(std::span<const std::byte> bytes) {
    if (bytes.size() > push_bytes_.size()) {
        fail("pass '{}' pushes {} bytes of constants; at most {} fit", pass_->name, bytes.size(), push_bytes_.size());
    }
    std::copy(bytes.begin(), bytes.end(), push_bytes_.begin());
    push_size_ = bytes.size();
    push_stale_ = true;
}

void GraphRecorder::prepare(VkPipelineBindPoint bind_point, std::string_view command) {
    require_rendering(bind_point == VK_PIPELINE_BIND_POINT_GRAPHICS, command);
    if (pipeline_ == nullptr) {
        fail("pass '{}' calls {} before it binds a pipeline", pass_->name, command);
    }
    if (rendering_ && wants_vertex_buffer_ && !has_vertex_buffer_) {
        fail("pass '{}' draws '{}' with vertex attributes, but without a vertex_buffer", pass_->name, pipeline_->name);
    }
    if (descriptors_stale_) {
        bound_.clear();
        push_descriptors(&bound_);
        descriptors_stale_ = false;
    }
    if (push_stale_ && pipeline_->push_constant_bytes > 0) {
        if (push_size_ < pipeline_->push_constant_bytes) {
            fail("pass '{}': shader '{}' has {} bytes of push constants, but {} were given", pass_->name,
                 pipeline_->name, pipeline_->push_constant_bytes, push_size_);
        }
        vkCmdPushConstants(commands_, pipeline_->layout, pipeline_->stages, 0,
                           (pipeline_->push_constant_bytes + 3) / 4 * 4, push_bytes_.data());
        push_stale_ = false;
    }
}

void GraphRecorder::push_descriptors(std::vector<Touch>* touches) {
    // The infos must stay where they are until the push.
    const std::size_t count = pipeline_->bindings.size();
    std::vector<VkDescriptorImageInfo> images(count);
    std::vector<VkDescriptorBufferInfo> buffers(count);
    std::vector<VkWriteDescriptorSet> writes;
    for (std::size_t i = 0; i < count; ++i) {
        const PipelineBinding& binding = pipeline_->bindings[i];
        const auto found =
            std::find_if(slots_.begin(), slots_.end(), [&](const Slot& s) { return s.name == binding.name; });
        if (found == slots_.end()) {
            fail("pass '{}': shader '{}' uses '{}', which was never set", pass_->name, pipeline_->name, binding.name);
        }
        const auto type = static_cast<VkDescriptorType>(binding.shader.vk_descriptor_type);
        VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstBinding = binding.shader.binding,
                                   .descriptorCount = 1,
                                   .descriptorType = type};
        if (type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER || type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER) {
            buffers[i] = describe_buffer(binding, *found);
            write.pBufferInfo = &buffers[i];
        } else {
            images[i] = describe_image(binding, *found);
            write.pImageInfo = &images[i];
        }
        writes.push_back(write);
        if (found->kind != SlotKind::bytes) {
            const bool texture = found->kind != SlotKind::buffer;
            const bool stores = type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER || type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
            touches->push_back({texture, found->resource, stores && declared_write(texture, found->resource)});
        }
    }
    if (!writes.empty()) {
        push_descriptor_set_(commands_, pipeline_->bind_point, pipeline_->layout, 0,
                             static_cast<std::uint32_t>(writes.size()), writes.data());
    }
}

VkDescriptorBufferInfo GraphRecorder::describe_buffer(const PipelineBinding& binding, const Slot& held) const {
    const bool uniform = binding.shader.vk_descriptor_type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    VkDescriptorBufferInfo info{};
    if (held.kind == SlotKind::bytes) {
        info = {held.bytes.buffer, held.bytes.offset, held.bytes.bytes};
    } else if (held.kind == SlotKind::buffer) {
        const BufferHandle buffer{held.resource};
        require(buffer, {UseKind::storage_read, UseKind::storage_write, UseKind::vertices, UseKind::indices},
                binding.name);
        info = {resources_.buffer(held.resource), 0,
                std::max<VkDeviceSize>(declaration_.buffers[held.resource].desc.bytes, 16)};
    } else {
        fail("pass '{}': '{}' is a block in shader '{}', but a texture was set", pass_->name, binding.name,
             pipeline_->name);
    }

    const VkPhysicalDeviceLimits& limits = device_.properties().limits;
    const VkDeviceSize most = uniform ? limits.maxUniformBufferRange : limits.maxStorageBufferRange;
    if (info.range > most) {
        fail("pass '{}': block '{}' of {} bytes is over the device's limit of {} for a {} block", pass_->name,
             binding.name, info.range, most, uniform ? "uniform" : "storage");
    }
    if (info.range < binding.shader.block_bytes) {
        fail("pass '{}': block '{}' of shader '{}' has {} bytes, but {} were given", pass_->name, binding.name,
             pipeline_->name, binding.shader.block_bytes, info.range);
    }
    return info;
}

VkImageViewType GraphRecorder::view_type(const PipelineBinding& binding, const Slot& held) const {
    const std::uint32_t layers = held.range.layers;
    const std::string& texture = declaration_.textures[held.resource].desc.name;
    constexpr std::uint32_t dim_2d = 1, dim_cube = 3;
    if (binding.shader.image_dim == dim_cube) {
        if (layers % 6 != 0 || (!binding.shader.arrayed && layers != 6) ||
            !declaration_.textures[held.resource].desc.cube) {
            fail("pass '{}': '{}' is a cube in shader '{}', but '{}' has {} layers and is {}made for cubes",
                 pass_->name, binding.name, pipeline_->name, texture, layers,
                 declaration_.textures[held.resource].desc.cube ? "" : "not ");
        }
        return binding.shader.arrayed ? VK_IMAGE_VIEW_TYPE_CUBE_ARRAY : VK_IMAGE_VIEW_TYPE_CUBE;
    }
    if (binding.shader.image_dim != dim_2d) {
        fail("pass '{}': '{}' of shader '{}' is neither 2D nor a cube", pass_->name, binding.name, pipeline_->name);
    }
    if (!binding.shader.arrayed && layers != 1) {
        fail("pass '{}': '{}' has one layer in shader '{}', but {} layers of '{}' were set; name one with one_layer()",
             pass_->name, binding.name, pipeline_->name, layers, texture);
    }
    if (binding.shader.multisampled != (declaration_.textures[held.resource].desc.samples > 1)) {
        fail("pass '{}': '{}' is {}multisampled in shader '{}', but '{}' has {} samples", pass_->name, binding.name,
             binding.shader.multisampled ? "" : "not ", pipeline_->name, texture,
             declaration_.textures[held.resource].desc.samples);
    }
    return binding.shader.arrayed ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
}

VkDescriptorImageInfo GraphRecorder::describe_image(const PipelineBinding& binding, const Slot& held) {
    const auto type = static_cast<VkDescriptorType>(binding.shader.vk_descriptor_type);
    if (type == VK_DESCRIPTOR_TYPE_SAMPLER) {
        return {.sampler = device_.pipelines().sampler(held.sampler)};
    }
    const bool storage = type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    if (held.kind != (storage ? SlotKind::storage : SlotKind::texture)) {
        fail("pass '{}': '{}' is {} in shader '{}'; set it with {}", pass_->name, binding.name,
             storage ? "a storage image" : "a sampled texture", pipeline_->name,
             storage ? "set_storage" : "a texture and set");
    }

    // The view has the shape that the shader declares; depth and stencil are read one at a time.
    const TextureHandle texture{held.resource};
    Range range = held.range;
    VkImageAspectFlags aspects = aspects_of(desc(texture).format);
    if (storage) {
        range.mips = 1;
        require(texture, range, {UseKind::storage_read, UseKind::storage_write}, binding.name);
    } else {
        require(texture, range, {UseKind::sample}, binding.name);
    }
    if (is_depth(desc(texture).format)) {
        aspects = binding.shader.integer ? VK_IMAGE_ASPECT_STENCIL_BIT : VK_IMAGE_ASPECT_DEPTH_BIT;
    }
    const VkImageView view = resources_.view(held.resource, range, view_type(binding, held), aspects);
    const VkSampler sampler = storage ? VK_NULL_HANDLE : device_.pipelines().sampler(held.sampler);
    return {sampler, view, layout_of(held.resource, range)};
}

}  // namespace gn
