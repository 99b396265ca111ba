// SPDX-License-Identifier: MIT
#include "gpu/features.h"

#include <algorithm>
#include <cstring>

namespace gn {
namespace {

struct FeatureText {
    std::string_view name, consequence;
};

constexpr std::array<FeatureText, feature_count> feature_texts{{
    {"anisotropy", "without it prefiltered maps are sampled isotropically and blur at grazing angles"},
    {"layer_from_vertex_shader", "without it layered maps are drawn by a geometry shader or one pass a layer"},
    {"conservative_rasterization", "without it a geometry shader widens the triangles"},
    {"fragment_interlock", "without it per-pixel lists are built with atomics"},
    {"ray_query", "without it rays are traced through a tree of boxes in a compute shader"},
    {"float32_blend", "without it 32-bit float maps cannot be accumulated by blending"},
    {"float32_filter", "without it 32-bit float maps are filtered in the shader or stored in 16 bits"},
    {"depth32_stencil8", "without it stencil techniques use 24-bit depth"},
    {"shader_float64", "without it exact predicates use pairs of floats"},
    {"atomic_float_add", "without it float sums use compare-and-swap"},
    {"subgroup_arithmetic", "without it reductions go through shared memory"},
    {"timestamps", "without them each pass is timed by its own submit and the host's clock"},
    {"multi_draw_indirect", "without it the draws of a run of objects are recorded one by one"},
}};

/// A required feature: its name and where it sits in the chain.
struct Required {
    const char* name;
    VkBool32& (*at)(FeatureChain&);
};

#define GN_REQUIRED(part, field)                                                   \
    Required {                                                                     \
#field, [](FeatureChain & chain) -> VkBool32& { return chain.part.field; } \
    }
const std::array required_features{
    GN_REQUIRED(v13, dynamicRendering),
    GN_REQUIRED(v13, synchronization2),
    GN_REQUIRED(v13, maintenance4),  // SPIR-V 1.6 says a workgroup's size in the way that this allows
    GN_REQUIRED(v12, scalarBlockLayout),
    GN_REQUIRED(core.features, geometryShader),
    GN_REQUIRED(core.features, depthClamp),
    GN_REQUIRED(core.features, independentBlend),
    GN_REQUIRED(core.features, logicOp),
    GN_REQUIRED(core.features, sampleRateShading),
    GN_REQUIRED(core.features, imageCubeArray),
    GN_REQUIRED(core.features, fragmentStoresAndAtomics),
    GN_REQUIRED(core.features, vertexPipelineStoresAndAtomics),
    GN_REQUIRED(core.features, shaderStorageImageWriteWithoutFormat),
    GN_REQUIRED(core.features, shaderClipDistance),
};
// Wanted where present, without a name of their own: queries that only widen what shaders may say.
const std::array wanted_features{
    GN_REQUIRED(core.features, shaderStorageImageReadWithoutFormat),
    GN_REQUIRED(core.features, shaderStorageImageExtendedFormats),
    GN_REQUIRED(core.features, shaderStorageImageMultisample),
    GN_REQUIRED(core.features, shaderImageGatherExtended),
    GN_REQUIRED(core.features, shaderInt64),
    GN_REQUIRED(core.features, occlusionQueryPrecise),
    GN_REQUIRED(core.features, pipelineStatisticsQuery),
    GN_REQUIRED(core.features, depthBiasClamp),
    GN_REQUIRED(core.features, largePoints),
    GN_REQUIRED(core.features, multiViewport),
    GN_REQUIRED(core.features, drawIndirectFirstInstance),
    GN_REQUIRED(core.features, fillModeNonSolid),
    GN_REQUIRED(v11, shaderDrawParameters),
    GN_REQUIRED(v12, shaderOutputViewportIndex),
    GN_REQUIRED(v12, samplerFilterMinmax),
    GN_REQUIRED(v12, hostQueryReset),
    GN_REQUIRED(v13, shaderDemoteToHelperInvocation),
};
#undef GN_REQUIRED

/// Chains only what the device knows, so that older drivers are not handed unknown structs.
void link(const Candidate& candidate, FeatureChain& chain) {
    chain.core.pNext = &chain.v11;
    chain.v11.pNext = &chain.v12;
    chain.v12.pNext = &chain.v13;
    void** tail = &chain.v13.pNext;
    const auto append = [&](const char* extension, auto& feature) {
        if (candidate.has_extension(extension)) {
            *tail = &feature;
            tail = &feature.pNext;
        }
    };
    append(VK_EXT_FRAGMENT_SHADER_INTERLOCK_EXTENSION_NAME, chain.interlock);
    append(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME, chain.atomic_float);
    append(VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME, chain.acceleration);
    append(VK_KHR_RAY_QUERY_EXTENSION_NAME, chain.ray_query);
}

bool format_has(VkPhysicalDevice physical, VkFormat format, VkFormatFeatureFlags wanted) {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(physical, format, &properties);
    return (properties.optimalTilingFeatures & wanted) == wanted;
}

void find_queue(Candidate& candidate) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(candidate.physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(candidate.physical, &count, families.data());
    const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t family = 0; family < count; ++family) {
        if ((families[family].queueFlags & both) == both) {
            candidate.queue_family = family;
            candidate.timestamp_bits = families[family].timestampValidBits;
            return;
        }
    }
}

void find_extensions(Candidate& candidate) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(candidate.physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(candidate.physical, nullptr, &count, extensions.data());
    for (const VkExtensionProperties& extension : extensions) {
        candidate.extensions.emplace_back(extension.extensionName);
    }
}

void find_features(Candidate& candidate, FeatureChain& chain, const VkPhysicalDeviceVulkan11Properties& v11) {
    const auto set = [&](Feature feature, bool present) {
        candidate.features[static_cast<std::size_t>(feature)] = present;
    };
    const VkFormatFeatureFlags blend = VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
    const VkFormatFeatureFlags filter = VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    const VkFormatFeatureFlags depth =
        VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
    const VkShaderStageFlags stages = VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    const VkPhysicalDevice physical = candidate.physical;
    set(Feature::anisotropy, chain.core.features.samplerAnisotropy != 0);
    set(Feature::layer_from_vertex_shader, chain.v12.shaderOutputLayer != 0);
    set(Feature::conservative_rasterization, candidate.has_extension(VK_EXT_CONSERVATIVE_RASTERIZATION_EXTENSION_NAME));
    set(Feature::fragment_interlock, chain.interlock.fragmentShaderPixelInterlock != 0);
    set(Feature::ray_query, chain.ray_query.rayQuery != 0 && chain.acceleration.accelerationStructure != 0 &&
                                chain.v12.bufferDeviceAddress != 0 &&
                                candidate.has_extension(VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME));
    set(Feature::float32_blend, format_has(physical, VK_FORMAT_R32G32B32A32_SFLOAT, blend));
    set(Feature::float32_filter, format_has(physical, VK_FORMAT_R32G32B32A32_SFLOAT, filter));
    set(Feature::depth32_stencil8, format_has(physical, VK_FORMAT_D32_SFLOAT_S8_UINT, depth));
    set(Feature::shader_float64, chain.core.features.shaderFloat64 != 0);
    set(Feature::atomic_float_add,
        chain.atomic_float.shaderBufferFloat32AtomicAdd != 0 && chain.atomic_float.shaderImageFloat32AtomicAdd != 0);
    set(Feature::subgroup_arithmetic, (v11.subgroupSupportedOperations & VK_SUBGROUP_FEATURE_ARITHMETIC_BIT) != 0 &&
                                          (v11.subgroupSupportedStages & stages) == stages);
    set(Feature::timestamps, !candidate.info.cpu && candidate.timestamp_bits > 0);
    set(Feature::multi_draw_indirect, chain.core.features.multiDrawIndirect != 0);
}

/// A real GPU before a virtual one before a CPU.
int rank(const Candidate& candidate) {
    switch (candidate.properties.deviceType) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return 4;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return 3;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return 2;
        case VK_PHYSICAL_DEVICE_TYPE_OTHER: return 1;
        default: return 0;
    }
}

