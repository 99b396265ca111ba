// SPDX-License-Identifier: MIT
// What a map's texels hide of the light, exactly: one of them, two that overlap, and all of them.
#include "scenes/analytic.h"
#include "shadow/lookup/backprojection/contours.glsl"
#include "shadow/lookup/backprojection/cover.glsl"
#include "shadow/lookup/backprojection/light_plane.glsl"
#include "shadow/lookup/backprojection/search.glsl"
#include "shadow/lookup/backprojection/sparse.glsl"
#include "shadow/show/show.h"
#include "tests/rig.h"
#include "tests/warp_scene.h"

#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <set>

namespace gn::backprojection_test {
namespace {

constexpr int rows = 32, columns = 32;

bool is_point(int k, int c) {
    return c % 4 == static_cast<int>(glsl::gn_back_column(k));
}

bool bit(const glsl::GnBackMask& mask, int k, int c) {
    const uint word = k < 16 ? mask.low[k / 4] : mask.high[k / 4 - 4];
    return is_point(k, c) && (word >> static_cast<uint>(c) & 1U) != 0;
}

using Corners = std::array<vec2, 4>;

glsl::GnBackCover hide(glsl::GnBackCover cover, const Corners& p, bool bitmask, bool disc = false) {
    return glsl::gn_back_hide(cover, p[0], p[1], p[2], p[3], bitmask, disc);
}

glsl::GnBackMask mask_of(const Corners& p) {
    return hide(glsl::gn_back_nothing(), p, true).mask;
}

/// Whether a point lies in a polygon, by the parity of the edges to its left.
bool inside(const Corners& p, dvec2 x) {
    bool odd = false;
    for (std::size_t i = 0; i < 4; ++i) {
        const dvec2 a(p.at(i)), b(p.at((i + 1) % 4));
        odd ^= (a.y <= x.y) != (b.y <= x.y) && x.x > a.x + (x.y - a.y) / (b.y - a.y) * (b.x - a.x);
    }
    return odd;
}

Corners rectangle(float left, float bottom, float right, float top) {
    return {vec2(left, bottom), vec2(right, bottom), vec2(right, top), vec2(left, top)};
}

TEST(Backprojection, ThePointsOfTheLightAreARotatedGridAndNoTwoShareAColumnOrARow) {
    std::set<float> xs, ys;
    std::array<int, 64> tiles{};
    for (int k = 0; k < rows; ++k) {
        for (int c = 0; c < columns; ++c) {
            if (!is_point(k, c)) {
                continue;
            }
            const vec2 x = glsl::gn_back_sample(k, c);
            xs.insert(std::round(x.x * 4096));
            ys.insert(std::round(x.y * 4096));
            ++tiles.at(static_cast<std::size_t>(k / 4 * 8 + c / 4));
            EXPECT_LT(std::max(std::abs(x.x), std::abs(x.y)), 1);
        }
    }
    EXPECT_EQ(xs.size(), 256U);
    EXPECT_EQ(ys.size(), 256U);
    EXPECT_TRUE(std::all_of(tiles.begin(), tiles.end(), [](int n) { return n == 4; }));
}

TEST(Backprojection, ThePointsOfADiscAreThoseWithinIt) {
    int count = 0;
    const glsl::GnBackMask disc{glsl::gn_back_disc_low, glsl::gn_back_disc_high};
    for (int k = 0; k < rows; ++k) {
        for (int c = 0; c < columns; ++c) {
            const bool within = is_point(k, c) && glm::length(glsl::gn_back_sample(k, c)) < 1;
            EXPECT_EQ(bit(disc, k, c), within) << k << ", " << c;
            count += within ? 1 : 0;
        }
    }
    const glsl::GnBackCover all = hide(glsl::gn_back_nothing(), rectangle(-2, -2, 2, 2), true);
    EXPECT_EQ(glsl::gn_back_hidden(all, true, true), 1) << "divided by " << count;
    EXPECT_EQ(glsl::gn_back_hidden(all, true, false), 1);
}

TEST(Backprojection, AMaskHoldsThePointsWithinThePolygon) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> at(-1.4F, 1.4F);
    for (int turn = 0; turn < 200; ++turn) {
        Corners p{};
        std::generate(p.begin(), p.end(), [&] { return vec2(at(random), at(random)); });
        const glsl::GnBackMask mask = mask_of(p);
        for (int k = 0; k < rows; ++k) {
            for (int c = 0; c < columns; ++c) {
                if (bit(mask, k, c) != (is_point(k, c) && inside(p, glsl::gn_back_sample(k, c)))) {
                    // A point within rounding of an edge may fall to either side.
                    const vec2 x = glsl::gn_back_sample(k, c);
                    bool near = false;
                    for (const vec2 d : {vec2(2e-6F, 0), vec2(-2e-6F, 0), vec2(0, 2e-6F), vec2(0, -2e-6F)}) {
                        near |= inside(p, x + d) != inside(p, x - d);
                    }
                    EXPECT_TRUE(is_point(k, c) && near) << turn << ": " << k << ", " << c;
                }
            }
        }
    }
}

/// Of quarters at each of the points: M(r,t) & ~(M(l,t) | M(r,b)).
TEST(Backprojection, ARectanglesMaskFollowsFromThoseOfItsQuarters) {
    const auto quarter = [](float x, float y) { return mask_of(rectangle(-2, -2, x, y)); };
    std::mt19937 random(11);
    std::uniform_real_distribution<float> at(-1.2F, 1.2F);
    for (int turn = 0; turn < 100; ++turn) {
        const float a = at(random), b = at(random), c = at(random), d = at(random);
        const float l = std::min(a, b), r = std::max(a, b), s = std::min(c, d), t = std::max(c, d);
        const glsl::GnBackMask got = mask_of(rectangle(l, s, r, t));
        const glsl::GnBackMask rt = quarter(r, t), lt = quarter(l, t), rs = quarter(r, s);
        EXPECT_EQ(got.low, rt.low & ~(lt.low | rs.low));
        EXPECT_EQ(got.high, rt.high & ~(lt.high | rs.high));
    }
}

TEST(Backprojection, NeighboursLeaveNoPointBetweenThemAndShareNone) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> off(-0.09F, 0.09F);
    constexpr std::size_t n = 13;
    std::array<std::array<vec2, n>, n> grid{};
    for (std::size_t y = 0; y < n; ++y) {
        for (std::size_t x = 0; x < n; ++x) {
            grid[y][x] = 0.2F * vec2(x, y) - 1.2F + vec2(off(random), off(random));
        }
    }
    glsl::GnBackMask all = glsl::gn_back_no_mask();
    for (std::size_t y = 0; y + 1 < n; ++y) {
        for (std::size_t x = 0; x + 1 < n; ++x) {
            const glsl::GnBackMask one = mask_of({grid[y][x], grid[y][x + 1], grid[y + 1][x + 1], grid[y + 1][x]});
            EXPECT_EQ(all.low & one.low, uvec4(0));
            EXPECT_EQ(all.high & one.high, uvec4(0));
            all = {all.low | one.low, all.high | one.high};
        }
    }
    EXPECT_EQ(glsl::gn_back_share(all, false), 1);
}

