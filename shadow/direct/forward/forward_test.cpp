// SPDX-License-Identifier: MIT
#include "shadow/direct/forward/forward.glsl"

#include "shadow/geometry/convex_body.h"
#include "shadow/placement/light_views.h"
#include "tests/rig.h"

#include <random>

namespace gn::forward_test {
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

TEST(Forward, MissingTexelsBeyondAViewAreKnown) {
    for (const int radius : {1, 2, 5}) {
        for (float at = 0; at <= 20; at += 0.13F) {
            float within = 0;
            for (int texel = 0; texel < 20; ++texel) {
                within += gn_forward_weight(vec2(at - (static_cast<float>(texel) + 0.5F), 0), radius) *
                          static_cast<float>(radius);
            }
            EXPECT_NEAR(gn_forward_share(at, 0, 20, radius), within, 1e-5) << radius << " at " << at;
        }
    }
}

TEST(Forward, ATexelReturnsToWhereItWasSeen) {
    GnLight spot;
    spot.kind = GN_LIGHT_SPOT;
    spot.position_ws = vec4(1, 9, 2, 1);
    spot.direction_ws = vec4(normalize(vec3(0.2F, -1, 0.1F)), 0);
    const Fitted fitted = fit_perspective(body_of(Box{vec3(-1, 0, -1), vec3(4, 1, 3)}), spot, 512, {});
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
        // In 32 bits it strays by no more than a small part of the way to the next texel.
        const vec3 next_ws =
            gn_forward_position(view, uv_ts + vec2(1.0F / 512, 0), dot(view.depth_from_ws, vec4(p_ws, 1)));
        ASSERT_LT(distance(back_ws, p_ws), 0.1F * distance(back_ws, next_ws)) << i;
    }
}

TEST(ForwardRendered, ConvergesToTheTracedHardShadow) {
    // The blurred rim is as wide as a texel: its squared error halves with every doubling, give or take the staircase.
    for (const char* scene : {"contact", "slab:hard=1", "contact:light=point"}) {
        double coarsest = 0, before = 1, mismatch = 0, edge = 0;
        for (const int resolution : {128, 256, 512, 1024}) {
            const auto c = test::compare(scene, fmt::format("forward,resolution={}", resolution),
                                         {.width = 256, .height = 256, .samples = 1});
            EXPECT_LT(*c.errors.rmse, 0.9 * before) << scene << " at " << resolution;
            before = *c.errors.rmse;
            mismatch = *c.errors.mismatch;
            edge = *c.errors.edge;
            coarsest = resolution == 128 ? mismatch : coarsest;
        }
        EXPECT_LT(mismatch, 0.5 * coarsest) << scene;
        // An edge marks the pixels on both of its sides; at 1024 texels, half a pixel wide, a quarter of them may be wrong.
        EXPECT_LT(mismatch, 0.25 * edge) << scene;
    }
}

TEST(ForwardRendered, LightsAnUnoccludedPlaneWhole) {
    for (const char* options : {"", ",forward.radius=0", ",forward.radius=3"}) {
        for (const char* scene : {"tilted:angle=0", "tilted:angle=60"}) {
            const auto c = test::compare(scene, std::string("forward,resolution=256") + options,
                                         {.width = 96, .height = 96, .samples = 1});
            // Splats add up in steps of 2^-16 and their share is taken out again: a hundred roundings.
            EXPECT_LE(*c.errors.acne, 100.0 / 65536) << scene << options;
            for (const float v : c.visibility().values) {
                ASSERT_TRUE(v >= 0 && v <= 1) << v;
            }
        }
    }
}

}  // namespace
}  // namespace gn::forward_test
