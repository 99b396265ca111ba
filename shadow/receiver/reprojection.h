// SPDX-License-Identifier: MIT
// The frame before, for parts that find again what it saw: the camera's matrix, and how objects moved.
//
//     if (const auto before = reprojection(input)) {
//         ... gn_reproject(before->before_cs_from_ws, before->before_from_now[object], p_ws) of reprojection.glsl ...
//     }
#pragma once

#include "shadow/stages.h"

#include <optional>
#include <vector>

namespace gn {

struct Reprojection {
    /// The clip space of the frame before, from this frame's world space: of points where they were then.
    mat4 before_cs_from_ws{1};
    /// For every object of the scene: ws, takes its points from where they are to where they were. Empty where nobody tells how
    /// objects move: a renderer's buffers hold their places, and its receivers name no objects.
    std::vector<mat4> before_from_now;
};

/// Unset where no frame came before: without a history, in its first frame, after a cut.
std::optional<Reprojection> reprojection(const FrameInput& input);

/// Leaves for the next frame what this one is: once a frame.
void leave_frame(History& history, const ViewSamples& samples, const Scene& scene, const SceneHandles& handles);

}  // namespace gn
