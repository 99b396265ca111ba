// SPDX-License-Identifier: MIT
// Views made from the samples: what they hold, and what they are worth.
#include "tests/cascade_frame.h"

#include <algorithm>

namespace gn::sdsm_test {
namespace {

using namespace cascades;
using namespace test;
using glsl::GnChoice;
using glsl::GnProjected;
using glsl::GnReceiver;

/// Every counted sample lies inside the view that serves it, kernel included, with a depth inside its range.
TEST(CascadesRendered, SampleDistributionViewsHoldEverySample) {
    const Scene& scene = test::built_in("corridor");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const Camera& camera = scene.camera("");
    for (const char* split : {"sdsm-minmax", "sdsm-histogram", "sdsm-minmax,cascades.select=projection"}) {
        const std::string text = std::string("pcf,resolution=256,placement=cascades,cascades.split=") + split;
        const Rendered frame = render(gpu, camera, camera, text);
        const float limit = 1 - 2 * guard_of(load_recipe(text), {}, {}).texels / 256 + 1e-4F;
        std::vector<int> served(4, 0);
        for (std::size_t p = 0; p < frame.samples.position_ws.size(); ++p) {
            const vec3 p_ws(frame.samples.position_ws[p]);
            const vec3 n_ws(frame.samples.normal_ws[p]);
            if (frame.samples.position_ws[p].w == 0 || !gn_counted(scene.lights[0].shape, p_ws, n_ws)) {
                continue;
            }
            GnReceiver receiver = receiver_at(frame.samples.normal_ws[p].w);
            receiver.p_ws = p_ws;
            const GnChoice choice = glsl::gn_cascades_choose(receiver, frame.data);
            for (const int view : {choice.first, choice.second}) {
                if (view >= 0) {
                    const GnLightView& chosen = frame.views[static_cast<std::size_t>(view)];
                    const vec4 p_cs = gn_clip(chosen, p_ws);
                    ASSERT_LE(std::max(std::abs(p_cs.x), std::abs(p_cs.y)), limit) << split << " view " << view;
                    const float depth = glm::dot(chosen.depth_from_ws, vec4(p_ws, 1));
                    ASSERT_GT(depth, 0) << split << " view " << view;
                    ASSERT_LT(depth, 1) << split << " view " << view;
                    ++served[static_cast<std::size_t>(view)];
                }
            }
        }
        EXPECT_GT(*std::min_element(served.begin(), served.end()), 0) << split;
    }
}

/// Of six turns the box of least area is taken: never larger than the one that faces the camera, and often smaller.
TEST(CascadesRendered, SampleDistributionBoxesTurnToTheLeastArea) {
    const Scene& scene = test::built_in("courtyard");
    SceneGpu gpu = upload_scene(device(), scene);
    const std::string text =
        "hard,resolution=256,placement=cascades,cascades.split=sdsm-minmax,cascades.transition=none";
    const double share = static_cast<double>(guard_of(load_recipe(text), {}, {}).texels) / 256;
    double least_ratio = 1;
    for (const Camera& camera : scene.cameras) {
        const Rendered frame = render(gpu, camera, camera, text);
        const LightFrame axes = facing(camera, scene.lights[0].shape);
        std::array<Box, 4> boxes;
        for (std::size_t p = 0; p < frame.samples.position_ws.size(); ++p) {
            const vec3 p_ws(frame.samples.position_ws[p]);
            if (frame.samples.position_ws[p].w > 0 &&
                gn_counted(scene.lights[0].shape, p_ws, vec3(frame.samples.normal_ws[p]))) {
                const GnChoice choice = glsl::gn_cascades_choose(receiver_at(frame.samples.normal_ws[p].w), frame.data);
                const dvec3 at(p_ws);
                boxes[static_cast<std::size_t>(choice.first)].grow(
                    vec3(glm::dot(axes.x, at), glm::dot(axes.y, at), glm::dot(axes.z, at)));
            }
        }
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            if (boxes[i].empty()) {
                continue;
            }
            const dvec2 sides = glm::max(dvec2(boxes[i].extent()) / (1 - 2 * share), dvec2(1e-3));
            const mat4& m = frame.views[i].cs_from_ws;
            const double area =
                4 / static_cast<double>(glm::length(glsl::gn_row(m, 0)) * glm::length(glsl::gn_row(m, 1)));
            EXPECT_LE(area, 1.01 * sides.x * sides.y) << camera.name << " cascade " << i;
            least_ratio = std::min(least_ratio, area / (sides.x * sides.y));
        }
    }
    EXPECT_LT(least_ratio, 0.8);
}

/// Casters are culled before the samples are known: what is left out lies outside of all the views that they chose.
TEST(CascadesRendered, SampleDistributionCastersAreCulledSafely) {
    const Scene& scene = test::built_in("corridor");
    SceneGpu gpu = upload_scene(device(), scene);
    const Camera& camera = scene.camera("middle");
    for (const char* split : {"sdsm-minmax", "sdsm-histogram"}) {
        const Rendered frame =
            render(gpu, camera, camera, std::string("pcf,resolution=256,placement=cascades,cascades.split=") + split);
        ASSERT_EQ(frame.casters.size(), frame.views.size());
        for (std::size_t i = 0; i < frame.views.size(); ++i) {
            EXPECT_LT(frame.casters[i].size(), scene.objects.size()) << split;
            const std::vector<std::uint32_t> needed = casters_of(scene, frame.views[i]);
            EXPECT_GT(needed.size(), 0U);
            EXPECT_TRUE(std::includes(frame.casters[i].begin(), frame.casters[i].end(), needed.begin(), needed.end()))
                << split << " cascade " << i;
        }
    }
}

/// At the size that pictures are compared at; a coarser picture blurs the finer maps' lead. The wrong samples lie along
/// edges, in bands as wide as a texel: texels half as large halve them, and take their root mean square down by a root.
TEST(CascadesRendered, SampleDistributionHalvesTheWrongSamplesOfPracticalSplits) {
    const ComparisonOptions options{.width = 640, .height = 360, .samples = 1};
    const Errors practical = compare("corridor", "pcf,placement=cascades", options).errors;
    for (const char* split : {"sdsm-minmax", "sdsm-histogram"}) {
        const Errors sdsm =
            compare("corridor", std::string("pcf,placement=cascades,cascades.split=") + split, options).errors;
        EXPECT_LE(*sdsm.mismatch, 0.5 * *practical.mismatch) << split;
        EXPECT_LE(*sdsm.rmse, std::sqrt(0.5) * *practical.rmse) << split;
    }
}

}  // namespace
}  // namespace gn::sdsm_test
