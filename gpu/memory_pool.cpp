// SPDX-License-Identifier: MIT
#include "gpu/memory_pool.h"

#include "gpu/device.h"

#include <algorithm>

namespace gn {
namespace {

constexpr VkDeviceSize chunk_bytes = VkDeviceSize{16} << 20U;
constexpr VkDeviceSize small_bytes = VkDeviceSize{1} << 20U;  ///< larger resources get their own allocation
constexpr std::size_t idle_heaps_kept = 4;

}  // namespace

VkDeviceSize FreeList::take(VkDeviceSize bytes, VkDeviceSize alignment) {
    for (auto range = free_.begin(); range != free_.end(); ++range) {
        const auto [begin, count] = *range;
        const VkDeviceSize offset = (begin + alignment - 1) / alignment * alignment;
        if (offset + bytes > begin + count) {
            continue;
        }

        // Split what is left before and after.
        free_.erase(range);
        if (offset > begin) {
            free_[begin] = offset - begin;
        }
        if (begin + count > offset + bytes) {
            free_[offset + bytes] = begin + count - offset - bytes;
        }
        return offset;
    }
    return ~VkDeviceSize{0};
}

void FreeList::give(VkDeviceSize offset, VkDeviceSize bytes) {
    auto entry = free_.emplace(offset, bytes).first;
    if (const auto next = std::next(entry); next != free_.end() && entry->first + entry->second == next->first) {
        entry->second += next->second;
        free_.erase(next);
    }
    if (entry != free_.begin()) {
        if (const auto previous = std::prev(entry); previous->first + previous->second == entry->first) {
            previous->second += entry->second;
            free_.erase(entry);
        }
    }
}

MemoryPool::MemoryPool(VkPhysicalDevice physical, VkDevice device, std::uint64_t& allocations)
    : device_(device), allocations_(allocations) {
    vkGetPhysicalDeviceMemoryProperties(physical, &properties_);
    VkPhysicalDeviceMaintenance3Properties limits{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &limits};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    largest_ = limits.maxMemoryAllocationSize;
}

MemoryPool::~MemoryPool() {
    for (const auto& chunk : chunks_) {
        vkFreeMemory(device_, chunk->memory, nullptr);
    }
    for (const MemoryHeap& heap : idle_heaps_) {
        vkFreeMemory(device_, heap.memory, nullptr);
    }
}

std::uint32_t MemoryPool::choose_type(std::uint32_t type_bits, MemoryUse use, std::string_view what) const {
    const VkMemoryPropertyFlags host = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const bool mapped = use == MemoryUse::host;
    const VkMemoryPropertyFlags required = mapped ? host : VkMemoryPropertyFlags{0};
    const VkMemoryPropertyFlags wanted =
        mapped ? host | VK_MEMORY_PROPERTY_HOST_CACHED_BIT : VkMemoryPropertyFlags{VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT};
    for (const VkMemoryPropertyFlags flags : {wanted, required}) {
        for (std::uint32_t type = 0; type < properties_.memoryTypeCount; ++type) {
            const bool allowed = (type_bits & (1U << type)) != 0;
            if (allowed && (properties_.memoryTypes[type].propertyFlags & flags) == flags) {
                return type;
            }
        }
    }
    fail("the device has no kind of memory that suits {}", what);
}

VkDeviceMemory MemoryPool::allocate_whole(VkDeviceSize bytes, std::uint32_t type, std::string_view what) {
    if (bytes > largest_) {
        throw OutOfMemory(
            fmt::format("{} needs {} MiB at once; this device allows {} MiB", what, bytes >> 20U, largest_ >> 20U));
    }
    const VkMemoryAllocateInfo info{
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = bytes, .memoryTypeIndex = type};
    VkDeviceMemory memory = VK_NULL_HANDLE;
    ++allocations_;
    VkResult result = vkAllocateMemory(device_, &info, nullptr, &memory);

    // Give back what is only kept for later before giving up.
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY && !idle_heaps_.empty()) {
        for (const MemoryHeap& heap : idle_heaps_) {
            vkFreeMemory(device_, heap.memory, nullptr);
        }
        idle_heaps_.clear();
        result = vkAllocateMemory(device_, &info, nullptr, &memory);
    }
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) {
        throw OutOfMemory(fmt::format("the device has no memory left for {} ({} MiB)", what, bytes >> 20U));
    }
    vk_check(result, "vkAllocateMemory", __FILE__, __LINE__);
    return memory;
}

