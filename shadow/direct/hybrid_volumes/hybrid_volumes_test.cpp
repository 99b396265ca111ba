// SPDX-License-Identifier: MIT
#include "tests/rig.h"

#include <gtest/gtest.h>

namespace gn::hybrid_volumes_test {
namespace {

std::vector<float> visibility(const Scene& scene, const std::string& recipe) {
    return test::compare(scene, recipe, {.width = 160, .height = 120, .samples = 1}).visibility().values;
}

// How many of the pixels around one differ from it in V.
int differing(const std::vector<float>& v, int x, int y, int reach) {
    int count = 0;
    for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
            const int at = std::clamp(y + dy, 0, 119) * 160 + std::clamp(x + dx, 0, 159);
            count += v[static_cast<std::size_t>(at)] != v[static_cast<std::size_t>(y * 160 + x)] ? 1 : 0;
        }
    }
    return count;
}

TEST(HybridVolumes, are_volumes_at_the_edges_of_the_map_and_the_map_elsewhere) {
    // A texel is a few pixels wide.
    for (const char* name : {"stack", "contact:light=point", "slab:hard=1"}) {
        const Scene scene = load_scene(name);
        const auto map = visibility(scene, "hard,resolution=64"), volumes = visibility(scene, "volumes");
        const auto both = visibility(scene, "hybrid-volumes,resolution=64");
        int of_map = 0, of_volumes = 0, far_from_edges = 0;
        for (int i = 0; i < 160 * 120; ++i) {
            const auto at = static_cast<std::size_t>(i);
            // Each sample has one of both; where they differ, the map's word counts only where its neighbours agree.
            EXPECT_TRUE(both[at] == map[at] || both[at] == volumes[at]) << name << " at " << i;
            of_map += both[at] != volumes[at] ? 1 : 0;
            of_volumes += both[at] != map[at] ? 1 : 0;
            if (differing(map, i % 160, i / 160, 16) == 0) {
                EXPECT_EQ(both[at], map[at]) << name << " at " << i;
                ++far_from_edges;
            }
        }
        EXPECT_GT(far_from_edges, 1000) << name;
        EXPECT_GT(of_volumes, 100) << name;
        EXPECT_LT(of_map, of_volumes / 10) << name;
    }
}

TEST(HybridVolumes, a_wider_band_finds_what_a_narrow_one_misses) {
    double before = 1;
    for (const int band : {1, 4}) {
        const auto c = test::compare("fence", fmt::format("hybrid-volumes,resolution=256,hybrid-volumes.band={}", band),
                                     {.width = 160, .height = 120, .samples = 1});
        EXPECT_LT(*c.errors.mismatch, before) << band;
        before = 0.5 * *c.errors.mismatch;
    }
}

}  // namespace
}  // namespace gn::hybrid_volumes_test
