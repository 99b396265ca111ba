// SPDX-License-Identifier: MIT
// Runs a plan on a Vulkan device at once and waits for it: what measuring and reading back need.
#pragma once

#include "gpu/pass_counters.h"
#include "gpu/pass_writer.h"

namespace gn {

class GraphExecutor {
  public:
    explicit GraphExecutor(Device& device);
    ~GraphExecutor();
    GraphExecutor(const GraphExecutor&) = delete;
    GraphExecutor& operator=(const GraphExecutor&) = delete;

    /// Records, submits and waits. Milliseconds per planned pass where timed, else zeros. On a CPU device a timed pass
    /// is a submit of its own, measured by the host's clock; on a GPU timestamps bracket it. Where a PassCounters lives for the
    /// device, a run without times is counted.
    std::vector<double> run(const GraphDeclaration& declaration, const GraphPlan& plan, GraphResources& resources,
                            const std::vector<Execute>& executes, bool timed);

  private:
    void destroy();
    void begin();
    void end_and_wait();
    std::vector<double> run_apart(std::span<const Turn> turns, const std::vector<Execute>& executes,
                                  PassWriter& writer);
    std::vector<double> run_together(std::span<const Turn> turns, const std::vector<Execute>& executes,
                                     PassWriter& writer, bool timestamps, PassCounters* counters);

    Device& device_;
    UploadArena arena_;
    PassTimestamps timestamps_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
};

}  // namespace gn
