// SPDX-License-Identifier: MIT
// Where sweeps are: shipped ones by name, others by path.
#pragma once

#include "apps/evaluation/sweep_store.h"

namespace gn {

struct NamedSweep {
    SweepTitle title;
    std::string where;  ///< the file, for sentences
};

/// "sambeek-quality" (of sweeps/), or a path to a .toml. Throws Error listing the shipped ones.
NamedSweep find_sweep(const std::string& name_or_path, bool quick);

/// A short fingerprint of a text.
std::string fingerprint_of(std::string_view text);

}  // namespace gn
