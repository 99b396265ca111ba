// SPDX-License-Identifier: MIT
#include "shadow/map/evsm/evsm.glsl"

#include "scenes/analytic.h"
#include "tests/rig.h"

#include <algorithm>
#include <random>

namespace gn::evsm_test {
namespace {

using namespace gn::glsl;

GnEvsmParams exact(int components = GN_EVSM_FOUR) {
    return {.components = components, .min_deviation = 0, .bleeding = 0};
}

struct Kernel {
    std::vector<float> depths;
    [[nodiscard]] vec4 warped(const GnEvsmParams& params) const {
        vec4 mean(0);
        for (const float depth : depths) {
            mean += gn_evsm_encode(depth, vec2(0), params) / static_cast<float>(depths.size());
        }
        return mean;
    }
    [[nodiscard]] vec2 plain() const {
        vec2 mean(0);
        for (const float depth : depths) {
            mean += gn_vsm_moments(depth, 0) / static_cast<float>(depths.size());
        }
        return mean;
    }
    [[nodiscard]] float lit(float receiver) const {
        const auto beyond = std::count_if(depths.begin(), depths.end(), [&](float d) { return d >= receiver; });
        return static_cast<float>(beyond) / static_cast<float>(depths.size());
    }
};

/// Nine depths in [low, high].
Kernel random_kernel(std::mt19937& random, float low, float high) {
    std::uniform_real_distribution<float> uniform(low, high);
    Kernel kernel;
    for (int i = 0; i < 9; ++i) {
        kernel.depths.push_back(uniform(random));
    }
    return kernel;
}

TEST(Evsm, NoAcceptedExponentOverflows) {
    // Every exponent that is not refused, at both ends of depth, on the steepest plane: finite and below the format's
    // greatest number even before the mean of four samples is divided.
    for (const int format : {GN_EVSM_FLOAT16, GN_EVSM_FLOAT32}) {
        const float limit = format == GN_EVSM_FLOAT16 ? 65504.0F : std::numeric_limits<float>::max() / 4;
        for (const float c : {0.0F, 1.0F, 5.0F, gn_evsm_limit(format)}) {
            for (const float depth : {0.0F, 0.5F, 1.0F}) {
                const vec4 stored =
                    gn_evsm_encode(depth, vec2(1, 1), {.format = format, .exponent = c, .exponent_negative = c});
                for (int i = 0; i < 4; ++i) {
                    EXPECT_LT(std::abs(stored[i]), limit) << "c " << c << " depth " << depth << " component " << i;
                }
            }
        }
    }
}

TEST(Evsm, BoundIsExactOnParallelPlanes) {
    for (int lit = 1; lit < 20; ++lit) {
        Kernel kernel;
        for (int i = 0; i < 20; ++i) {
            kernel.depths.push_back(i < lit ? 0.6F : 0.4F);
        }
        EXPECT_NEAR(gn_evsm_visible(kernel.warped(exact()), 0.6F, 0, exact()), kernel.lit(0.6F), 1e-4);
    }
}

TEST(Evsm, BlockersOfTwoDepthsAreTheNearerOne) {
    for (const int components : {GN_EVSM_TWO, GN_EVSM_FOUR}) {
        for (int hidden = 1; hidden < 20; ++hidden) {
            Kernel kernel;
            for (int i = 0; i < 20; ++i) {
                kernel.depths.push_back(i < hidden ? 0.4F : 0.6F);
            }
            const vec2 found = gn_evsm_found(kernel.warped(exact(components)), 0.6F, 0, exact(components));
            EXPECT_NEAR(found.x, static_cast<float>(hidden) / 20, 1e-4);
            // The positive warp of the receiver is e^8 of the blocker's: what is left of its rounding is a share of it.
            EXPECT_NEAR(found.y, 0.4F, components == GN_EVSM_FOUR ? 1e-4 : 5e-3) << components << " " << hidden;
        }
    }
}

TEST(Evsm, IsAtMostTheVarianceBoundAndAtLeastPercentageCloserFiltering) {
    // Where nothing in the kernel lies beyond the receiver, a convex warp can only lower Chebyshev's bound: with t the
    // zero of the optimal square of the plain bound, (f(x) - f(t)) / (f(d) - f(t)) <= (x - t) / (d - t) for x <= d.
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0.05F, 1);
    for (int i = 0; i < 2000; ++i) {
        const float receiver = uniform(random);
        const Kernel kernel = random_kernel(random, 0, receiver);
        GnEvsmParams params = exact(i % 2);
        params.exponent = 1 + 41 * uniform(random);
        const float evsm = gn_evsm_visible(kernel.warped(params), receiver, 0, params);
        EXPECT_LE(evsm, gn_vsm_chebyshev(kernel.plain(), receiver, 0) + 2e-4) << "case " << i;
        EXPECT_GE(evsm, kernel.lit(receiver) - 1e-4) << "case " << i;
    }
}

TEST(Evsm, MayExceedTheVarianceBoundWhereTheKernelReachesBeyondTheReceiver) {
    // The limit of that law: a little of a far background drowns the positive warp, a little of a near caster the
    // negative one, while plain depth weighs both fairly. It still never falls below the truth.
    Kernel kernel;
    kernel.depths.assign(100, 0.45F);
    std::fill_n(kernel.depths.begin(), 2, 0.1F);
    std::fill_n(kernel.depths.begin() + 2, 5, 0.9F);
    const float evsm = gn_evsm_visible(kernel.warped(exact()), 0.5F, 0, exact());
    EXPECT_GT(evsm, gn_vsm_chebyshev(kernel.plain(), 0.5F, 0) + 0.02F);
    EXPECT_GE(evsm, kernel.lit(0.5F));
}

TEST(Evsm, FourComponentsAreNeverBrighterThanTwo) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int i = 0; i < 500; ++i) {
        const Kernel kernel = random_kernel(random, 0, 1);
        const float receiver = uniform(random);
        const vec4 moments = kernel.warped(exact());
        EXPECT_LE(gn_evsm_visible(moments, receiver, 0, exact(GN_EVSM_FOUR)),
                  gn_evsm_visible(moments, receiver, 0, exact(GN_EVSM_TWO)));
    }
}

