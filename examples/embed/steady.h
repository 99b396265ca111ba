// SPDX-License-Identifier: MIT
// Whether frames that repeat create anything: after the third of one size, Gnomon must not.
#pragma once

#include "gpu/device.h"

#include <optional>
#include <string>

class Steady {
  public:
    /// Sizes changed: the next frames may create what they need.
    void begin() {
        since_ = 0;
        known_.reset();
    }
    void after_frame(const gn::Counters& counters);

    [[nodiscard]] std::uint32_t frames() const { return frames_; }  ///< that were held to it
    /// "nothing", or what was.
    [[nodiscard]] std::string created() const { return created_.empty() ? "nothing" : created_; }

  private:
    std::uint32_t since_ = 0, frames_ = 0;
    std::optional<gn::Counters> known_;
    std::string created_;
};
