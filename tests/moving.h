// SPDX-License-Identifier: MIT
// Frames in a sequence of a scene whose casters move, and what they miss of the truth.
#pragma once

#include "shadow/frame/history.h"
#include "tests/rig.h"

namespace gn::test {

constexpr uint moving_width = 96, moving_height = 64;

/// The next frame of the scene's first camera; a history keeps what outlives frames, null keeps nothing.
inline FrameResult draw_moving(SceneGpu& gpu, const Recipe& recipe, History* history) {
    return render_frame(device(), gpu, gpu.scene->cameras.front(), recipe,
                        {.width = moving_width, .height = moving_height, .picture = false, .history = history});
}

/// The root mean square error of such a frame's first light beside one traced ray a sample.
inline double error_against_truth(const Scene& scene, const FrameResult& frame) {
    const TruthResult truth =
        Truth(scene).trace(frame.samples.position_ws, frame.samples.normal_ws, scene.lights.front(), {.samples = 1});
    return visibility_errors(frame.visibility.front().values, truth.visibility, truth.counted, moving_width,
                             moving_height)
        .rmse.value();
}

}  // namespace gn::test
