// SPDX-License-Identifier: MIT
// What moved since a version: all boxes of the steps between, or the answer that nothing is known.
#include "shadow/scene/moves.h"

#include <gtest/gtest.h>

namespace gn::moves_test {
namespace {

Box box_at(float x) {
    return {vec3(x, 0, 0), vec3(x + 1, 1, 1)};
}

/// The left ends of the boxes since a version; {-1} where anything may differ.
std::vector<float> since(const Moves& moves, std::uint64_t version) {
    const auto touched = moves.since(version);
    std::vector<float> ends;
    for (const Box& box_ws : touched.value_or(std::vector<Box>{{vec3(-1), vec3(0)}})) {
        ends.push_back(box_ws.min.x);
    }
    return ends;
}

using Ends = std::vector<float>;

TEST(Moves, TellsWhatMovedSinceAVersion) {
    Moves moves;
    moves.add(0, 5, {});
    moves.add(5, 7, {{box_at(1), box_at(2)}});
    moves.add(7, 20, {{box_at(3)}});
    EXPECT_EQ(since(moves, 20), Ends{});
    EXPECT_EQ(since(moves, 7), Ends{3});
    EXPECT_EQ(since(moves, 5), (Ends{1, 2, 3}));
    EXPECT_EQ(since(moves, 6), Ends{-1}) << "no version of this geometry";
    EXPECT_EQ(since(moves, 0), Ends{-1}) << "anything differs from what was before the first";
}

TEST(Moves, ForgetsWhatWasBeforeAStepOfWhichNothingIsKnown) {
    Moves moves;
    moves.add(0, 1, {});
    moves.add(1, 2, {{box_at(1)}});
    moves.add(2, 3, {});
    moves.add(3, 4, {{box_at(4)}});
    EXPECT_EQ(since(moves, 1), Ends{-1});
    EXPECT_EQ(since(moves, 2), Ends{-1});
    EXPECT_EQ(since(moves, 3), Ends{4});
    // A version in between that nobody told of is such a step too.
    moves.add(5, 6, {{box_at(6)}});
    EXPECT_EQ(since(moves, 3), Ends{-1});
    EXPECT_EQ(since(moves, 5), Ends{6});
}

TEST(Moves, RemembersOnlySoMuch) {
    Moves moves;
    moves.add(0, 1, {});
    for (std::uint64_t v = 1; v <= Moves::most_steps + 1; ++v) {
        moves.add(v, v + 1, {{box_at(static_cast<float>(v))}});
    }
    EXPECT_EQ(since(moves, 1), Ends{-1});
    EXPECT_EQ(since(moves, 2).size(), Moves::most_steps);
    moves.add(Moves::most_steps + 2, 1000, std::vector<Box>(Moves::most_boxes + 1, box_at(0)));
    EXPECT_EQ(since(moves, Moves::most_steps + 2), Ends{-1});
    EXPECT_EQ(since(moves, 1000), Ends{});
}

TEST(Moves, EmptyBoxesTouchNothing) {
    Moves moves;
    moves.add(0, 1, {{Box{}, box_at(1)}});
    EXPECT_EQ(since(moves, 0), Ends{1});
}

}  // namespace
}  // namespace gn::moves_test
