// SPDX-License-Identifier: MIT
// A loop over one set of resources: what a round creates takes the place of what earlier rounds created.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace gn {

/// The resources of one kind that rounds share, by index into the declaration.
class Rounds {
  public:
    void begin() { running_ = true; }
    void next() { std::fill(taken_.begin(), taken_.end(), false); }
    void end() { *this = {}; }

    /// A resource of an earlier round of this description that this round has not yet; it has it from now on.
    template <class Declared, class Desc>
    std::optional<std::uint32_t> take(const std::vector<Declared>& declared, const Desc& desc) {
        for (std::size_t i = 0; i < indices_.size(); ++i) {
            if (!taken_[i] && declared[indices_[i]].desc == desc) {
                taken_[i] = true;
                return indices_[i];
            }
        }
        return std::nullopt;
    }
    /// Remembers what this round had to create.
    void made(std::uint32_t index) {
        if (running_) {
            indices_.push_back(index);
            taken_.push_back(true);
        }
    }

  private:
    bool running_ = false;
    std::vector<std::uint32_t> indices_;
    std::vector<bool> taken_;
};

}  // namespace gn
