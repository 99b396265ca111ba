// SPDX-License-Identifier: MIT

#include "tests/warp_scene.h"

namespace gn::fit_test {
namespace {

/// The camera that the scene has, and one a step aside that is turned a little.
std::vector<Camera> cameras_of(const Scene& scene) {
    Camera other = scene.cameras[0];
    other.position_ws += vec3(0.2F, 0.1F, -0.3F);
    other.forward_ws = glm::normalize(other.forward_ws + vec3(0.1F, -0.05F, 0.0F));
    return {scene.cameras[0], other};
}

TEST(Fit, EveryViewSampleProjectsInsideTheMap) {
    std::size_t single_views = 0;
    for (const char* name :
         {"contact", "contact:light=spot", "contact:light=point", "half-plane", "corridor", "duel"}) {
        const Scene scene = load_scene(name);
        SceneGpu gpu = upload_scene(test::device(), scene);
        for (const Camera& camera : cameras_of(scene)) {
            const LightViews views = test::place(scene, "hard,placement=fit", 64, 64, &camera);
            if (views.views.size() != 1) {
                continue;
            }
            ++single_views;
            const CpuSamples cpu = render_samples(test::device(), gpu, camera, 64, 64);
            std::size_t counted = 0;
            for (std::size_t i = 0; i < cpu.position_ws.size(); ++i) {
                const vec3 p_ws(cpu.position_ws[i]);
                if (cpu.position_ws[i].w < 0.5F || !gn_counted(scene.lights[0].shape, p_ws, vec3(cpu.normal_ws[i]))) {
                    continue;
                }
                ++counted;
                const vec4 p_cs = views.views[0].cs_from_ws * vec4(p_ws, 1);
                ASSERT_GT(p_cs.w, 0) << name;
                ASSERT_LE(std::max(std::abs(p_cs.x), std::abs(p_cs.y)) / p_cs.w, 1.0F) << name << " sample " << i;
                const float depth = glm::dot(views.views[0].depth_from_ws, vec4(p_ws, 1));
                ASSERT_TRUE(depth > 0 && depth < 1) << name << " sample " << i << " at depth " << depth;
            }
            EXPECT_GT(counted, 500U) << name;
        }
    }
    // Only lights that the receivers surround take six views: here the duel's from inside.
    EXPECT_GE(single_views, 10U);
}

/// [EASW09]: near and far are the fitted body's. A spot far away from a small scene spends its depth on the scene, and a
/// range ends it.
TEST(Fit, DepthOfALightWithAPositionIsTheBodys) {
    const Box box_ws{vec3(-1, 0, -1), vec3(1, 1, 1)};
    Scene scene;
    scene.bounds_ws = box_ws;
    scene.cameras.push_back({.position_ws = vec3(0, 0.5F, 6), .near = 0.1F, .far = 100});
    scene.lights.push_back({"lamp", {}});
    GnLight& shape = scene.lights[0].shape;
    shape.position_ws = vec4(0, 50, 0, 1);
    shape.cos_outer = std::cos(0.5F);
    for (const uint kind : {GN_LIGHT_SPOT, GN_LIGHT_POINT, GN_LIGHT_RECTANGLE}) {
        shape.kind = kind;
        shape.range = 0;
        const LightViews views = test::place(scene, "hard,placement=fit");
        ASSERT_EQ(views.views.size(), 1U);
        // From the top of the box, 49 m away, to its floor: a thousandth of the distance at each end is room, 0.1 m in all.
        EXPECT_NEAR(views.views[0].metres_per_depth, 1, 0.1) << kind;
        EXPECT_NEAR(glm::dot(views.views[0].depth_from_ws, vec4(0, 0, 0, 1)), 1, 0.1) << kind;
        shape.range = 49.5F;
        EXPECT_NEAR(test::place(scene, "hard,placement=fit").views[0].metres_per_depth, 0.5, 0.1) << kind;
    }
}

/// A caster between the light and the fitted near plane still casts: the camera looks at the floor in the shadow of a sheet
/// that it does not see. A texel of the map is a hundredth of the shadow's width here.
TEST(Fit, CasterBeforeTheNearPlaneStillCasts) {
    for (const uint kind : {GN_LIGHT_DIRECTIONAL, GN_LIGHT_SPOT, GN_LIGHT_POINT}) {
        Scene scene = load_scene("contact");
        scene.closed_form = nullptr;
        GnLight& shape = scene.lights[0].shape;
        const auto first = static_cast<uint>(scene.positions_ws.size());
        for (const vec2 corner : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)}) {
            scene.positions_ws.emplace_back(2 + corner.x, 6, 2 + corner.y);
            scene.normals_ws.emplace_back(0, 1, 0);
            scene.uvs.emplace_back(0);
        }
        scene.triangles.emplace_back(first, first + 1, first + 2);
        scene.triangles.emplace_back(first, first + 2, first + 3);
        scene.objects.back().triangle_count += 2;
        shape.kind = kind;
        shape.direction_ws = vec4(0, -1, 0, 0);
        shape.right_ws = vec4(1, 0, 0, 0);
        shape.up_ws = vec4(0, 0, 1, 0);
        shape.position_ws = vec4(2, 12, 2, 1);
        shape.cos_outer = std::cos(0.6F);
        scene.cameras = {
            {.position_ws = vec3(2, 1.5F, 4), .forward_ws = glm::normalize(vec3(0, -1, -1)), .near = 0.1F}};
        finish_scene(scene);
        const LightViews views = test::place(scene, "hard,placement=fit");
        ASSERT_EQ(views.views.size(), 1U);
        EXPECT_LT(glm::dot(views.views[0].depth_from_ws, vec4(2, 6, 2, 1)), 0)
            << "the sheet lies before the near plane";
        const auto c = test::compare(scene, "hard,placement=fit,resolution=1024", {.samples = 1});
        std::size_t shadowed = 0;
        for (std::size_t i = 0; i < c.truth.visibility.size(); ++i) {
            shadowed += c.truth.counted[i] != 0 && c.truth.visibility[i] == 0 ? 1 : 0;
        }
        EXPECT_GT(shadowed, 2000U) << kind;
        EXPECT_EQ(*c.errors.leak, 0) << kind;
    }
}

/// [Sam07] 3.2.1: his lights are spots, each a camera of its own; none of his scenes needs more than one map a light.
TEST(Fit, OneMapServesEverySpotOfVanSambeeksScenes) {
    for (const char* name : {"car", "boxes", "disco-box", "island", "warehouse-inside", "warehouse-outside"}) {
        Scene scene = load_scene(fmt::format("{}:light=spot", name));
        for (std::size_t i = 0; i < scene.lights.size(); ++i) {
            std::swap(scene.lights[0], scene.lights[i]);
            EXPECT_EQ(test::place(scene, "hard,placement=fit").views.size(), 1U) << name << " " << scene.lights[0].name;
        }
    }
}

}  // namespace
}  // namespace gn::fit_test
