// SPDX-License-Identifier: MIT
// Device memory: small resources share chunks, large ones and the graphs' heaps have their own allocation; heaps are
// kept between frames.
#pragma once

#include "base/error.h"

#include <vulkan/vulkan.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string_view>
#include <vector>

namespace gn {

enum class MemoryUse { image, buffer, host };

/// A part of an allocation.
struct MemorySlice {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0, bytes = 0;
    std::byte* mapped = nullptr;  ///< of this slice; null unless host
    std::uint32_t chunk = ~0U;    ///< ~0: an allocation of its own
};

/// A whole allocation that a frame graph places its transients in.
struct MemoryHeap {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize bytes = 0;
    std::uint32_t type = 0;
};

/// First-fit over the free ranges of [0, bytes). Pure arithmetic.
class FreeList {
  public:
    explicit FreeList(VkDeviceSize bytes) : free_{{0, bytes}} {}
    /// The offset, or ~0 when nothing fits.
    VkDeviceSize take(VkDeviceSize bytes, VkDeviceSize alignment);
    void give(VkDeviceSize offset, VkDeviceSize bytes);
    [[nodiscard]] const std::map<VkDeviceSize, VkDeviceSize>& ranges() const { return free_; }

  private:
    std::map<VkDeviceSize, VkDeviceSize> free_;  ///< offset -> bytes, never adjacent
};

class MemoryPool {
  public:
    /// `allocations` counts what the driver was asked for.
    MemoryPool(VkPhysicalDevice physical, VkDevice device, std::uint64_t& allocations);
    ~MemoryPool();
    MemoryPool(const MemoryPool&) = delete;
    MemoryPool& operator=(const MemoryPool&) = delete;

    /// Throws Error naming `what` when the device has no memory left.
    MemorySlice allocate(const VkMemoryRequirements& needs, MemoryUse use, std::string_view what);
    void release(const MemorySlice& slice);

    MemoryHeap take_heap(VkDeviceSize bytes, std::uint32_t type_bits, std::string_view what);
    void give_heap(const MemoryHeap& heap);

    /// The largest single allocation.
    [[nodiscard]] VkDeviceSize largest() const { return largest_; }

  private:
    struct Chunk {
        VkDeviceMemory memory = VK_NULL_HANDLE;
        std::byte* mapped = nullptr;
        std::uint32_t type = 0;
        MemoryUse use = MemoryUse::buffer;
        FreeList free;
    };
    [[nodiscard]] std::uint32_t choose_type(std::uint32_t type_bits, MemoryUse use, std::string_view what) const;
    VkDeviceMemory allocate_whole(VkDeviceSize bytes, std::uint32_t type, std::string_view what);
    /// Where memory for the host is mapped, null for other uses; memory that cannot be mapped is freed.
    std::byte* map_or_free(VkDeviceMemory memory, MemoryUse use);

    VkDevice device_;
    std::uint64_t& allocations_;
    VkPhysicalDeviceMemoryProperties properties_{};
    VkDeviceSize largest_ = 0;
    std::vector<std::unique_ptr<Chunk>> chunks_;
    std::vector<MemoryHeap> idle_heaps_;
};

}  // namespace gn
