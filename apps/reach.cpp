// SPDX-License-Identifier: MIT
#include "apps/reach.h"

#include "base/error.h"

#include <algorithm>

namespace gn {

Reach reach_of(const CpuSamples& samples, const GnLight& light, std::span<const float> visibility) {
    Reach reach;
    const std::size_t channels = visibility.size() / std::max<std::size_t>(samples.position_ws.size(), 1);
    for (std::size_t i = 0; i < samples.position_ws.size(); ++i) {
        if (!(samples.position_ws[i].w > 0.5F)) {
            continue;
        }
        ++reach.surfaces;
        if (gn_counted(light, vec3(samples.position_ws[i]), vec3(samples.normal_ws[i]))) {
            ++reach.counted;
            for (std::size_t c = 0; c < channels; ++c) {
                reach.brightest = std::max(reach.brightest, visibility[channels * i + c]);
            }
        }
    }
    return reach;
}

std::string empty_reason(const Reach& reach, const std::string& light, const std::string& view) {
    if (reach.surfaces == 0) {
        return fmt::format(
            "view '{}' sees no surface of the scene, so there is nothing to measure; --view names another", view);
    }
    return reach.counted > 0 ? ""
                             : fmt::format(
                                   "light '{}' reaches no sample of view '{}': all that it sees faces away from the "
                                   "light, meets it at less than 0.06 degrees, or lies outside its range or cone",
                                   light, view);
}

std::string shadow_remark(const Reach& reach, const std::string& light) {
    return reach.counted == 0 || reach.brightest > 0
               ? ""
               : fmt::format("all that light '{}' could reach in this view is in shadow (a lamp inside its shade?)",
                             light);
}

}  // namespace gn
