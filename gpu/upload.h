// SPDX-License-Identifier: MIT
// Values on the GPU.
#pragma once

#include "gpu/memory.h"

#include <span>
#include <vector>

namespace gn {

/// A buffer that holds these values, one behind the other as the processor has them.
template <class T>
Buffer upload(Device& device, const char* name, const std::vector<T>& values,
              VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {
    return upload_buffer(device, {.name = name, .bytes = values.size() * sizeof(T), .usage = usage},
                         std::as_bytes(std::span(values)));
}

}  // namespace gn
