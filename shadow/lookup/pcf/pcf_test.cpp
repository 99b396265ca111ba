// SPDX-License-Identifier: MIT
#include "shadow/lookup/pcf/pcf.glsl"

#include "shadow/lookup/poisson.h"
#include "tests/lookup_by_hand.h"

namespace gn::pcf_test {
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

/// V of a grid kernel over a footprint of `pixel` texels on a straight edge: texels left of `edge` are lit.
double over_pixel(int kernel, int size, float pixel, float t, int edge, float first, float end) {
    size = gn_pcf_size(kernel, size);
    const GnPcfSpan span = gn_pcf_span(kernel, size, pixel, t, first, end);
    double sum = 0;
    double total = 0;
    for (float texel = std::floor(span.low); texel < span.high; texel += 1) {
        const auto w = static_cast<double>(gn_pcf_span_weight(kernel, span, texel));
        total += w;
        sum += texel < static_cast<float>(edge) ? w : 0;
    }
    return sum / total;
}

TEST(Pcf, FootprintOfThePixelIsItsBoxIntegral) {
    for (const float pixel : {0.2F, 2.9F, 7.3F, 40.0F, 333.3F}) {
        for (float t = 300; t < 1100; t += 13.7F) {
            const double side = std::max(3.0, static_cast<double>(pixel));
            const double exact = std::clamp((700.0 - (static_cast<double>(t) - 0.5 * side)) / side, 0.0, 1.0);
            EXPECT_NEAR(over_pixel(GN_PCF_BILINEAR_NXN, 3, pixel, t, 700, 0, 2048), exact, 1e-4)
                << pixel << " at " << t;
            // Whole texels are one more at most.
            EXPECT_NEAR(over_pixel(GN_PCF_NXN, 3, pixel, t, 700, 0, 2048), exact, 1 / side) << pixel << " at " << t;
        }
    }
}

TEST(Pcf, FootprintLargerThanTheMapIsTheMapsMean) {
    // A view's rectangle from texel 256 to 512: what lies beyond it belongs to other views and counts for nothing.
    for (const int kernel : {GN_PCF_2X2, GN_PCF_NXN, GN_PCF_BILINEAR_NXN}) {
        EXPECT_NEAR(over_pixel(kernel, 5, 1e6F, 300, 320, 256, 512), 0.25, 1e-6) << kernel;
        EXPECT_EQ(over_pixel(kernel, 5, 4, 256, 256, 256, 512), 0) << kernel;
        EXPECT_EQ(over_pixel(kernel, 5, 4, 512, 512, 256, 512), 1) << kernel;
    }
}

TEST(Pcf, SmallFootprintsLeaveTheKernelAsItIs) {
    for (int kernel = GN_PCF_2X2; kernel <= GN_PCF_GAUSSIAN; ++kernel) {
        for (float t = 12; t < 28; t += 0.17F) {
            EXPECT_NEAR(over_pixel(kernel, 5, 0.9F, t, 20, 0, 64),
                        grid(kernel, 5, t, 5.3F, [](int i, int) { return i < 20; }), 1e-5)
                << "kernel " << kernel << " at " << t;
        }
    }
}

TEST(Pcf, SubpixelsFillTheSquareEvenly) {
    // Boxes at the corner hold their share of n points to a few of them; a plain sequence of halves would not.
    for (const int n : {16, 64, 256}) {
        for (const float side : {0.25F, 0.5F, 0.75F}) {
            int inside = 0;
            for (int i = 0; i < n; ++i) {
                const vec2 p = gn_pcf_subpixel(i) + 0.5F;
                ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
                inside += p.x < side && p.y < side ? 1 : 0;
            }
            EXPECT_NEAR(inside, static_cast<double>(side * side) * n, 2 + std::log2(n) / 2) << n << " " << side;
        }
    }
}

TEST(Pcf, SpiralFillsTheDiscEvenly) {
    // The taps' share in a half plane tends to the disc's segment area: taps to infinity is the integral.
    const auto error = [](int taps) {
        double worst = 0;
        for (double edge = -0.9; edge < 1; edge += 0.1) {
            int inside = 0;
            for (int i = 0; i < taps; ++i) {
                inside += gn_vogel(i, taps, 0.3F).x < static_cast<float>(edge) ? 1 : 0;
            }
            const double exact = 0.5 + (edge * std::sqrt(1 - edge * edge) + std::asin(edge)) / static_cast<double>(pi);
            worst = std::max(worst, std::abs(static_cast<double>(inside) / taps - exact));
        }
        return worst;
    };
    EXPECT_LT(error(4096), 0.005);
    EXPECT_LT(error(1024), error(16));
}

TEST(Pcf, PointsOfTheSpiralKeepApart) {
    // [Vog79] By the golden angle no point comes nearer to another than 1.546 / sqrt(n), whatever n. Other angles make spokes:
    // 2 radians, nearly 7/22 of a turn, 0.76; 2.39 radians 1.26.
    for (const int n : {64, 256}) {
        float nearest = 2;
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < i; ++j) {
                nearest = std::min(nearest, glm::distance(gn_vogel(i, n, 0.3F), gn_vogel(j, n, 0.3F)));
            }
        }
        EXPECT_GT(nearest * std::sqrt(static_cast<float>(n)), 1.54F) << n;
    }
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

