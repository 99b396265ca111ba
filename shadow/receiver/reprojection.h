// SPDX-License-Identifier: MIT
// The frame before, for parts that find again what it saw: the camera's matrix, and how objects moved.
//
//     if (const auto before = reprojection(input)) {
//         ... gn_reproject(before->before_cs_from_ws, before->before_from_now[object], p_ws) of reprojection.glsl ...
//     }
//     if (const auto seen = samples_before(input)) {
//         ... whether seen->position at that place is the point where it was: else something else hid it ...
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

/// What the frame before saw, of this frame's size: ViewSamples::position and ViewSamples::normal of then.
struct SamplesBefore {
    TextureHandle position, normal;
};

/// Unset where no frame came before that kept its samples, or where it had another size. Whoever asks lets this frame keep its
/// own for the next: the images that the library makes live on in the history, those that a renderer has imported are copied, once
/// for every asking. Not to be asked within rounds over lights of a graph (FrameGraph::begin_rounds).
std::optional<SamplesBefore> samples_before(const FrameInput& input);

/// Leaves for the next frame what this one is: once a frame.
void leave_frame(History& history, const ViewSamples& samples, const Scene& scene, const SceneHandles& handles);

}  // namespace gn
