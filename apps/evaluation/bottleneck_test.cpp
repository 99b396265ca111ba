// SPDX-License-Identifier: MIT
// Which unit a pass waits for, on passes and a machine that are made up.
#include "apps/evaluation/bottleneck.h"

#include <gtest/gtest.h>

namespace gn::bottleneck_test {
namespace {

/// A machine of round numbers, nanoseconds: 10 us a pass, 0.1 Gvertices/s, 1 Gfragments/s, 10 GB/s, 100 Gmadd/s.
constexpr MachineRates machine{.pass = 10'000,
                               .vertex = 10,
                               .culled = 2,
                               .primitive = 20,
                               .emitted = 100,
                               .fragment = 1,
                               .sample = 0.5,
                               .byte = 0.1,
                               .madd = 0.01};

/// A million pixels, four bytes each, with one large triangle.
PassWork full_screen(double ms) {
    PassWork pass;
    pass.ms = ms;
    pass.draws = pass.shades = true;
    pass.counts = {.vertices = 3, .emitted = 0, .primitives = 1, .fragments = 1'000'000, .items = 0};
    pass.samples = 1'000'000;
    pass.bytes = 4'000'000;
    return pass;
}

TEST(Bottleneck, FloorsAreCountsTimesRates) {
    PassWork pass = full_screen(20);
    pass.counts->vertices = 100'000;
    pass.counts->primitives = 50'000;
    pass.counts->emitted = 10'000;
    pass.bytes = 5'000'000;
    const Floors floors = floors_of(pass, machine);
    EXPECT_NEAR(floors.overhead, 0.01, 1e-12);
    EXPECT_NEAR(floors.vertices, 1, 1e-12);
    EXPECT_NEAR(floors.primitives, 1, 1e-12);
    EXPECT_NEAR(floors.geometry, 1, 1e-12);
    EXPECT_NEAR(floors.fill, 1, 1e-12);
    EXPECT_NEAR(floors.bandwidth, 0.5, 1e-12);
    // Bytes move while pixels are made; all else adds up.
    EXPECT_NEAR(floors.rest, 20 - 4.01, 1e-9);
}

TEST(Bottleneck, ATrivialFullScreenPassIsFillAndALongOneShaders) {
    EXPECT_EQ(bottleneck_of(full_screen(1.2), machine).unit, Unit::fill);
    const Verdict verdict = bottleneck_of(full_screen(11.01006), machine);
    EXPECT_EQ(verdict.unit, Unit::shaders);
    // 10 ms over a million fragments are 10 ns each, a thousand multiply-adds of 0.01 ns.
    ASSERT_TRUE(verdict.madds);
    EXPECT_NEAR(*verdict.madds, 1000, 1e-3);
}

TEST(Bottleneck, WhatNoCounterExplainsWhileRasterizingIsFillRate) {
    // A stencil pass: volumes that cover the screen, most of whose samples fail.
    PassWork stencil = full_screen(5);
    stencil.shades = false;
    stencil.samples = 1000;
    EXPECT_EQ(bottleneck_of(stencil, machine).unit, Unit::fill);
    EXPECT_FALSE(bottleneck_of(stencil, machine).madds) << "nothing that could compute";
    // Depth alone: samples are what there is to count.
    stencil.counts->fragments = 0;
    stencil.samples = 1'000'000;
    EXPECT_NEAR(floors_of(stencil, machine).fill, 0.5, 1e-12);
}

TEST(Bottleneck, GeometryBytesAndCopiesHaveTheirOwnNames) {
    PassWork pass = full_screen(5);
    pass.counts->fragments = 1000;
    pass.samples = 200'000;
    pass.counts->vertices = 400'000;
    EXPECT_EQ(bottleneck_of(pass, machine).unit, Unit::vertices);
    pass.counts->vertices = 30'000;
    pass.counts->primitives = 200'000;
    EXPECT_EQ(bottleneck_of(pass, machine).unit, Unit::primitives);
    // Where one sample passes, one triangle was drawn; the others cost what culled ones do.
    pass.samples = 1;
    EXPECT_NEAR(floors_of(pass, machine).primitives, (199'999 * 2 + 20) * 1e-6, 1e-12);
    EXPECT_EQ(bottleneck_of(pass, machine).unit, Unit::shaders);
    pass.counts->primitives = 10'000;
    pass.counts->emitted = 40'000;
    EXPECT_EQ(bottleneck_of(pass, machine).unit, Unit::geometry);
    pass.counts->emitted = 0;
    pass.bytes = 40'000'000;
    EXPECT_EQ(bottleneck_of(pass, machine).unit, Unit::bandwidth);
    PassWork copy{.ms = 5, .counts = PassWork::Counts{}, .samples = 0, .bytes = 8'000'000};
    EXPECT_EQ(bottleneck_of(copy, machine).unit, Unit::bandwidth);
    PassWork compute{.ms = 5,
                     .draws = false,
                     .shades = true,
                     .counts = PassWork::Counts{.items = 1000},
                     .samples = 0,
                     .bytes = 8'000};
    EXPECT_EQ(bottleneck_of(compute, machine).unit, Unit::shaders);
}

TEST(Bottleneck, WhatIsAsShortAsAnEmptyPassIsOverhead) {
    EXPECT_EQ(bottleneck_of(full_screen(0.02), machine).unit, Unit::overhead);
    EXPECT_NE(bottleneck_of(full_screen(0.021), machine).unit, Unit::overhead);
}

TEST(Bottleneck, WithoutCountsOnlyBytesAreKnown) {
    PassWork pass = full_screen(5);
    pass.counts.reset();
    pass.samples.reset();
    EXPECT_EQ(bottleneck_of(pass, machine).unit, Unit::unknown);
    EXPECT_FALSE(bottleneck_of(pass, machine).madds);
    pass.bytes = 40'000'000;
    EXPECT_EQ(bottleneck_of(pass, machine).unit, Unit::bandwidth);
}

TEST(Bottleneck, OfAFrameIsWhereMostMillisecondsAre) {
    using Passes = std::vector<JudgedPass>;
    EXPECT_EQ(bottleneck_of(Passes{{Unit::fill, 3}, {Unit::shaders, 2}, {Unit::shaders, 2}}), Unit::shaders);
    EXPECT_EQ(bottleneck_of(Passes{{Unit::fill, 5}, {Unit::shaders, 2}, {Unit::shaders, 2}}), Unit::fill);
    EXPECT_EQ(bottleneck_of(Passes{}), Unit::unknown);
}

TEST(Bottleneck, RoundsOfAPassAddUp) {
    PassWork sum = full_screen(2);
    sum += full_screen(3);
    EXPECT_EQ(sum.ms, 5);
    EXPECT_EQ(sum.counts->fragments, 2'000'000U);
    EXPECT_EQ(sum.samples, 2'000'000U);
    EXPECT_EQ(sum.bytes, 8'000'000U);
    PassWork uncounted = full_screen(1);
    uncounted.counts.reset();
    sum += uncounted;
    EXPECT_FALSE(sum.counts) << "a part that was not counted leaves the sum uncounted";
}

}  // namespace
}  // namespace gn::bottleneck_test
