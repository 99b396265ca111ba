// SPDX-License-Identifier: MIT
// The runs of a sweep: every combination of every grid, each with a name that is the same on every machine.
#pragma once

#include "apps/evaluation/sweep_file.h"

#include <cstddef>

namespace gn {

struct SweepRun {
    std::string key;   ///< of all that it asks for: what is finished is known by it
    std::string grid;  ///< the name of its grid
    std::string scene, recipe, view, light;
    int width = 0, height = 0, samples = 0, repeat = 0;
    bool shaded = false;  ///< also held against [EASW09] eq. 1.3
    std::vector<std::pair<std::string, std::string>>
        at;  ///< its place: axis and name of the value, in the file's order

    /// Runs of one view share what was loaded and traced for it.
    [[nodiscard]] std::string view_text() const;
};

/// All runs, those of a view side by side. Views come in an order that is scrambled, but always the same: what is finished is a
/// fair sample of what is not, so that times can be foretold. The same run in two grids is there twice, with one key.
/// Throws Error: the grid, the text, what would be valid.
std::vector<SweepRun> expand(const SweepFile& file, const std::string& where);

/// --shard 2/4: the second of four parts.
struct Shard {
    int index = 1, count = 1;  ///< 1 to count
};
/// Throws Error.
Shard parse_shard(const std::string& text);
/// The runs of a part: whole views where there are enough of them, so that none is traced twice. The parts are disjoint, and
/// together they are all.
std::vector<SweepRun> share_of(const std::vector<SweepRun>& runs, const Shard& shard);

}  // namespace gn
