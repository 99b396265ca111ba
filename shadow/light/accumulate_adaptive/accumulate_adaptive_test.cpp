// SPDX-License-Identifier: MIT
// As exact as the whole grid where it must be, with fewer shadows where penumbrae are narrow.
#include "shadow/frame/history.h"
#include "shadow/light/accumulate_adaptive/light_tree.h"
#include "tests/direct_scenes.h"
#include "tests/rig.h"

#include <set>

namespace gn::accumulate_adaptive_test {
namespace {

constexpr uint width = 96, height = 72;

Scene scene_under(float half_size) {
    GnLight panel = by_hand::rectangle({-1, 3.5F, 1.5F}, {0, 0, 0});
    panel.half_size = vec2(half_size);
    return by_hand::SceneBuilder()
        .ground(6)
        .box({-0.6F, 0.8F, -0.5F}, {0.5F, 1.3F, 0.6F})
        .light(panel)
        .camera({0.5F, 4, 5}, {0, 0.4F, 0})
        .scene();
}

struct Sequence {
    std::vector<float> v;              ///< of the last frame
    std::vector<std::size_t> shadows;  ///< that each frame drew
};

/// Frames of a still camera.
Sequence draw(const Scene& scene, const std::string& recipe, int frames) {
    const test::ValidationGuard guard;
    SceneGpu gpu = upload_scene(test::device(), scene);
    const PreparedRecipe prepared(test::device(), load_recipe(recipe));
    History history(test::device());
    Sequence sequence;
    for (int i = 0; i < frames; ++i) {
        const FrameResult frame = render_frame(gpu, scene.camera(""), prepared,
                                               {.width = width,
                                                .height = height,
                                                .only_light = 0,
                                                .picture = false,
                                                .history = frames > 1 ? &history : nullptr});
        EXPECT_EQ(frame.refused.front(), "");
        sequence.v = frame.visibility.front().values;
        sequence.shadows.push_back(
            static_cast<std::size_t>(std::count_if(frame.statistics.passes.begin(), frame.statistics.passes.end(),
                                                   [](const PassTime& pass) { return pass.name == "light: add"; })));
    }
    return sequence;
}

constexpr const char* maps = ",resolution=128";

std::string adaptive(float threshold, int levels = 3) {
    return fmt::format(
        "hard,light=accumulate-adaptive,accumulate-adaptive.levels={},accumulate-adaptive.threshold={}{}", levels,
        threshold, maps);
}

double difference(const std::vector<float>& a, const std::vector<float>& b) {
    double squares = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        squares += (static_cast<double>(a[i]) - b[i]) * (static_cast<double>(a[i]) - b[i]);
    }
    return std::sqrt(squares / static_cast<double>(a.size()));
}

TEST(LightTree, CellsOfALevelAreTheFirstPointsOfTheSequence) {
    for (const int level : {1, 2, 4}) {
        const std::vector<TreeLeaf> leaves = leaves_of(divided_to(level, 5));
        std::set<std::uint32_t> points;
        for (const TreeLeaf& leaf : leaves) {
            points.insert(leaf.point);
            EXPECT_EQ(leaf.share, 1.0F / static_cast<float>(leaves.size()));
        }
        EXPECT_EQ(leaves.size(), std::size_t{1} << (2 * level));
        EXPECT_EQ(points.size(), leaves.size());
        EXPECT_EQ(*points.rbegin(), leaves.size() - 1);
    }
}

TEST(LightTree, PartsAreDividedWhereTheirParentsFourDisagree) {
    // The light and one quarter are divided; both disagree enough, and a quarter that was not divided is asked for nothing.
    SeenTree seen{divided_to(1, 3), std::vector<std::uint32_t>(21, 0)};
    seen.tree.divided[tree_cell(1, uvec2(1, 0))] = true;
    seen.disagree[tree_cell(0, uvec2(0))] = 10;
    seen.disagree[tree_cell(1, uvec2(1, 0))] = 10;
    seen.disagree[tree_cell(1, uvec2(0, 1))] = 99;
    const LightTree next = refined(seen, 10);
    std::size_t quarters = 0, sixteenths = 0;
    for (std::uint32_t i = 0; i < 16; ++i) {
        quarters += i < 4 && next.divided[tree_cell(1, uvec2(i % 2, i / 2))] ? 1 : 0;
        sixteenths += next.divided[tree_cell(2, uvec2(i % 4, i / 4))] ? 1 : 0;
    }
    EXPECT_EQ(quarters, 4U);
    EXPECT_EQ(sixteenths, 4U);
    EXPECT_TRUE(next.divided[tree_cell(2, uvec2(3, 1))]);
    float shares = 0;
    for (const TreeLeaf& leaf : leaves_of(next)) {
        shares += leaf.share;
    }
    EXPECT_EQ(shares, 1);
    EXPECT_EQ(refined(seen, 11).divided, divided_to(1, 3).divided);
}

TEST(LightTree, EachDividedCellHearsItsFourPartsOnce) {
    SeenTree seen{divided_to(1, 4), std::vector<std::uint32_t>(85, 0)};
    seen.disagree[0] = 1;
    LightTree tree = refined(seen, 1);
    tree.divided[tree_cell(2, uvec2(2, 1))] = true;
    std::map<std::uint32_t, std::vector<char>> heard;
    for (const TreeLeaf& leaf : leaves_of(tree)) {
        for (std::size_t level = 0; level < leaf.parents.size(); ++level) {
            if ((leaf.speaks >> level & 1U) != 0) {
                heard[leaf.parents[level]].push_back((leaf.first >> level & 1U) != 0  ? 'f'
                                                     : (leaf.last >> level & 1U) != 0 ? 'l'
                                                                                      : '-');
            }
        }
    }
    EXPECT_EQ(heard.size(), 6U);
    for (const auto& [cell, who] : heard) {
        EXPECT_EQ(std::string(who.begin(), who.end()), "f--l") << cell;
    }
}

TEST(AccumulateAdaptive, WithoutAThresholdItIsTheWholeGrid) {
    const Scene scene = scene_under(0.5F);
    const Sequence whole = draw(scene, fmt::format("hard,light=accumulate,accumulate.lights=64{}", maps), 1);
    const Sequence zero = draw(scene, adaptive(0), 4);
    EXPECT_EQ(zero.shadows, (std::vector<std::size_t>{4, 16, 64, 64}));
    EXPECT_EQ(zero.v, whole.v);
    // A single frame has nobody to learn from.
    EXPECT_EQ(draw(scene, adaptive(0.5F), 1).v, whole.v);
}

TEST(AccumulateAdaptive, NarrowPenumbraeTakeFewerShadowsThanWideOnes) {
    // Once the tree stands still, after as many frames as it has levels.
    const Sequence narrow = draw(scene_under(0.03F), adaptive(0.01F), 4),
                   wide = draw(scene_under(1), adaptive(0.01F), 4);
    EXPECT_LE(narrow.shadows.back(), 16U);
    EXPECT_GE(wide.shadows.back(), 40U);
    EXPECT_LT(difference(narrow.v, draw(scene_under(0.03F), adaptive(0), 4).v), 0.02);
}

TEST(AccumulateAdaptive, TheErrorGrowsWithTheThreshold) {
    const Scene scene = scene_under(0.5F);
    const std::vector<float> whole = draw(scene, adaptive(0), 4).v;
    double before = 0;
    std::size_t shadows = 64;
    // All of 64 points, some of them, 16 alike, four.
    for (const float threshold : {0.003F, 0.01F, 0.012F, 0.3F}) {
        const Sequence some = draw(scene, adaptive(threshold), 4);
        const double error = difference(some.v, whole);
        EXPECT_GE(error, before) << threshold;
        EXPECT_LE(some.shadows.back(), shadows) << threshold;
        before = error;
        shadows = some.shadows.back();
    }
    EXPECT_EQ(shadows, 4U);
    EXPECT_GT(before, 0.01);
}

}  // namespace
}  // namespace gn::accumulate_adaptive_test
