// SPDX-License-Identifier: MIT
// The frame: calls of every stage in flow order. See frame.cpp. What a host records is add_frame; measuring is a caller of it.
//
//     const PreparedRecipe recipe(device, load_recipe("pcf,placement=cascades"));   // once
//     Frames frames(device, 2);
//     History history(device);
//     for (std::uint32_t slot = 0;; slot = 1 - slot) {
//         wait_for(fences[slot]);                     // the host's own
//         frames.begin(slot);
//         FrameGraph graph(device);
//         const FrameCasters casters{scene, import_scene(graph, uploaded)};    // uploaded: upload_scene(device, scene), once
//         const ViewSamples receivers = lent_samples(graph, camera, graph.import(position), graph.import(normal));
//         const std::array<FrameLight, 2> lights{{{&sun, 17}, {&lamp, 4}}};
//         const std::vector<LightShadow> shadows = add_frame(graph, receivers, casters, lights, recipe, &history);
//         add_own_shading(graph, shadows[0].visibility.image, ...);   // or keep it: copy it into an imported texture
//         graph.record(frames, commands);             // the host's command buffer
//         history.advance();
//     }
#pragma once

#include "shadow/recipe/prepared.h"
#include "shadow/recipe/recipe.h"
#include "shadow/stages.h"

namespace gn {

/// What casts in a frame: the scene with its bounds, which must live as long as the graph, and its buffers in that graph.
struct FrameCasters {
    const Scene& scene;
    SceneHandles handles;
};

/// A light of a frame. Its id is the same in every frame, whatever order lights come in: what the history keeps for a light
/// is found by it. No two lights of a frame share one.
struct FrameLight {
    const Light* light = nullptr;
    std::uint64_t id = 0;
};

/// What add_frame makes of a light: V of every receiver, or one sentence why there is none.
struct LightShadow {
    Visibility visibility;  ///< R32F of the receivers' size, transient; an invalid handle where refused
    std::string refused;    ///< "" where there is a shadow
};

/// Adds the shadows of the lights, on the receivers, of the casters, to the graph: what a host records every frame. One
/// entry a light, in the order given. A recipe that cannot serve a light refuses it in a sentence, and the others go on.
/// `history` keeps what outlives the frame, null where nothing does; the caller advances it once the frame is recorded.
/// What parts find out only when the frame has completed becomes sentences in `late_remarks`, which must live as long as
/// answers can come. Passes are those of the group "shadow". Nothing is drawn, waited for or read back here. Throws Error.
std::vector<LightShadow> add_frame(FrameGraph& graph, const ViewSamples& receivers, const FrameCasters& casters,
                                   std::span<const FrameLight> lights, const PreparedRecipe& recipe,
                                   History* history = nullptr, std::set<std::string>* late_remarks = nullptr);
/// The scene's lights, each with its index for an id.
std::vector<FrameLight> lights_of(const Scene& scene);

/// Receivers that a host has drawn itself: RGBA32F textures of one size, position (ws, metres; w = 1 where a surface is seen,
/// 2 where that receives no shadow, else 0) and normal (unit, geometric, ws, towards the camera; w = metres along the camera's
/// axis). The shading's textures and depth stay invalid: a recipe that needs one refuses. Throws Error naming format or size.
ViewSamples lent_samples(const FrameGraph& graph, const Camera& camera, TextureHandle position, TextureHandle normal);

/// What a rendered frame leaves: pictures on the CPU and the graph's accounts.
struct FrameResult {
    CpuSamples samples;                ///< empty where the options ask for none
    std::vector<Image> visibility;     ///< one a light, 1 or 3 channels, in [0,1]; empty Image for lights not asked for
    std::vector<std::string> refused;  ///< one a light: the sentence why, or ""
    std::vector<std::string> remarks;  ///< limits of the recipe's parts that show in this scene, one sentence each
    Image picture;                     ///< linear RGB radiance, cd/m^2
    GraphStatistics statistics;        ///< medians over the repeats
    std::vector<double> shadow_ms, frame_ms;   ///< one per repeat
    std::vector<std::vector<double>> pass_ms;  ///< per pass of `statistics`, one per repeat
};

struct FrameOptions {
    uint width = 640, height = 360;
    int repeat = 0;                          ///< timed runs after one that warms up; 0: one run, without times
    int only_light = -1;                     ///< index, or -1 for all
    bool samples = true, visibility = true;  ///< whether they are read back
    bool picture = true;                     ///< whether it is shaded and read back
    History* history = nullptr;              ///< of a camera's sequence; advanced by every frame that completes
};

/// Renders one view of the scene with one recipe, waits and reads back: what measuring does. Throws Error; refusals per light
/// are in the result.
FrameResult render_frame(SceneGpu& scene, const Camera& camera, const PreparedRecipe& recipe,
                         const FrameOptions& options);
/// The same with a recipe that is prepared for this frame alone.
FrameResult render_frame(Device& device, SceneGpu& scene, const Camera& camera, const Recipe& recipe,
                         const FrameOptions& options);
/// Only the view samples, for the truth.
CpuSamples render_samples(Device& device, SceneGpu& scene, const Camera& camera, uint width, uint height);

/// The shaded picture from given visibilities (one Image a light; empty means V = 1), linear radiance.
Image shade(Device& device, SceneGpu& scene, const Camera& camera, uint width, uint height,
            std::span<const Image> visibility);

/// The camera's constants for a picture of this size.
GnViewConstants view_constants(const Camera& camera, uint width, uint height);

/// Stages that frame.cpp calls; each in its stage's folder.
SceneHandles import_scene(FrameGraph& graph, SceneGpu& scene);
ViewSamples add_view_samples(FrameGraph& graph, const SceneGpu& scene, const SceneHandles& handles,
                             const Camera& camera, uint width, uint height);
/// placement -> map -> lookup, direct, or both, for the light or each that serves it, then visibility. Throws Refusal.
Visibility add_shadow(const FrameInput& input, const Recipe& recipe);
/// An image of V of the view's size, with 1 or 3 channels.
TextureHandle create_visibility(FrameGraph& graph, const ViewSamples& samples, uint channels = 1);
/// The shared resolve pass: every view sample through the placement's choice and the lookup's function.
Visibility add_resolve(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map);
/// Light x V, summed over the lights, as RGBA32F radiance. An invalid handle means V = 1.
TextureHandle add_shading(const FrameInput& input, std::span<const TextureHandle> visibility);

}  // namespace gn
