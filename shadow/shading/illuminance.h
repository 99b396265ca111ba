// SPDX-License-Identifier: MIT
// The light that view samples would get if nothing stood between.
#pragma once

#include "shadow/stages.h"

namespace gn {

/// Unshadowed illuminance of every sample under a light, lux, the cosine of its geometric normal included; 0 where the
/// sample does not count. Area lights are taken at their centre.
std::vector<float> unshadowed_illuminance(const CpuSamples& samples, const GnLight& light);

}  // namespace gn
