// SPDX-License-Identifier: MIT
#pragma once

#include "host_device.h"

struct Options {
    DeviceOptions device;
    std::string output = "embed.png";
    bool draw_casters = false;  ///< with pipelines of the host's own, instead of lending buffers
    bool visibility = false;    ///< V of both lights as pictures beside the output
    std::string recipe = "pcf,placement=cascades";
    std::string baked;  ///< a folder of compiled shaders, or "" where they are compiled
    VkExtent2D size{1280, 720};
    std::uint32_t objects = 1000;
    std::uint32_t frames = 24;
};

/// Throws std::runtime_error with a sentence.
Options read_options(int argc, char** argv);
