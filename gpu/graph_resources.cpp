// SPDX-License-Identifier: MIT
#include "gpu/graph_resources.h"

#include "gpu/transfer.h"

#include <algorithm>

namespace gn {
namespace {

constexpr VkBufferUsageFlags transient_buffer_usage =
    VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
    VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

}  // namespace

GraphResources::GraphResources(Device& device, const GraphDeclaration& declaration, const Imports& imports)
    : device_(device),
      declaration_(declaration),
      imports_(imports),
      images_(declaration.textures.size()),
      buffers_(declaration.buffers.size()),
      own_image_(images_.size()),
      own_buffer_(buffers_.size()) {
    footprints_.textures.resize(images_.size());
    footprints_.buffers.resize(buffers_.size());

    // Only what a living pass touches exists.
    std::vector<bool> textures(images_.size()), buffers(buffers_.size());
    for (const std::uint32_t pass : living_passes(declaration)) {
        for (const Use& use : declaration.passes[pass].uses) {
            (use.texture ? textures : buffers)[use.resource] = true;
        }
    }
    try {
        rebind(imports);
        for (std::uint32_t i = 0; i < images_.size(); ++i) {
            if (imports.textures[i] == nullptr && textures[i]) {
                make_texture(i);
            }
        }
        for (std::uint32_t i = 0; i < buffers_.size(); ++i) {
            if (imports.buffers[i] == nullptr && buffers[i]) {
                make_buffer(i);
            }
        }
    } catch (...) {
        destroy();
        throw;
    }
}

GraphResources::~GraphResources() {
    destroy();
}

void GraphResources::rebind(const Imports& imports) {
    imports_ = imports;
    for (std::size_t i = 0; i < images_.size(); ++i) {
        images_[i] = imports.textures[i] != nullptr ? imports.textures[i]->vk() : images_[i];
    }
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
        buffers_[i] = imports.buffers[i] != nullptr ? imports.buffers[i]->vk() : buffers_[i];
    }
}

void GraphResources::destroy() {
    for (const auto& [key, view] : views_) {
        vkDestroyImageView(device_.vk(), view, nullptr);
    }
    for (std::size_t i = 0; i < images_.size(); ++i) {
        if (own_image_[i]) {
            vkDestroyImage(device_.vk(), images_[i], nullptr);
        }
    }
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
        if (own_buffer_[i]) {
            vkDestroyBuffer(device_.vk(), buffers_[i], nullptr);
        }
    }
    for (const MemoryHeap& heap : heaps_) {
        device_.memory().give_heap(heap);
    }
}

void GraphResources::make_texture(std::uint32_t index) {
    TextureDesc desc = declaration_.textures[index].desc;
    desc.usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    for (const DeclaredPass& pass : declaration_.passes) {
        for (const Use& use : pass.uses) {
            desc.usage |= use.texture && use.resource == index ? usage_of(use.kind) : 0;
        }
    }
    images_[index] = create_image(device_, desc);
    own_image_[index] = true;
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device_.vk(), images_[index], &needs);
    const VkDeviceSize granularity = device_.properties().limits.bufferImageGranularity;
    footprints_.textures[index] = {needs.size, std::max(needs.alignment, granularity), needs.memoryTypeBits};
}

void GraphResources::make_buffer(std::uint32_t index) {
    const BufferDesc& desc = declaration_.buffers[index].desc;
    const VkDeviceSize bytes = std::max<VkDeviceSize>(desc.bytes, 16);
    if (bytes > device_.memory().largest()) {
        fail("buffer '{}' needs {} MiB; this device allows {} MiB", desc.name, bytes >> 20U,
             device_.memory().largest() >> 20U);
    }
    const VkBufferCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = bytes, .usage = desc.usage | transient_buffer_usage};
    GN_VK(vkCreateBuffer(device_.vk(), &info, nullptr, &buffers_[index]));
    ++device_.counters().buffers;
    own_buffer_[index] = true;
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device_.vk(), buffers_[index], &needs);

    // Linear and optimal resources may not share a page: round both ends up to the granularity.
    const VkDeviceSize granularity = device_.properties().limits.bufferImageGranularity;
    const VkDeviceSize rounded = (needs.size + granularity - 1) / granularity * granularity;
    footprints_.buffers[index] = {rounded, std::max(needs.alignment, granularity), needs.memoryTypeBits};
}

void GraphResources::bind_memory(const GraphPlan& plan) {
    for (const Heap& heap : plan.heaps) {
        heaps_.push_back(
            device_.memory().take_heap(heap.bytes, heap.type_bits, "the frame's transient textures and buffers"));
    }
    for (std::uint32_t i = 0; i < images_.size(); ++i) {
        if (own_image_[i]) {
            const Placement& placement = plan.textures[i];
            GN_VK(vkBindImageMemory(device_.vk(), images_[i], heaps_[placement.heap].memory, placement.offset));
        }
    }
    for (std::uint32_t i = 0; i < buffers_.size(); ++i) {
        if (own_buffer_[i]) {
            const Placement& placement = plan.buffers[i];
            GN_VK(vkBindBufferMemory(device_.vk(), buffers_[i], heaps_[placement.heap].memory, placement.offset));
        }
    }
}

VkImageView GraphResources::view(std::uint32_t texture, const Range& range, VkImageViewType type,
                                 VkImageAspectFlags aspects) {
    const VkImageSubresourceRange part{aspects, range.mip, range.mips, range.layer, range.layers};
    if (imports_.textures[texture] != nullptr) {
        return imports_.textures[texture]->view(type, part);
    }
    const Fingerprint key = Hasher()
                                .value(texture)
                                .value(range.mip)
                                .value(range.mips)
                                .value(range.layer)
                                .value(range.layers)
                                .value(type)
                                .value(aspects)
                                .finish();
    if (const auto found = views_.find(key); found != views_.end()) {
        return found->second;
    }
    const VkImageView view =
        create_view(device_, images_[texture], declaration_.textures[texture].desc.format, type, part);
    views_.emplace(key, view);
    return view;
}

}  // namespace gn
