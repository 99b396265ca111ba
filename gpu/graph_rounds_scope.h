// SPDX-License-Identifier: MIT
// Rounds of a graph that end also where one of them refuses.
#pragma once

#include "gpu/frame_graph.h"

namespace gn {

class RoundsScope {
  public:
    explicit RoundsScope(FrameGraph& graph) : graph_(graph) { graph.begin_rounds(); }
    ~RoundsScope() { graph_.end_rounds(); }
    RoundsScope(const RoundsScope&) = delete;
    RoundsScope& operator=(const RoundsScope&) = delete;

    void next() const { graph_.next_round(); }
    /// Before the scope ends; ending twice does nothing.
    void end() const { graph_.end_rounds(); }

  private:
    FrameGraph& graph_;
};

}  // namespace gn