/// The ground of the half-plane under a slanting sun, seen from straight above: its shadow ends at x = 2 metres. The camera
/// is turned about its axis by an angle.
Scene ground_from_above(float x, double turn) {
    Scene scene = load_scene("half-plane:light=directional,hard=1");
    scene.lights.front().shape.direction_ws = vec4(glm::normalize(vec3(1, -1, 0)), 0);
    Camera& camera = scene.cameras.front();
    camera.position_ws = {x, 1.5F, 0};
    camera.forward_ws = {0, -1, 0};
    camera.up_ws = vec3(dvec3(std::sin(turn), 0, -std::cos(turn)));
    return scene;
}

/// The largest error of V against `expected`, a function of a pixel's distance from the shadow's edge over its width, and
/// how many pixels the edge crosses.
template <class Expected>
std::pair<double, int> worst_at_edge(const Scene& scene, const std::string& recipe, Expected expected) {
    constexpr uint pixels = 24;
    const auto c = test::compare(scene, recipe, {.width = pixels, .height = pixels, .samples = 1});
    const Camera& camera = scene.cameras.front();
    const double width =
        2 * std::tan(0.5 * static_cast<double>(camera.yfov)) * static_cast<double>(camera.position_ws.y) / pixels;
    double worst = 0;
    int crossed = 0;
    for (std::size_t i = 0; i < c.frame.samples.position_ws.size(); ++i) {
        const double v = expected((static_cast<double>(c.frame.samples.position_ws[i].x) - 2) / width);
        worst = std::max(worst, std::abs(v - static_cast<double>(c.visibility().values[i])));
        crossed += v > 0.01 && v < 0.99 ? 1 : 0;
    }
    return {worst, crossed};
}

TEST(PcfRendered, GridOverThePixelsFootprintIsItsBoxIntegral) {
    // The map is fitted to the view's body, whose apex lies beside its base as the sun sees it: 16 texels a pixel across the
    // edge. The edge lies within half a texel of where the map has it, and the normal bias moves the receiver by a fraction of
    // one more; kernels of whole texels are up to one longer than the pixel.
    constexpr double texels = 16;
    const auto box = [](double x) { return std::clamp(0.5 + x, 0.0, 1.0); };
    const std::string recipe = "pcf,resolution=512,pcf.kernel=";
    for (const float x : {2.02F, 2.031F, 2.05F}) {
        for (const std::string kernel : {"bilinear-nxn", "nxn", "bilinear"}) {
            const auto [worst, crossed] =
                worst_at_edge(ground_from_above(x, 0), recipe + kernel + ",pcf.footprint=pixel", box);
            EXPECT_LT(worst, (kernel == "nxn" ? 1.75 : 0.75) / texels) << kernel << " at " << x;
            EXPECT_GE(crossed, 24);
        }
        // Three texels of the sixteen are no average over the pixel.
        EXPECT_GT(worst_at_edge(ground_from_above(x, 0), recipe + "bilinear-nxn", box).first, 0.2);
    }
}

