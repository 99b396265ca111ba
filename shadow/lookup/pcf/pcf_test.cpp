// SPDX-License-Identifier: MIT
#include "shadow/lookup/pcf/pcf.glsl"

#include "shadow/lookup/poisson.h"
#include "tests/rig.h"

namespace gn {
namespace {

using namespace gn::glsl;

/// V of a grid kernel at (x, y) in texels over a map where lit(i, j) says whether texel (i, j) lets the light pass.
template <class Lit>
double grid(int kernel, int size, float x, float y, Lit lit) {
    size = gn_pcf_size(kernel, size);
    double sum = 0;
    double total = 0;
    for (int j = 0; j < gn_pcf_footprint(kernel, size); ++j) {
        for (int i = 0; i < gn_pcf_footprint(kernel, size); ++i) {
            const auto weight = [&](float t, int k) {
                return static_cast<double>(kernel == GN_PCF_GAUSSIAN ? gn_pcf_gaussian(size, t, k)
                                                                     : gn_pcf_weight(kernel, size, t, k));
            };
            const double w = weight(x, i) * weight(y, j);
            total += w;
            sum += lit(gn_pcf_first(kernel, size, x) + i, gn_pcf_first(kernel, size, y) + j) ? w : 0;
        }
    }
    return sum / total;
}

TEST(Pcf, FourOfNineTexelsBehindTheReceiverGiveTheFigureOfTheThesis) {
    // [Sam07] fig. 2.6: a receiver at 22, five texels at 11 and four at 53. The figure's 0.56 is the share in shadow, 5/9.
    constexpr float receiver = 22;
    const float depth[3][3] = {{11, 11, 53}, {11, 11, 53}, {11, 53, 53}};
    for (const int kernel : {GN_PCF_3X3, GN_PCF_NXN}) {
        const double v = grid(kernel, 3, 1.5F, 1.5F, [&](int i, int j) {
            return i >= 0 && i < 3 && j >= 0 && j < 3 && receiver <= depth[j][i];
        });
        EXPECT_NEAR(v, 4.0 / 9, 1e-6);
    }
    // Averaging depths first would compare with 29.7 and say lit.
    EXPECT_GT((5.0 * 11 + 4.0 * 53) / 9, static_cast<double>(receiver));
}

TEST(Pcf, WeightsOfEveryGridSumToOne) {
    for (int kernel = GN_PCF_2X2; kernel <= GN_PCF_BILINEAR_NXN; ++kernel) {
        for (int size = 1; size <= 9; ++size) {
            for (float t = 10; t < 11; t += 0.0625F) {
                const int n = gn_pcf_size(kernel, size);
                float sum = 0;
                for (int i = 0; i < gn_pcf_footprint(kernel, n); ++i) {
                    sum += gn_pcf_weight(kernel, n, t, i);
                }
                EXPECT_NEAR(sum, 1, 1e-5) << "kernel " << kernel << " size " << n << " at " << t;
            }
        }
    }
}

TEST(Pcf, KernelsOfWholeTexelsAreCentredToHalfATexel) {
    for (int size = 1; size <= 6; ++size) {
        for (float t = 10; t < 12; t += 0.09F) {
            const int first = gn_pcf_first(GN_PCF_NXN, size, t);
            EXPECT_LE(std::abs(static_cast<float>(first) + 0.5F * static_cast<float>(size) - t), 0.5F)
                << size << " at " << t;
        }
    }
}

TEST(Pcf, BilinearGridIsTheBoxIntegralOfAStraightEdge) {
    // Texels left of 20 are lit. A box of n texels around t covers exactly the share left of the edge.
    for (const int size : {1, 2, 3, 5, 8}) {
        for (float t = 12; t < 28; t += 0.17F) {
            const double v = grid(GN_PCF_BILINEAR_NXN, size, t, 5.3F, [](int i, int) { return i < 20; });
            const double exact = std::clamp((20.0 - (static_cast<double>(t) - 0.5 * size)) / size, 0.0, 1.0);
            EXPECT_NEAR(v, exact, 1e-5) << "size " << size << " at " << t;
        }
    }
}

TEST(Pcf, GridsAreMonotoneAcrossAnEdge) {
    for (int kernel = GN_PCF_2X2; kernel <= GN_PCF_GAUSSIAN; ++kernel) {
        double before = 1;
        for (float t = 12; t < 28; t += 0.05F) {
            const double v = grid(kernel, 5, t, 5.3F, [](int i, int) { return i < 20; });
            EXPECT_LE(v, before + 1e-6);
            before = v;
        }
        EXPECT_EQ(before, 0);
    }
}

TEST(Pcf, SpiralFillsTheDiscEvenly) {
    // The taps' share in a half plane tends to the disc's segment area: taps to infinity is the integral.
    const auto error = [](int taps) {
        double worst = 0;
        for (double edge = -0.9; edge < 1; edge += 0.1) {
            int inside = 0;
            for (int i = 0; i < taps; ++i) {
                inside += gn_pcf_vogel(i, taps, 0.3F).x < static_cast<float>(edge) ? 1 : 0;
            }
            const double exact = 0.5 + (edge * std::sqrt(1 - edge * edge) + std::asin(edge)) / static_cast<double>(pi);
            worst = std::max(worst, std::abs(static_cast<double>(inside) / taps - exact));
        }
        return worst;
    };
    EXPECT_LT(error(4096), 0.005);
    EXPECT_LT(error(1024), error(16));
}

TEST(Poisson, PointsKeepTheirSpacingAndFillTheDisc) {
    for (const int count : {1, 4, 16, 25, 64, 128}) {
        const PoissonSet set = poisson_disc(count, 5);
        ASSERT_EQ(set.points.size(), static_cast<std::size_t>(count));
        for (std::size_t i = 0; i < set.points.size(); ++i) {
            EXPECT_LE(glm::length(set.points[i]), 1.0F);
            for (std::size_t j = 0; j < i; ++j) {
                EXPECT_GE(glm::distance(set.points[i], set.points[j]), set.spacing);
            }
        }
        // Maximal packings of n discs in a disc reach a relative radius of about 0.65 to 0.85 of the densest.
        if (count >= 16) {
            const double densest = 2 * std::sqrt(0.9069 / count);
            EXPECT_GT(set.spacing / densest, 0.6) << count;
        }
    }
    EXPECT_EQ(poisson_disc(16, 5).points[7], poisson_disc(16, 5).points[7]);
    EXPECT_NE(poisson_disc(16, 5).points[7], poisson_disc(16, 6).points[7]);
}

TEST(PcfRendered, OneNearestTapIsTheHardShadow) {
    const auto hard = test::compare("contact", "hard,resolution=512");
    const auto pcf = test::compare("contact", "pcf,resolution=512,pcf.kernel=nxn,pcf.size=1");
    std::size_t different = 0;
    for (std::size_t i = 0; i < hard.truth.counted.size(); ++i) {
        different += hard.visibility().values[i] != pcf.visibility().values[i] ? 1 : 0;
    }
    // The guard bands differ by a texel, so the maps' texels are not the same; both err in their staircase only.
    EXPECT_LT(static_cast<double>(different) / static_cast<double>(hard.truth.counted.size()), 0.01);
}

TEST(PcfRendered, EveryKernelStaysInRangeAndFreeOfAcne) {
    for (const char* kernel :
         {"2x2", "3x3", "nxn", "bilinear", "bilinear-nxn", "gaussian", "poisson", "rotated-poisson", "vogel"}) {
        const auto c = test::compare("tilted:angle=80", std::string("pcf,resolution=512,pcf.kernel=") + kernel,
                                     {.width = 96, .height = 96});
        EXPECT_LE(*c.errors.acne, 1e-3) << kernel;
        for (const float v : c.visibility().values) {
            ASSERT_TRUE(v >= 0 && v <= 1) << kernel << " gave " << v;
        }
    }
}

}  // namespace
}  // namespace gn
