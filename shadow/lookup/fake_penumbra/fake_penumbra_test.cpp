// SPDX-License-Identifier: MIT
// The penumbra of a half-plane is as wide as the light makes it, up to the radius; and what each form does not see.
#include "shadow/lookup/fake_penumbra/fake_edge.glsl"
#include "shadow/lookup/fake_penumbra/fake_flood.h"
#include "tests/penumbra.h"
#include "tests/warp_scene.h"

#include <algorithm>
#include <cmath>

namespace gn::fake_penumbra_test {
namespace {

constexpr const char* kinds[] = {"half-plane", "half-plane:light=spot", "half-plane:light=point",
                                 "half-plane:light=directional"};

TEST(FakePenumbra, RampsAreThoseOfAStraightEdge) {
    const double pi = std::acos(-1.0);
    for (const double x : {-1.0, -0.6, 0.0, 0.25, 1.0}) {
        EXPECT_NEAR(glsl::gn_fake_ramp(true, static_cast<float>(x)), 0.5 + 0.5 * x, 1e-6);
        // What a chord at x leaves of the disc, by sums over strips.
        double area = 0;
        for (int i = 0; i < 20000; ++i) {
            const double t = -1 + (i + 0.5) / 10000;
            area += t < x ? 2 * std::sqrt(1 - t * t) / 10000 : 0;
        }
        EXPECT_NEAR(glsl::gn_fake_ramp(false, static_cast<float>(x)), area / pi, 1e-3) << x;
    }
    EXPECT_EQ(glsl::gn_fake_ramp(false, 3), 1);
    EXPECT_EQ(glsl::gn_fake_ramp(true, -3), 0);
}

TEST(FakePenumbra, WidthsAreTheLightsWithinTheirBounds) {
    // An edge 6 texels away, seen by the light's point 0.5 x the spread: the half width is 12 texels.
    EXPECT_FLOAT_EQ(glsl::gn_fake_distance(6, 0.25F, 0.5F, 0, 32), 0.5F);
    EXPECT_FLOAT_EQ(glsl::gn_fake_distance(6, 0.25F, 0.5F, 0, 8), 0.75F) << "cut at the radius";
    EXPECT_FLOAT_EQ(glsl::gn_fake_distance(6, 0.25F, 0.5F, 24, 32), 0.25F) << "the least width";
    EXPECT_FLOAT_EQ(glsl::gn_fake_distance(0, 0, 0.5F, 0, 8), 0);
}

/// gn_fake_point finds the point of the light whose way on the map it is given.
TEST(FakePenumbra, TheLightsPointIsFoundFromItsPlaceOnTheMap) {
    for (const char* name : kinds) {
        const Scene scene = load_scene(name);
        const LightViews views = test::place(scene, "fake-penumbra,placement=fit");
        glsl::GnLookup at{};
        at.light = scene.lights.front().shape;
        at.receiver.p_ws = vec3(0.3F, 0, -0.4F);
        at.receiver.n_ws = vec3(0, 1, 0);
        at.view = views.views.front();
        at.projected = glsl::gn_project(at.receiver, at.view, GnBias{});
        const glsl::GnExtentLight light = glsl::gn_fake_light(at.light, at.receiver.p_ws);
        const glsl::GnFakeAxes axes = glsl::gn_fake_axes(at, light);
        for (const vec2 q : {vec2(0.5F, 0.25F), vec2(-0.7F, 0.1F), vec2(0, -1)}) {
            const float spread = 0.8F;
            const vec2 d_ts = glsl::gn_extent_way(glsl::gn_extent_kernel(at, light, spread), q);
            const vec2 found = glsl::gn_fake_point(axes, d_ts);
            EXPECT_NEAR(found.x, spread * q.x, 1e-4) << name;
            EXPECT_NEAR(found.y, spread * q.y, 1e-4) << name;
            EXPECT_GE(glsl::gn_fake_norm(axes.square, found),
                      0.99F * axes.least * std::max(std::abs(d_ts.x), std::abs(d_ts.y)))
                << "rings that are skipped hold nothing nearer";
        }
    }
}

TEST(FakePenumbra, OnThePictureTheLightsPointIsFoundAlongItsRay) {
    for (const char* name : kinds) {
        const GnLight light = load_scene(name).lights.front().shape;
        const vec3 p_ws(0.2F, 0, 0.1F);
        const glsl::GnExtentLight half_light = glsl::gn_fake_light(light, p_ws);
        const vec2 q(0.3F, -0.6F);
        const vec3 beside_ws = p_ws + q.x * half_light.right_ws + q.y * half_light.up_ws;
        const vec3 ray_ws =
            light.kind == GN_LIGHT_DIRECTIONAL ? vec3(light.direction_ws) : beside_ws - vec3(light.position_ws);
        const vec2 found = glsl::gn_fake_beside(light, half_light, p_ws, beside_ws + 0.1F * ray_ws);
        EXPECT_NEAR(found.x, q.x, 1e-3) << name;
        EXPECT_NEAR(found.y, q.y, 1e-3) << name;
    }
}

TEST(FakePenumbra, JumpsReachAsFarAsStepsDo) {
    for (const int radius : {1, 2, 7, 32, 100}) {
        EXPECT_EQ(flood_strides(radius, false).size(), static_cast<std::size_t>(radius));
        int reach = 0;
        for (const int stride : flood_strides(radius, true)) {
            reach += stride;
        }
        EXPECT_GE(reach, radius);
    }
}

/// A map's texel, and a pixel of the picture, on the ground of half-plane, over the ramp's width of a metre.
constexpr double texel_of(int resolution) {
    return 24.0 / resolution / 2;
}
constexpr double pixel = 2.4 / 72;

void expect_ramp(const std::string& scene, const std::string& recipe, double tolerance) {
    const auto c = test::compare(scene, recipe, {.width = 96, .height = 72, .samples = 64});
    const std::vector<test::Slice> slices = test::error_slices(c, 20);
    for (std::size_t s = 0; s < slices.size(); ++s) {
        if (slices.at(s).samples > 20) {
            EXPECT_NEAR(slices.at(s).mean(), 0, tolerance + 4 * slices.at(s).standard_error())
                << scene << " by " << recipe << ", slice " << s;
        }
    }
}

TEST(FakePenumbraRendered, ASearchFindsTheRampOfEveryLight) {
    for (const char* scene : kinds) {
        expect_ramp(scene, "fake-penumbra,resolution=256", texel_of(256));
    }
    expect_ramp("half-plane", "fake-penumbra,resolution=512,fake-penumbra.radius=128", texel_of(512));
}

TEST(FakePenumbraRendered, AFloodFindsTheRampOfEveryLight) {
    for (const char* scene : kinds) {
        expect_ramp(scene, "fake-penumbra,resolution=1024,fake-penumbra.form=jump-flood", texel_of(1024) + pixel);
    }
    expect_ramp("half-plane", "fake-penumbra,resolution=1024,fake-penumbra.form=flood", texel_of(1024) + pixel);
}

/// The share of samples in slices of x whose V lies further than `tolerance` from a ramp from `from` to `to`.
double off_ramp(const test::Comparison& c, double from, double to, double tolerance) {
    int off = 0;
    int count = 0;
    for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
        const double x = c.frame.samples.position_ws[i].x;
        if (c.truth.counted[i] != 0 && std::abs(x) < 1.2) {
            const double expected = std::clamp((x - from) / (to - from), 0.0, 1.0);
            off += std::abs(c.visibility().values[i] - expected) > tolerance ? 1 : 0;
            ++count;
        }
    }
    return static_cast<double>(off) / count;
}

/// The ramp that the width map draws lies inside the hard shadow, all of its metre.
TEST(FakePenumbraRendered, AWidthMapsRampLiesInsideTheHardShadow) {
    const test::ComparisonOptions size{.width = 128, .height = 96, .samples = 1};
    const auto c = test::compare(
        "half-plane", "fake-penumbra,resolution=256,fake-penumbra.form=width-map,fake-penumbra.radius=128", size);
    EXPECT_EQ(off_ramp(c, -1, 0, 1.5 * texel_of(256)), 0);
}

/// A radius of n texels leaves 2 n of the ramp, and n of the width map's.
TEST(FakePenumbraRendered, ThePenumbraEndsAtTheRadius) {
    const test::ComparisonOptions size{.width = 128, .height = 96, .samples = 1};
    const Scene scene = load_scene("half-plane");
    const GnLightView view = test::place(scene, "fake-penumbra,placement=fit").views.front();
    const double texel =
        1.0 / glm::length(test::uv_of(view, dvec3(1, 0, 0)) - test::uv_of(view, dvec3(0))) / view.resolution;
    const double reach = 8 * texel;
    const std::string recipe = "fake-penumbra,placement=fit,fake-penumbra.radius=8,fake-penumbra.form=";
    // A texel and a half of a ramp of sixteen, or of eight. The map is finer towards one side of the picture than in its middle.
    EXPECT_LT(off_ramp(test::compare("half-plane", recipe + "radial", size), -reach, reach, 1.5 / 16), 0.01);
    EXPECT_LT(off_ramp(test::compare("half-plane", recipe + "width-map", size), -reach, 0, 1.5 / 8), 0.01);
}

/// Floods count pixels: on the ground each is as large as its neighbour lies away.
TEST(FakePenumbraRendered, AFloodsPenumbraEndsAtTheRadius) {
    const test::ComparisonOptions size{.width = 96, .height = 72, .samples = 1};
    constexpr double radius = 5;
    for (const char* form : {"flood", "jump-flood"}) {
        const auto c = test::compare(
            "half-plane", fmt::format("fake-penumbra,fake-penumbra.radius={},fake-penumbra.form={}", radius, form),
            size);
        int beyond = 0, within = 0;
        for (std::size_t i = 0; i + 1 < c.truth.counted.size(); ++i) {
            const vec3 p_ws(c.frame.samples.position_ws[i]), beside_ws(c.frame.samples.position_ws[i + 1]);
            if (i % size.width + 1 == size.width || c.truth.counted[i] == 0 || c.truth.counted[i + 1] == 0) {
                continue;
            }
            // An edge lies within a pixel.
            const double pixels =
                std::abs(static_cast<double>(p_ws.x)) / static_cast<double>(glm::distance(p_ws, beside_ws));
            const float v = c.visibility().values[i];
            beyond += pixels > radius + 1 && v > 0 && v < 1 ? 1 : 0;
            within += pixels < radius - 1 && v > 0 && v < 1 ? 1 : 0;
        }
        EXPECT_EQ(beyond, 0) << form;
        EXPECT_GT(within, 300) << form;
    }
}

TEST(FakePenumbraRendered, WithoutSizeTheShadowIsHard) {
    const test::ComparisonOptions size{.width = 96, .height = 72, .samples = 1};
    for (const char* form : {"radial", "width-map", "flood", "jump-flood"}) {
        for (const char* scene : {"contact:radius=0", "fence:radius=0"}) {
            EXPECT_EQ(
                test::compare(scene, std::string("fake-penumbra,fake-penumbra.form=") + form, size).visibility().values,
                test::compare(scene, "hard", size).visibility().values)
                << form << " of " << scene;
        }
    }
}

/// Edges of a light without extent stay where they are: no step of a flood is drawn.
TEST(FakePenumbraRendered, NothingIsFloodedWithoutSize) {
    for (const char* form : {"flood", "jump-flood"}) {
        const auto steps = [&](const char* scene) {
            const auto c = test::compare(scene, std::string("fake-penumbra,resolution=64,fake-penumbra.form=") + form,
                                         {.width = 32, .height = 24, .samples = 1});
            const auto& passes = c.frame.statistics.passes;
            return std::count_if(passes.begin(), passes.end(), [](const auto& pass) { return pass.name == "flood"; });
        };
        EXPECT_EQ(steps("contact:radius=0"), 0) << form;
        EXPECT_GT(steps("contact:radius=1"), 0) << form;
    }
}

/// Where only the penumbra is in the picture and not the edge, a flood has nothing to begin with; a search of the map has.
TEST(FakePenumbraRendered, AFloodLosesThePenumbraWhoseHardShadowIsOffScreen) {
    const test::ComparisonOptions size{.width = 96, .height = 54, .samples = 64, .view = "beside"};
    const auto flood = test::compare("half-plane", "fake-penumbra,fake-penumbra.form=jump-flood", size);
    const auto search = test::compare("half-plane", "fake-penumbra,resolution=256,fake-penumbra.radius=128", size);
    EXPECT_GT(*flood.errors.rmse, 0.05);
    EXPECT_LT(*search.errors.rmse, 0.5 * *flood.errors.rmse);
    EXPECT_EQ(*std::min_element(flood.visibility().values.begin(), flood.visibility().values.end()), 1);
}

}  // namespace
}  // namespace gn::fake_penumbra_test
