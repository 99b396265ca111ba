// SPDX-License-Identifier: MIT
#include "shadow/direct/forward/forward.glsl"

#include "shadow/placement/receivers.h"
#include "tests/rig.h"

#include <random>

namespace gn {
namespace {

using namespace gn::glsl;

TEST(Forward, SplatsOfALitSurfaceAddUpToOne) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int radius = 0; radius <= 8; ++radius) {
        for (int i = 0; i < 50; ++i) {
            const vec2 p(uniform(random), uniform(random));
            float sum = 0;
            for (int y = -10; y <= 10; ++y) {
                for (int x = -10; x <= 10; ++x) {
                    sum += gn_forward_weight(p - vec2(x, y), radius);
                }
            }
            EXPECT_NEAR(sum, 1, 1e-4) << radius;
        }
    }
}

TEST(Forward, ATexelReturnsToWhereItWasSeen) {
    GnLight spot;
    spot.kind = GN_LIGHT_SPOT;
    spot.position_ws = vec4(1, 9, 2, 1);
    spot.direction_ws = vec4(normalize(vec3(0.2F, -1, 0.1F)), 0);
    const Fitted fitted =
        fit_perspective(body_of(Box{vec3(-1, 0, -1), vec3(4, 1, 3)}), spot, Box{vec3(-5), vec3(5)}, 512, {});
    ASSERT_TRUE(fitted.valid);
    const GnLightView& view = fitted.view;
    std::mt19937 random(6);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int i = 0; i < 100; ++i) {
        const vec3 p_ws(uniform(random) * 4 - 0.5F, uniform(random), uniform(random) * 3 - 0.5F);
        const vec4 p_cs = view.cs_from_ws * vec4(p_ws, 1);
        const vec2 uv_ts =
            vec2(view.rect_ts) + (vec2(p_cs) / p_cs.w * 0.5F + 0.5F) * vec2(view.rect_ts.z, view.rect_ts.w);
        const vec3 back_ws = gn_forward_position(view, uv_ts, dot(view.depth_from_ws, vec4(p_ws, 1)));
        // A texel is a centimetre wide here; its position must not stray to a neighbour.
        ASSERT_LT(distance(back_ws, p_ws), 1e-3) << i;
    }
}

TEST(ForwardRendered, ConvergesToTheTracedHardShadow) {
    for (const char* scene : {"contact", "slab:hard=1", "contact:light=point"}) {
        double before = 1;
        for (const int resolution : {128, 256, 512, 1024}) {
            const auto c = test::compare(scene, fmt::format("forward,resolution={}", resolution),
                                         {.width = 256, .height = 256, .samples = 1});
            const double noise = 3 * std::sqrt(*c.errors.mismatch / static_cast<double>(c.errors.samples));
            EXPECT_LT(*c.errors.mismatch, 0.75 * before + noise) << scene << " at " << resolution;
            before = *c.errors.mismatch;
        }
        EXPECT_LT(before, 0.01) << scene;
    }
}

TEST(ForwardRendered, LightsAnUnoccludedPlaneWhole) {
    for (const char* options : {"", ",forward.radius=0", ",forward.radius=3"}) {
        for (const char* scene : {"tilted:angle=0", "tilted:angle=60"}) {
            const auto c = test::compare(scene, std::string("forward,resolution=256") + options,
                                         {.width = 96, .height = 96, .samples = 1});
            EXPECT_LE(*c.errors.acne, 0.02) << scene << options;
            for (const float v : c.visibility().values) {
                ASSERT_TRUE(v >= 0 && v <= 1) << v;
            }
        }
    }
}

}  // namespace
}  // namespace gn