TEST(Backprojection, AreasOfASquareAreProductsAndOfADiscSegments) {
    const auto area = [](const Corners& p, bool disc) {
        return glsl::gn_back_hidden(hide(glsl::gn_back_nothing(), p, false, disc), false, disc);
    };
    EXPECT_NEAR(area(rectangle(-3, -0.5F, 0.25F, 4), false), 0.625 * 0.75, 1e-6);
    EXPECT_NEAR(area({vec2(-9, -9), vec2(9, -9), vec2(9, 9), vec2(9, 9)}, false), 0.5, 1e-5) << "below the diagonal";
    for (const double c : {-0.7, 0.0, 0.4}) {
        const double segment = (std::acos(c) - c * std::sqrt(1 - c * c)) / std::acos(-1.0);
        EXPECT_NEAR(area(rectangle(static_cast<float>(c), -5, 7, 5), true), segment, 1e-5) << c;
    }
    EXPECT_NEAR(area(rectangle(-0.1F, -0.2F, 0.3F, 0.1F), true), 0.4 * 0.3 / std::acos(-1.0), 1e-6);
}

/// Two occluders over each other are one to the mask and two to the areas.
TEST(Backprojection, OverlapsCountOnceInTheMaskAndTwiceInTheAreas) {
    const Corners left = rectangle(-2, -2, 0, 2), right = rectangle(0, -2, 2, 2);
    for (const bool bitmask : {false, true}) {
        const auto one = hide(glsl::gn_back_nothing(), left, bitmask);
        EXPECT_EQ(glsl::gn_back_hidden(hide(one, right, bitmask), bitmask, false), 1) << "complementary halves";
        EXPECT_EQ(glsl::gn_back_hidden(hide(one, left, bitmask), bitmask, false), bitmask ? 0.5 : 1.0)
            << "coincident halves";
    }
}

