// SPDX-License-Identifier: MIT
// What rendered tests need: a device with validation on, a frame of a scene, and the truth for the same samples.
#pragma once

#include "reference/truth.h"
#include "shadow/frame/frame.h"
#include "shadow/metrics/metrics.h"

#include <gtest/gtest.h>

namespace gn::test {

/// The suite's device, core and synchronization validation on.
Device& device();

/// Fails the running test on any validation message that it caused.
struct ValidationGuard {
    std::size_t before = device().messages().size();
    ValidationGuard() = default;
    ValidationGuard(const ValidationGuard&) = delete;
    ValidationGuard& operator=(const ValidationGuard&) = delete;
    ~ValidationGuard();
};

/// A scene that is no file, `courtyard` or `slab:light=point`: made once a suite, which takes a second where sanitizers watch.
const Scene& built_in(const std::string& name);

/// Every shipped recipe; with sanitizers every fourth, since the sweep over parameters draws each of them there.
std::vector<std::string> drawn_recipes();

/// The recipe's text with four points of its light, which are a loop as well as sixty-four are, and four levels of a
/// placement that has some; as it is where there are none, or where a suite is thorough.
std::string with_few_points(const Recipe& recipe, const std::string& text);

/// A recipe's text with few points, and with maps of so many texels a side where it has maps.
std::string with_small_maps(const std::string& recipe, uint resolution);

/// One frame of a scene, first light unless told, and its truth.
struct Comparison {
    Scene scene;
    FrameResult frame;
    TruthResult truth;
    Errors errors;
    explicit Comparison(Scene given);
    Comparison(Comparison&&) noexcept;
    ~Comparison();
    [[nodiscard]] const Image& visibility() const { return frame.visibility.front(); }
};

struct ComparisonOptions {
    uint width = 192, height = 192;
    int samples = 64;
    std::string view;
};

Comparison compare(Scene scene, const std::string& recipe, const ComparisonOptions& options = {});
/// Of a built-in scene, or of a file by its path.
Comparison compare(const std::string& scene, const std::string& recipe, const ComparisonOptions& options = {});

}  // namespace gn::test
