// SPDX-License-Identifier: MIT
#include "shadow/placement/receivers.h"
#include "tests/warp_scene.h"

namespace gn {
namespace {

TEST(Fit, EveryViewSampleProjectsInsideTheMap) {
    for (const char* name : {"contact", "half-plane", "corridor", "duel"}) {
        const Scene scene = load_scene(name);
        SceneGpu gpu = upload_scene(test::device(), scene);
        const CpuSamples cpu = render_samples(test::device(), gpu, scene.cameras[0], 64, 64);
        FrameGraph graph(test::device());
        const SceneHandles handles;
        const ViewSamples samples{.width = 64, .height = 64, .camera = scene.cameras[0]};
        const FrameInput input{test::device(), graph, scene, handles, samples, nullptr, 0};
        const Recipe recipe = load_recipe("hard,placement=fit");
        const LightViews views = recipe.placement->place(input, recipe);
        for (std::size_t i = 0; i < cpu.position_ws.size() && views.views.size() == 1; ++i) {
            const vec3 p_ws(cpu.position_ws[i]);
            if (cpu.position_ws[i].w < 0.5F || !gn_counted(scene.lights[0].shape, p_ws, vec3(cpu.normal_ws[i]))) {
                continue;
            }
            const vec4 p_cs = views.views[0].cs_from_ws * vec4(p_ws, 1);
            ASSERT_GT(p_cs.w, 0) << name;
            ASSERT_LE(std::max(std::abs(p_cs.x), std::abs(p_cs.y)) / p_cs.w, 1.0F) << name << " sample " << i;
        }
    }
}

/// A caster between the light and the fitted near plane still casts.
TEST(Fit, CasterBeforeTheNearPlaneStillCasts) {
    Scene scene = load_scene("contact");
    // Look only at the ground behind the box, so that the box itself is no receiver and lies nearer to the light.
    const auto c = test::compare(scene, "hard,resolution=1024");
    std::size_t shadowed = 0;
    for (std::size_t i = 0; i < c.truth.visibility.size(); ++i) {
        shadowed += c.truth.counted[i] != 0 && c.truth.visibility[i] == 0 ? 1 : 0;
    }
    EXPECT_GT(shadowed, 200U);
    EXPECT_LT(*c.errors.leak, 0.05);
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
}  // namespace gn
