// SPDX-License-Identifier: MIT
// Writes the passes of a plan into a command buffer: label, barriers, commands. Whoever executes, records with it.
#pragma once

#include "gpu/recorder.h"

namespace gn {

using Execute = std::function<void(Recorder&)>;

class PassWriter {
  public:
    PassWriter(Device& device, const GraphDeclaration& declaration, GraphResources& resources, UploadArena& arena);

    void write(VkCommandBuffer commands, const PlannedPass& planned, const Execute& execute);

  private:
    void label(VkCommandBuffer commands, const std::string& name) const;
    void barriers(VkCommandBuffer commands, const PlannedPass& planned) const;

    const GraphDeclaration& declaration_;
    GraphResources& resources_;
    GraphRecorder recorder_;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label_;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label_;
};

/// A pair of timestamps a pass; answers are milliseconds.
class PassTimestamps {
  public:
    explicit PassTimestamps(Device& device) : device_(device) {}
    ~PassTimestamps();
    PassTimestamps(const PassTimestamps&) = delete;
    PassTimestamps& operator=(const PassTimestamps&) = delete;

    /// Makes room for as many passes as there ever are and resets them.
    void begin(VkCommandBuffer commands, std::uint32_t most);
    void stamp(VkCommandBuffer commands);
    /// Of the passes that were stamped last; zeros where `wait` is false and the device has not finished.
    [[nodiscard]] std::vector<double> read(bool wait) const;

  private:
    Device& device_;
    VkQueryPool pool_ = VK_NULL_HANDLE;
    std::uint32_t capacity_ = 0, next_ = 0;
};

}  // namespace gn
