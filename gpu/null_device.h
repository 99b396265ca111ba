// SPDX-License-Identifier: MIT
// A device that does not exist: frame graphs on it plan barriers and memory and execute nothing.
#pragma once

#include "gpu/device.h"

namespace gn {

/// vk() is VK_NULL_HANDLE; shaders, pipelines and memory are not there (asking for them is a broken invariant).
std::unique_ptr<Device> make_null_device();

}  // namespace gn
