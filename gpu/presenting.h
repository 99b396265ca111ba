// SPDX-License-Identifier: MIT
// A device that also shows pictures in windows.
#pragma once

#include "gpu/device.h"

#include <span>

namespace gn {

/// A device of its own as Device::create makes one, with a swapchain besides. `instance_extensions`: what the window system
/// asks of the instance for its surfaces. Throws Error where the device cannot present.
std::unique_ptr<Device> create_presenting_device(const DeviceOptions& options,
                                                 std::span<const char* const> instance_extensions);

}  // namespace gn