/// X = (u - u_p) z z_p / (n (z_p - z)) for a light across the view in its eye, at near-plane u and distances z; of a sun
/// tan = (u - u_p) / (z_p - z).
TEST(Backprojection, ATexelIsSeenBeforeTheLightWhereTheFormulaSays) {
    for (const char* name : {"slab:radius=0.4", "slab:light=directional,radius=0.05"}) {
        const Scene scene = load_scene(name);
        const GnLight& light = scene.lights.front().shape;
        const LightViews views = test::place(scene, "backprojection,placement=fit");
        const GnLightView& view = views.views.front();
        const vec3 p_ws(0.3F, 0, -0.2F);
        const vec3 q_ws(0.1F, 1.4F, 0.15F);
        const glsl::GnBackLight half_light = glsl::gn_back_light(light, p_ws);
        const glsl::GnBackRays rays = glsl::gn_back_rays(view, half_light);
        const vec2 uv_ts(test::uv_of(view, dvec3(q_ws)));
        const float depth = glm::dot(view.depth_from_ws, vec4(q_ws, 1));
        const vec4 n = glsl::gn_back_point(rays, uv_ts, depth);
        const vec2 seen = glsl::gn_back_seen(rays, n);
        EXPECT_TRUE(glsl::gn_back_between(rays, n));

        // On the light: along the line from the receiver through the texel.
        const vec3 toward_ws = -vec3(light.direction_ws);
        const vec3 way_ws = (q_ws - p_ws) / glm::dot(toward_ws, q_ws - p_ws);
        if (light.kind == GN_LIGHT_DIRECTIONAL) {
            const float tangent = std::tan(light.angular_radius);
            EXPECT_NEAR(seen.x, glm::dot(way_ws, half_light.right_ws) / (tangent * tangent), 2e-3);
            EXPECT_NEAR(seen.y, glm::dot(way_ws, half_light.up_ws) / (tangent * tangent), 2e-3);
            continue;
        }
        const vec3 centre_ws(light.position_ws);
        const float z_p = glm::dot(toward_ws, centre_ws - p_ws), z = glm::dot(toward_ws, centre_ws - q_ws), near = 0.1F;
        const auto on_near = [&](vec3 a_ws, float z_a) {
            return vec2(glm::dot(vec3(light.right_ws), a_ws - centre_ws),
                        glm::dot(vec3(light.up_ws), a_ws - centre_ws)) *
                   (near / z_a);
        };
        const vec2 x_m = (on_near(q_ws, z) - on_near(p_ws, z_p)) * (z * z_p / (near * (z_p - z)));
        EXPECT_NEAR(seen.x, x_m.x / light.half_size.x, 1e-4);
        EXPECT_NEAR(seen.y, x_m.y / light.half_size.y, 1e-4);
    }
}

TEST(Backprojection, ASphereIsTheDiscThatIsSeen) {
    // A cone of half angle asin(r / d) is r d / sqrt(d^2 - r^2) wide at d.
    for (const double d : {0.6, 1.0, 10.0}) {
        EXPECT_NEAR(glsl::gn_back_silhouette(0.5F, static_cast<float>(d)), 0.5 * d / std::sqrt(d * d - 0.25), 1e-5 * d);
    }
}

