// SPDX-License-Identifier: MIT
// What a device keeps of its pipelines and samplers, in the process and on disk; how they are made stands in pipeline.cpp.
#include "gpu/pipeline_cache.h"

#include <algorithm>

namespace gn {

PipelineCache::PipelineCache(Device& device, std::filesystem::path folder) : device_(device), disk_(std::move(folder)) {
    load();
}

void PipelineCache::load() {
    const VkPhysicalDeviceProperties& driver = device_.properties();
    disk_key_ = Hasher()
                    .value(driver.vendorID)
                    .value(driver.deviceID)
                    .value(driver.driverVersion)
                    .bytes(driver.pipelineCacheUUID, VK_UUID_SIZE)
                    .finish();
    // The first word says how many bytes follow.
    const std::vector<std::uint32_t> words = disk_.load(disk_key_);
    const std::size_t bytes = words.empty() ? 0 : words[0];
    const bool whole = bytes > 0 && bytes <= (words.size() - 1) * 4;
    const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                         .initialDataSize = whole ? bytes : 0,
                                         .pInitialData = whole ? words.data() + 1 : nullptr};
    GN_VK(vkCreatePipelineCache(device_.vk(), &info, nullptr, &vk_));
}

void PipelineCache::save() {
    if (saved_ == pipelines_.size()) {
        return;
    }
    saved_ = pipelines_.size();
    std::size_t bytes = 0;
    if (vkGetPipelineCacheData(device_.vk(), vk_, &bytes, nullptr) != VK_SUCCESS || bytes == 0) {
        return;
    }
    std::vector<std::uint32_t> words(1 + (bytes + 3) / 4);
    if (vkGetPipelineCacheData(device_.vk(), vk_, &bytes, words.data() + 1) == VK_SUCCESS) {
        words[0] = static_cast<std::uint32_t>(bytes);
        disk_.store(disk_key_, words);
    }
}

PipelineCache::~PipelineCache() {
    save();
    vkDestroyPipelineCache(device_.vk(), vk_, nullptr);
    for (auto& [key, pipeline] : pipelines_) {
        destroy(pipeline);
    }
    for (const auto& [key, sampler] : samplers_) {
        vkDestroySampler(device_.vk(), sampler, nullptr);
    }
}

std::shared_ptr<const void> PipelineCache::remake(const std::set<Fingerprint>& shaders) {
    const auto reaches = [&](const std::optional<ShaderSource>& shader) {
        return shader && shaders.contains(shader->fingerprint.value());
    };
    // Pipelines destroy themselves with their last holder, so that a failure half-way leaves nothing.
    struct Held {
        PipelineCache& cache;
        std::map<Fingerprint, Pipeline> pipelines;
        ~Held() {
            for (auto& [key, pipeline] : pipelines) {
                cache.destroy(pipeline);
            }
        }
    };
    const std::lock_guard lock(making_);
    const auto held = std::make_shared<Held>(Held{*this, {}});
    for (const auto& [key, making] : makings_) {
        if (making.compute && reaches(making.compute->shader)) {
            held->pipelines.emplace(key, make(*making.compute));
        } else if (making.raster && (reaches(making.raster->vertex) || reaches(making.raster->geometry) ||
                                     reaches(making.raster->fragment))) {
            held->pipelines.emplace(key, make(*making.raster, making.formats));
        }
    }
    device_.counters().pipelines += held->pipelines.size();
    for (auto& [key, pipeline] : held->pipelines) {
        std::swap(pipelines_.at(key), pipeline);
    }
    return held;
}

VkSampler PipelineCache::sampler(const SamplerDesc& desc) {
    const VkSamplerAddressMode v = desc.address_v == VK_SAMPLER_ADDRESS_MODE_MAX_ENUM ? desc.address : desc.address_v;
    const Fingerprint key = Hasher()
                                .value(desc.filter)
                                .value(desc.mip_linear)
                                .value(desc.address)
                                .value(v)
                                .value(desc.border)
                                .value(desc.compare.value_or(VK_COMPARE_OP_MAX_ENUM))
                                .value(desc.anisotropy)
                                .finish();
    if (const auto found = samplers_.find(key); found != samplers_.end()) {
        return found->second;
    }
    const bool anisotropic = desc.anisotropy > 1.0F && device_.has(Feature::anisotropy);
    const VkSamplerCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
        .magFilter = desc.filter,
        .minFilter = desc.filter,
        .mipmapMode = desc.mip_linear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST,
        .addressModeU = desc.address,
        .addressModeV = v,
        .addressModeW = desc.address,
        .anisotropyEnable = anisotropic ? VK_TRUE : VK_FALSE,
        .maxAnisotropy = std::min(desc.anisotropy, device_.properties().limits.maxSamplerAnisotropy),
        .compareEnable = desc.compare ? VK_TRUE : VK_FALSE,
        .compareOp = desc.compare.value_or(VK_COMPARE_OP_ALWAYS),
        .maxLod = VK_LOD_CLAMP_NONE,
        .borderColor = desc.border,
    };
    VkSampler sampler = VK_NULL_HANDLE;
    GN_VK(vkCreateSampler(device_.vk(), &info, nullptr, &sampler));
    ++device_.counters().samplers;
    samplers_.emplace(key, sampler);
    return sampler;
}

}  // namespace gn
