// SPDX-License-Identifier: MIT
#include "gpu/device.h"

#include "base/paths.h"
#include "gpu/features.h"
#include "gpu/instance.h"
#include "gpu/memory_barrier.h"
#include "gpu/memory_pool.h"
#include "gpu/pipeline_cache.h"
#include "gpu/presenting.h"
#include "gpu/vk_names.h"

#include <algorithm>
#include <cstdlib>
#include <optional>

namespace gn {

void vk_check(VkResult result, const char* call, const char* file, int line) {
    if (result >= VK_SUCCESS) {
        return;
    }
    const std::string_view name(call);
    fail("{} in {} at {}:{}", result_name(result), name.substr(0, name.find('(')), file, line);
}

namespace {

class VulkanDevice final : public Device {
  public:
    // Both begin with a device that is whole: where one fails halfway, the destructor takes back what it made.
    /// `surfaces`: extensions of the instance for windows; none: the device shows none.
    explicit VulkanDevice(const DeviceOptions& options, std::span<const char* const> surfaces = {}) : VulkanDevice() {
        validates_ = options.validation;
        presents_ = !surfaces.empty();
        instance_.emplace(options.validation, log_, surfaces);
        std::vector<Candidate> candidates = examine_all(instance_->vk());
        const char* variable = std::getenv("GNOMON_DEVICE");
        const std::string pick = options.pick.empty() && variable != nullptr ? variable : options.pick;
        candidate_ = candidates[choose(candidates, pick)];
        candidate_.info.notes = instance_->notes();
        vk_instance_ = instance_->vk();
        queue_family_ = candidate_.queue_family;
        create_device();
        create_parts();
    }

    VulkanDevice(const AdoptedDevice& host, std::shared_ptr<ShaderCompiler> shaders) : VulkanDevice() {
        shaders_ = std::move(shaders);
        candidate_ = examine(host.physical);
        if (!candidate_.missing.empty()) {
            fail("the host's device '{}' lacks {}", candidate_.info.name, candidate_.missing);
        }
        keep_enabled(candidate_, host);
        if (!candidate_.missing.empty()) {
            fail(
                "the host's device '{}' was created without {}; enable that in vkCreateDevice, and say so in "
                "AdoptedDevice::features and extensions",
                candidate_.info.name, candidate_.missing);
        }
        for (const char* call : {"vkCmdPushDescriptorSetKHR", "vkCmdBeginRendering", "vkCmdPipelineBarrier2"}) {
            if (vkGetDeviceProcAddr(host.device, call) == nullptr) {
                fail(
                    "the host's device '{}' was created without {}, whatever AdoptedDevice says; enable Vulkan 1.3 and "
                    "VK_KHR_push_descriptor",
                    candidate_.info.name, call);
            }
        }
        candidate_.info.why = "the host renderer lent it";
        adopted_ = true;
        vk_instance_ = host.instance;
        device_ = host.device;
        queue_ = host.queue;
        queue_family_ = host.queue_family;
        create_parts();
    }

    ~VulkanDevice() override {
        if (device_ != VK_NULL_HANDLE) {
            vkDeviceWaitIdle(device_);
            pipelines_.reset();
            memory_.reset();
            vkDestroyFence(device_, fence_, nullptr);
            vkDestroyCommandPool(device_, pool_, nullptr);
            if (!adopted_) {
                vkDestroyDevice(device_, nullptr);
            }
        }
    }

    [[nodiscard]] const DeviceInfo& info() const override { return candidate_.info; }
    [[nodiscard]] bool has(Feature feature) const override {
        return candidate_.features[static_cast<std::size_t>(feature)];
    }
    [[nodiscard]] VkInstance instance() const override { return vk_instance_; }
    [[nodiscard]] VkPhysicalDevice physical() const override { return candidate_.physical; }
    [[nodiscard]] VkDevice vk() const override { return device_; }
    [[nodiscard]] VkQueue queue() const override { return queue_; }
    [[nodiscard]] std::uint32_t queue_family() const override { return queue_family_; }
    [[nodiscard]] const VkPhysicalDeviceProperties& properties() const override { return candidate_.properties; }
    [[nodiscard]] ShaderCompiler& shaders() override { return *shaders_; }
    [[nodiscard]] PipelineCache& pipelines() override { return *pipelines_; }
    [[nodiscard]] MemoryPool& memory() override { return *memory_; }
    [[nodiscard]] const std::vector<std::string>& messages() const override { return log_.messages; }
    [[nodiscard]] bool validates() const override { return validates_; }
    void report(const std::string& message) override {
        const std::lock_guard lock(log_.mutex);
        log_.messages.push_back(message);
    }

