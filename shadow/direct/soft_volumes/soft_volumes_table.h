// SPDX-License-Identifier: MIT
// What segments hide of a light, by both their ends.
#pragma once

#include <vector>

namespace gn {

/// side^4 entries, the first end's x fastest, then its y, the second end's x and y; each axis from -1 to 1.
std::vector<float> soft_volumes_table(bool square, int side);
/// GLSL: float gn_coverage(vec2 a, vec2 b) of a buffer `coverage` with u.side entries an axis, mixed between 16 entries.
extern const char* const soft_volumes_table_text;

}  // namespace gn
