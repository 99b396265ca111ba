// SPDX-License-Identifier: MIT
// Stands between the library and the driver in the suite's process: counts what lives, and lets a call fail where a test asks.
// The linker finds these functions before the loader's.
#include "tests/vulkan_calls.h"

#include <gtest/gtest.h>
#include <vulkan/vulkan.h>

#include <dlfcn.h>

namespace gn::test {
namespace {

struct Failing {
    std::string call;
    std::size_t after = 0;  ///< calls of that name that still succeed
    bool armed = false, failed = false;
};
Failing failing;             // NOLINT: one process, one driver
std::size_t living_objects;  // NOLINT

/// Whether this call must fail: it was asked for, or the device is lost since.
bool fails(const char* call, bool finds_out) {
    if (!failing.armed) {
        return false;
    }
    if (failing.failed) {
        return finds_out;
    }
    if (failing.call != call || failing.after-- > 0) {
        return false;
    }
    failing.failed = true;
    return true;
}

template <class Function>
Function loaders(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

FailingCall::FailingCall(const std::string& call, std::size_t after) {
    failing = {call, after, true, false};
}
FailingCall::~FailingCall() {
    failing = {};
}
bool FailingCall::happened() const {  // NOLINT(readability-convert-member-functions-to-static): of this one alone
    return failing.failed;
}

std::size_t living() {
    return living_objects;
}

const std::vector<std::string>& calls_that_can_fail() {
    static const std::vector<std::string> names{"vkQueueSubmit2",
                                                "vkWaitForFences",
                                                "vkDeviceWaitIdle",
                                                "vkResetCommandPool",
                                                "vkBeginCommandBuffer",
                                                "vkEndCommandBuffer",
                                                "vkResetFences",
                                                "vkAllocateCommandBuffers",
                                                "vkMapMemory",
                                                "vkBindBufferMemory",
                                                "vkBindImageMemory",
                                                "vkGetQueryPoolResults",
                                                "vkCreateBuffer",
                                                "vkCreateImage",
                                                "vkCreateImageView",
                                                "vkAllocateMemory",
                                                "vkCreateShaderModule",
                                                "vkCreateDescriptorSetLayout",
                                                "vkCreatePipelineLayout",
                                                "vkCreateComputePipelines",
                                                "vkCreateGraphicsPipelines",
                                                "vkCreatePipelineCache",
                                                "vkCreateSampler",
                                                "vkCreateQueryPool",
                                                "vkCreateCommandPool",
                                                "vkCreateFence"};
    return names;
}

}  // namespace gn::test

using namespace gn::test;

// What is lost is found out by submitting and by waiting, and stays lost. Waiting still waits, so that nothing is destroyed
// while it is in use.
#define GN_CALL(name, parameters, arguments)                                  \
    extern "C" VKAPI_ATTR VkResult VKAPI_CALL name parameters {               \
        static const auto loader = loaders<PFN_##name>(#name);                \
        return fails(#name, false) ? VK_ERROR_DEVICE_LOST : loader arguments; \
    }
#define GN_WAITS(name, parameters, arguments)                      \
    extern "C" VKAPI_ATTR VkResult VKAPI_CALL name parameters {    \
        static const auto loader = loaders<PFN_##name>(#name);     \
        const VkResult result = loader arguments;                  \
        return fails(#name, true) ? VK_ERROR_DEVICE_LOST : result; \
    }
#define GN_MAKES(name, parameters, arguments)                   \
    extern "C" VKAPI_ATTR VkResult VKAPI_CALL name parameters { \
        static const auto loader = loaders<PFN_##name>(#name);  \
        if (fails(#name, false)) {                              \
            return VK_ERROR_DEVICE_LOST;                        \
        }                                                       \
        const VkResult result = loader arguments;               \
        living_objects += result == VK_SUCCESS ? 1 : 0;         \
        return result;                                          \
    }
#define GN_ENDS(name, Handle)                                                                                    \
    extern "C" VKAPI_ATTR void VKAPI_CALL name(VkDevice device, Handle handle, const VkAllocationCallbacks* a) { \
        static const auto loader = loaders<PFN_##name>(#name);                                                   \
        living_objects -= handle != VK_NULL_HANDLE ? 1 : 0;                                                      \
        loader(device, handle, a);                                                                               \
    }
#define GN_OBJECT(Object)                                                                                             \
    GN_MAKES(vkCreate##Object,                                                                                        \
             (VkDevice device, const Vk##Object##CreateInfo* info, const VkAllocationCallbacks* a, Vk##Object* made), \
             (device, info, a, made))                                                                                 \
    GN_ENDS(vkDestroy##Object, Vk##Object)

// NOLINTBEGIN(readability-identifier-naming, readability-inconsistent-declaration-parameter-name)
extern "C" VKAPI_ATTR VkResult VKAPI_CALL vkQueueSubmit2(VkQueue queue, uint32_t count, const VkSubmitInfo2* submits,
                                                         VkFence fence) {
    static const auto loader = loaders<PFN_vkQueueSubmit2>("vkQueueSubmit2");
    return fails("vkQueueSubmit2", true) ? VK_ERROR_DEVICE_LOST : loader(queue, count, submits, fence);
}
GN_WAITS(vkWaitForFences, (VkDevice device, uint32_t count, const VkFence* fences, VkBool32 all, uint64_t timeout),
         (device, count, fences, all, timeout))
GN_WAITS(vkDeviceWaitIdle, (VkDevice device), (device))
GN_WAITS(vkGetQueryPoolResults,
         (VkDevice device, VkQueryPool pool, uint32_t first, uint32_t count, size_t size, void* data,
          VkDeviceSize stride, VkQueryResultFlags flags),
         (device, pool, first, count, size, data, stride, flags))
GN_CALL(vkResetCommandPool, (VkDevice device, VkCommandPool pool, VkCommandPoolResetFlags flags), (device, pool, flags))
GN_CALL(vkBeginCommandBuffer, (VkCommandBuffer commands, const VkCommandBufferBeginInfo* info), (commands, info))
GN_CALL(vkEndCommandBuffer, (VkCommandBuffer commands), (commands))
GN_CALL(vkResetFences, (VkDevice device, uint32_t count, const VkFence* fences), (device, count, fences))
GN_CALL(vkAllocateCommandBuffers, (VkDevice device, const VkCommandBufferAllocateInfo* info, VkCommandBuffer* made),
        (device, info, made))
GN_CALL(vkMapMemory,
        (VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size, VkMemoryMapFlags flags,
         void** data),
        (device, memory, offset, size, flags, data))
GN_CALL(vkBindBufferMemory, (VkDevice device, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset),
        (device, buffer, memory, offset))
GN_CALL(vkBindImageMemory, (VkDevice device, VkImage image, VkDeviceMemory memory, VkDeviceSize offset),
        (device, image, memory, offset))
GN_OBJECT(Buffer)
GN_OBJECT(Image)
GN_OBJECT(ImageView)
GN_OBJECT(ShaderModule)
GN_OBJECT(DescriptorSetLayout)
GN_OBJECT(PipelineLayout)
GN_OBJECT(PipelineCache)
GN_OBJECT(Sampler)
GN_OBJECT(QueryPool)
GN_OBJECT(CommandPool)
GN_OBJECT(Fence)
GN_MAKES(vkAllocateMemory,
         (VkDevice device, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks* a, VkDeviceMemory* made),
         (device, info, a, made))
GN_ENDS(vkFreeMemory, VkDeviceMemory)
GN_MAKES(vkCreateComputePipelines,
         (VkDevice device, VkPipelineCache cache, uint32_t count, const VkComputePipelineCreateInfo* infos,
          const VkAllocationCallbacks* a, VkPipeline* made),
         (device, cache, count, infos, a, made))
GN_MAKES(vkCreateGraphicsPipelines,
         (VkDevice device, VkPipelineCache cache, uint32_t count, const VkGraphicsPipelineCreateInfo* infos,
          const VkAllocationCallbacks* a, VkPipeline* made),
         (device, cache, count, infos, a, made))
GN_ENDS(vkDestroyPipeline, VkPipeline)
// NOLINTEND(readability-identifier-naming, readability-inconsistent-declaration-parameter-name)

namespace gn::test {
namespace {

TEST(VulkanCalls, FailWhereTheyAreAskedTo) {
    const FailingCall none("vkDeviceWaitIdle", 1);
    EXPECT_FALSE(fails("vkDeviceWaitIdle", true));
    EXPECT_FALSE(none.happened());
    EXPECT_FALSE(fails("vkCreateBuffer", false));
    EXPECT_TRUE(fails("vkDeviceWaitIdle", true));
    EXPECT_TRUE(none.happened());
    EXPECT_TRUE(fails("vkQueueSubmit2", true)) << "it stays lost";
    EXPECT_FALSE(fails("vkCreateBuffer", false));
}

}  // namespace
}  // namespace gn::test
