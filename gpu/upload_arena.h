// SPDX-License-Identifier: MIT
// Host-visible bytes that live for one execution: the blocks given by Recorder::set_bytes, lists of draws, and what
// the device answers.
#pragma once

#include "gpu/memory.h"

#include <algorithm>
#include <cstring>

namespace gn {

struct UploadedBytes {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceSize offset = 0, bytes = 0;
    std::byte* mapped = nullptr;  ///< where the bytes are for the host
};

class UploadArena {
  public:
    explicit UploadArena(Device& device) : device_(device) {}

    /// Forgets everything; the device must have finished.
    void reset() {
        chunk_ = 0;
        used_ = 0;
    }

    /// Makes the room that another arena has, so that no later frame needs to.
    void match(const UploadArena& other) {
        for (std::size_t i = chunks_.size(); i < other.chunks_.size(); ++i) {
            add_chunk(other.chunks_[i].desc().bytes);
        }
    }

    UploadedBytes put(std::span<const std::byte> data) {
        const UploadedBytes result = reserve(data.size());
        if (!data.empty()) {
            std::memcpy(result.mapped, data.data(), data.size());
        }
        return result;
    }

    /// Room for `bytes`, with whatever they hold.
    UploadedBytes reserve(std::size_t bytes) {
        // Go on to a chunk that has room, making it where there is none.
        while (chunk_ < chunks_.size() && used_ + bytes > chunks_[chunk_].desc().bytes) {
            ++chunk_;
            used_ = 0;
        }
        if (chunk_ == chunks_.size()) {
            add_chunk(std::max<VkDeviceSize>(chunk_bytes, bytes));
        }
        const Buffer& chunk = chunks_[chunk_];
        const UploadedBytes result{chunk.vk(), used_, std::max<VkDeviceSize>(bytes, 4), chunk.mapped() + used_};
        used_ += (result.bytes + alignment - 1) / alignment * alignment;
        return result;
    }

  private:
    void add_chunk(VkDeviceSize bytes) {
        chunks_.emplace_back(
            device_, BufferDesc{.name = "uniforms",
                                .bytes = bytes,
                                .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                         VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                                .host_visible = true});
    }

    static constexpr VkDeviceSize chunk_bytes = VkDeviceSize{256} * 1024;
    static constexpr VkDeviceSize alignment = 256;  ///< the most that Vulkan lets a device ask for

    Device& device_;
    std::vector<Buffer> chunks_;
    std::size_t chunk_ = 0;
    VkDeviceSize used_ = 0;
};

}  // namespace gn
