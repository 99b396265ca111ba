// SPDX-License-Identifier: MIT
// Views made from the samples: what they hold, and what they are worth.
#include "tests/cascade_frame.h"

namespace gn {
namespace {

using namespace cascades;
using namespace test;
using glsl::GnChoice;
using glsl::GnProjected;
using glsl::GnReceiver;

/// Every counted sample lies inside the view that serves it, kernel included, with a depth inside its range.
TEST(CascadesRendered, SampleDistributionViewsHoldEverySample) {
    const Scene scene = load_scene("corridor");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const Camera& camera = scene.camera("");
    for (const char* split : {"sdsm-minmax", "sdsm-histogram", "sdsm-minmax,cascades.select=projection"}) {
        const std::string text = std::string("pcf,resolution=256,placement=cascades,cascades.split=") + split;
        const Rendered frame = render(gpu, camera, camera, text);
        const float limit = 1 - 2 * guard_of(load_recipe(text)).texels / 256 + 1e-4F;
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
}  // namespace gn
