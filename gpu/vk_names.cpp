// SPDX-License-Identifier: MIT
#include "gpu/vk_names.h"

#include <array>
#include <utility>

namespace gn {
namespace {

template <class Value, std::size_t count>
std::string look_up(Value value, const std::array<std::pair<Value, const char*>, count>& table) {
    for (const auto& [known, name] : table) {
        if (known == value) {
            return name;
        }
    }
    return std::to_string(static_cast<long long>(value));
}

template <std::size_t count>
std::string join(std::uint64_t bits, const std::array<std::pair<std::uint64_t, const char*>, count>& table) {
    std::string text;
    for (const auto& [bit, name] : table) {
        if ((bits & bit) != 0) {
            text += (text.empty() ? "" : "|") + std::string(name);
            bits &= ~bit;
        }
    }
    if (bits != 0) {
        text += (text.empty() ? "" : "|") + std::to_string(bits);
    }
    return text.empty() ? "none" : text;
}

}  // namespace

std::string result_name(VkResult result) {
    static constexpr std::array<std::pair<VkResult, const char*>, 9> table{{
        {VK_ERROR_OUT_OF_HOST_MEMORY, "out of memory"},
        {VK_ERROR_OUT_OF_DEVICE_MEMORY, "out of device memory"},
        {VK_ERROR_DEVICE_LOST, "the device was lost"},
        {VK_ERROR_LAYER_NOT_PRESENT, "a layer is not installed"},
        {VK_ERROR_EXTENSION_NOT_PRESENT, "an extension is not present"},
        {VK_ERROR_FEATURE_NOT_PRESENT, "a feature is not present"},
        {VK_ERROR_INCOMPATIBLE_DRIVER, "there is no Vulkan driver"},
        {VK_ERROR_FORMAT_NOT_SUPPORTED, "the format is not supported"},
        {VK_ERROR_INITIALIZATION_FAILED, "initialization failed"},
    }};
    return look_up(result, table);
}

std::string format_name(VkFormat format) {
    static constexpr std::array<std::pair<VkFormat, const char*>, 33> table{{
        {VK_FORMAT_UNDEFINED, "undefined"},
        {VK_FORMAT_R8_UNORM, "r8"},
        {VK_FORMAT_R8_UINT, "r8ui"},
        {VK_FORMAT_R8G8_UNORM, "rg8"},
        {VK_FORMAT_R8G8B8A8_UNORM, "rgba8"},
        {VK_FORMAT_R8G8B8A8_SRGB, "rgba8-srgb"},
        {VK_FORMAT_R8G8B8A8_UINT, "rgba8ui"},
        {VK_FORMAT_B8G8R8A8_UNORM, "bgra8"},
        {VK_FORMAT_B8G8R8A8_SRGB, "bgra8-srgb"},
        {VK_FORMAT_A2B10G10R10_UNORM_PACK32, "rgb10a2"},
        {VK_FORMAT_B10G11R11_UFLOAT_PACK32, "r11g11b10f"},
        {VK_FORMAT_R16_UNORM, "r16"},
        {VK_FORMAT_R16_SFLOAT, "r16f"},
        {VK_FORMAT_R16_UINT, "r16ui"},
        {VK_FORMAT_R16G16_UNORM, "rg16"},
        {VK_FORMAT_R16G16_SFLOAT, "rg16f"},
        {VK_FORMAT_R16G16B16A16_UNORM, "rgba16"},
        {VK_FORMAT_R16G16B16A16_SNORM, "rgba16-snorm"},
        {VK_FORMAT_R16G16B16A16_SFLOAT, "rgba16f"},
        {VK_FORMAT_R16G16B16A16_UINT, "rgba16ui"},
        {VK_FORMAT_R32_SFLOAT, "r32f"},
        {VK_FORMAT_R32_UINT, "r32ui"},
        {VK_FORMAT_R32_SINT, "r32i"},
        {VK_FORMAT_R32G32_SFLOAT, "rg32f"},
        {VK_FORMAT_R32G32_UINT, "rg32ui"},
        {VK_FORMAT_R32G32B32A32_SFLOAT, "rgba32f"},
        {VK_FORMAT_R32G32B32A32_UINT, "rgba32ui"},
        {VK_FORMAT_R32G32B32_SFLOAT, "rgb32f"},
        {VK_FORMAT_D16_UNORM, "d16"},
        {VK_FORMAT_X8_D24_UNORM_PACK32, "d24"},
        {VK_FORMAT_D24_UNORM_S8_UINT, "d24s8"},
        {VK_FORMAT_D32_SFLOAT, "d32f"},
        {VK_FORMAT_D32_SFLOAT_S8_UINT, "d32fs8"},
    }};
    return look_up(format, table);
}

std::string layout_name(VkImageLayout layout) {
    static constexpr std::array<std::pair<VkImageLayout, const char*>, 9> table{{
        {VK_IMAGE_LAYOUT_UNDEFINED, "undefined"},
        {VK_IMAGE_LAYOUT_GENERAL, "general"},
        {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, "color"},
        {VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, "depth"},
        {VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, "depth-read"},
        {VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL, "depth-read-stencil"},
        {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, "sampled"},
        {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, "copy-from"},
        {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, "copy-to"},
    }};
    return look_up(layout, table);
}

std::string stages_name(VkPipelineStageFlags2 stages) {
    static constexpr std::array<std::pair<std::uint64_t, const char*>, 11> table{{
        {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, "all"},
        {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, "indirect"},
        {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, "index"},
        {VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, "vertex-input"},
        {VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT, "geometry"},
        {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT, "early-tests"},
        {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "fragment"},
        {VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, "late-tests"},
        {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "color-output"},
        {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "compute"},
        {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, "transfer"},
    }};
    return join(stages, table);
}

std::string access_name(VkAccessFlags2 access) {
    static constexpr std::array<std::pair<std::uint64_t, const char*>, 13> table{{
        {VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, "indirect-read"},
        {VK_ACCESS_2_INDEX_READ_BIT, "index-read"},
        {VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT, "vertex-read"},
        {VK_ACCESS_2_UNIFORM_READ_BIT, "uniform-read"},
        {VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, "sampled-read"},
        {VK_ACCESS_2_SHADER_STORAGE_READ_BIT, "storage-read"},
        {VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, "storage-write"},
        {VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT, "color-read"},
        {VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, "color-write"},
        {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, "depth-read"},
        {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, "depth-write"},
        {VK_ACCESS_2_TRANSFER_READ_BIT, "copy-read"},
        {VK_ACCESS_2_TRANSFER_WRITE_BIT, "copy-write"},
    }};
    return join(access, table);
}

}  // namespace gn