/// What lies between the receiver and the light, beyond a depth, falls into the searched area; its corners touch its borders.
TEST(Backprojection, TheSearchedAreaHoldsTheReceiversPyramid) {
    const Scene scene = load_scene("slab");
    const GnLight& light = scene.lights.front().shape;
    const GnLightView view = test::place(scene, "backprojection,placement=fit").views.front();
    const vec3 p_ws(0.3F, 0, -0.2F);
    const glsl::GnBackLight half_light = glsl::gn_back_light(light, p_ws);
    const float nearest = glm::dot(view.depth_from_ws, vec4(0, 1.5F, 0, 1));
    const vec4 area = glsl::gn_back_area(view, vec4(0, 0, 1, 1), half_light, nearest);
    vec4 hull(1, 1, 0, 0);
    for (int i = 0; i <= 20; ++i) {
        for (const vec2 x : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)}) {
            const vec3 way_ws = half_light.centre_ws + x.x * half_light.right_ws + x.y * half_light.up_ws;
            const vec3 q_ws = p_ws + way_ws * (static_cast<float>(i) / 20);
            if (glm::dot(view.depth_from_ws, vec4(q_ws, 1)) >= nearest) {
                const vec2 uv(test::uv_of(view, dvec3(q_ws)));
                hull = vec4(glm::min(vec2(hull), uv), glm::max(vec2(hull.z, hull.w), uv));
            }
        }
    }
    EXPECT_TRUE(glm::all(glm::lessThanEqual(vec2(area), vec2(hull) + 1e-6F)));
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(vec2(area.z, area.w), vec2(hull.z, hull.w) - 1e-6F)));
    EXPECT_LT(area.z - area.x, 1.2F * (hull.z - hull.x)) << "no more than a step wider";
}

/// Root of the mean square of V minus the closed form, over samples of which it says `part`.
template <class Select>
double rmse_where(const test::Comparison& c, Select part) {
    double sum = 0;
    double count = 0;
    for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
        const dvec3 p_ws(c.frame.samples.position_ws[i]);
        if (c.truth.counted[i] == 0 || !part(p_ws)) {
            continue;
        }
        const double wrong = c.visibility().values[i] - c.scene.closed_form(0, p_ws).value();
        sum += wrong * wrong;
        count += 1;
    }
    EXPECT_GT(count, 100);
    return std::sqrt(sum / count);
}

TEST(BackprojectionRendered, ASlabsPenumbraIsTheProductOfItsRamps) {
    for (const char* scene : {"slab", "slab:light=spot"}) {
        const auto c = test::compare(scene, "backprojection", {.width = 128, .height = 96, .samples = 1});
        EXPECT_LE(rmse_where(c, [](dvec3 p) { return p.y < 0.1; }), 0.01) << scene;
    }
}

/// The mask needs no more of the occluders than that they cover what the texels do. Over the map's own texels, which 256 a side allow.
TEST(BackprojectionRendered, ASlabIsTheSameByWhateverStandsForItsTexels) {
    for (const char* occluder : {"micropatch", "microquad", "microtri", "microrect", "contour"}) {
        const auto c = test::compare(
            "slab",
            fmt::format("backprojection,backprojection.occluder={},backprojection.budget=0,resolution=256", occluder),
            {.width = 64, .height = 48, .samples = 1});
        EXPECT_LE(rmse_where(c, [](dvec3 p) { return p.y < 0.1; }), 0.01) << occluder;
        for (const float v : c.visibility().values) {
            ASSERT_EQ(256 * v, std::round(256 * v)) << "of 256 points";
        }
    }
}