TEST(PcfRendered, TurnedFootprintsAreBoundedByGridsAndFilledByDiscs) {
    // A map over all of the scene, whose axes are the world's: 8192 texels over some 25 metres, 24 to a pixel.
    const std::string recipe = "pcf,resolution=8192,placement=single,pcf.footprint=pixel,pcf.kernel=";
    for (const double turn : {0.3, 0.785}) {
        const double cosine = std::cos(turn);
        const double sine = std::sin(turn);
        const Scene scene = ground_from_above(2.013F, turn);
        const auto box = [&](double x) { return std::clamp(0.5 + x / (cosine + sine), 0.0, 1.0); };
        EXPECT_LT(worst_at_edge(scene, recipe + "bilinear-nxn", box).first, 0.05) << turn;

        // The share of a turned square on one side of a line; 128 taps know it to a few of them.
        const auto square = [&](double x) {
            double lit = 0;
            for (int i = 0; i < 64; ++i) {
                for (int j = 0; j < 64; ++j) {
                    lit += x + cosine * ((i + 0.5) / 64 - 0.5) + sine * ((j + 0.5) / 64 - 0.5) > 0 ? 1 : 0;
                }
            }
            return lit / 4096;
        };
        const auto [worst, crossed] =
            worst_at_edge(scene, recipe + "vogel,pcf.taps=128,pcf.radius=0,pcf.radius_world=0", square);
        EXPECT_LT(worst, 0.05 + 3.0 / 128) << turn;
        EXPECT_GE(crossed, 24);
    }
}

/// The largest difference of V between two pictures, and how many pixels are neither lit nor dark in the second.
std::pair<float, int> worst_between(const std::vector<float>& a, const std::vector<float>& b) {
    float worst = 0;
    int between = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
        worst = std::max(worst, std::abs(a[i] - b[i]));
        between += b[i] > 0.01F && b[i] < 0.99F ? 1 : 0;
    }
    return {worst, between};
}

TEST(PcfRendered, GridsAverageTheComparisonsUnderTheirBox) {
    // A box of n texels around the receiver, texel by texel; n x n whole ones around the middle of the receiver's own.
    const Scene scene = load_scene("contact");  // with edges along the map's axes and across them
    const auto body = [](int size, bool whole) {
        return fmt::format(R"(
    vec2 p = at.projected.uv_ts / at.projected.texel_ts;
    vec2 middle = {} ? floor(p) + 0.5 : p;
    float sum = 0.0;
    for (int y = -4; y <= 4; ++y) {{
        for (int x = -4; x <= 4; ++x) {{
            ivec2 texel = ivec2(floor(p)) + ivec2(x, y);
            vec2 apart = abs(vec2(texel) + 0.5 - middle);
            vec2 covered = clamp({:.1f} + 0.5 - apart, 0.0, 1.0);
            sum += lit(texel) ? covered.x * covered.y : 0.0;
        }}
    }}
    return sum / {:.1f};)",
                           whole, 0.5 * size, static_cast<double>(size * size));
    };
    for (const auto& [kernel, size] :
         {std::pair("bilinear-nxn", 1), std::pair("bilinear-nxn", 4), std::pair("nxn", 3)}) {
        const Recipe recipe =
            load_recipe(fmt::format("pcf,resolution=128,placement=single,pcf.size={},pcf.kernel={}", size, kernel));
        const auto by_hand = test::visibility_by_hand(scene, recipe, body(size, kernel == std::string("nxn")), 40);
        const auto [worst, between] = worst_between(test::visibility_of(scene, recipe, 40), by_hand);
        // Both round differently: positions of some 100 texels have steps of 1e-5.
        EXPECT_LT(worst, 1e-4) << kernel << " " << size;
        EXPECT_GE(between, 40) << kernel << " " << size;
    }
}

TEST(PcfRendered, TurnedDiscsAreTheShareOfTheirDisc) {
    // A lattice of points within the radius, each with the texel that it falls into.
    constexpr int taps = 128;
    const std::string body = R"(
    vec2 p = at.projected.uv_ts / at.projected.texel_ts;
    float sum = 0.0;
    float count = 0.0;
    for (int y = -20; y <= 20; ++y) {
        for (int x = -20; x <= 20; ++x) {
            vec2 d = vec2(x, y) * 0.3;
            if (length(d) <= 6.0) {
                sum += lit(ivec2(floor(p + d))) ? 1.0 : 0.0;
                count += 1.0;
            }
        }
    }
    return sum / count;)";
    const Scene scene = load_scene("contact");  // with edges along the map's axes and across them
    const Recipe recipe =
        load_recipe(fmt::format("pcf,resolution=256,placement=single,pcf.kernel=vogel,pcf.taps={},pcf.radius=6", taps));
    const auto by_hand = test::visibility_by_hand(scene, recipe, body, 40);
    const auto [worst, between] = worst_between(test::visibility_of(scene, recipe, 40), by_hand);
    // An edge passes some twelve taps' cells and misjudges half a cell of each, of either sign: 4.5 taps were measured.
    EXPECT_LT(worst, 6.0 / taps);
    EXPECT_GE(between, 150);
}

