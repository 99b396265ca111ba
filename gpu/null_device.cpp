// SPDX-License-Identifier: MIT
#include "gpu/null_device.h"

namespace gn {
namespace {

class NullDevice final : public Device {
  public:
    [[nodiscard]] const DeviceInfo& info() const override { return info_; }
    [[nodiscard]] bool has(Feature) const override { return false; }
    [[nodiscard]] VkInstance instance() const override { return VK_NULL_HANDLE; }
    [[nodiscard]] VkPhysicalDevice physical() const override { return VK_NULL_HANDLE; }
    [[nodiscard]] VkDevice vk() const override { return VK_NULL_HANDLE; }
    [[nodiscard]] VkQueue queue() const override { return VK_NULL_HANDLE; }
    [[nodiscard]] std::uint32_t queue_family() const override { return 0; }
    [[nodiscard]] const VkPhysicalDeviceProperties& properties() const override { return properties_; }
    [[nodiscard]] ShaderCompiler& shaders() override { absent("shaders"); }
    [[nodiscard]] PipelineCache& pipelines() override { absent("pipelines"); }
    [[nodiscard]] MemoryPool& memory() override { absent("memory"); }
    void run(const std::function<void(VkCommandBuffer)>&) override { absent("commands"); }
    [[nodiscard]] const std::vector<std::string>& messages() const override { return messages_; }

  private:
    [[noreturn]] static void absent(const char* what) {
        check_failed(__FILE__, __LINE__, "the null device has no", what);
    }

    DeviceInfo info_{.name = "null", .driver = "none", .cpu = true, .why = "a plan needs no device"};
    VkPhysicalDeviceProperties properties_{};
    std::vector<std::string> messages_;
};

}  // namespace

std::unique_ptr<Device> make_null_device() {
    return std::make_unique<NullDevice>();
}

}  // namespace gn
