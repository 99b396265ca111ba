// SPDX-License-Identifier: MIT
// The last slice ends at the farthest object that is seen, and stable windows do not crawl with that end.
#include "tests/cascade_frame.h"
#include "tests/warp_scene.h"

namespace gn::far_test {
namespace {

using namespace cascades;
using namespace test;
using glsl::GnReceiver;

/// A floor before the camera that ends at 30 m; a street that leads aside, and a house at its end, which stands beside what the
/// camera sees and reaches to 420 m.
Scene floor_and_house() {
    Scene scene = test::long_floor(2, 30);
    const auto add = [&](const char* name, vec3 low, vec3 high) {
        scene.triangles.emplace_back(0, 0, 0);
        scene.objects.push_back({name, static_cast<std::uint32_t>(scene.objects.size()), 1, 0, Box{low, high}});
        scene.bounds_ws.grow(Box{low, high});
    };
    scene.bounds_ws = {};
    add("floor", vec3(-5, -0.01F, -30), vec3(5, 0, -2));
    add("street", vec3(5, -0.01F, -3), vec3(1500, 0, 0));
    add("house", vec3(1490, 0, -420), vec3(1500, 10, 0));
    return scene;
}

Interval range_for(const Scene& scene, const GnCascadesParams& params, vec3 from_ws = vec3(0, 0.5F, 0)) {
    FrameGraph graph(device());
    const SceneHandles handles;
    ViewSamples samples{.width = 160, .height = 90};
    samples.camera = {.position_ws = from_ws, .yfov = 0.9F, .near = 0.1F, .far = 1000};
    const FrameInput input{device(), graph, scene, handles, samples, scene.lights.data()};
    return range_of(input, params);
}

TEST(CascadeFar, TightSlicesEndAtTheFarthestObjectSeen) {
    const Scene scene = floor_and_house();
    EXPECT_NEAR(range_for(scene, {.far = GN_FAR_SCENE, .fit = GN_FIT_FITTED}).far, 420, 1);
    EXPECT_NEAR(range_for(scene, {.far = GN_FAR_OBJECTS, .fit = GN_FIT_FITTED}).far, 30, 1e-2);
    // Where the camera sees something there, nothing is cut.
    Scene seen = scene;
    seen.objects[1].bounds_ws = Box{vec3(0, 0, -420), vec3(1500, 10, -400)};
    EXPECT_NEAR(range_for(seen, {.far = GN_FAR_OBJECTS, .fit = GN_FIT_FITTED}).far, 420, 1);
}

/// The end of stable slices is the scene's diagonal over a whole power of the root of two: never before the farthest object,
/// less than half an octave behind it, and the same while that end moves within a step.
TEST(CascadeFar, StableSlicesEndAtStepsOfHalfAnOctave) {
    const Scene scene = floor_and_house();
    const double diagonal = static_cast<double>(scene.bounds_ws.diagonal());
    double before = 0;
    int steps = 0;
    for (float z = -1; z < 60; z += 0.25F) {
        const double end = static_cast<double>(z) + 30;
        const double far = range_for(scene, {.far = GN_FAR_OBJECTS}, vec3(0, 0.5F, z)).far;
        EXPECT_GE(far, end) << z;
        EXPECT_LE(far, 1.4143 * end) << z;
        const double halves = 2 * std::log2(diagonal / far);
        EXPECT_NEAR(halves, std::round(halves), 1e-6) << z;
        steps += before != 0 && far != before ? 1 : 0;
        before = far;
    }
    // From 29 to 90 metres the end moves by 3.3 half octaves.
    EXPECT_GE(steps, 3);
    EXPECT_LE(steps, 4);
}

/// In the courtyard, seen from under the arcade towards the wall: every sample lies before the last end and in the map that
/// serves it; stable windows that the cut made smaller leave V where the camera's steps are small, to the bit.
TEST(CascadesRendered, CutSlicesHoldEverySampleAndStandStill) {
    Scene scene = with_hard_sun("courtyard");
    SceneGpu gpu = upload_scene(device(), scene);
    Camera camera = scene.camera("");
    camera.far = 10 * scene.bounds_ws.diagonal();
    for (const char* fit : {"plain", "fitted", "stable"}) {
        const std::string recipe = fmt::format(
            "hard,resolution=512,placement=cascades,cascades.transition=none,cascades.fit={},cascades.far=objects",
            fit);
        const Rendered frame = render(gpu, camera, camera, recipe);
        const float last = frame.data.ends[3] * (1 + 1e-5F);
        for (std::size_t p = 0; p < frame.samples.position_ws.size(); ++p) {
            if (frame.samples.position_ws[p].w > 0) {
                GnReceiver receiver = receiver_at(frame.samples.normal_ws[p].w);
                receiver.p_ws = vec3(frame.samples.position_ws[p]);
                ASSERT_LE(receiver.view_depth, last) << fit;
                const auto view = static_cast<std::size_t>(glsl::gn_cascades_choose(receiver, frame.data).first);
                const vec4 p_cs = gn_clip(frame.views[view], receiver.p_ws);
                ASSERT_LT(std::max(std::abs(p_cs.x), std::abs(p_cs.y)), 1) << fit;
            }
        }
    }
    const std::string stable =
        "pcf,resolution=512,placement=cascades,cascades.transition=none,cascades.far=objects,cascades.count=3";
    const Rendered still = render(gpu, camera, camera, stable);
    for (const vec3 step : {vec3(0.003F, 0, 0), vec3(0.01F, 0.004F, -0.02F)}) {
        const Rendered other = render(gpu, camera, moved(camera, step), stable);
        EXPECT_EQ(differing(still.visibility, other.visibility), 0U) << step.x;
    }
}

}  // namespace
}  // namespace gn::far_test
