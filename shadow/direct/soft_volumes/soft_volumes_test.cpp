// SPDX-License-Identifier: MIT
#include "shadow/direct/soft_volumes/soft_volumes.glsl"

#include "scenes/analytic.h"
#include "shadow/direct/soft_volumes/soft_volumes_table.h"
#include "tests/direct_scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace gn::soft_volumes_test {
namespace {

using namespace glsl;

/// A convex polygon that turns left around some middle.
std::vector<vec2> polygon(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1, 1);
    const vec2 middle(1.3F * unit(random), 1.3F * unit(random));
    const float radius = 0.3F + 0.9F * std::abs(unit(random));
    std::vector<vec2> corners;
    for (int i = 0; i < 5; ++i) {
        const float angle = (static_cast<float>(i) + 0.4F * unit(random)) * 1.2566F;
        corners.push_back(middle + radius * vec2(std::cos(angle), std::sin(angle)));
    }
    return corners;
}
bool inside(const std::vector<vec2>& corners, vec2 p) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (gn_cross2(corners[(i + 1) % corners.size()] - corners[i], p - corners[i]) < 0) {
            return false;
        }
    }
    return true;
}

TEST(SoftVolumesLaws, edges_and_the_centre_add_up_to_what_a_caster_hides) {
    std::mt19937 random(5);
    constexpr int side = 400;
    for (int round = 0; round < 60; ++round) {
        const bool square = round % 2 == 0;
        const std::vector<vec2> corners = polygon(random);
        // By counting points of the light.
        int in = 0, all = 0;
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const vec2 p = (vec2(x, y) + 0.5F) / (0.5F * side) - 1.0F;
                if (square || dot(p, p) <= 1) {
                    ++all;
                    in += inside(corners, p) ? 1 : 0;
                }
            }
        }
        // By the hard shadow and the edges; the centre is beside the caster where it is to the right of an edge.
        float hidden = inside(corners, {0, 0}) ? 1.0F : 0.0F;
        vec4 quarters(0);
        for (std::size_t i = 0; i < corners.size(); ++i) {
            vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
            if (gn_cut_to_light(square, a, b)) {
                const float sign = gn_cross2(a, b) > 0 ? -1.0F : 1.0F;
                hidden += sign * gn_beyond(square, a, b);
                for (int q = 0; q < 4; ++q) {
                    vec2 c = a, d = b;
                    if (gn_soft_volumes_quarter({(q & 1) != 0 ? 1 : -1, (q & 2) != 0 ? 1 : -1}, c, d)) {
                        quarters[q] += sign * gn_beyond(square, c, d);
                    }
                }
            }
        }
        // Points of a grid miss a straight line's area by a cell a row at the worst, and mostly by far less.
        EXPECT_NEAR(hidden, static_cast<double>(in) / all, 0.004) << round;
        const float hard = inside(corners, {0, 0}) ? 0.0F : 1.0F;
        EXPECT_NEAR(gn_soft_volumes_light4(hard, quarters), 1 - hidden, 1e-4) << round;
    }
}

TEST(SoftVolumesLaws, the_table_holds_what_segments_hide) {
    for (const bool square : {false, true}) {
        const std::vector<float> table = soft_volumes_table(square, 8);
        ASSERT_EQ(table.size(), 4096U);
        for (std::size_t i = 0; i < table.size(); i += 7) {
            ASSERT_GE(table[i], 0.0F);
            ASSERT_LE(table[i], 0.5F + 1e-5F) << "beyond a segment lies at most half of the light";
        }
        // From (-1, 1/7) to (1, 1/7): all above a line.
        const float share = table[4 * 8 + 0 + 64 * (7 + 8 * 4)];
        const double y = 1.0 / 7;
        const double above = square ? 0.5 * (1 - y) : (std::acos(y) - y * std::sqrt(1 - y * y)) / std::numbers::pi;
        EXPECT_NEAR(share, above, square ? 0.0 + 0.2 : 1e-5);
    }
}

struct Difference {
    double worst = 0, rms = 0;
    std::size_t far = 0, penumbra = 0;
};
Difference from_closed_form(const test::Comparison& c, double allowed) {
    Difference d;
    for (std::size_t i = 0; i < c.truth.visibility.size(); ++i) {
        const dvec3 p_ws(c.frame.samples.position_ws[i]);
        if (c.truth.counted[i] == 0 || std::abs(p_ws.y) > 1e-5) {
            continue;
        }
        const double v = *c.scene.closed_form(0, p_ws),
                     off = std::abs(v - static_cast<double>(c.visibility().values[i]));
        if (v > 0 && v < 1) {
            ++d.penumbra;
            d.rms += off * off;
        }
        d.worst = std::max(d.worst, off);
        d.far += off > allowed ? 1 : 0;
    }
    d.rms = std::sqrt(d.rms / static_cast<double>(d.penumbra));
    return d;
}

TEST(SoftVolumesRendered, slab_is_exact) {
    for (const char* light : {"slab", "slab:light=spot"}) {
        const Difference d =
            from_closed_form(test::compare(light, "soft-volumes", {.width = 96, .height = 96, .samples = 16}), 1e-3);
        EXPECT_GT(d.penumbra, 1000U);
        // A pixel on the hard edge itself may take either side of it, once a row at most and mostly never.
        EXPECT_LE(d.far, 4U) << light << ", the worst " << d.worst;
    }
}

