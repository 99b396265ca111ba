// SPDX-License-Identifier: MIT
// A Vulkan 1.3 device: own and headless, or adopted from a host renderer. Knows no shadow.
#pragma once

#include "base/error.h"

#include <vulkan/vulkan.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace gn {

class ShaderCompiler;
class PipelineCache;
class MemoryPool;

/// A failed Vulkan call becomes an Error that names the call: GN_VK(vkQueueSubmit2(...)).
void vk_check(VkResult result, const char* call, const char* file, int line);
#define GN_VK(call) ::gn::vk_check((call), #call, __FILE__, __LINE__)

struct DeviceInfo {
    std::string name, driver;        ///< "llvmpipe (LLVM 15.0.6, 256 bits)", "Mesa 22.3.6 (LLVM 15.0.6)"
    bool cpu = false;                ///< a software rasterizer: passes are timed by submits and the host clock
    std::string why;                 ///< one sentence: why this device was chosen
    std::vector<std::string> notes;  ///< what goes without on this machine, one sentence each
};

/// Optional features that parts may ask for. Each is queried; none is assumed.
enum class Feature {
    anisotropy,
    layer_from_vertex_shader,
    conservative_rasterization,
    fragment_interlock,
    ray_query,
    float32_blend,
    float32_filter,
    depth32_stencil8,
    shader_float64,
    atomic_float_add,
    subgroup_arithmetic,
    timestamps,  ///< meaningful ones
    multi_draw_indirect,
};
inline constexpr int feature_count = 13;
std::string_view feature_name(Feature feature);
/// What a missing feature rules out or falls back to, one sentence.
std::string_view feature_consequence(Feature feature);

struct DeviceOptions {
    bool validation = false;  ///< core and synchronization validation; messages are collected
    std::string pick;         ///< part of a device's name; empty: the best, a real GPU before a CPU
};

/// What a host renderer lends. The queue must support graphics and compute and stay externally synchronized.
struct AdoptedDevice {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
    /// What the device was created with, which Vulkan cannot be asked: the chain of features given to vkCreateDevice (with
    /// pEnabledFeatures in its first struct where those were used) and the names of the extensions.
    const VkPhysicalDeviceFeatures2* features = nullptr;
    std::vector<const char*> extensions{};
};

/// How much was made since the device was; a steady frame makes nothing.
struct Counters {
    std::uint64_t pipelines = 0, samplers = 0, images = 0, buffers = 0, views = 0, allocations = 0;
    std::uint64_t pools = 0;  ///< of commands and queries
    std::uint64_t texts =
        0;  ///< of shaders, composed for a frame and not kept: who keeps one seals it (gpu/pipeline.h)
    bool operator==(const Counters&) const = default;
};

class Device {
  public:
    static std::unique_ptr<Device> create(const DeviceOptions& options = {});
    /// Throws Error when the host's device lacks, or was created without, what Gnomon needs; it names all of that. Without
    /// `shaders` it compiles those of the data folder.
    static std::unique_ptr<Device> adopt(const AdoptedDevice& host, std::shared_ptr<ShaderCompiler> shaders = nullptr);
    virtual ~Device() = default;

    [[nodiscard]] virtual const DeviceInfo& info() const = 0;
    [[nodiscard]] virtual bool has(Feature feature) const = 0;
    [[nodiscard]] virtual VkInstance instance() const = 0;
    [[nodiscard]] virtual VkPhysicalDevice physical() const = 0;
    [[nodiscard]] virtual VkDevice vk() const = 0;
    [[nodiscard]] virtual VkQueue queue() const = 0;
    [[nodiscard]] virtual std::uint32_t queue_family() const = 0;
    [[nodiscard]] virtual const VkPhysicalDeviceProperties& properties() const = 0;

    [[nodiscard]] virtual ShaderCompiler& shaders() = 0;
    [[nodiscard]] virtual PipelineCache& pipelines() = 0;
    [[nodiscard]] virtual MemoryPool& memory() = 0;

    [[nodiscard]] Counters& counters() { return counters_; }

    /// Records with `record`, submits, waits. Throws Error on a lost device.
    virtual void run(const std::function<void(VkCommandBuffer)>& record) = 0;
    /// Validation messages (errors and warnings, performance hints filtered) since the device was made.
    [[nodiscard]] virtual const std::vector<std::string>& messages() const = 0;
    /// Whether it was made with validation. Passes then check what they compute, too, and report it as a message.
    [[nodiscard]] virtual bool validates() const { return false; }
    virtual void report(const std::string& message) { check_failed(__FILE__, __LINE__, "validates()", message); }

  private:
    Counters counters_;
};

/// A line per physical device, and for the one that would be picked its features, formats, limits and what they rule
/// out; the text of `gnomon doctor`. Never throws: a machine without Vulkan is a sentence.
struct DoctorReport {
    bool usable = false;
    std::vector<std::string> lines;
};
DoctorReport examine_machine();

}  // namespace gn
