// SPDX-License-Identifier: MIT
#include "shadow/receiver/expect.h"

#include <algorithm>

namespace gn {

std::string expect_text(const Device& device) {
    if (!device.validates()) {
        return "#define gn_unit(v) clamp(v, 0.0, 1.0)\n";
    }
    // V may miss its range by rounding: a sum of 256 weights by 256 half units of a 24-bit significand, twice that here.
    return R"(
bool gn_broken = false;
#define GN_EXPECT(condition) { if (!(condition)) { gn_broken = true; } }
bool gn_finite(float x) { return !isnan(x) && !isinf(x); }
bool gn_in_unit(float v) { return gn_finite(v) && v >= -1.526e-5 && v <= 1.0 + 1.526e-5; }
float gn_unit(float v) {
    GN_EXPECT(gn_in_unit(v));
    return gn_broken ? -1.0e9 : clamp(v, 0.0, 1.0);
}
vec3 gn_unit(vec3 v) { return vec3(gn_unit(v.r), gn_unit(v.g), gn_unit(v.b)); }
)";
}

void report_marked(Device& device, const Image& visibility, const std::string& recipe, std::size_t light) {
    if (!device.validates()) {
        return;
    }
    const std::vector<float>& values = visibility.values;
    const auto marked = [](float v) { return !(v >= 0 && v <= 1); };
    const auto first = std::find_if(values.begin(), values.end(), marked);
    if (first == values.end()) {
        return;
    }
    const auto at = (first - values.begin()) / visibility.channels;
    device.report(fmt::format(
        "visibility of light {} by {}: {} of {} samples are outside [0, 1] or not a number before they are clamped, "
        "the first at pixel {}, {}",
        light, recipe, std::count_if(first, values.end(), marked), values.size(), at % visibility.width,
        at / visibility.width));
}

}  // namespace gn
