// SPDX-License-Identifier: MIT
// Figures of which too few samples tell.
#pragma once

#include "shadow/metrics/flicker.h"
#include "shadow/metrics/metrics.h"

#include <string>
#include <vector>

namespace gn {

/// A sentence for each of leak, acne and penumbra that is told by some of a light's samples, but by fewer than one in 500: a spot or two
/// of the scene decide it, however many pixels sample them.
std::vector<std::string> few_samples(const Errors& errors, const std::string& light);

/// The same of flicker: a sentence where fewer than twenty changes make it up; empty elsewhere, and where nothing changes.
std::string few_changes(const Flicker& flicker, const std::string& light);

}  // namespace gn
