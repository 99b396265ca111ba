// SPDX-License-Identifier: MIT
// Each slice's map warped: one slice is lispsm's map, receivers are inside, depth stays linear, errors fall.
#include "tests/cascade_frame.h"
#include "tests/warp_scene.h"

namespace gn::warped_test {
namespace {

using namespace cascades;
using namespace test;

constexpr const char* warped = "pcf,placement=cascades,cascades.fit=warped";

TEST(CascadesWarped, OneSliceIsTheMapOfLispsm) {
    for (const char* name : {"corridor", "courtyard"}) {
        const Scene scene = load_scene(name);
        const LightViews one = place(scene, std::string(warped) + ",cascades.count=1");
        const LightViews whole = place(scene, "pcf,placement=lispsm");
        ASSERT_EQ(one.views.size(), 1U);
        const Camera& camera = scene.cameras[0];
        for (const ConvexBody& body : {body_of(camera, 1, 0.5, 5), body_of(camera, 1, 5, 20)}) {
            for (const dvec3& p : body.vertices()) {
                // To a tenth of a texel: slices overlap by a hundred-thousandth of their length.
                EXPECT_LT(1024 * glm::length(uv_of(one.views[0], p) - uv_of(whole.views[0], p)), 0.1) << name;
            }
        }
    }
}

TEST(CascadesWarped, ReceiversLieInsideTheirMapsWithLinearDepth) {
    const Scene& scene = test::built_in("corridor");
    SceneGpu gpu = upload_scene(device(), scene);
    const Camera& camera = scene.camera("");
    for (const char* transition : {"none", "blend", "dither"}) {
        const std::string text = std::string(warped) + ",resolution=512,cascades.transition=" + transition;
        const Rendered frame = render(gpu, camera, camera, text);
        const Guard guard = guard_of(load_recipe(text), {}, {});
        const float limit = 1 - 2 * guard.texels / 512 + 1e-4F;
        std::vector<int> served(4, 0);
        for (std::size_t i = 0; i < frame.samples.position_ws.size(); ++i) {
            const vec3 p_ws(frame.samples.position_ws[i]);
            if (frame.samples.position_ws[i].w == 0) {
                continue;
            }
            glsl::GnReceiver receiver = receiver_at(frame.samples.normal_ws[i].w);
            receiver.p_ws = p_ws;
            const glsl::GnChoice choice = glsl::gn_cascades_choose(receiver, frame.data);
            for (const int index : {choice.first, choice.second}) {
                if (index < 0) {
                    continue;
                }
                const GnLightView& view = frame.views[static_cast<std::size_t>(index)];
                const vec4 p_cs = gn_clip(view, p_ws);
                ASSERT_GT(p_cs.w, 0);
                ASSERT_LE(std::max(std::abs(p_cs.x), std::abs(p_cs.y)) / p_cs.w, limit) << transition << index;
                const float depth = glm::dot(view.depth_from_ws, vec4(p_ws, 1));
                ASSERT_GT(depth, 0) << transition << index;
                ASSERT_LT(depth, 1) << transition << index;
                ++served[static_cast<std::size_t>(index)];
            }
        }
        EXPECT_GT(*std::min_element(served.begin(), served.end()), 0) << transition;
        for (const GnLightView& view : frame.views) {
            // A metre along the light is the same step of depth everywhere, and no step on the map.
            const vec3 ray = -vec3(view.eye_ws);
            EXPECT_NEAR(glm::dot(vec3(view.depth_from_ws), ray) * view.metres_per_depth, 1, 1e-5);
            EXPECT_LT(glm::length(uv_of(view, camera.position_ws) - uv_of(view, camera.position_ws + ray)), 1e-4);
        }
    }
}

TEST(CascadesWarped, CulledCastersChangeNoTexel) {
    const Scene& scene = test::built_in("corridor");
    const LightViews views = place(scene, warped);
    ASSERT_EQ(views.casters.size(), 4U);
    EXPECT_LT(views.casters[0].size(), scene.objects.size());
    for (std::size_t i = 0; i < views.views.size(); ++i) {
        for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
            if (std::find(views.casters[i].begin(), views.casters[i].end(), object) != views.casters[i].end()) {
                continue;
            }
            // No vertex of a box left out is inside the map, before its far plane.
            for (const vec3 corner : scene.objects[object].bounds_ws.corners()) {
                const vec4 p_cs = gn_clip(views.views[i], corner);
                const bool on_map = p_cs.w > 0 && std::abs(p_cs.x) <= p_cs.w && std::abs(p_cs.y) <= p_cs.w;
                EXPECT_FALSE(on_map && glm::dot(views.views[i].depth_from_ws, vec4(corner, 1)) <= 1);
            }
        }
    }
}

/// A light overhead of a long view: what warping is for.
TEST(CascadesWarped, LowersTheErrorOfTheCorridor) {
    const ComparisonOptions options{.width = 480, .height = 270, .samples = 1};
    for (const char* count : {"1", "2", "4"}) {
        const std::string recipe = std::string("pcf,placement=cascades,cascades.count=") + count + ",cascades.fit=";
        const double plain = *compare("corridor", recipe + "fitted", options).errors.rmse;
        const double with_warp = *compare("corridor", recipe + "warped", options).errors.rmse;
        EXPECT_LT(with_warp, 0.95 * plain) << count;
    }
}

TEST(CascadesWarped, IsRefusedWithAChoiceByProjection) {
    const Scene& scene = test::built_in("corridor");
    const Recipe recipe = load_recipe(std::string(warped) + ",cascades.select=projection");
    EXPECT_THROW(check_recipe(recipe, scene, scene.lights[0], device()), Refusal);
}

}  // namespace
}  // namespace gn::warped_test