TEST(SoftVolumesRendered, the_table_errs_by_its_steps) {
    const auto rms = [](const char* recipe) {
        return from_closed_form(test::compare("slab", recipe, {.width = 64, .height = 64, .samples = 16}), 1).rms;
    };
    const double coarse = rms("soft-volumes,soft-volumes.coverage=table,soft-volumes.table=8");
    const double fine = rms("soft-volumes,soft-volumes.coverage=table,soft-volumes.table=24");
    EXPECT_LT(coarse, 0.05);
    EXPECT_LT(fine, 0.5 * coarse);
}

TEST(SoftVolumesRendered, casters_one_behind_the_other_hide_their_sum) {
    // Two boards that hide the same half of the light: what both hide is counted twice, up to all of it.
    const scenes::Sheet low{1, {-1, -1}, {0, 1}}, high{1.2, {-1, -1}, {0, 1}};
    by_hand::SceneBuilder b;
    b.ground(6).camera({0.2F, 1.5F, 2}, {0, 0, 0});
    for (const scenes::Sheet& s : {low, high}) {
        const vec3 from(s.low.x, s.y, s.low.y), to(s.high.x, s.y, s.high.y);
        b.quad({from.x, from.y, to.z}, {to.x, from.y, to.z}, {to.x, from.y, from.z}, {from.x, from.y, from.z});
    }
    GnLight light = by_hand::rectangle({0, 4, 0}, {0, 0, 0});
    light.right_ws = vec4(1, 0, 0, 0);
    light.up_ws = vec4(0, 0, 1, 0);
    light.half_size = {0.8F, 0.8F};
    b.light(light);
    const test::Comparison c = test::compare(b.scene(), "soft-volumes", {.width = 64, .height = 64, .samples = 16});
    std::size_t far = 0, twice = 0;
    for (std::size_t i = 0; i < c.truth.visibility.size(); ++i) {
        const dvec3 p_ws(c.frame.samples.position_ws[i]);
        if (c.truth.counted[i] != 0 && std::abs(p_ws.y) < 1e-5) {
            const double v1 = *scenes::sheet_visibility(light, {&low, 1}, p_ws);
            const double v2 = *scenes::sheet_visibility(light, {&high, 1}, p_ws);
            const double hidden = 2 - v1 - v2;
            // Where the centre is in both shadows the hard one counts once, and what edges show is taken off twice.
            const double expected = std::clamp(1 - hidden, 0.0, 1.0);
            const bool both = p_ws.x < 0 && std::abs(p_ws.z) < 1.5;
            far += !both && std::abs(expected - static_cast<double>(c.visibility().values[i])) > 1e-3 ? 1 : 0;
            twice += hidden - (1 - std::min(v1, v2)) > 0.1 && hidden < 1 ? 1 : 0;
        }
    }
    EXPECT_GT(twice, 100U);
    EXPECT_LE(far, 4U);
}

TEST(SoftVolumesLaws, a_box_holds_what_a_caster_hides) {
    // A half-plane whose edge runs along y at x = 0.25, with what lies to the left hidden: seen from the middle, which is hidden
    // too, what is shown lies to the right.
    const vec4 half = gn_soft_volumes_box(true, {0.25F, -1}, {0.25F, 1});
    EXPECT_NEAR(gn_soft_volumes_box_share(true, half), 0.375F, 1e-6F);
    EXPECT_EQ(half, vec4(0.25F, -1, -1, -1));
    // A caster within the light is bounded by its edges alone; its mirror image turns the other way and has the same box.
    const vec4 small = gn_soft_volumes_box(true, {0.2F, 0.1F}, {0.6F, 0.5F});
    EXPECT_EQ(small, vec4(0.2F, 0.1F, -0.6F, -0.5F));
    EXPECT_EQ(gn_soft_volumes_box(true, {0.6F, 0.5F}, {0.2F, 0.1F}), small);
    // On a disc the border bulges beyond the ends.
    const float s = std::sqrt(0.5F);
    EXPECT_NEAR(gn_soft_volumes_box(false, {s, -s}, {s, s}).z, -1, 1e-6F);
    // V is held to the share from both sides.
    EXPECT_EQ(gn_soft_volumes_bounded(1, 0.8F, 0.5F), 0.5F);
    EXPECT_EQ(gn_soft_volumes_bounded(0, -0.8F, 0.5F), 0.5F);
    EXPECT_EQ(gn_soft_volumes_bounded(1, 0.3F, 0.5F), 0.7F);
}

TEST(SoftVolumesRendered, boxes_and_quarters_and_pieces_err_less_where_casters_overlap) {
    const auto rms = [](const std::string& recipe) {
        return from_closed_form(test::compare("overlap", recipe, {.width = 48, .height = 48, .samples = 16}), 1).rms;
    };
    const double plain = rms("soft-volumes");
    EXPECT_LT(rms("soft-volumes,soft-volumes.bounded=true"), 0.9 * plain);
    EXPECT_LT(rms("soft-volumes,soft-volumes.regions=four"), 0.8 * plain);
    const double four = rms("soft-volumes-split");
    EXPECT_LT(four, 0.6 * plain);
    EXPECT_LT(rms("soft-volumes-split,split.side=3"), four);
}

TEST(SoftVolumesRendered, one_box_for_four_regions_is_refused) {
    const Scene& scene = test::built_in("slab");
    SceneGpu uploaded = upload_scene(test::device(), scene);
    const FrameResult frame =
        render_frame(test::device(), uploaded, scene.cameras.front(),
                     load_recipe("soft-volumes,soft-volumes.regions=four,soft-volumes.bounded=true"),
                     {.width = 8, .height = 8, .picture = false});
    EXPECT_NE(frame.refused.front().find("take it with soft-volumes.regions=one"), std::string::npos);
}

}  // namespace
}  // namespace gn::soft_volumes_test
