// SPDX-License-Identifier: MIT
#include "shadow/frame/map_memory.h"

#include "gpu/memory_pool.h"

#include <algorithm>
#include <bit>

namespace gn {

void check_map_memory(const FrameInput& input, const Recipe& recipe, TextureHandle map) {
    const TextureDesc& desc = input.graph.desc(map);
    const VkDeviceSize bytes = texel_bytes(desc), most_bytes = input.device.memory().largest();
    const std::uint32_t side = std::max(desc.width, desc.height);
    const std::uint32_t most_side = input.device.properties().limits.maxImageDimension2D;
    if (bytes <= most_bytes && side <= most_side) {
        return;
    }

    // Bytes grow with the square of the resolution: halve it until they fit.
    auto fits = std::bit_floor(static_cast<std::uint32_t>(recipe.resolution));
    const auto scaled = [&](double value, double power) {
        return value * std::pow(static_cast<double>(fits) / recipe.resolution, power);
    };
    while (fits > static_cast<std::uint32_t>(min_resolution) &&
           (scaled(static_cast<double>(bytes), 2) > static_cast<double>(most_bytes) || scaled(side, 1) > most_side)) {
        fits /= 2;
    }
    refuse(
        "light '{}': with resolution = {} its map of {} x {} texels in {} layer{} takes {} MiB, and device '{}' "
        "gives {} MiB at once and {} texels a side; resolution = {} fits",
        input.light().name, recipe.resolution, desc.width, desc.height, desc.layers, desc.layers == 1 ? "" : "s",
        bytes >> 20U, input.device.info().name, most_bytes >> 20U, most_side, fits);
}

std::string with_less_memory(const std::string& problem, const Recipe& recipe) {
    if (recipe.map == nullptr || recipe.resolution / 2 < min_resolution) {
        return problem;
    }
    return fmt::format("{}; the recipe's maps need a quarter with resolution = {} instead of {}", problem,
                       recipe.resolution / 2, recipe.resolution);
}

}  // namespace gn
