// SPDX-License-Identifier: MIT
// It changes nothing of V, and answers with the least of the radii that the lookup tells.
#include "shadow/frame/history.h"
#include "shadow/show/show.h"
#include "tests/rig.h"

#include <algorithm>
#include <bit>

namespace gn::smallest_radius_test {
namespace {

TEST(SmallestRadius, IsTheLeastThatIsToldAndVStays) {
    const test::ValidationGuard guard;
    const Scene& scene = test::built_in("slab");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameOptions plain{.width = 83, .height = 61, .only_light = 0, .samples = false, .picture = false};
    History history(test::device());
    FrameOptions measured = plain;
    measured.history = &history;
    const FrameResult with =
        render_frame(test::device(), gpu, scene.camera(""), load_recipe("pcss,visibility=smallest-radius"), measured);
    const FrameResult without = render_frame(test::device(), gpu, scene.camera(""), load_recipe("pcss"), plain);
    EXPECT_EQ(with.visibility[0].values, without.visibility[0].values);

    const std::vector<std::string> name{"filter-radius"};
    const Shown told =
        show_hidden(test::device(), gpu, scene.camera(""), load_recipe("pcss"), name, {.width = 83, .height = 61})
            .front();
    float least = 3e38F;
    int positive = 0;
    for (std::size_t i = 0; i < told.values.pixels(); ++i) {
        const float radius = told.values.values[2 * i];
        least = radius > 0 ? std::min(least, radius) : least;
        positive += radius > 0 ? 1 : 0;
    }
    EXPECT_GT(positive, 100);
    EXPECT_EQ(std::bit_cast<float>(*history.answered("smallest filter of light 0")), least);
}

}  // namespace
}  // namespace gn::smallest_radius_test
