// SPDX-License-Identifier: MIT
// Rows that neighbours have read are as good as one's own where edges run along the light's axes, and a half-plane's penumbra is as
// wide as the light makes it.
#include "shadow/lookup/sssm/sssm.glsl"

#include "tests/penumbra.h"

#include <cmath>

namespace gn::sssm_test {
namespace {

using namespace gn::glsl;

TEST(Sssm, PointsOfADiscSpreadAsItsAreaDoes) {
    // A quarter of the squared radius along each axis, of a square a third of half the side.
    for (const bool square : {false, true}) {
        double sum = 0, squares = 0;
        for (int i = 0; i < 100; ++i) {
            const float x = gn_sssm_point(i, 100, 0.5F, 0);
            sum += static_cast<double>(gn_sssm_weight(square, x));
            squares += static_cast<double>(gn_sssm_weight(square, x) * x * x);
        }
        EXPECT_NEAR(squares / sum, square ? 1.0 / 3 : 1.0 / 4, 1e-3);
    }
}

TEST(Sssm, TheNeighbourIsWhereTheLightSeesTheKernelsPoint) {
    GnLight light;
    light.position_ws = vec4(0.3F, 4, -1, 1);
    light.direction_ws = vec4(glm::normalize(vec3(0.4F, -1, 0.2F)), 0);
    const vec3 p_ws(1, 0.5F, 2), n_ws = glm::normalize(vec3(0.5F, 1, -0.25F)), way_ws(0.3F, 0.1F, -0.2F);
    for (const uint kind : {GN_LIGHT_POINT, GN_LIGHT_DIRECTIONAL}) {
        light.kind = kind;
        const vec4 seen = gn_sssm_neighbour(light, p_ws, n_ws, way_ws);
        EXPECT_EQ(seen.w, 1);
        EXPECT_NEAR(glm::dot(n_ws, vec3(seen) - p_ws), 0, 1e-6) << "on the receiver's plane";
        const vec3 ray = kind == GN_LIGHT_POINT ? p_ws + way_ws - vec3(light.position_ws) : vec3(light.direction_ws);
        EXPECT_LT(glm::length(glm::cross(vec3(seen) - (p_ws + way_ws), ray)), 1e-5) << "on the light's ray";
    }
    light.kind = GN_LIGHT_DIRECTIONAL;
    EXPECT_EQ(gn_sssm_neighbour(light, p_ws, glm::cross(vec3(light.direction_ws), vec3(1, 0, 0)), way_ws).w, 0)
        << "a plane along the rays";
}

TEST(Sssm, RowsHandOnWhatTheyFound) {
    for (const float value : {0.0F, 0.01F, 1.0F, 30.0F, 4000.0F}) {
        EXPECT_NEAR(gn_sssm_unpack(gn_sssm_pack(value)), value, 1e-3F * value);
        EXPECT_LT(gn_sssm_pack(value), 1);
    }
}

/// The half-plane seen from straight above, from below its sheet, so that columns of pixels run along its edge. The light's axes
/// change places where `turned`.
Scene under_the_sheet(bool turned, float yfov) {
    Scene scene = load_scene("half-plane");
    scene.cameras = {
        {.position_ws = vec3(0, 1.5F, 0), .forward_ws = vec3(0, -1, 0), .up_ws = vec3(0, 0, -1), .yfov = yfov}};
    scene.paths.clear();
    if (turned) {
        std::swap(scene.lights.front().shape.right_ws, scene.lights.front().shape.up_ws);
    }
    return scene;
}

/// [BGC16]'s separation is exact where what hides the light ends along the light's axes.
TEST(SssmRendered, RowsOfNeighboursAreTheGridsOnEdgesAlongTheAxes) {
    const test::ComparisonOptions size{.width = 96, .height = 72, .samples = 1};
    for (const bool turned : {false, true}) {
        const std::string recipe = "sssm,resolution=512,sssm.jitter=false";
        const auto rows = test::compare(under_the_sheet(turned, 0.9F), recipe, size);
        const auto grid = test::compare(under_the_sheet(turned, 0.9F), recipe + ",sssm.separable=false", size);
        // Turned, neighbours are as far away as rows are apart to half a pixel's width, which is less than half of that: no row
        // changes sides but the one that the edge goes through.
        const float most = turned ? 1.0F / 9 + 1e-6F : 1e-6F;
        int penumbra = 0;
        for (std::size_t i = 0; i < grid.truth.counted.size(); ++i) {
            const float x = grid.frame.samples.position_ws[i].x;
            if (grid.truth.counted[i] != 0 && std::abs(x) <= 0.4F) {
                const float v = grid.visibility().values[i];
                penumbra += v > 0 && v < 1 ? 1 : 0;
                ASSERT_NEAR(rows.visibility().values[i], v, most) << "turned " << turned << ", x = " << x;
            }
        }
        EXPECT_GT(penumbra, 1000);
    }
}

/// A kernel that `least` makes of a light without extent is as broad across its rows as along them: 9 points that lie evenly on a
/// square err on an edge along its sides by two of them at most.
TEST(SssmRendered, NarrowKernelsSpreadBothWays) {
    const test::ComparisonOptions size{.width = 96, .height = 72, .samples = 1};
    for (const bool turned : {false, true}) {
        Scene scene = under_the_sheet(turned, 0.9F);
        scene.lights.front().shape.half_size = vec2(0.001F);
        const std::string recipe = "sssm,resolution=32,sssm.jitter=false";
        const auto rows = test::compare(scene, recipe, size);
        const auto grid = test::compare(scene, recipe + ",sssm.separable=false", size);
        int penumbra = 0, same = 0;
        for (std::size_t i = 0; i < grid.truth.counted.size(); ++i) {
            const float v = grid.visibility().values[i];
            penumbra += v > 0 && v < 1 ? 1 : 0;
            same += v > 0 && v < 1 && std::abs(rows.visibility().values[i] - v) < 1e-6F ? 1 : 0;
            ASSERT_NEAR(rows.visibility().values[i], v, 2.0F / 9 + 1e-6F) << "turned " << turned;
        }
        EXPECT_GT(penumbra, 300);
        // Rows that lie closer than pixels are all read: V is the grid's wherever the search's row has found what hides the light.
        EXPECT_GT(same, penumbra * 3 / 4) << "turned " << turned;
    }
}

/// A picture too narrow for any neighbour: eight rows would lie beside the receiver, and its own must do.
TEST(SssmRendered, WhereNoNeighbourIsSeenARowMustDo) {
    const test::ComparisonOptions size{.width = 96, .height = 4, .samples = 1};
    const std::string recipe = "sssm,resolution=512,sssm.side=8,sssm.jitter=false";
    const auto rows = test::compare(under_the_sheet(false, 0.01F), recipe, size);
    const auto grid = test::compare(under_the_sheet(false, 0.01F), recipe + ",sssm.separable=false", size);
    EXPECT_GT(grid.visibility().values.front(), 0);
    EXPECT_LT(grid.visibility().values.front(), 1);
    for (std::size_t i = 0; i < grid.visibility().values.size(); ++i) {
        ASSERT_NEAR(rows.visibility().values[i], grid.visibility().values[i], 1e-6) << i;
    }
}

TEST(SssmRendered, AHalfPlanesRampIsAsWideAsTheLightMakesIt) {
    for (const char* scene :
         {"half-plane", "half-plane:light=spot", "half-plane:light=point", "half-plane:light=directional"}) {
        for (const int resolution : {256, 1024}) {
            const auto c = test::compare(scene, fmt::format("sssm,resolution={}", resolution),
                                         {.width = 64, .height = 48, .samples = 64});
            const std::vector<test::Slice> slices = test::error_slices(c, 10);
            // The map decides a caster's edge to its texel, as seen on the receiver 2 m behind it: views are at most 24 m wide
            // there, ramps at least 0.5 m, so that it is half of one on the mean. Where a share s of the light is hidden, rows
            // of 9 points miss it with 1 - 9 s: V is too great by s (1 - 9 s), at most 1 / 36.
            const double texel = 24.0 / resolution / 2 / 0.5 / 2, missed = 1.0 / 36;
            for (std::size_t s = 0; s < slices.size(); ++s) {
                if (slices.at(s).samples > 20) {
                    EXPECT_NEAR(slices.at(s).mean(), 0, texel + missed)
                        << scene << " at " << resolution << ", slice " << s;
                }
            }
        }
    }
}

}  // namespace
}  // namespace gn::sssm_test
