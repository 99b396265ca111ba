// SPDX-License-Identifier: MIT
// What rendered tests need: a device with validation on, a frame of a scene, and the truth for the same samples.
#pragma once

#include "reference/truth.h"
#include "shadow/frame/frame.h"
#include "shadow/metrics/metrics.h"

#include <gtest/gtest.h>

namespace gn::test {

/// The suite's device, core and synchronization validation on.
inline Device& device() {
    static const std::unique_ptr<Device> instance = Device::create({.validation = true});
    return *instance;
}

/// Fails the running test on any validation message that it caused.
struct ValidationGuard {
    std::size_t before = device().messages().size();
    ValidationGuard() = default;
    ValidationGuard(const ValidationGuard&) = delete;
    ValidationGuard& operator=(const ValidationGuard&) = delete;
    ~ValidationGuard() {
        for (std::size_t i = before; i < device().messages().size(); ++i) {
            ADD_FAILURE() << "validation: " << device().messages()[i];
        }
    }
};

/// One frame of a scene, first light unless told, and its truth.
struct Comparison {
    Scene scene;
    FrameResult frame;
    TruthResult truth;
    Errors errors;
    [[nodiscard]] const Image& visibility() const { return frame.visibility.front(); }
};

struct ComparisonOptions {
    uint width = 192, height = 192;
    int samples = 64;
    std::string view;
};

inline Comparison compare(Scene scene, const std::string& recipe, const ComparisonOptions& options = {}) {
    const ValidationGuard guard;
    Comparison c{.scene = std::move(scene)};
    SceneGpu gpu = upload_scene(device(), c.scene);
    c.frame = render_frame(device(), gpu, c.scene.camera(options.view), load_recipe(recipe),
                           {.width = options.width, .height = options.height, .only_light = 0, .picture = false});
    EXPECT_EQ(c.frame.refused.front(), "");
    c.truth = Truth(c.scene).trace(c.frame.samples.position_ws, c.frame.samples.normal_ws, c.scene.lights.front(),
                                   {.samples = options.samples});
    c.errors = visibility_errors(c.frame.visibility.front().values, c.truth.visibility, c.truth.counted,
                                 static_cast<int>(options.width), static_cast<int>(options.height));
    // What is asserted of a comparison is asserted of a good part of the picture.
    EXPECT_GT(c.errors.samples, c.visibility().values.size() / 50) << c.scene.name << " with " << recipe;
    return c;
}

inline Comparison compare(const std::string& scene, const std::string& recipe, const ComparisonOptions& options = {}) {
    return compare(load_scene(scene), recipe, options);
}

}  // namespace gn::test