/// Edges between the middles of a window's sides: what they enclose is half of a window that two texels beside each other hide, an
/// eighth at a corner, all but an eighth of three, and what two corners leave.
TEST(Backprojection, OutlinesRunAroundWhatTheTexelsHide) {
    const std::array<vec2, 4> sides{vec2(0.5F, 0), vec2(1, 0.5F), vec2(0.5F, 1), vec2(0, 0.5F)};
    const auto hidden = [](int window, std::array<int, 4> bits) {
        const int count = static_cast<int>(std::popcount(static_cast<unsigned>(window)));
        const bool opposite = count == 2 && (window == bits[0] + bits[2] || window == bits[1] + bits[3]);
        return opposite ? 0.75 : std::array<double, 5>{0, 0.125, 0.5, 0.875, 1}.at(static_cast<std::size_t>(count));
    };
    std::mt19937 random(5);
    constexpr int n = 9;
    for (int turn = 0; turn < 20; ++turn) {
        std::array<std::array<int, n>, n> hides{};
        for (int y = 1; y + 1 < n; ++y) {
            for (int x = 1; x + 1 < n; ++x) {
                hides.at(static_cast<std::size_t>(y)).at(static_cast<std::size_t>(x)) = static_cast<int>(random() % 2);
            }
        }
        double enclosed = 0, expected = 0;
        for (std::size_t y = 0; y + 1 < n; ++y) {
            for (std::size_t x = 0; x + 1 < n; ++x) {
                const int window = hides.at(y).at(x) + 2 * hides.at(y).at(x + 1) + 4 * hides.at(y + 1).at(x + 1) +
                                   8 * hides.at(y + 1).at(x);
                expected += hidden(window, {1, 2, 4, 8});
                const uint segments = glsl::gn_back_segments(window);
                for (uint i = 0; i < segments >> 8; ++i) {
                    // Twice the signed area between the edge and the origin, what hides on the edge's left.
                    const dvec2 from = dvec2(x, y) + dvec2(sides.at(segments >> (4 * i) & 3U));
                    const dvec2 to = dvec2(x, y) + dvec2(sides.at(segments >> (4 * i + 2) & 3U));
                    enclosed += 0.5 * (from.x * to.y - from.y * to.x);
                }
            }
        }
        EXPECT_NEAR(enclosed, expected, 1e-9);
    }
}

/// Seen from the light the sides of a box are steps in depth, not holes: without walls light leaks through them.
TEST(BackprojectionRendered, WallsCloseTheGapsBetweenPatches) {
    const auto leak = [](const char* gaps) {
        return *test::compare("contact:radius=5",
                              fmt::format("backprojection,backprojection.occluder=micropatch,backprojection.budget=0,"
                                          "resolution=128,backprojection.gaps={}",
                                          gaps),
                              {.width = 64, .height = 48, .samples = 64})
                    .errors.leak;
    };
    EXPECT_LT(leak("true"), 0.3 * leak("false"));
}

/// Two sheets that touch as the map sees them, a metre apart: the light is seen between them from its sides. No early-out says that
/// they hide all of it.
TEST(BackprojectionRendered, GapsThatAreTooDeepStayOpen) {
    const auto rmse = [](const char* settings) {
        return *test::compare(
                    "overlap:arrangement=opposite",
                    fmt::format("backprojection,backprojection.budget=0,resolution=128,backprojection.{}", settings),
                    {.width = 48, .height = 36, .samples = 256})
                    .errors.rmse;
    };
    EXPECT_GT(rmse("gap_limit=0"), 0.06) << "closed";
    EXPECT_LT(rmse("gap_limit=0.2"), 0.02) << "quads that span the gap are left out, a texel at each side of it";
    EXPECT_LT(rmse("gap_limit=0.2,backprojection.occluder=micropatch"), 0.005);
}