TEST(Evsm, TheNegativeWarpAnswersWhereTheKernelReachesBeyondTheReceiver) {
    // Two of ten depths lie far behind the receiver and lift the positive mean over it: that bound says nothing. To the
    // negative warp they are as good as nothing, and its bound is the share of two planes, exact up to exp(-6).
    Kernel kernel;
    kernel.depths.assign(10, 0.2F);
    std::fill_n(kernel.depths.begin(), 2, 0.9F);
    GnEvsmParams params = exact(GN_EVSM_FOUR);
    params.exponent = params.exponent_negative = 10;
    const vec4 moments = kernel.warped(params);
    EXPECT_NEAR(gn_evsm_visible(moments, 0.5F, 0, params), 0.2F, 1e-3);
    params.components = GN_EVSM_TWO;
    EXPECT_EQ(gn_evsm_visible(moments, 0.5F, 0, params), 1.0F);
}

TEST(Evsm, ADeviationIsWorthTheSameAtEveryDepth) {
    // One deviation behind a flat occluder Chebyshev's bound is a half, warped or not: the warp's slope goes with its value.
    for (const float depth : {0.2F, 0.5F, 0.8F}) {
        GnEvsmParams params = exact(GN_EVSM_TWO);
        params.exponent = 10;
        const Kernel flat{{depth}};
        // The warp bends by two hundredths over the deviation, which moves the half by half of that.
        EXPECT_NEAR(gn_evsm_visible(flat.warped(params), depth + 0.001F, 0.001F, params), 0.5F, 0.01F) << depth;
    }
}

TEST(Evsm, ABiasMovesTheWarpedReceiverByItsShare) {
    // A receiver at 0.5 of which the bias has taken 0.01: the warp is smaller by exp(-0.01), not by exp(-2 c 0.01).
    GnProjected projected{};
    projected.depth = 0.49F;
    projected.bias = 0.01F;
    for (const float c : {5.0F, 20.0F, 42.0F}) {
        const float ratio = gn_evsm_positive(gn_evsm_receiver(projected, c), c) / gn_evsm_positive(0.5F, c);
        EXPECT_NEAR(ratio, std::exp(-0.01F), 1e-5F) << c;
    }
}

TEST(Evsm, BleedingOfThreePlanesFallsWithTheExponent) {
    using namespace scenes::stack_scene;
    const auto depth = [](double y) { return static_cast<float>((10 + height_a - y) / 20); };
    const Kernel kernel{{depth(height_a), depth(height_b)}};
    float previous = static_cast<float>(bleeding(dy));
    for (const float c : {2.0F, 5.0F, 10.0F, 20.0F, 40.0F}) {
        GnEvsmParams params = exact(GN_EVSM_TWO);
        params.exponent = c;
        const float leak = gn_evsm_visible(kernel.warped(params), depth(height_c), 0, params);
        EXPECT_LT(leak, previous) << "c " << c;
        previous = leak;
    }
    EXPECT_LT(previous, 1e-3);
}

