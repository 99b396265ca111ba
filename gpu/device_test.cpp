// SPDX-License-Identifier: MIT
#include "gpu/device.h"

#include "gpu/features.h"
#include "gpu/pipeline_cache.h"
#include "gpu/test_device.h"

#include <algorithm>

namespace gn::device_test {
namespace {

class Devices : public Rendered {};

/// A device made by hand, as a host makes its own.
class HostMade {
  public:
    HostMade(Device& like, const VkPhysicalDeviceFeatures2& features) : like_(like), features_(features) {
        const float priority = 1;
        const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                            .queueFamilyIndex = like.queue_family(),
                                            .queueCount = 1,
                                            .pQueuePriorities = &priority};
        const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                      .pNext = &features,
                                      .queueCreateInfoCount = 1,
                                      .pQueueCreateInfos = &queue,
                                      .enabledExtensionCount = static_cast<std::uint32_t>(extensions_.size()),
                                      .ppEnabledExtensionNames = extensions_.data()};
        GN_VK(vkCreateDevice(like.physical(), &info, nullptr, &device_));
        vkGetDeviceQueue(device_, like.queue_family(), 0, &queue_);
    }
    ~HostMade() { vkDestroyDevice(device_, nullptr); }
    HostMade(const HostMade&) = delete;
    HostMade& operator=(const HostMade&) = delete;
    [[nodiscard]] AdoptedDevice lent() const {
        return {like_.instance(), like_.physical(), device_, queue_, like_.queue_family(), &features_, extensions_};
    }

  private:
    Device& like_;
    const VkPhysicalDeviceFeatures2& features_;
    std::vector<const char*> extensions_{VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
};

TEST_F(Devices, TheChosenOneSaysWhy) {
    EXPECT_FALSE(device.info().name.empty());
    EXPECT_FALSE(device.info().driver.empty());
    EXPECT_FALSE(device.info().why.empty());
    EXPECT_EQ(device.info().cpu, device.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU);
    EXPECT_FALSE(device.info().cpu && device.has(Feature::timestamps)) << "a CPU's timestamps mean nothing";
}

TEST_F(Devices, AnUnknownNameListsTheKnown) {
    const std::string error = error_of([] { Device::create({.pick = "no such device"}); });
    EXPECT_NE(error.find("'no such device'"), std::string::npos) << error;
    EXPECT_NE(error.find(device.info().name), std::string::npos) << error;
}

TEST_F(Devices, EveryFeatureHasANameAndAConsequence) {
    for (int i = 0; i < feature_count; ++i) {
        EXPECT_FALSE(feature_name(static_cast<Feature>(i)).empty());
        EXPECT_NE(feature_consequence(static_cast<Feature>(i)).find("without"), std::string_view::npos);
    }
}

TEST_F(Devices, TheDoctorNamesTheDeviceAndEveryFeature) {
    const DoctorReport report = examine_machine();
    EXPECT_TRUE(report.usable);
    const auto mentions = [&](std::string_view text) {
        return std::any_of(report.lines.begin(), report.lines.end(),
                           [&](const std::string& line) { return line.find(text) != std::string::npos; });
    };
    EXPECT_TRUE(mentions(device.info().name));
    for (int i = 0; i < feature_count; ++i) {
        EXPECT_TRUE(mentions(feature_name(static_cast<Feature>(i))));
    }
}

TEST_F(Devices, AHostsDeviceRunsAGraph) {
    // What this device was made with, but for one feature that the host does not speak of.
    FeatureChain chain;
    std::vector<const char*> extensions;
    enable(examine(device.physical()), chain, extensions);
    chain.core.features.shaderFloat64 = VK_FALSE;
    const auto adopted = Device::adopt({device.instance(), device.physical(), device.vk(), device.queue(),
                                        device.queue_family(), &chain.core, extensions});
    EXPECT_FALSE(adopted->has(Feature::shader_float64)) << "the host did not say that it enabled it";
    EXPECT_EQ(adopted->has(Feature::layer_from_vertex_shader), device.has(Feature::layer_from_vertex_shader));
    EXPECT_EQ(adopted->has(Feature::anisotropy), device.has(Feature::anisotropy));
    FrameGraph graph(*adopted);
    const BufferHandle out = graph.create(BufferDesc{.name = "out", .bytes = 64});
    graph.keep(out);
    graph.add_pass(
        "fill", [&](PassBuilder& pass) { pass.copy_to(out); }, [=](Recorder& r) { r.fill(out, 0x01020304U); });
    graph.execute();
    EXPECT_EQ(values_of<std::uint32_t>(graph.download(out)), std::vector<std::uint32_t>(16, 0x01020304U));
}

TEST_F(Devices, AHostsDeviceWithoutARequiredFeatureIsRefusedByItsName) {
    // The hardware has depth clamping and the rest; this host did not turn it on.
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    v13.dynamicRendering = v13.synchronization2 = VK_TRUE;
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v13};
    features.features.geometryShader = VK_TRUE;
    const HostMade host(device, features);
    const std::string error = error_of([&] { Device::adopt(host.lent()); });
    EXPECT_NE(error.find("depthClamp"), std::string::npos) << error;
    EXPECT_NE(error.find("scalarBlockLayout"), std::string::npos) << error;
    EXPECT_NE(error.find("maintenance4"), std::string::npos) << error;
    EXPECT_EQ(error.find("synchronization2"), std::string::npos) << error;
    EXPECT_EQ(error.find("geometryShader"), std::string::npos) << error;
}

