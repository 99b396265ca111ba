// SPDX-License-Identifier: MIT
// What moved, by version of the geometry: whoever keeps something that was made of an older version asks here what of it must
// be made anew.
//
//     const auto touched = handles.moves->since(kept.version);   // kept.version: SceneHandles::version when it was made
//     if (!touched) { make_all_anew(); }
//     for (const Box& box_ws : *touched) { make_anew_where_it_touches(box_ws); }
#pragma once

#include "base/math.h"

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace gn {

class Moves {
  public:
    /// Steps that are remembered, and boxes of one; what was made of an older version knows nothing of what moved since.
    static constexpr std::size_t most_steps = 64, most_boxes = 256;

    /// The geometry went from one version to the next. touched_ws: boxes (metres, world space) in which all that differs lay
    /// before, and in which it lies now; unset: anything may differ.
    void add(std::uint64_t from, std::uint64_t to, std::optional<std::vector<Box>> touched_ws);
    /// The boxes of every step after `version`, none where it is the present one; unset where anything may differ.
    [[nodiscard]] std::optional<std::vector<Box>> since(std::uint64_t version) const;

  private:
    struct Step {
        std::uint64_t from = 0, to = 0;
        std::vector<Box> touched_ws;
    };
    std::deque<Step> steps_;  ///< each begins where the one before ended
    std::uint64_t now_ = 0;
};

}  // namespace gn
