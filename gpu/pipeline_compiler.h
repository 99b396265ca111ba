// SPDX-License-Identifier: MIT
// A thread that makes pipelines while frames are recorded without them.
#pragma once

#include "gpu/pipeline_cache.h"

#include <memory>

namespace gn {

class FrameGraph;

class PipelineCompiler {
  public:
    explicit PipelineCompiler(Device& device);
    /// Leaves what has not been begun, and waits for what has.
    ~PipelineCompiler();
    PipelineCompiler(const PipelineCompiler&) = delete;
    PipelineCompiler& operator=(const PipelineCompiler&) = delete;

    /// Whether the thread is at work: whoever asks for a graph then is told no.
    [[nodiscard]] bool busy() const;
    /// Whether every pipeline is there that the graph's passes bind. Those that are not the thread makes from now on: ask
    /// again in a later frame. Called by the thread that records. Throws Error where one could not be made.
    bool ready(FrameGraph& graph);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gn