std::string names_of(const std::vector<Candidate>& candidates) {
    std::string names;
    for (const Candidate& candidate : candidates) {
        names += (names.empty() ? "'" : ", '") + candidate.info.name + "'";
    }
    return names.empty() ? "none" : names;
}

}  // namespace

std::string_view feature_name(Feature feature) {
    return feature_texts[static_cast<std::size_t>(feature)].name;
}

std::string_view feature_consequence(Feature feature) {
    return feature_texts[static_cast<std::size_t>(feature)].consequence;
}

bool Candidate::has_extension(std::string_view name) const {
    return std::find(extensions.begin(), extensions.end(), name) != extensions.end();
}

Candidate examine(VkPhysicalDevice physical) {
    Candidate candidate;
    candidate.physical = physical;
    vkGetPhysicalDeviceProperties(physical, &candidate.properties);
    candidate.info.name = candidate.properties.deviceName;
    candidate.info.cpu = candidate.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    const std::uint32_t version = candidate.properties.apiVersion;
    if (version < VK_API_VERSION_1_3) {
        candidate.missing =
            fmt::format("Vulkan 1.3 (it has {}.{})", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version));
        return candidate;
    }
    find_extensions(candidate);
    find_queue(candidate);

    // Ask for the names and the features in one chain each.
    VkPhysicalDeviceVulkan12Properties v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES};
    VkPhysicalDeviceVulkan11Properties v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES, &v12};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v11};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    candidate.info.driver = v12.driverInfo[0] != '\0' ? v12.driverInfo : v12.driverName;
    FeatureChain chain;
    link(candidate, chain);
    vkGetPhysicalDeviceFeatures2(physical, &chain.core);
    find_features(candidate, chain, v11);

    const auto lacks = [&](const std::string& what) {
        candidate.missing += (candidate.missing.empty() ? "" : ", ") + what;
    };
    for (const Required& required : required_features) {
        if (required.at(chain) == VK_FALSE) {
            lacks(required.name);
        }
    }
    if (!candidate.has_extension(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME)) {
        lacks(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    }
    if (candidate.queue_family == ~0U) {
        lacks("a queue for graphics and compute");
    }
    return candidate;
}

