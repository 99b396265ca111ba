// SPDX-License-Identifier: MIT
#include "gpu/described_device.h"

namespace gn {
namespace {

class DescribedDevice final : public Device {
  public:
    DescribedDevice(Device& real, DeviceDescription& description)
        : real_(real), description_(description), info_(real.info()) {
        info_.cpu = description_.has.contains(DeviceTrait{});
        info_.why = "it is described, for shaders that are compiled ahead";
    }

    [[nodiscard]] const DeviceInfo& info() const override {
        description_.asked.insert(DeviceTrait{});
        return info_;
    }
    [[nodiscard]] bool has(Feature feature) const override {
        description_.asked.insert(DeviceTrait{feature});
        return description_.has.contains(DeviceTrait{feature});
    }
    [[nodiscard]] VkInstance instance() const override { return real_.instance(); }
    [[nodiscard]] VkPhysicalDevice physical() const override { return real_.physical(); }
    [[nodiscard]] VkDevice vk() const override { return real_.vk(); }
    [[nodiscard]] VkQueue queue() const override { return real_.queue(); }
    [[nodiscard]] std::uint32_t queue_family() const override { return real_.queue_family(); }
    [[nodiscard]] const VkPhysicalDeviceProperties& properties() const override { return real_.properties(); }
    [[nodiscard]] ShaderCompiler& shaders() override { return real_.shaders(); }
    [[nodiscard]] PipelineCache& pipelines() override { return real_.pipelines(); }
    [[nodiscard]] MemoryPool& memory() override { return real_.memory(); }
    void run(const std::function<void(VkCommandBuffer)>& record) override { real_.run(record); }
    [[nodiscard]] const std::vector<std::string>& messages() const override { return real_.messages(); }

  private:
    Device& real_;
    DeviceDescription& description_;
    DeviceInfo info_;
};

}  // namespace

std::unique_ptr<Device> make_described_device(Device& real, DeviceDescription& description) {
    return std::make_unique<DescribedDevice>(real, description);
}

}  // namespace gn
