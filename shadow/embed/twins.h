// SPDX-License-Identifier: MIT
// Lenders of frames that nobody will record.
#pragma once

#include "shadow/embed/state.h"

namespace gn::embed {

class Twins {
  public:
    Twins(Device& device, const LentCasters& casters)
        : none_(device, 1), missing_(device, none_, true), mesh_(casters.twin()), history_(device) {}
    /// What the next frame is declared with.
    Lenders lend(const Frame& frame) {
        missing_.begin(frame.receivers.width, frame.receivers.height);
        return {none_, missing_, mesh_, history_, remarks_};
    }
    /// The frame declared last is over.
    void advance() { history_.advance(); }

  private:
    Frames none_;
    LentImages missing_;
    LentCasters mesh_;
    History history_;
    std::set<std::string> remarks_;
};

}  // namespace gn::embed
