// SPDX-License-Identifier: MIT
// What stands on a slice's bottom casts its true penumbra, what stands above it the bottom's; and slices are united as asked.
#include "shadow/lookup/occlusion_textures/occlusion_textures.glsl"
#include "scenes/analytic.h"
#include "tests/penumbra.h"
#include "tests/warp_scene.h"

#include <algorithm>
#include <cmath>

namespace gn::occlusion_textures_test {
namespace {

TEST(OcclusionTextures, ABottomBelongsToTheSliceAboveIt) {
    const float end = 6;
    for (const int count : {4, 7, 16}) {
        for (int k = 0; k < count; ++k) {
            const float bottom = glsl::gn_slice_bottom(k, count, end);
            EXPECT_EQ(glsl::gn_slice_of(bottom, count, end), k);
            EXPECT_EQ(glsl::gn_slice_of(bottom - 0.5F * end / static_cast<float>(count), count, end), k);
            EXPECT_EQ(glsl::gn_slice_of(bottom + 0.01F * end, count, end), std::min(k + 1, count - 1));
        }
        EXPECT_EQ(glsl::gn_slice_of(0, count, end), 0);
    }
}

/// A slice's metres are the light's own, whatever way the view looks: of points of a plane across the light all the same.
TEST(OcclusionTextures, SlicesLieAcrossTheLight) {
    const Scene scene = load_scene("half-plane");
    const GnLight& light = scene.lights.front().shape;
    const GnLightView view = test::place(scene, "occlusion-textures,placement=fit").views.front();
    for (const vec3 p_ws : {vec3(0.4F, 1.5F, 0.3F), vec3(-0.9F, 1.5F, -0.6F), vec3(0, 1.5F, 0)}) {
        const vec2 uv_ts(test::uv_of(view, dvec3(p_ws)));
        const float depth = glm::dot(view.depth_from_ws, vec4(p_ws, 1));
        EXPECT_NEAR(glsl::gn_slices_metres(light, view, uv_ts, depth), 2.5, 1e-4);
    }
    EXPECT_GE(glsl::gn_slices_end(light, view), 4);
}

TEST(OcclusionTextures, CellsAreAsLargeTogetherAsTheLight) {
    const float pi = std::acos(-1.0F);
    for (const int n : {1, 3, 8}) {
        for (const bool square : {false, true}) {
            const float side = glsl::gn_occlusion_side(square, n);
            EXPECT_NEAR(side * side * static_cast<float>(n * n), square ? 4 : pi, 1e-4);
            vec2 mean(0);
            for (int i = 0; i < n * n; ++i) {
                mean += glsl::gn_occlusion_cell(square, i, n) / static_cast<float>(n * n);
            }
            EXPECT_LT(glm::length(mean), square || n > 1 ? 0.08F : 0.75F);
        }
    }
}

/// Squares within a length, the first and the last at its ends, leave no gap.
TEST(OcclusionTextures, SquaresCoverALength) {
    EXPECT_EQ(glsl::gn_occlusion_squares(8, 8), 1);
    EXPECT_EQ(glsl::gn_occlusion_squares(9, 8), 2);
    EXPECT_EQ(glsl::gn_occlusion_squares(15.9F, 8), 2);
    EXPECT_EQ(glsl::gn_occlusion_squares(33, 8), 5);
}

/// [EASW09] eq. 1.5 and figure 1.6: halves that coincide, and halves that complete each other, are the same to all of them.
TEST(OcclusionTextures, SharesAreFusedByTheRuleOfTheirName) {
    const glsl::GnFused fused = glsl::gn_fuse(glsl::gn_fuse(glsl::gn_unfused(), 0.5F), 0.5F);
    EXPECT_EQ(glsl::gn_fused(fused, GN_FUSION_SUM), 1);
    EXPECT_EQ(glsl::gn_fused(fused, GN_FUSION_MAX), 0.5F);
    EXPECT_EQ(glsl::gn_fused(fused, GN_FUSION_MEAN), 0.75F);
    EXPECT_EQ(glsl::gn_fused(fused, GN_FUSION_PRODUCT), 0.75F);
    EXPECT_EQ(glsl::gn_fused(glsl::gn_fuse(fused, 0.25F), GN_FUSION_SUM), 1) << "no more than all";
    EXPECT_EQ(glsl::gn_fused(glsl::gn_fuse(glsl::gn_unfused(), 0.25F), GN_FUSION_SUM), 0.25F);
}

constexpr int resolution = 512, slices = 8;
/// A texel of the map on the ground, metres: views are at most 8 m wide there.
constexpr double texel = 8.0 / resolution;

constexpr uint columns = 96, rows = 72;
float end_of(const Scene& scene) {
    const LightViews views = test::place(scene, "occlusion-textures,placement=fit,resolution=512", columns, rows);
    return glsl::gn_slices_end(scene.lights.front().shape, views.views.front());
}

/// half-plane with its sheet `before` slices above the bottom of the slice that it stands in; the penumbra's width by that bottom.
struct Sliced {
    Scene scene{};
    double width = 0;
};
Sliced sheet_in_slice(const std::string& name, float before) {
    Sliced result{load_scene(name)};
    const GnLight light = result.scene.lights.front().shape;
    const float end = end_of(result.scene);
    const float light_metres = 4;  // of the light over the ground
    // The slice whose bottom lies nearest to two metres below the light.
    int k = 0;
    while (k + 1 < slices && glsl::gn_slice_bottom(k, slices, end) < 2) {
        ++k;
    }
    const float bottom = glsl::gn_slice_bottom(k, slices, end);
    const float y = light_metres - bottom + before * end / slices;
    for (vec3& p_ws : result.scene.positions_ws) {
        p_ws.y = p_ws.y > 1 ? y : p_ws.y;
    }
    EXPECT_FLOAT_EQ(end_of(result.scene), end) << "the view does not follow what casts";
    result.width = 2 * static_cast<double>(light.half_size.x * (light_metres - bottom) / bottom);
    return result;
}

/// The greatest difference between V and a ramp of a width about x = 0.
double off_ramp(const test::Comparison& c, double width) {
    double worst = 0;
    for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
        const double x = c.frame.samples.position_ws[i].x;
        const double z = c.frame.samples.position_ws[i].z;
        // Where the map's border is farther away than the kernel is wide.
        if (c.truth.counted[i] != 0 && std::abs(x) < 1.5 && z > -1.4 && z < 0.6) {
            const double expected = std::clamp(0.5 + x / width, 0.0, 1.0);
            worst = std::max(worst, std::abs(static_cast<double>(c.visibility().values[i]) - expected));
        }
    }
    return worst;
}

TEST(OcclusionTexturesRendered, PenumbraeAreThoseOfTheSlicesBottom) {
    const test::ComparisonOptions size{.width = columns, .height = rows, .samples = 1};
    for (const float before : {0.0F, 0.5F, 0.9F}) {
        const Sliced sliced = sheet_in_slice("half-plane", before);
        for (const char* filter : {"sums", "n-buffers"}) {
            const auto c = test::compare(sliced.scene,
                                         fmt::format("occlusion-textures,placement=fit,resolution=512,occlusion-"
                                                     "textures.cells=6,occlusion-textures.filter_by={}",
                                                     filter),
                                         size);
            // Squares that overlap bend a cell's ramp by at most an eighth.
            const double bent = std::string(filter) == "n-buffers" ? 1.0 / 8 / 6 : 0;
            EXPECT_LT(off_ramp(c, sliced.width), texel / sliced.width + bent) << filter << ", " << before;
        }
    }
}

/// On a bottom the penumbra is the true one, of other lights too.
TEST(OcclusionTexturesRendered, WhatStandsOnABottomIsExact) {
    const Sliced sliced = sheet_in_slice("half-plane:light=spot", 0);
    const auto c =
        test::compare(sliced.scene, "occlusion-textures,placement=fit,resolution=512,occlusion-textures.cells=6",
                      {.width = columns, .height = rows, .samples = 256});
    for (const test::Slice& slice : test::error_slices(c, 20)) {
        if (slice.samples > 20) {
            // Thirty-six cells of a disc.
            EXPECT_NEAR(slice.mean(), 0, texel + 1.0 / 36 + 4 * slice.standard_error());
        }
    }
}

/// Sheets at 3 m and 2 m under a light at 5 m hide the same half of it from x = 0, or both halves: shares of slices cannot tell.
TEST(OcclusionTexturesRendered, HalvesFuseAsPredicted) {
    struct Case {
        const char* fusion;
        float left;
    };
    for (const char* arrangement : {"same", "opposite"}) {
        for (const Case& each : {Case{"sum", 0}, Case{"max", 0.5F}, Case{"mean", 0.25F}, Case{"product", 0.25F}}) {
            const auto c = test::compare(fmt::format("overlap:arrangement={}", arrangement),
                                         fmt::format("occlusion-textures,occlusion-textures.fusion={}", each.fusion),
                                         {.width = columns, .height = rows, .samples = 1});
            int count = 0;
            for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
                const vec4 p_ws = c.frame.samples.position_ws[i];
                if (c.truth.counted[i] != 0 && p_ws.y < 0.1F && std::abs(p_ws.x) < 0.02F) {
                    // Two hundredths of a metre of ramps of half a metre and more.
                    EXPECT_NEAR(c.visibility().values[i], each.left, 0.08) << each.fusion << ", " << arrangement;
                    ++count;
                }
            }
            EXPECT_GT(count, 40);
        }
    }
}

TEST(OcclusionTexturesRendered, WithoutSizeTheShadowIsHard) {
    const test::ComparisonOptions size{.width = columns, .height = rows, .samples = 1};
    EXPECT_EQ(test::compare("contact:radius=0", "occlusion-textures", size).visibility().values,
              test::compare("contact:radius=0", "hard,resolution=512", size).visibility().values);
}

}  // namespace
}  // namespace gn::occlusion_textures_test