    void run(const std::function<void(VkCommandBuffer)>& record) override {
        // Record; the host may read afterwards what the device wrote.
        GN_VK(vkResetCommandPool(device_, pool_, 0));
        const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                             .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
        GN_VK(vkBeginCommandBuffer(commands_, &begin));
        memory_barrier(commands_, all_writes, all_uses);
        record(commands_);
        memory_barrier(commands_, all_writes, host_reads);
        GN_VK(vkEndCommandBuffer(commands_));

        const VkCommandBufferSubmitInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                               .commandBuffer = commands_};
        const VkSubmitInfo2 submit{
            .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &buffer};
        GN_VK(vkResetFences(device_, 1, &fence_));
        GN_VK(vkQueueSubmit2(queue_, 1, &submit, fence_));
        GN_VK(vkWaitForFences(device_, 1, &fence_, VK_TRUE, ~std::uint64_t{0}));
    }

  private:
    VulkanDevice() = default;

    void create_device() {
        const float priority = 1.0F;
        const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                            .queueFamilyIndex = queue_family_,
                                            .queueCount = 1,
                                            .pQueuePriorities = &priority};
        FeatureChain chain;
        std::vector<const char*> extensions;
        enable(candidate_, chain, extensions);
        if (presents_) {
            if (!candidate_.has_extension(VK_KHR_SWAPCHAIN_EXTENSION_NAME)) {
                fail("the device '{}' shows no windows: it lacks {}", candidate_.info.name,
                     VK_KHR_SWAPCHAIN_EXTENSION_NAME);
            }
            extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
        }
        const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                      .pNext = &chain.core,
                                      .queueCreateInfoCount = 1,
                                      .pQueueCreateInfos = &queue,
                                      .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                                      .ppEnabledExtensionNames = extensions.data()};
        GN_VK(vkCreateDevice(candidate_.physical, &info, nullptr, &device_));
        vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
    }

    void create_parts() {
        const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                           .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                           .queueFamilyIndex = queue_family_};
        GN_VK(vkCreateCommandPool(device_, &pool, nullptr, &pool_));
        const VkCommandBufferAllocateInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                   .commandPool = pool_,
                                                   .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                   .commandBufferCount = 1};
        GN_VK(vkAllocateCommandBuffers(device_, &commands, &commands_));
        const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        GN_VK(vkCreateFence(device_, &fence, nullptr, &fence_));
        shaders_ = shaders_ != nullptr ? shaders_ : compiler_of(data_root());
        memory_ = std::make_unique<MemoryPool>(candidate_.physical, device_, counters().allocations);
        const std::filesystem::path kept = cache_root().empty() ? std::filesystem::path() : cache_root() / "pipelines";
        pipelines_ = std::make_unique<PipelineCache>(*this, kept);
    }

    MessageLog log_;
    bool validates_ = false, presents_ = false;
    std::optional<VulkanInstance> instance_;
    Candidate candidate_;
    VkInstance vk_instance_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queue_family_ = 0;
    bool adopted_ = false;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    std::shared_ptr<ShaderCompiler> shaders_;
    std::unique_ptr<MemoryPool> memory_;
    std::unique_ptr<PipelineCache> pipelines_;
};

}  // namespace

std::unique_ptr<Device> Device::create(const DeviceOptions& options) {
    return std::make_unique<VulkanDevice>(options);
}

std::unique_ptr<Device> create_presenting_device(const DeviceOptions& options,
                                                 std::span<const char* const> instance_extensions) {
    return std::make_unique<VulkanDevice>(options, instance_extensions);
}

std::unique_ptr<Device> Device::adopt(const AdoptedDevice& host, std::shared_ptr<ShaderCompiler> shaders) {
    for (const auto& [given, what] : {std::pair{host.instance != VK_NULL_HANDLE, "instance"},
                                      {host.physical != VK_NULL_HANDLE, "physical device"},
                                      {host.device != VK_NULL_HANDLE, "device"},
                                      {host.queue != VK_NULL_HANDLE, "queue"},
                                      {host.features != nullptr, "chain of the features that it enabled"}}) {
        if (!given) {
            fail("the host lends no {}; instance, physical device, device, queue and features are needed", what);
        }
    }
    return std::make_unique<VulkanDevice>(host, std::move(shaders));
}

}  // namespace gn