/// A light of 1 m at 5 m, whose halves z < 0 of the view see two sheets at 3 m and 2 m over each other: two layers of the map.
TEST(BackprojectionRendered, OverlapsAreRightByPointsAndWrongByAreasAsPredicted) {
    const scenes::Sheet high{3, {-14, -14}, {0, 0}}, low{2, {-14, -14}, {0, 14}};
    struct Case {
        const char* settings;
        double (*expected)(double, double);
    };
    for (const Case& fusion :
         {Case{"fusion=union", [](double a, double b) { return std::min(a, b); }},
          Case{"fusion=farthest", [](double, double b) { return b; }},
          Case{"fusion=sum,backprojection.combine=area", [](double a, double b) { return std::max(a + b - 1, 0.0); }},
          Case{"fusion=product", [](double a, double b) { return a * b; }},
          Case{"fusion=max", [](double a, double b) { return std::min(a, b); }},
          // eq. 1.5: the middle between the greatest that either hides and what both hide apart from each other.
          Case{"fusion=mean", [](double a, double b) { return (std::min(a, b) + std::max(a + b - 1, 0.0)) / 2; }}}) {
        const auto c = test::compare(
            "overlap",
            fmt::format("backprojection,resolution=192,backprojection.layers=2,backprojection.{}", fusion.settings),
            {.width = 40, .height = 30, .samples = 1});
        const GnLight& light = c.scene.lights.front().shape;
        double sum = 0;
        double count = 0;
        for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
            const dvec3 p_ws(c.frame.samples.position_ws[i]);
            if (c.truth.counted[i] == 0 || p_ws.y > 0.1 || p_ws.z > -1) {
                continue;
            }
            const double expected = fusion.expected(scenes::sheet_visibility(light, {&high, 1}, p_ws).value(),
                                                    scenes::sheet_visibility(light, {&low, 1}, p_ws).value());
            const double wrong = c.visibility().values[i] - expected;
            sum += wrong * wrong;
            count += 1;
        }
        EXPECT_GT(count, 100);
        EXPECT_LE(std::sqrt(sum / count), 0.02) << fusion.settings;
    }
}

/// What pyramids narrow and decide is what the loop over all texels finds, bit for bit.
TEST(BackprojectionRendered, EarlyOutsAndNarrowerSearchesChangeNoSample) {
    // Where the receiver's plane is followed, what lies up a slope is before a receiver and hides nothing from it.
    const char* const plane = "bias.receiver_plane=true";
    for (const auto& [scene, bias] : {std::pair{"slab", "resolution=48"},
                                      {"contact:light=spot", "resolution=48"},
                                      {"contact", "resolution=48"},
                                      {"contact:radius=2,elevation=20", plane}}) {
        const auto values = [&](const char* settings) {
            return test::compare(
                       scene,
                       fmt::format("backprojection,resolution=48,{},backprojection.budget=0,backprojection.{}", bias,
                                   settings),
                       {.width = 24, .height = 18, .samples = 1})
                .visibility()
                .values;
        };
        const auto all = values("pyramid=none");
        for (const char* pyramid : {"pyramid=hsm", "pyramid=mssm", "pyramid=ysm", "early_out=false", "refine=0"}) {
            EXPECT_EQ(values(pyramid), all) << scene << ", " << pyramid;
        }
        if (std::string_view(bias) == plane || std::string_view(scene) == "contact") {
            continue;
        }
        // Patches with their walls leave no gap either; areas that overlap add up in another order.
        const std::string walls = "occluder=micropatch,backprojection.";
        EXPECT_EQ(values((walls + "pyramid=ysm").c_str()), values((walls + "pyramid=none").c_str())) << scene;
        const std::string areas = "combine=area,backprojection.";
        const auto by_area = values((areas + "pyramid=ysm").c_str()),
                   in_full = values((areas + "pyramid=none").c_str());
        for (std::size_t i = 0; i < by_area.size(); ++i) {
            EXPECT_NEAR(by_area[i], in_full[i], 1e-4) << scene << ", areas, sample " << i;
        }
    }
}

/// What a search tells of itself: classes say V, and a budget is kept by coarser levels.
TEST(BackprojectionRendered, WhatASearchTellsOfItselfIsWhatItDid) {
    const Scene& scene = test::built_in("slab");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const auto told = [&](const char* settings) {
        const Recipe recipe = load_recipe(fmt::format("backprojection,resolution=512,backprojection.{}", settings));
        const std::vector<std::string> names{"search-class", "visited-texels", "level"};
        const std::vector<Shown> shown =
            show_hidden(test::device(), gpu, scene.camera(""), recipe, names, {.width = 64, .height = 48});
        const FrameResult frame =
            render_frame(test::device(), gpu, scene.camera(""), recipe,
                         {.width = 64, .height = 48, .repeat = 0, .only_light = 0, .picture = false});
        const std::vector<float>& v = frame.visibility.front().values;
        std::array<int, 4> of{};
        float most = 0, coarsest = 0;
        for (std::size_t i = 0; i < v.size(); ++i) {
            const auto value = [&](std::size_t k) { return shown.at(k).values.values.at(2 * i); };
            const auto why = static_cast<std::size_t>(value(0));
            ++of.at(why);
            EXPECT_TRUE(why != 1 || v[i] == 1) << i;
            EXPECT_TRUE(why != 2 || v[i] == 0) << i;
            EXPECT_EQ(why == 3, value(1) > 0) << i;
            most = std::max(most, value(1));
            coarsest = std::max(coarsest, value(2));
        }
        EXPECT_GT(of[1], 100) << "lit";
        EXPECT_GT(of[2], 10) << "umbra";
        EXPECT_GT(of[3], 100) << "read";
        return vec2(most, coarsest);
    };
    const vec2 all = told("budget=0"), some = told("budget=144");
    EXPECT_EQ(all.y, 0);
    EXPECT_NEAR(some.y, 0.5F * std::log2(all.x / 144), 0.2F);
    // The finer of two levels that are blended has up to four times as many, and cells at both ends of a side.
    EXPECT_LT(some.x, 27 * 27);
    EXPECT_GT(some.x, 144);
}

