// SPDX-License-Identifier: MIT
// Where the views of successive frames lie in their texels.
#include "shadow/placement/jittered/jittered.glsl"
#include "shadow/frame/history.h"
#include "shadow/placement/place.h"
#include "tests/warp_scene.h"

#include <cmath>

namespace gn::jittered_test {
namespace {

/// Of 64 places the farthest point of a texel has one within an eighth of its side or a little more.
TEST(Jittered, PlacesFillTheTexelEvenly) {
    EXPECT_EQ(glsl::gn_jitter(0), vec2(0));
    double farthest = 0;
    for (int i = 0; i < 32 * 32; ++i) {
        const dvec2 p((i % 32 + 0.5) / 32 - 0.5, (static_cast<double>(i / 32) + 0.5) / 32 - 0.5);
        double nearest = 1;
        for (uint k = 0; k < 64; ++k) {
            const dvec2 q(glsl::gn_jitter(k));
            EXPECT_LE(std::max(std::abs(q.x), std::abs(q.y)), 0.5);
            const dvec2 d = glm::abs(p - q);
            const dvec2 around = glm::min(d, 1.0 - d);
            nearest = std::min(nearest, std::max(around.x, around.y));
        }
        farthest = std::max(farthest, nearest);
    }
    EXPECT_LT(farthest, 0.125);
}

/// A point's place on the map moves by the jitter, in texels, and its depth does not; the same for every kind of view.
TEST(Jittered, EveryViewMovesByTheJitterInTexels) {
    Scene scene = test::long_floor(2, 60, vec3(0.3F, 1, 0.2F));
    for (const uint kind : {GN_LIGHT_DIRECTIONAL, GN_LIGHT_SPOT}) {
        GnLight& light = scene.lights[0].shape;
        light.kind = kind;
        light.position_ws = vec4(0, 60, -30, 1);
        light.cos_outer = std::cos(0.6F);
        light.direction_ws = kind == GN_LIGHT_SPOT ? vec4(0, -1, 0, 0) : light.direction_ws;
        for (const std::string of : {"fit", "lispsm", "cube"}) {
            if (of == "cube" && kind == GN_LIGHT_DIRECTIONAL) {
                EXPECT_THROW(check_recipe(load_recipe("hard,placement=jittered,jittered.of=cube"), scene,
                                          scene.lights[0], test::device()),
                             Refusal);
                continue;
            }
            History history(test::device());
            for (uint frame = 0; frame < 5; ++frame) {
                FrameGraph graph(test::device());
                const SceneHandles handles;
                const ViewSamples samples{.width = 64, .height = 64, .camera = scene.cameras.front()};
                const FrameInput input{test::device(),      graph, scene,   handles, samples,
                                       scene.lights.data(), 0,     &history};
                const LightViews moved = place_views(
                    input, load_recipe(fmt::format("hard,placement=jittered,jittered.of={},resolution=512", of)));
                const LightViews rests =
                    place_views(input, load_recipe(fmt::format("hard,placement={},resolution=512", of)));
                ASSERT_EQ(moved.views.size(), rests.views.size());
                EXPECT_EQ(moved.views[0].depth_from_ws, rests.views[0].depth_from_ws);
                const std::size_t view = of == "cube" ? 3 : 0;  // the face that looks down
                const dvec3 p_ws(1, 0, -20);
                const dvec2 change = test::uv_of(moved.views[view], p_ws) - test::uv_of(rests.views[view], p_ws);
                const dvec2 expected = dvec2(glsl::gn_jitter(frame));
                EXPECT_NEAR(change.x * 512, expected.x, 0.01) << of << " frame " << frame;
                EXPECT_NEAR(change.y * 512, expected.y, 0.01) << of << " frame " << frame;
                history.advance();
            }
        }
    }
}

}  // namespace
}  // namespace gn::jittered_test
