// SPDX-License-Identifier: MIT
// A loop over one set of resources and passes: what a round creates takes the place of what earlier rounds created, and
// passes that are those of the round before are not declared again.
#pragma once

#include "gpu/graph_plan.h"

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

/// The passes that rounds share.
class PassRounds {
  public:
    void begin() { running_ = true; }
    [[nodiscard]] bool running() const { return running_; }
    /// A pass of the round in hand; it is not declared before the round ends.
    void add(DeclaredPass pass) { round_.push_back(std::move(pass)); }

    /// Ends the round: it is one more of the loop before it where its passes are the same, else it begins one.
    void next(GraphDeclaration& declaration) {
        if (round_.empty()) {
            return;
        }
        const auto before = declaration.passes.begin() + first_;
        if (std::equal(before, before + count_, round_.begin(), round_.end())) {
            std::vector<DeclaredLoop>& loops = declaration.loops;
            if (!loops.empty() && loops.back().first == first_) {
                ++loops.back().rounds;
            } else {
                loops.push_back({first_, count_, 2});
            }
        } else {
            first_ = static_cast<std::uint32_t>(declaration.passes.size());
            count_ = static_cast<std::uint32_t>(round_.size());
            std::move(round_.begin(), round_.end(), std::back_inserter(declaration.passes));
        }
        round_.clear();
    }
    void end(GraphDeclaration& declaration) {
        next(declaration);
        *this = {};
    }

  private:
    bool running_ = false;
    std::uint32_t first_ = 0, count_ = 0;  ///< what the round before is declared as
    std::vector<DeclaredPass> round_;
};

}  // namespace gn