std::vector<Candidate> examine_all(VkInstance instance) {
    std::uint32_t count = 0;
    vkEnumeratePhysicalDevices(instance, &count, nullptr);
    std::vector<VkPhysicalDevice> physical(count);
    vkEnumeratePhysicalDevices(instance, &count, physical.data());
    std::vector<Candidate> candidates;
    for (std::uint32_t i = 0; i < count; ++i) {
        candidates.push_back(examine(physical[i]));
    }
    return candidates;
}

std::size_t choose(std::vector<Candidate>& candidates, const std::string& pick) {
    std::size_t best = candidates.size();
    std::string unusable;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const Candidate& candidate = candidates[i];
        if (!pick.empty() && candidate.info.name.find(pick) == std::string::npos) {
            continue;
        }
        if (!candidate.missing.empty()) {
            unusable += fmt::format("; '{}' lacks {}", candidate.info.name, candidate.missing);
            continue;
        }
        if (best == candidates.size() || rank(candidate) > rank(candidates[best])) {
            best = i;
        }
    }
    if (best == candidates.size()) {
        fail("no Vulkan device {}can be used; there are: {}{}",
             pick.empty() ? "" : fmt::format("with '{}' in its name ", pick), names_of(candidates), unusable);
    }

    DeviceInfo& info = candidates[best].info;
    if (!pick.empty()) {
        info.why = fmt::format("its name contains '{}' as asked", pick);
    } else if (info.cpu) {
        info.why =
            "no GPU with a usable Vulkan 1.3 driver was found, so a software rasterizer does the work" + unusable;
    } else {
        info.why = candidates.size() == 1 ? "it is the only device" : "it is the most capable kind of GPU found";
    }
    return best;
}

namespace {

template <class Struct>
Struct copy_of(const VkBaseInStructure* given) {
    Struct copy{};
    std::memcpy(&copy, given, sizeof(Struct));
    copy.pNext = nullptr;
    return copy;
}

/// Reads a host's chain, whose structs may be those of a whole version or of one extension.
void read_chain(const VkPhysicalDeviceFeatures2& host, FeatureChain& chain) {
    chain.core.features = host.features;
    for (const auto* s = static_cast<const VkBaseInStructure*>(host.pNext); s != nullptr; s = s->pNext) {
        switch (s->sType) {
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES:
                chain.v11 = copy_of<VkPhysicalDeviceVulkan11Features>(s);
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES:
                chain.v12 = copy_of<VkPhysicalDeviceVulkan12Features>(s);
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES:
                chain.v13 = copy_of<VkPhysicalDeviceVulkan13Features>(s);
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES:
                chain.v13.dynamicRendering = copy_of<VkPhysicalDeviceDynamicRenderingFeatures>(s).dynamicRendering;
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES:
                chain.v13.synchronization2 = copy_of<VkPhysicalDeviceSynchronization2Features>(s).synchronization2;
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES:
                chain.v13.maintenance4 = copy_of<VkPhysicalDeviceMaintenance4Features>(s).maintenance4;
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES:
                chain.v12.scalarBlockLayout = copy_of<VkPhysicalDeviceScalarBlockLayoutFeatures>(s).scalarBlockLayout;
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES:
                chain.v12.bufferDeviceAddress =
                    copy_of<VkPhysicalDeviceBufferDeviceAddressFeatures>(s).bufferDeviceAddress;
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FRAGMENT_SHADER_INTERLOCK_FEATURES_EXT:
                chain.interlock = copy_of<VkPhysicalDeviceFragmentShaderInterlockFeaturesEXT>(s);
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT:
                chain.atomic_float = copy_of<VkPhysicalDeviceShaderAtomicFloatFeaturesEXT>(s);
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR:
                chain.acceleration = copy_of<VkPhysicalDeviceAccelerationStructureFeaturesKHR>(s);
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR:
                chain.ray_query = copy_of<VkPhysicalDeviceRayQueryFeaturesKHR>(s);
                break;
            default: break;  // asks for nothing that is used here
        }
    }
}

}  // namespace

