// SPDX-License-Identifier: MIT
// Flicker as rendered: cascades that keep their texels fixed to the world against those that follow the camera.
#include "shadow/metrics/flicker.h"
#include "shadow/history.h"
#include "tests/rig.h"

#include <cmath>

namespace gn {
namespace {

constexpr uint width = 640, height = 360;

struct Walked {
    double flicker = 0, rmse = 0;  ///< of all steps; mean over the frames
};

/// Follows the cameras with one history, against the closed answer of the tracer for a sun without size.
Walked walk(const Scene& scene, const std::vector<Camera>& cameras, const std::string& text) {
    const test::ValidationGuard guard;
    const Recipe recipe = load_recipe(text);
    const Truth tracer(scene);
    SceneGpu gpu = upload_scene(test::device(), scene);
    History history(test::device());
    Flicker flicker;
    CpuSamples before;
    SignedError error_before;
    Walked walked;
    const auto view_of = [](const CpuSamples& samples) {
        const Camera& camera = samples.camera;
        const mat4 cs_from_ws = cs_from_vs(camera, static_cast<float>(width) / height) * vs_from_ws(camera);
        return PathView{
            width, height, cs_from_ws, 2 * std::tan(camera.yfov / 2) / height, samples.normal_ws, samples.position_ws};
    };
    for (const Camera& camera : cameras) {
        FrameResult frame = render_frame(
            test::device(), gpu, camera, recipe,
            {.width = width, .height = height, .repeat = 0, .only_light = 0, .picture = false, .history = &history});
        EXPECT_EQ(frame.refused.front(), "");
        const TruthResult truth =
            tracer.trace(frame.samples.position_ws, frame.samples.normal_ws, scene.lights[0].shape, {.samples = 1});
        const std::vector<float>& found = frame.visibility.front().values;
        SignedError error = signed_error(found, truth.visibility, truth.counted, width, height);
        walked.rmse += visibility_errors(found, truth.visibility, truth.counted, width, height).rmse.value() /
                       static_cast<double>(cameras.size());
        if (!before.position_ws.empty()) {
            flicker += flicker_between(error_before, error, same_points(view_of(before), view_of(frame.samples)));
        }
        before = std::move(frame.samples);
        error_before = std::move(error);
    }
    EXPECT_GT(flicker.samples, 1000U) << text;
    walked.flicker = flicker.root_mean_square().value_or(NAN);
    return walked;
}

TEST(FlickerRendered, AStillCameraHasNone) {
    const Scene scene = load_scene("corridor");
    const std::vector<Camera> still(3, scene.camera(""));
    for (const char* recipe : {"pcf,placement=cascades,resolution=256", "pcf,placement=fit,resolution=256"}) {
        EXPECT_EQ(walk(scene, still, recipe).flicker, 0.0) << recipe;
    }
}

TEST(FlickerRendered, SnappedCascadesFlickerATenthOfThoseThatAreNot) {
    // Snapped windows surround spheres, whose texels are about twice as large at the same resolution. So that the others
    // are no worse to begin with, they get the resolution at which their error is no greater.
    // A texel of constant bias keeps comparisons off the threshold, where the rounding of the view's own positions turns
    // single taps on and off: that is acne's flicker, not that of the texels.
    const Scene scene = load_scene("corridor");
    const std::vector<Camera>& path = scene.paths.at(0).frames;
    const Walked snapped =
        walk(scene, path, "pcf,placement=cascades,cascades.fit=stable,resolution=512,bias.constant=1");
    const Walked loose = walk(scene, path, "pcf,placement=cascades,cascades.fit=plain,resolution=256,bias.constant=1");
    EXPECT_LE(loose.rmse, snapped.rmse);
    EXPECT_LE(snapped.flicker, 0.1 * loose.flicker) << snapped.flicker << " against " << loose.flicker;
    EXPECT_GT(loose.flicker, 0.01);
    RecordProperty("snapped", std::to_string(snapped.flicker));
    RecordProperty("loose", std::to_string(loose.flicker));
}

}  // namespace
}  // namespace gn
