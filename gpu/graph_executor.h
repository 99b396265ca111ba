// SPDX-License-Identifier: MIT
// Runs a plan on a Vulkan device, and times it.
#pragma once

#include "gpu/recorder.h"

namespace gn {

class GraphExecutor {
  public:
    explicit GraphExecutor(Device& device);
    ~GraphExecutor();
    GraphExecutor(const GraphExecutor&) = delete;
    GraphExecutor& operator=(const GraphExecutor&) = delete;

    using Execute = std::function<void(Recorder&)>;
    /// Records, submits and waits. Milliseconds per planned pass where timed, else zeros. On a CPU device a timed pass
    /// is a submit of its own, measured by the host's clock; on a GPU timestamps bracket it.
    std::vector<double> run(const GraphDeclaration& declaration, const GraphPlan& plan, GraphResources& resources,
                            const std::vector<Execute>& executes, bool timed);

  private:
    void begin();
    void end_and_wait();
    void record(const GraphDeclaration& declaration, const PlannedPass& planned, GraphResources& resources,
                GraphRecorder& recorder, const Execute& execute);
    void barriers(const GraphDeclaration& declaration, const PlannedPass& planned, GraphResources& resources) const;
    void label(const std::string& name) const;
    std::vector<double> run_apart(const GraphDeclaration& declaration, const GraphPlan& plan, GraphResources& resources,
                                  const std::vector<Execute>& executes, GraphRecorder& recorder);
    std::vector<double> run_together(const GraphDeclaration& declaration, const GraphPlan& plan,
                                     GraphResources& resources, const std::vector<Execute>& executes,
                                     GraphRecorder& recorder, bool timestamps);

    Device& device_;
    UploadArena arena_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    VkQueryPool queries_ = VK_NULL_HANDLE;
    std::uint32_t query_count_ = 0;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label_ = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label_ = nullptr;
};

}  // namespace gn