TEST_F(Devices, AHostMayNameFeaturesOneByOneButMustNameThem) {
    FeatureChain chain;
    std::vector<const char*> extensions;
    enable(examine(device.physical()), chain, extensions);

    // One struct a feature instead of one a version.
    VkPhysicalDeviceScalarBlockLayoutFeatures scalar{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES};
    VkPhysicalDeviceMaintenance4Features sizes{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES, &scalar};
    VkPhysicalDeviceSynchronization2Features barriers{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES,
                                                      &sizes};
    VkPhysicalDeviceDynamicRenderingFeatures rendering{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES,
                                                       &barriers};
    scalar.scalarBlockLayout = sizes.maintenance4 = VK_TRUE;
    barriers.synchronization2 = rendering.dynamicRendering = VK_TRUE;
    const VkPhysicalDeviceFeatures2 one_by_one{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &rendering,
                                               chain.core.features};
    AdoptedDevice host{device.instance(),     device.physical(), device.vk(), device.queue(),
                       device.queue_family(), &one_by_one,       extensions};
    EXPECT_EQ(error_of([&] { EXPECT_FALSE(Device::adopt(host)->has(Feature::layer_from_vertex_shader)); }), "");

    host.extensions.clear();
    EXPECT_NE(error_of([&] { Device::adopt(host); }).find("VK_KHR_push_descriptor"), std::string::npos);
    host.features = nullptr;
    EXPECT_NE(error_of([&] { Device::adopt(host); }).find("features"), std::string::npos);
}

TEST_F(Devices, PipelinesAreMadeOnce) {
    const ComputeDesc desc{compute_shader("once", "layout(local_size_x = 1) in; void main() {}"), {}};
    const Pipeline& first = device.pipelines().get(desc);
    const std::size_t count = device.pipelines().size();
    EXPECT_EQ(&device.pipelines().get(desc), &first);
    EXPECT_EQ(device.pipelines().size(), count);
}

TEST(Validation, CollectsMessages) {
    // Without this, a clean log would prove nothing.
    const auto device = Device::create({.validation = true});
    EXPECT_TRUE(device->messages().empty());
    const VkBufferCreateInfo nothing{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = 0, .usage = 0};
    VkBuffer buffer = VK_NULL_HANDLE;
    if (vkCreateBuffer(device->vk(), &nothing, nullptr, &buffer) == VK_SUCCESS) {
        vkDestroyBuffer(device->vk(), buffer, nullptr);
    }
    EXPECT_FALSE(device->messages().empty());
}

TEST(Validation, SeesAMissingBarrier) {
    const auto device = Device::create({.validation = true});
    const Buffer a(*device, {.name = "a", .bytes = 64}), b(*device, {.name = "b", .bytes = 64});
    device->run([&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, 64};
        vkCmdFillBuffer(commands, a.vk(), 0, 64, 1);
        vkCmdCopyBuffer(commands, a.vk(), b.vk(), 1, &region);
    });
    ASSERT_FALSE(device->messages().empty());
    EXPECT_NE(device->messages().front().find("SYNC-HAZARD-READ-AFTER-WRITE"), std::string::npos);
}

}  // namespace
}  // namespace gn::device_test