/// [RSC87] Between the centres of four texels the mean is bilinear: at a centre the texel's own, halfway that of both.
TEST(Pcf, BilinearTapsInterpolateBetweenCentres) {
    const float texel_ts = 1.0F / 64;
    const GnBilinear centre = gn_bilinear(vec2(10.5F, 20.5F) * texel_ts, texel_ts);
    EXPECT_EQ(centre.corner_ts, vec2(11, 21) * texel_ts);
    EXPECT_EQ(centre.share, vec2(0));
    for (const vec2 p : {vec2(10.7F, 20.6F), vec2(11.3F, 21.49F), vec2(11, 21)}) {
        const GnBilinear tap = gn_bilinear(p * texel_ts, texel_ts);
        EXPECT_EQ(tap.corner_ts, vec2(11, 21) * texel_ts);
        const vec2 way = p - vec2(10.5F, 20.5F);
        // In the order of a gather: the far texel of each axis alone.
        EXPECT_NEAR(gn_bilinear_mean(vec4(0, 1, 1, 0), tap.share), way.x, 1e-5);
        EXPECT_NEAR(gn_bilinear_mean(vec4(1, 1, 0, 0), tap.share), way.y, 1e-5);
        EXPECT_NEAR(gn_bilinear_mean(vec4(0, 1, 0, 0), tap.share), way.x * way.y, 1e-5);
        EXPECT_EQ(gn_bilinear_mean(vec4(1), tap.share), 1);
    }
}

TEST(PcfRendered, OneBilinearTapIsTheBilinearKernel) {
    const Scene scene = load_scene("contact");
    const std::string tap = ",pcf.kernel=vogel,pcf.taps=1,pcf.radius=0,pcf.tap=bilinear";
    for (const std::string map : {"pcf,resolution=128", "pcf,resolution=128,casters=ids"}) {
        const auto bilinear = test::visibility_of(scene, load_recipe(map + ",pcf.kernel=bilinear"), 48);
        const auto [worst, between] = worst_between(test::visibility_of(scene, load_recipe(map + tap), 48), bilinear);
        EXPECT_LT(worst, 1e-5) << map;
        EXPECT_GE(between, 40) << map;
    }
}

/// Each tap of a set is the bilinear mean of the comparisons around it, of comparisons made by hand.
TEST(PcfRendered, DiscsOfBilinearTapsAreTheMeanOfTheirTaps) {
    constexpr int taps = 7;
    constexpr float radius = 3.3F;
    std::string body = "    vec2 p = at.projected.uv_ts / at.projected.texel_ts - 0.5;\n    float sum = 0.0;\n";
    for (const vec2& point : poisson_disc(taps, 1).points) {
        body += fmt::format(R"(    {{
        vec2 t = p + {:.6f} * vec2({:.9f}, {:.9f});
        ivec2 first = ivec2(floor(t));
        vec2 s = t - floor(t);
        for (int k = 0; k < 4; ++k) {{
            ivec2 beside = ivec2(k % 2, k / 2);
            vec2 w = mix(1.0 - s, s, vec2(beside));
            sum += lit(first + beside) ? w.x * w.y : 0.0;
        }}
    }}
)",
                            radius, point.x, point.y);
    }
    body += fmt::format("    return sum / {:.1f};", static_cast<double>(taps));
    const Scene scene = load_scene("contact");
    const Recipe recipe = load_recipe(
        fmt::format("pcf,resolution=128,placement=single,pcf.kernel=poisson,pcf.taps={},pcf.radius={},pcf.tap=bilinear",
                    taps, radius));
    const auto by_hand = test::visibility_by_hand(scene, recipe, body, 40);
    const auto [worst, between] = worst_between(test::visibility_of(scene, recipe, 40), by_hand);
    EXPECT_LT(worst, 1e-4);
    EXPECT_GE(between, 40);
}

