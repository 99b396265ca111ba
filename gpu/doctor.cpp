// SPDX-License-Identifier: MIT
// What this machine's Vulkan can do, in lines for people.
#include "gpu/features.h"
#include "gpu/instance.h"
#include "gpu/vk_names.h"

#include <cstdlib>

namespace gn {
namespace {

std::string kind_of(const Candidate& candidate) {
    switch (candidate.properties.deviceType) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return "discrete GPU";
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return "integrated GPU";
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return "virtual GPU";
        case VK_PHYSICAL_DEVICE_TYPE_CPU: return "CPU, a software rasterizer";
        default: return "other";
    }
}

std::string format_row(VkPhysicalDevice physical, VkFormat format) {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(physical, format, &properties);
    const VkFormatFeatureFlags has = properties.optimalTilingFeatures;
    std::string can;
    const auto add = [&](VkFormatFeatureFlags bit, const char* name) {
        can += (has & bit) != 0 ? (can.empty() ? "" : ", ") + std::string(name) : "";
    };
    add(VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, "sample");
    add(VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT, "filter");
    add(VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT, "draw");
    add(VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT, "blend");
    add(VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT, "depth");
    add(VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT, "store");
    add(VK_FORMAT_FEATURE_STORAGE_IMAGE_ATOMIC_BIT, "atomics");
    return fmt::format("  {:<11} {}", format_name(format), can.empty() ? "nothing" : can);
}

void describe_device(const Candidate& candidate, std::vector<std::string>& lines) {
    lines.emplace_back("features that techniques may ask for:");
    for (int i = 0; i < feature_count; ++i) {
        const auto feature = static_cast<Feature>(i);
        const bool present = candidate.features[static_cast<std::size_t>(i)];
        lines.push_back(fmt::format("  {:<26} {}", feature_name(feature),
                                    present ? "yes" : fmt::format("no: {}", feature_consequence(feature))));
    }
    lines.emplace_back("formats:");
    for (const VkFormat format :
         {VK_FORMAT_D16_UNORM, VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT,
          VK_FORMAT_R8_UNORM, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16_UNORM, VK_FORMAT_R16G16B16A16_UNORM,
          VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32_UINT, VK_FORMAT_R32G32_SFLOAT,
          VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_UINT}) {
        lines.push_back(format_row(candidate.physical, format));
    }
    const VkPhysicalDeviceLimits& limits = candidate.properties.limits;
    lines.emplace_back("limits:");
    lines.push_back(fmt::format("  largest texture            {} x {}, {} layers", limits.maxImageDimension2D,
                                limits.maxImageDimension2D, limits.maxImageArrayLayers));
    lines.push_back(fmt::format("  colour attachments         {}", limits.maxColorAttachments));
    lines.push_back(fmt::format("  largest storage block      {} MiB", limits.maxStorageBufferRange >> 20U));
    lines.push_back(fmt::format("  compute workgroup          {} invocations, {} KiB shared",
                                limits.maxComputeWorkGroupInvocations, limits.maxComputeSharedMemorySize >> 10U));
    lines.push_back(fmt::format("  samples for depth          {:#x}", limits.framebufferDepthSampleCounts));
    lines.push_back(fmt::format("  largest anisotropy         {}", limits.maxSamplerAnisotropy));
}

bool validation_installed() {
    MessageLog log;
    try {
        const VulkanInstance instance(true, log);
        return true;
    } catch (const Error&) {
        return false;
    }
}

void examine_into(DoctorReport& report) {
    MessageLog log;
    const VulkanInstance instance(false, log);
    std::vector<Candidate> candidates = examine_all(instance.vk());
    for (const Candidate& candidate : candidates) {
        const std::uint32_t version = candidate.properties.apiVersion;
        report.lines.push_back(
            fmt::format("device '{}': {}, driver {}, Vulkan {}.{}.{}{}", candidate.info.name, kind_of(candidate),
                        candidate.info.driver, VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                        VK_API_VERSION_PATCH(version),
                        candidate.missing.empty() ? "" : "; cannot be used, it lacks " + candidate.missing));
    }
    const char* variable = std::getenv("GNOMON_DEVICE");
    const Candidate& chosen = candidates[choose(candidates, variable != nullptr ? variable : "")];
    report.usable = true;
    report.lines.push_back(fmt::format("chosen: '{}', because {}", chosen.info.name, chosen.info.why));
    describe_device(chosen, report.lines);
    report.lines.push_back(fmt::format("validation layer: {}", validation_installed() ? "installed" : "not installed"));
}

}  // namespace

DoctorReport examine_machine() {
    DoctorReport report;
    try {
        examine_into(report);
    } catch (const std::exception& error) {
        report.lines.emplace_back(error.what());
    }
    return report;
}

}  // namespace gn
