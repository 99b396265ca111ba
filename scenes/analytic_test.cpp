// SPDX-License-Identifier: MIT
// Closed forms against brute force: double-precision rays through the scene's own triangles.
#include "scenes/analytic.h"

#include "scenes/noise.h"
#include "tests/thorough.h"

#include <gtest/gtest.h>

namespace gn::scenes {
namespace {

// Möller and Trumbore's test of the open segment (p, p + d) against one triangle.
bool crosses(const Scene& scene, uvec3 t, dvec3 p, dvec3 d) {
    const dvec3 a(scene.positions_ws[t.x]), e1 = dvec3(scene.positions_ws[t.y]) - a,
                                            e2 = dvec3(scene.positions_ws[t.z]) - a;
    const dvec3 h = glm::cross(d, e2);
    const double det = glm::dot(e1, h);
    if (std::abs(det) < 1e-14) {
        return false;
    }
    const dvec3 s = p - a, q = glm::cross(s, e1);
    const double u = glm::dot(s, h) / det, v = glm::dot(d, q) / det, at = glm::dot(e2, q) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && at > 1e-7 && at < 1;
}

bool blocked(const Scene& scene, dvec3 p, dvec3 d) {
    for (const uvec3 t : scene.triangles) {
        if (crosses(scene, t, p, d)) {
            return true;
        }
    }
    return false;
}

// Where a random ray of a camera first meets the scene, lifted off the surface by a tenth of a millimetre or nothing.
struct Seen {
    dvec3 p, n;
};
std::optional<Seen> first_hit(const Scene& scene, const Camera& camera, dvec2 ndc) {
    const dvec3 f(camera.forward_ws), r = glm::normalize(glm::cross(f, dvec3(camera.up_ws))), u = glm::cross(r, f);
    const double half = std::tan(0.5 * camera.yfov);
    const dvec3 eye(camera.position_ws), d = f + half * (ndc.x * r + ndc.y * u);
    double nearest = 1e30;
    std::optional<Seen> seen;
    for (const uvec3 t : scene.triangles) {
        const dvec3 a(scene.positions_ws[t.x]), b(scene.positions_ws[t.y]), c(scene.positions_ws[t.z]);
        const dvec3 n = glm::cross(b - a, c - a);
        const double along = glm::dot(n, d);
        const double at = glm::dot(a - eye, n) / along;
        if (along == 0 || !(at > 0 && at < nearest) || !crosses(scene, t, eye, d * at * 2.0)) {
            continue;
        }
        nearest = at;
        seen = Seen{eye + at * d, glm::normalize(along < 0 ? n : -n)};
    }
    return seen;
}

// Mean of unblocked segments to the cells of a k x k raster over the light (a rectangle or a spot's disc).
double traced(const Scene& scene, const GnLight& light, dvec3 p, int k) {
    if (light.kind == uint(GN_LIGHT_DIRECTIONAL)) {
        return blocked(scene, p, -dvec3(light.direction_ws) * 1e4) ? 0 : 1;
    }
    const bool disc = light.kind != uint(GN_LIGHT_RECTANGLE);
    const dvec2 half = disc ? dvec2(light.radius) : dvec2(light.half_size);
    double lit = 0, total = 0;
    for (int i = 0; i < k * k; ++i) {
        const dvec2 cell = 2.0 * (dvec2(i % k, i / k) + 0.5) / static_cast<double>(k) - 1.0;
        if (disc && glm::dot(cell, cell) > 1) {
            continue;
        }
        const dvec3 q =
            dvec3(light.position_ws) + half.x * cell.x * dvec3(light.right_ws) + half.y * cell.y * dvec3(light.up_ws);
        total += 1;
        lit += blocked(scene, p, q - p) ? 0 : 1;
    }
    return lit / total;
}

struct Case {
    const char* scene;
    int receivers, raster;
    double tolerance;  ///< of the raster: half a cell for every straight border that can cross the light
    bool has_lit = true, has_dark = true;
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.scene;
}

class ClosedForm : public ::testing::TestWithParam<Case> {};

TEST_P(ClosedForm, EqualsBruteForceAtRandomReceiversOfEveryView) {
    const Case c = GetParam();
    const Scene scene = make_builtin_scene(c.scene);
    ASSERT_TRUE(scene.closed_form);
    const GnLight light = scene.lights.at(0).shape;
    Dice dice(7);
    int compared = 0, lit = 0, dark = 0;
    for (const Camera& camera : scene.cameras) {
        for (int i = 0; i < c.receivers; ++i) {
            const auto seen = first_hit(scene, camera, {dice.between(-1, 1), dice.between(-1, 1)});
            if (!seen || !gn_counted(light, vec3(seen->p), vec3(seen->n))) {
                continue;
            }
            const auto expected = scene.closed_form(0, seen->p);
            ASSERT_TRUE(expected.has_value()) << c.scene;
            const double measured = traced(scene, light, seen->p + 2e-7 * seen->n, c.raster);
            EXPECT_NEAR(measured, *expected, c.tolerance)
                << c.scene << " view " << camera.name << " at " << seen->p.x << ' ' << seen->p.y << ' ' << seen->p.z;
            ++compared;
            lit += *expected > 0.99 ? 1 : 0;
            dark += *expected < 0.01 ? 1 : 0;
        }
    }
    EXPECT_GT(compared, c.receivers / 4) << c.scene << ": too few receivers in view";
    EXPECT_EQ(lit > 0, c.has_lit) << c.scene;
    EXPECT_EQ(dark > 0, c.has_dark) << c.scene;
}

// A raster of k cells misplaces each border by at most half a cell of 2/k across the unit light: 1/(2k) of its area a
// border, and up to twice that for the disc, whose own rim is rasterized too.
INSTANTIATE_TEST_SUITE_P(
    Scenes, ClosedForm,
    ::testing::ValuesIn(test::picked<Case>({Case{"half-plane", 200, 128, 1.0 / 256},
                                            Case{"half-plane:radius=0.1", 200, 64, 1.0 / 128},
                                            Case{"half-plane:hard=1", 400, 1, 0},
                                            Case{"half-plane:light=spot", 100, 128, 0.012},
                                            Case{"half-plane:light=point,hard=1", 400, 1, 0},
                                            Case{"half-plane:light=directional,hard=1", 400, 1, 0},
                                            Case{"slab", 200, 128, 4.0 / 256},
                                            Case{"slab:light=spot,radius=0.4", 100, 128, 0.02},
                                            Case{"slab:hard=1", 400, 1, 0},
                                            Case{"overlap", 200, 128, 8.0 / 256},
                                            Case{"overlap:arrangement=same", 100, 128, 2.0 / 256},
                                            Case{"overlap:arrangement=opposite", 100, 128, 2.0 / 256, false},
                                            Case{"overlap:hard=1", 300, 1, 0},
                                            Case{"stack", 400, 1, 0},
                                            Case{"tilted:angle=89", 100, 1, 0, true, false},
                                            Case{"tilted:angle=0,light=spot", 100, 1, 0, true, false},
                                            Case{"contact", 500, 1, 0},
                                            Case{"contact:light=point", 500, 1, 0},
                                            Case{"fence", 120, 1, 0},
                                            Case{"corridor", 200, 1, 0},
                                            Case{"duel", 400, 1, 0},
                                            Case{"duel:light=spot", 400, 1, 0}})));

TEST(ClosedForms, HalfPlaneIsALinearRampOfTheCatalogueWidth) {
    // Light 1 m wide at 4 m, occluder at 2 m below it: the ramp is 1 * (4 - 2) / 2 = 1 m wide.
    const Scene scene = make_builtin_scene("half-plane");
    for (int i = -12; i <= 12; ++i) {
        const double x = 0.05 * i;
        EXPECT_NEAR(*scene.closed_form(0, {x, 0, 0.2}), std::clamp(0.5 + x, 0.0, 1.0), 1e-9) << x;
    }
}

TEST(ClosedForms, OverlapFusesOccluders) {
    const Scene scene = make_builtin_scene("overlap");
    EXPECT_NEAR(*scene.closed_form(0, {0, 0, -1.5}), 0.5, 1e-9);  // the same half twice
    EXPECT_NEAR(*scene.closed_form(0, {0, 0, 1.5}), 0.0, 1e-9);   // both halves
}

TEST(ClosedForms, NothingIsClaimedForLightsWithoutOne) {
    EXPECT_FALSE(make_builtin_scene("slab:light=point").closed_form(0, dvec3(0)).has_value());
    EXPECT_FALSE(make_builtin_scene("contact:radius=1").closed_form(0, dvec3(0, 0, 3)).has_value());
    EXPECT_FALSE(make_builtin_scene("tilted:angle=89,radius=2").closed_form(0, dvec3(0)).has_value());
}

TEST(ClosedForms, DiscIsClippedExactly) {
    EXPECT_NEAR(unit_disc_area(2, 2), std::numbers::pi, 1e-12);
    EXPECT_NEAR(unit_disc_area(0, 2), 0.5 * std::numbers::pi, 1e-12);
    EXPECT_NEAR(unit_disc_area(0, 0), 0.25 * std::numbers::pi, 1e-12);
    EXPECT_NEAR(unit_disc_area(-2, 0.3), 0, 1e-12);
    // The four corners around any cross add up to the disc.
    const double x = 0.37, z = -0.61;
    EXPECT_NEAR(unit_disc_area(x, z) + unit_disc_area(-x, z) + unit_disc_area(x, -z) + unit_disc_area(-x, -z),
                std::numbers::pi, 1e-12);
}

TEST(ClosedForms, BleedingFollowsEquation34) {
    // Chebyshev's bound from the two-plane moments, computed the long way.
    const double a = -stack_scene::height_a, b = -stack_scene::height_b;
    for (const double dy : {0.0, 0.4, stack_scene::dy, 5.0}) {
        const double mean = 0.5 * (a + b), variance = 0.5 * (a * a + b * b) - mean * mean, t = b + dy;
        EXPECT_NEAR(stack_scene::bleeding(dy), variance / (variance + (t - mean) * (t - mean)), 1e-12) << dy;
    }
}

TEST(ContactGap, MeasuresHowFarLightLeaksFromTheFoot) {
    const Scene scene = make_builtin_scene("contact");
    const GnLight light = scene.lights[0].shape;
    // Samples on the ground behind the box; light leaks up to 4 cm from the foot.
    std::vector<vec4> points;
    std::vector<float> exact, leaking;
    Dice dice(3);
    for (int i = 0; i < 20000; ++i) {
        const vec4 p(dice.between(-1.5F, 1.5F), 0, dice.between(-1.5F, 1.5F), 1);
        const double truth = *scene.closed_form(0, dvec3(p));
        const double away = contact_scene::distance_to_foot(dvec3(p));
        if (away == 0) {
            continue;
        }
        points.push_back(p);
        exact.push_back(static_cast<float>(truth));
        leaking.push_back(away < 0.04 ? 1.0F : static_cast<float>(truth));
    }
    EXPECT_EQ(contact_scene::gap(light, points, exact), 0);
    // Never more than what leaks; of 20000 points on nine square metres some 25 lie in the outermost 3 mm around the foot.
    EXPECT_LE(contact_scene::gap(light, points, leaking), 0.04);
    EXPECT_GE(contact_scene::gap(light, points, leaking), 0.037);
}

}  // namespace
}  // namespace gn::scenes