/// From pixel to pixel V changes by no more than the receiver moves over the map, in texels; single texels jump by a tap.
TEST(PcfRendered, VOfBilinearTapsIsContinuousInTheReceiver) {
    constexpr uint pixels = 32;
    Scene scene = ground_from_above(2.02F, 0.4);
    scene.cameras.front().yfov *= 0.35F;
    const auto steepest = [&](const std::string& tap) {
        const Recipe recipe = load_recipe(
            "pcf,resolution=64,placement=single,pcf.kernel=poisson,pcf.taps=4,pcf.radius=1.5,pcf.tap=" + tap);
        const auto v = test::visibility_of(scene, recipe, pixels);
        float most = 0;
        for (std::size_t i = 0; i < v.size(); ++i) {
            most = std::max(most, i % pixels > 0 ? std::abs(v[i] - v[i - 1]) : 0);
            most = std::max(most, i >= pixels ? std::abs(v[i] - v[i - pixels]) : 0);
        }
        return most;
    };
    // The map spans all of the scene, at least 10 metres; a pixel, seen from 1.5 metres above, is at most as many texels wide.
    const Camera& camera = scene.cameras.front();
    const double pixel = 2 * std::tan(0.5 * static_cast<double>(camera.yfov)) * 1.5 / pixels / (10.0 / 64);
    ASSERT_LT(pixel, 0.15);
    // Along both axes of the map at once, 1.42 times as far.
    EXPECT_LT(steepest("bilinear"), 1.42 * pixel);
    EXPECT_GT(steepest("bilinear"), 0.01);
    EXPECT_GE(steepest("texel"), 0.25);
}

/// Taps go on in the views beside their own, and end at a rectangle's border without acne.
TEST(PcfRendered, BilinearTapsNeedNoMoreBiasOverAnyPlacement) {
    const std::string taps = "pcf,resolution=256,pcf.kernel=vogel,pcf.radius=4,pcf.tap=bilinear,placement=";
    const test::ComparisonOptions size{.width = 96, .height = 72, .samples = 1};
    for (const std::string recipe : {"fit", "cascades", "perceptual", "adaptive", "virtual"}) {
        EXPECT_LE(*test::compare("tilted:angle=70", taps + recipe, size).errors.acne, 1e-3) << recipe;
    }
    for (const std::string edges : {"cross", "guard"}) {
        EXPECT_LE(*test::compare("tilted:angle=60,light=point", taps + "cube,cube.edges=" + edges, size).errors.acne,
                  1e-3)
            << edges;
    }
}

TEST(PcfRendered, IdsNeedNoBiasOnAPlane) {
    const std::string unbiased =
        ",resolution=256,bias.constant=0,bias.normal=0,bias.cone=0,bias.receiver_plane=0,pcf.kernel=";
    for (const char* kernel : {"bilinear-nxn", "gaussian", "vogel", "vogel,pcf.tap=bilinear"}) {
        const test::ComparisonOptions small{.width = 96, .height = 96, .samples = 1};
        EXPECT_GT(*test::compare("tilted:angle=60", "pcf" + unbiased + kernel, small).errors.acne, 0.1) << kernel;
        // The weights sum to one but for rounding.
        EXPECT_LT(*test::compare("tilted:angle=60", "pcf,casters=ids" + unbiased + kernel, small).errors.acne, 1e-6)
            << kernel;
    }
}

/// What least and greatest depths of all that a kernel reads decide, its taps would have found. [AHH18] 7.6
TEST(PcfRendered, ExtremesChangeNoSample) {
    const test::ComparisonOptions size{.width = 96, .height = 72, .samples = 1};
    for (const char* kernel :
         {"bilinear-nxn,pcf.size=7", "gaussian,pcf.size=3,casters=ids", "nxn,pcf.size=4,pcf.footprint=pixel",
          "vogel,pcf.taps=32,pcf.radius=6", "rotated-poisson,pcf.radius_world=0.1,pcf.tap=bilinear",
          "vogel,pcf.footprint=pixel,placement=cascades"}) {
        const bool sun = std::string_view(kernel).find("cascades") != std::string_view::npos;
        const bool ids = std::string_view(kernel).find("ids") != std::string_view::npos;
        // The warehouse shadows itself, which ids do not count.
        const char* const scene = sun ? "fence" : ids ? "warehouse-inside" : "contact:light=spot";
        const std::string recipe = "pcf,resolution=256,pcf.kernel=" + std::string(kernel);
        const auto without = test::compare(scene, recipe, size);
        const auto with = test::compare(scene, recipe + (sun ? ",pcf.extremes=blocks" : ",pcf.extremes=texels"), size);
        float most = 0;
        for (std::size_t i = 0; i < with.visibility().values.size(); ++i) {
            most = std::max(most, std::abs(with.visibility().values[i] - without.visibility().values[i]));
        }
        EXPECT_LT(most, 1e-6F) << scene << " " << kernel << ": more than the weights' rounding";
    }
}

}  // namespace
}  // namespace gn::pcf_test
