// SPDX-License-Identifier: MIT
// What clamps hide. A pass that makes V clamps it; on a device that validates, a sample whose V is not within [0, 1] before
// that, or for which a GN_EXPECT of its formulas does not hold, is marked instead, and the frame reports it as a message.
#pragma once

#include "base/image.h"
#include "gpu/device.h"

namespace gn {

/// GLSL that stands before every include: gn_unit(v), which clamps or marks; where the device validates also GN_EXPECT,
/// and gn_finite(x) and gn_in_unit(v) for its conditions.
std::string expect_text(const Device& device);

/// Reports the marked samples of an image of V, and whatever else lies outside [0, 1], where the device validates.
void report_marked(Device& device, const Image& visibility, const std::string& recipe, std::size_t light);

}  // namespace gn
