// SPDX-License-Identifier: MIT
// What a light finds in a view: whether there was anything to measure.
#pragma once

#include "base/image.h"
#include "shadow/stages.h"

#include <span>
#include <string>

namespace gn {

struct Reach {
    std::size_t surfaces = 0;  ///< view samples that see a surface
    std::size_t counted = 0;   ///< of them, those that count for the light
    float brightest = 0;       ///< the largest V of those
};
/// `visibility`: V of the light, one value a view sample.
Reach reach_of(const CpuSamples& samples, const GnLight& light, std::span<const float> visibility);

/// The sentence why there is nothing to measure, or "".
std::string empty_reason(const Reach& reach, const std::string& light, const std::string& view);
/// The sentence where all that the light could reach is in shadow, or "".
std::string shadow_remark(const Reach& reach, const std::string& light);

}  // namespace gn
