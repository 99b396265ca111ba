// SPDX-License-Identifier: MIT
// Random meshes of every kind against the traced hard shadow, and sheets that meet at small angles.
#include "tests/random_meshes.h"

#include <gtest/gtest.h>

namespace gn {
namespace parts {
const Part& direct_volumes();
}
namespace volumes_random_test {
namespace {

using namespace by_hand;

class VolumesRandom : public testing::TestWithParam<unsigned> {};

TEST_P(VolumesRandom, equal_the_traced_hard_shadow_away_from_edges) {
    const auto mode_of = [](unsigned seed) { return std::array{"auto", "z-fail", "zp+"}.at(seed % 3); };
    expect_random_meshes_as_traced(
        GetParam(),
        [&](unsigned seed) {
            return direct_recipe(parts::direct_volumes(),
                                 {{"closed", seed % 2 == 0 ? "1" : "0"}, {"mode", mode_of(seed)}});
        },
        mode_of);
}

TEST(VolumesHinge, what_shows_behind_the_back_of_a_sheet_is_in_its_shadow) {
    for (const auto& [angle, wall] : {std::pair{0.001F, false}, {0.001F, true}, {0.01F, false}, {-0.001F, false}}) {
        const Scene scene = hinge(angle, wall);
        for (const char* recipe :
             {"volumes", "volumes,volumes.mode=z-fail", "volumes,volumes.mode=zp+", "split-volumes"}) {
            std::size_t shadowed = 0;
            for (const Comparison& result : render_and_judge(scene, load_recipe(recipe), 120, 90)) {
                EXPECT_EQ(result.wrong, 0U)
                    << recipe << ", angle " << angle << ": of " << result.judged << ", " << result.first;
                shadowed += result.shadowed;
            }
            EXPECT_GT(shadowed, 100U);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, VolumesRandom, testing::Range(0U, mesh_kinds),
                         [](const auto& tested) { return std::string(mesh_kind_name(tested.param)); });

}  // namespace
}  // namespace volumes_random_test
}  // namespace gn