/// Mean visibility on the floor of the stack well inside the shadow of A and B.
double bleeding_under_b(const test::Comparison& c) {
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
        const vec4 p_ws = c.frame.samples.position_ws[i];
        if (p_ws.w > 0.5F && p_ws.y < 1e-3F && std::abs(p_ws.x) < 0.8F && std::abs(p_ws.z) < 0.8F) {
            sum += c.visibility().values[i];
            ++count;
        }
    }
    EXPECT_GT(count, 20);
    return sum / count;
}

TEST(EvsmRendered, IsNowhereBrighterThanTheVarianceMapOnTheFloorOfTheStack) {
    // The floor is the farthest surface: without a bias no kernel on it reaches beyond it.
    for (const std::string placement : {"fit", "cascades"}) {
        const std::string rest = ".bleeding=0,resolution=512,bias.constant=0,bias.normal=0,placement=" + placement;
        const auto vsm = test::compare("stack", "vsm,vsm.min_deviation=0,vsm" + rest, {.samples = 1});
        for (const std::string recipe : {"evsm2", "evsm4"}) {
            const auto evsm = test::compare("stack", recipe + ",evsm.min_deviation=0,evsm" + rest, {.samples = 1});
            EXPECT_LT(bleeding_under_b(evsm), 0.1 * bleeding_under_b(vsm)) << recipe << " in " << placement;
            for (std::size_t i = 0; i < vsm.truth.counted.size(); ++i) {
                const vec4 p_ws = vsm.frame.samples.position_ws[i];
                if (p_ws.w > 0.5F && p_ws.y < 1e-3F) {
                    ASSERT_LE(evsm.visibility().values[i], vsm.visibility().values[i] + 2e-3)
                        << recipe << " in " << placement << " at " << p_ws.x << ", " << p_ws.z;
                }
            }
        }
    }
}

TEST(Evsm, RefusesExponentsThatTheFormatCannotHold) {
    const Scene scene = load_scene("stack");
    const auto refusal = [&](const std::string& recipe) {
        return find_part(Stage::map, "evsm").refuses(scene, scene.lights.front(), load_recipe(recipe));
    };
    EXPECT_NE(refusal("evsm4,evsm.format=float16,evsm.exponent=20").find("evsm.exponent = 20"), std::string::npos);
    EXPECT_NE(refusal("evsm4,evsm.format=float16,evsm.exponent=20").find("at most 5"), std::string::npos);
    EXPECT_NE(refusal("evsm4,evsm.format=float16,evsm.exponent_negative=6").find("evsm.exponent_negative = 6"),
              std::string::npos);
    EXPECT_EQ(refusal("evsm2,evsm.format=float16,evsm.exponent=5,evsm.exponent_negative=6"), "");
    for (const char* fits : {"evsm4", "evsm2", "evsm4,evsm.format=float16", "evsm4,evsm.exponent=42",
                             "evsm4,evsm.format=float16,evsm.exponent=5"}) {
        EXPECT_EQ(refusal(fits), "") << fits;
    }
}

TEST(EvsmRendered, LeaksNoMoreThanTheVarianceMapByDefault) {
    // Nothing was tuned: neither the bias nor the exponents.
    const auto vsm = test::compare("stack", "vsm", {.samples = 16});
    const auto evsm = test::compare("stack", "evsm4", {.samples = 16});
    EXPECT_LE(*evsm.errors.leak, *vsm.errors.leak);
}

TEST(EvsmRendered, StaysInRangeAndFreeOfAcne) {
    for (const char* options : {"", ",evsm.format=float16", ",evsm.samples=4,evsm.blur=gaussian,evsm.radius=5"}) {
        const auto c = test::compare("tilted:angle=75", std::string("evsm4,resolution=512") + options,
                                     {.width = 96, .height = 96, .samples = 1});
        // The negative warp bends over a kernel whose depths deviate by s: its mean lies c s^2 nearer than the middle's
        // depth, which takes (c s)^2 of the light, less the tail that is cut. The blur of five texels has s = 1/100 here,
        // which at c = 10 is a hundredth; the narrower ones have none to speak of.
        EXPECT_LE(*c.errors.acne, 0.01) << options;
        for (const float v : c.visibility().values) {
            ASSERT_TRUE(v >= 0 && v <= 1) << v << options;
        }
    }
}

}  // namespace
}  // namespace gn::evsm_test
