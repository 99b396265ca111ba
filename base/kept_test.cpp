// SPDX-License-Identifier: MIT
// Values are made once a version.
#include "base/kept.h"

#include <gtest/gtest.h>

namespace gn::kept_test {
namespace {

TEST(Kept, WhatIsKeptFollowsItsVersion) {
    Kept kept;
    int made = 0;
    const auto make = [&] { return ++made; };
    EXPECT_EQ(*kept.get(1, "edges", 0, make), 1);
    EXPECT_EQ(*kept.get(1, "edges", 0, make), 1);
    EXPECT_EQ(*kept.get(1, "edges", 7, make), 2) << "another key";
    EXPECT_EQ(*kept.get(1, "planes", 0, make), 3) << "another name";
    const auto held = kept.get(1, "edges", 0, make);
    EXPECT_EQ(*kept.get(2, "edges", 0, make), 4) << "a later version";
    EXPECT_EQ(kept.size(), 1U);
    EXPECT_EQ(*held, 1) << "whoever uses a value holds it";
    EXPECT_EQ(*kept.get(1, "edges", 0, make), 5) << "an earlier one";
}

}  // namespace
}  // namespace gn::kept_test