TEST(Backprojection, SamplesMoveApartAsPenumbraeWiden) {
    GnBackprojectionParams params;
    params.sparse = 3;
    params.sparse_samples = 8;
    EXPECT_EQ(glsl::gn_back_apart(0, params), 0);
    EXPECT_EQ(glsl::gn_back_apart(15.9F, params), 0);
    EXPECT_EQ(glsl::gn_back_apart(16.1F, params), 1);
    EXPECT_EQ(glsl::gn_back_apart(40, params), 2);
    EXPECT_EQ(glsl::gn_back_apart(1000, params), 3);

    // What a pass tells the next one arrives, and a mixture of two views is neither.
    for (int apart = 0; apart <= 4; ++apart) {
        const float told = glsl::gn_back_told(-1, apart);
        EXPECT_EQ(glsl::gn_back_told_visibility(told), -1);
        EXPECT_EQ(glsl::gn_back_told_apart(told), apart);
    }
    EXPECT_EQ(glsl::gn_back_told_visibility(glsl::gn_back_told(1, 2)), 1);
    EXPECT_EQ(glsl::gn_back_told_visibility(glsl::gn_back_told(0, 2)), 0);
    EXPECT_EQ(glsl::gn_back_told_visibility(0.9F), -1);
    EXPECT_EQ(glsl::gn_back_told_apart(0.9F), 0);
}

/// Samples that are looked up lattice by lattice have the V that they have together; what is interpolated is near it.
TEST(BackprojectionRendered, SparseSamplesAreTheSameAndOthersAreNear) {
    const test::ComparisonOptions size{.width = 63, .height = 47, .samples = 1};
    for (const char* scene : {"slab", "contact:light=spot"}) {
        const auto values = [&](const char* settings) {
            return test::compare(scene, fmt::format("backprojection,resolution=256{}", settings), size)
                .visibility()
                .values;
        };
        const std::vector<float> all = values("");
        EXPECT_EQ(values(",backprojection.sparse=3,backprojection.sparse_samples=64"), all)
            << "no penumbra is as wide as twice the picture";
        const std::vector<float> some = values(",backprojection.sparse=3,backprojection.sparse_samples=4");
        double squares = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            squares += static_cast<double>((some[i] - all[i]) * (some[i] - all[i]));
        }
        // A ramp of n samples, between which a curve of at most one over its width is straight: n^-2 / 8 and its like at corners.
        EXPECT_LT(std::sqrt(squares / static_cast<double>(all.size())), 0.02) << scene;
    }
}

TEST(BackprojectionRendered, WithoutSizeTheShadowIsHard) {
    for (const char* scene : {"slab:hard=1", "slab:hard=1,light=point", "slab:hard=1,light=directional"}) {
        const test::ComparisonOptions options{.width = 64, .height = 48, .samples = 1};
        const auto soft = test::compare(scene, "backprojection,backprojection.least=0", options);
        const auto hard = test::compare(scene, "hard", options);
        EXPECT_EQ(soft.visibility().values, hard.visibility().values) << scene;
    }
}

}  // namespace
}  // namespace gn::backprojection_test