void keep_enabled(Candidate& candidate, const AdoptedDevice& host) {
    FeatureChain chain;
    read_chain(*host.features, chain);
    candidate.extensions.assign(host.extensions.begin(), host.extensions.end());

    // What must be there.
    const auto lacks = [&](const std::string& what) {
        candidate.missing += (candidate.missing.empty() ? "" : ", ") + what;
    };
    for (const Required& required : required_features) {
        if (required.at(chain) == VK_FALSE) {
            lacks(required.name);
        }
    }
    if (!candidate.has_extension(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME)) {
        lacks(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    }

    // What may be: present and enabled. Formats and limits need no enabling.
    const auto only_if = [&](Feature feature, bool enabled) {
        bool& present = candidate.features[static_cast<std::size_t>(feature)];
        present = present && enabled;
    };
    const auto on = [&](const char* extension, VkBool32 feature) {
        return feature != VK_FALSE && candidate.has_extension(extension);
    };
    only_if(Feature::anisotropy, chain.core.features.samplerAnisotropy != 0);
    only_if(Feature::shader_float64, chain.core.features.shaderFloat64 != 0);
    only_if(Feature::multi_draw_indirect, chain.core.features.multiDrawIndirect != 0);
    only_if(
        Feature::layer_from_vertex_shader,
        chain.v12.shaderOutputLayer != 0 || candidate.has_extension(VK_EXT_SHADER_VIEWPORT_INDEX_LAYER_EXTENSION_NAME));
    only_if(Feature::conservative_rasterization,
            candidate.has_extension(VK_EXT_CONSERVATIVE_RASTERIZATION_EXTENSION_NAME));
    only_if(Feature::fragment_interlock,
            on(VK_EXT_FRAGMENT_SHADER_INTERLOCK_EXTENSION_NAME, chain.interlock.fragmentShaderPixelInterlock));
    only_if(Feature::atomic_float_add,
            on(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME, chain.atomic_float.shaderBufferFloat32AtomicAdd) &&
                chain.atomic_float.shaderImageFloat32AtomicAdd != 0);
    only_if(Feature::ray_query,
            on(VK_KHR_RAY_QUERY_EXTENSION_NAME, chain.ray_query.rayQuery) &&
                on(VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME, chain.acceleration.accelerationStructure) &&
                chain.v12.bufferDeviceAddress != 0);
}

void enable(const Candidate& candidate, FeatureChain& chain, std::vector<const char*>& extensions) {
    // Ask again, then keep only what is used.
    FeatureChain present;
    link(candidate, present);
    vkGetPhysicalDeviceFeatures2(candidate.physical, &present.core);
    link(candidate, chain);
    for (const Required& required : required_features) {
        required.at(chain) = VK_TRUE;
    }
    for (const Required& wanted : wanted_features) {
        wanted.at(chain) = wanted.at(present);
    }
    const auto has = [&](Feature feature) { return candidate.features[static_cast<std::size_t>(feature)]; };
    const auto bit = [&](Feature feature) { return has(feature) ? VK_TRUE : VK_FALSE; };
    chain.core.features.samplerAnisotropy = bit(Feature::anisotropy);
    chain.core.features.shaderFloat64 = bit(Feature::shader_float64);
    chain.core.features.multiDrawIndirect = bit(Feature::multi_draw_indirect);
    chain.v12.shaderOutputLayer = bit(Feature::layer_from_vertex_shader);
    chain.interlock.fragmentShaderPixelInterlock = bit(Feature::fragment_interlock);
    chain.atomic_float.shaderBufferFloat32AtomicAdd = bit(Feature::atomic_float_add);
    chain.atomic_float.shaderImageFloat32AtomicAdd = bit(Feature::atomic_float_add);
    chain.atomic_float.shaderBufferFloat32Atomics = present.atomic_float.shaderBufferFloat32Atomics;
    chain.atomic_float.shaderImageFloat32Atomics = present.atomic_float.shaderImageFloat32Atomics;
    chain.v12.bufferDeviceAddress = bit(Feature::ray_query);
    chain.acceleration.accelerationStructure = bit(Feature::ray_query);
    chain.ray_query.rayQuery = bit(Feature::ray_query);

    extensions.push_back(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    const auto add = [&](const char* name) {
        if (candidate.has_extension(name)) {
            extensions.push_back(name);
        }
    };
    add(VK_EXT_CONSERVATIVE_RASTERIZATION_EXTENSION_NAME);
    add(VK_EXT_FRAGMENT_SHADER_INTERLOCK_EXTENSION_NAME);
    add(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME);
    add(VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME);
    add(VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME);
    add(VK_KHR_RAY_QUERY_EXTENSION_NAME);
}

}  // namespace gn
