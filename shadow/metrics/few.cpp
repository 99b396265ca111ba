// SPDX-License-Identifier: MIT
#include "shadow/metrics/few.h"

#include "base/error.h"

namespace gn {

std::vector<std::string> few_samples(const Errors& errors, const std::string& light) {
    constexpr std::size_t enough = 500;
    std::vector<std::string> said;
    const auto say = [&](const char* figure, std::size_t count, const char* found) {
        if (count > 0 && count * enough < errors.samples) {
            said.push_back(fmt::format("'{}' of light '{}' is told by {} of {} samples, those that the truth finds {}",
                                       figure, light, count, errors.samples, found));
        }
    };
    say("leak", errors.dark, "dark");
    say("acne", errors.lit, "lit");
    say("penumbra", errors.partial, "in between");
    return said;
}

std::string few_changes(const Flicker& flicker, const std::string& light) {
    constexpr double enough = 20;
    const double told_by = flicker.told_by();
    if (told_by == 0 || told_by >= enough) {
        return {};
    }
    return fmt::format(
        "'flicker' of light '{}' is told by about {:.0f} of {} points that two frames show; larger pictures show more",
        light, told_by, flicker.samples);
}

}  // namespace gn
