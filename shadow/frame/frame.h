// SPDX-License-Identifier: MIT
// The frame: calls of every stage in flow order. See frame.cpp.
#pragma once

#include "shadow/recipe/recipe.h"
#include "shadow/stages.h"

namespace gn {

/// What a rendered frame leaves: pictures on the CPU and the graph's accounts.
struct FrameResult {
    CpuSamples samples;
    std::vector<Image> visibility;     ///< one a light, one channel, in [0,1]; empty Image for lights not asked for
    std::vector<std::string> refused;  ///< one a light: the sentence why, or ""
    std::vector<std::string> remarks;  ///< limits of the recipe's parts that show in this scene, one sentence each
    Image picture;                     ///< linear RGB radiance, cd/m^2
    GraphStatistics statistics;        ///< medians over the repeats
    std::vector<double> shadow_ms, frame_ms;   ///< one per repeat
    std::vector<std::vector<double>> pass_ms;  ///< per pass of `statistics`, one per repeat
};

struct FrameOptions {
    uint width = 640, height = 360;
    int repeat = 1;
    int only_light = -1;  ///< index, or -1 for all
    bool picture = true;
    History* history = nullptr;  ///< of a camera's sequence; advanced by every frame that completes
};

/// Renders one view of the scene with one recipe. Throws Error; refusals per light are in the result.
FrameResult render_frame(Device& device, SceneGpu& scene, const Camera& camera, const Recipe& recipe,
                         const FrameOptions& options);
/// Only the view samples, for the truth.
CpuSamples render_samples(Device& device, SceneGpu& scene, const Camera& camera, uint width, uint height);

/// The shaded picture from given visibilities (one Image a light; empty means V = 1), linear radiance.
Image shade(Device& device, SceneGpu& scene, const Camera& camera, uint width, uint height,
            std::span<const Image> visibility);

/// Stages that frame.cpp calls; each in its stage's folder.
SceneHandles import_scene(FrameGraph& graph, SceneGpu& scene);
ViewSamples add_view_samples(FrameGraph& graph, const SceneGpu& scene, const SceneHandles& handles,
                             const Camera& camera, uint width, uint height);
/// placement -> map -> lookup, or direct, then visibility, for one light. Throws Refusal.
Visibility add_shadow(const FrameInput& input, const Recipe& recipe);
/// An R32F image of the view's size.
TextureHandle create_visibility(FrameGraph& graph, const ViewSamples& samples);
/// The shared resolve pass: every view sample through the placement's choice and the lookup's function.
Visibility add_resolve(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map);
/// Light x V, summed over the lights, as RGBA32F radiance. An invalid handle means V = 1.
TextureHandle add_shading(const FrameInput& input, std::span<const TextureHandle> visibility);

}  // namespace gn