std::byte* MemoryPool::map_or_free(VkDeviceMemory memory, MemoryUse use) {
    if (use != MemoryUse::host) {
        return nullptr;
    }
    void* mapped = nullptr;
    const VkResult result = vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &mapped);
    if (result != VK_SUCCESS) {
        vkFreeMemory(device_, memory, nullptr);
    }
    vk_check(result, "vkMapMemory", __FILE__, __LINE__);
    return static_cast<std::byte*>(mapped);
}

MemorySlice MemoryPool::allocate(const VkMemoryRequirements& needs, MemoryUse use, std::string_view what) {
    const std::uint32_t type = choose_type(needs.memoryTypeBits, use, what);
    if (needs.size > small_bytes) {
        const VkDeviceMemory memory = allocate_whole(needs.size, type, what);
        return {memory, 0, needs.size, map_or_free(memory, use), ~0U};
    }

    // Look through the chunks of this kind; images and buffers never share one (bufferImageGranularity).
    const auto slice_of = [&](std::uint32_t index, VkDeviceSize offset) {
        const Chunk& chunk = *chunks_[index];
        return MemorySlice{chunk.memory, offset, needs.size, chunk.mapped != nullptr ? chunk.mapped + offset : nullptr,
                           index};
    };
    for (std::uint32_t index = 0; index < chunks_.size(); ++index) {
        Chunk& chunk = *chunks_[index];
        if (chunk.type == type && chunk.use == use) {
            if (const VkDeviceSize offset = chunk.free.take(needs.size, needs.alignment); offset != ~VkDeviceSize{0}) {
                return slice_of(index, offset);
            }
        }
    }

    const VkDeviceMemory memory = allocate_whole(chunk_bytes, type, what);
    chunks_.push_back(
        std::make_unique<Chunk>(Chunk{memory, map_or_free(memory, use), type, use, FreeList(chunk_bytes)}));
    const auto index = static_cast<std::uint32_t>(chunks_.size() - 1);
    return slice_of(index, chunks_.back()->free.take(needs.size, needs.alignment));
}

void MemoryPool::release(const MemorySlice& slice) {
    if (slice.memory == VK_NULL_HANDLE) {
        return;
    }
    if (slice.chunk == ~0U) {
        vkFreeMemory(device_, slice.memory, nullptr);
        return;
    }
    chunks_[slice.chunk]->free.give(slice.offset, slice.bytes);
}

MemoryHeap MemoryPool::take_heap(VkDeviceSize bytes, std::uint32_t type_bits, std::string_view what) {
    const std::uint32_t type = choose_type(type_bits, MemoryUse::image, what);
    const auto fits = [&](const MemoryHeap& heap) {
        return heap.type == type && heap.bytes >= bytes && heap.bytes <= 2 * bytes;
    };
    const auto found = std::find_if(idle_heaps_.begin(), idle_heaps_.end(), fits);
    if (found != idle_heaps_.end()) {
        const MemoryHeap heap = *found;
        idle_heaps_.erase(found);
        return heap;
    }
    return {allocate_whole(bytes, type, what), bytes, type};
}

void MemoryPool::give_heap(const MemoryHeap& heap) {
    idle_heaps_.push_back(heap);
    if (idle_heaps_.size() > idle_heaps_kept) {
        vkFreeMemory(device_, idle_heaps_.front().memory, nullptr);
        idle_heaps_.erase(idle_heaps_.begin());
    }
}

}  // namespace gn
