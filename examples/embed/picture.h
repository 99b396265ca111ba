// SPDX-License-Identifier: MIT
#pragma once

#include "frames.h"

#include <string>

/// Waits for the slot and writes an 8-bit image that is in `layout`, and stays in it, as a PNG. Throws std::runtime_error.
void write_picture(const HostDevice& host, FrameSlot& slot, const HostImage& image, VkImageLayout layout,
                   const std::string& path);
