// SPDX-License-Identifier: MIT
// The penumbra of a half-plane is as wide as the light makes it, whatever the map's resolution and the kind of light.
#include "shadow/lookup/pcss/pcss.glsl"

#include "base/disc.h"
#include "shadow/recipe/part.h"
#include "shadow/show/show.h"
#include "tests/penumbra.h"
#include "tests/warp_scene.h"

#include <algorithm>
#include <cmath>

namespace gn::pcss_test {
namespace {

TEST(Pcss, SpreadIsThePenumbraOverTheLight) {
    // [EASW09] 5.2.2: w_p = w_l (d_r - d_o) / d_o; of a sun 2 tan(a) (d_r - d_o).
    EXPECT_FLOAT_EQ(glsl::gn_extent_spread(false, 4, 2), 1);
    EXPECT_FLOAT_EQ(glsl::gn_extent_spread(false, 5, 4), 0.25F);
    EXPECT_FLOAT_EQ(glsl::gn_extent_spread(true, 5, 3), 2);
    EXPECT_EQ(glsl::gn_extent_spread(false, 2, 3), 0) << "nothing behind the receiver hides the light";
}

TEST(Pcss, ASpheresPenumbraIsWiderThanItsDiscs) {
    // 2 r (d_r - d_o) / sqrt(d_o^2 - r^2) against 2 r (d_r - d_o) / d_o.
    for (const double d : {0.6, 1.0, 2.0, 10.0}) {
        const double r = 0.5;
        EXPECT_NEAR(glsl::gn_extent_bulge(static_cast<float>(r), static_cast<float>(d)), d / std::sqrt(d * d - r * r),
                    1e-5 * d)
            << d;
    }
}

TEST(Pcss, PointsLieInTheLightsOwnShape) {
    double mean_square = 0;
    glsl::GnExtentPoints discs = glsl::gn_extent_points(false, 64, 0.3F);
    glsl::GnExtentPoints squares = glsl::gn_extent_points(true, 64, 0.3F);
    for (int i = 0; i < 64; ++i) {
        const vec2 disc = glsl::gn_extent_next(discs);
        const vec2 square = glsl::gn_extent_next(squares);
        EXPECT_LE(glm::length(disc), 1);
        EXPECT_LE(std::max(std::abs(square.x), std::abs(square.y)), 1);
        mean_square += static_cast<double>(glm::dot(disc, disc)) / 64;
    }
    EXPECT_NEAR(mean_square, 0.5, 1e-5) << "even over the disc's area";
}

/// As far as a sine's argument of 255 golden angles has digits.
TEST(Pcss, PointsOfADiscAreAGoldenSpiral) {
    glsl::GnExtentPoints points = glsl::gn_extent_points(false, 256, 0.3F);
    for (int i = 0; i < 256; ++i) {
        const vec2 expected = glsl::gn_vogel(i, 256, 2 * glm::pi<float>() * 0.3F);
        EXPECT_LE(glm::distance(glsl::gn_extent_next(points), expected), 2e-4F) << i;
    }
}

TEST(Pcss, DiscsTurnToTheReceiverAndRectanglesDoNot) {
    GnLight light;
    light.kind = GN_LIGHT_POINT;
    light.position_ws = vec4(1, 2, 3, 1);
    light.radius = 0.25F;
    const vec3 p_ws(-2, 0.5F, 1);
    const glsl::GnExtentLight sphere = glsl::gn_extent_light(light, p_ws);
    const vec3 to_light = gn_to_light(light, p_ws);
    EXPECT_NEAR(glm::dot(sphere.right_ws, to_light), 0, 1e-6);
    EXPECT_NEAR(glm::dot(sphere.up_ws, to_light), 0, 1e-6);
    EXPECT_NEAR(glm::dot(sphere.right_ws, sphere.up_ws), 0, 1e-6);
    EXPECT_NEAR(glm::length(sphere.right_ws), 0.25, 1e-6);

    light.kind = GN_LIGHT_RECTANGLE;
    light.half_size = vec2(0.5F, 0.1F);
    const glsl::GnExtentLight panel = glsl::gn_extent_light(light, p_ws);
    EXPECT_TRUE(panel.square);
    EXPECT_EQ(panel.right_ws, 0.5F * vec3(light.right_ws));
    EXPECT_EQ(panel.up_ws, 0.1F * vec3(light.up_ws));

    light.kind = GN_LIGHT_DIRECTIONAL;
    light.angular_radius = 0.1F;
    EXPECT_NEAR(glm::length(glsl::gn_extent_light(light, p_ws).up_ws), std::tan(0.1), 1e-6);
}

/// A point keeps its noise while a pixel there is as large, whatever else the camera does; points beside it have others.
TEST(Pcss, NoiseOfASurfaceStaysOnIt) {
    const vec3 n_ws = glm::normalize(vec3(0.1F, 1, -0.2F));
    double sum = 0;
    for (int i = 0; i < 400; ++i) {
        const vec3 p_ws(0.013F * static_cast<float>(i % 20), -1e-7F, 0.0171F * static_cast<float>(i / 20) - 5000);
        const float noise = glsl::gn_surface_noise(p_ws, n_ws, 0.008F);
        EXPECT_EQ(glsl::gn_surface_noise(p_ws, n_ws, 0.01F), noise);
        EXPECT_EQ(glsl::gn_surface_noise(p_ws + vec3(0, 2e-7F, 0), n_ws, 0.008F), noise) << "a plane has no other side";
        sum += static_cast<double>(noise);
    }
    EXPECT_NEAR(sum / 400, 0.5, 3 * std::sqrt(1.0 / 12 / 400));
}

/// Casters before the receivers keep their distances where a lookup reads them, and are clamped where it does not.
TEST(Pcss, CastersKeepTheirDistances) {
    for (const char* scene_name : {"half-plane", "half-plane:light=spot", "half-plane:light=directional"}) {
        const Scene scene = load_scene(scene_name);
        const auto least_depth = [&](const char* recipe) {
            const LightViews views = test::place(scene, recipe);
            float least = 1;
            for (const vec3& p_ws : scene.positions_ws) {
                least = std::min(least, glm::dot(views.views.front().depth_from_ws, vec4(p_ws, 1)));
            }
            return least;
        };
        EXPECT_GE(least_depth("pcss,placement=fit"), 0) << scene_name;
        EXPECT_LT(least_depth("pcf,placement=fit"), 0) << scene_name;
    }
}

TEST(Pcss, DistancesAreAlongTheLightsAxisWhateverWayTheViewLooks) {
    const Scene scene = load_scene("half-plane");
    const GnLight& light = scene.lights.front().shape;
    const LightViews views = test::place(scene, "pcss,placement=fit");
    const GnLightView& view = views.views.front();
    const vec3 axis = glsl::gn_extent_axis(light, vec3(0));
    const glsl::GnExtentMetres metres = glsl::gn_extent_metres(view, axis);
    for (const vec3 p_ws : {vec3(0.4F, 0, 0.3F), vec3(-0.5F, 2, -0.6F), vec3(-1, 1, 0.2F)}) {
        const vec2 uv_ts(test::uv_of(view, dvec3(p_ws)));
        const float depth = glm::dot(view.depth_from_ws, vec4(p_ws, 1));
        EXPECT_NEAR(glsl::gn_extent_distance(metres, view, uv_ts, depth),
                    glm::dot(axis, p_ws - vec3(light.position_ws)), 1e-4);
    }
}

/// `noise`: the most that samples may err by, on the root mean square.
void expect_ramp(const char* scene, const std::string& recipe, int resolution, const test::ComparisonOptions& size,
                 double noise) {
    const auto c = test::compare(scene, fmt::format("{},resolution={}", recipe, resolution), size);
    const std::vector<test::Slice> slices = test::error_slices(c, 20);
    // The map decides a caster's edge to its texel, as seen on the receiver 2 m behind it: views are at most 24 m wide
    // there, ramps at least 0.5 m.
    const double texel = 24.0 / resolution / 2 / 0.5;
    // Where a share s of the light is hidden, 16 even taps of the search miss it with 1 - 16 s: V is too great by
    // s (1 - 16 s), at most 1 / 64.
    const double missed = 1.0 / 64;
    for (std::size_t s = 0; s < slices.size(); ++s) {
        if (slices.at(s).samples > 20) {
            EXPECT_NEAR(slices.at(s).mean(), 0, texel + missed + 4 * slices.at(s).standard_error())
                << scene << " by " << recipe << " at " << resolution << ", slice " << s;
        }
    }
    EXPECT_LT(*c.errors.penumbra, noise) << scene << " by " << recipe;
}

TEST(PcssRendered, AHalfPlanesRampIsAsWideAsTheLightMakesIt) {
    // 40 taps: even sets of points err by less than 2 / 40 on a straight edge.
    const double noise = 0.05;
    for (const char* scene :
         {"half-plane", "half-plane:light=spot", "half-plane:light=point", "half-plane:light=directional"}) {
        for (const int resolution : {512, 2048}) {
            expect_ramp(scene, "pcss", resolution, {.width = 128, .height = 96, .samples = 256}, noise);
        }
    }
    expect_ramp("half-plane", "pcss,pcss.tap=bilinear", 512, {.width = 128, .height = 96, .samples = 256}, noise);
    expect_ramp("half-plane", "pcss,pcss.noise=pixel", 512, {.width = 128, .height = 96, .samples = 256}, noise);
}

/// Squares about the centre become circles, areas keep their ratios, and back. [SC97]
TEST(Pcss, RastersAndSetsFillTheLightsShapeEvenly) {
    int within = 0;
    constexpr int side = 40;
    for (int i = 0; i < side * side; ++i) {
        const vec2 p = glsl::gn_raster_point(i, side);
        const vec2 q = glsl::gn_disc_of_square(p);
        EXPECT_NEAR(glm::length(q), std::max(std::abs(p.x), std::abs(p.y)), 1e-6);
        EXPECT_LT(glm::distance(glsl::gn_square_of_disc(q), p), 1e-5);
        EXPECT_LT(glm::distance(disc_from_square(0.5F * p + 0.5F), q), 1e-6) << "the host's map";
        // A half of the disc that no axis of the map bounds.
        within += q.x + 0.3F * q.y > 0 ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(within) / (side * side), 0.5, 0.01);
    EXPECT_EQ(glsl::gn_disc_of_square(vec2(0)), vec2(0));
    EXPECT_EQ(glsl::gn_square_of_disc(vec2(0)), vec2(0));
    EXPECT_EQ(glsl::gn_raster_point(2, 2), vec2(-0.5F, 0.5F)) << "row by row";
}

/// Whatever kernel looks at the light, in either of its shapes.
TEST(PcssRendered, RampsAreAsWideWithEveryKernel) {
    const test::ComparisonOptions size{.width = 64, .height = 48, .samples = 256};
    // A straight edge passes 16 x 16 points a row at a time.
    const std::string raster = "pcss,pcss.taps=256,pcss.density=64,pcss.search_taps=64,pcss.kernel=grid";
    expect_ramp("half-plane:light=spot", raster, 2048, size, 0.5 / 16);
    expect_ramp("half-plane", raster, 2048, size, 0.5 / 16);
    // A set that is turned errs by chance; as it is it would err alike along the whole edge.
    const std::string turned = "pcss,pcss.taps=64,pcss.density=64,pcss.kernel=rotated-poisson";
    expect_ramp("half-plane:light=spot", turned, 2048, size, 0.04);
    expect_ramp("half-plane", turned, 2048, size, 0.04);
}

/// Whether a placement serves the scene's first light with the recipe.
bool serves(const Part& placement, const std::string& scene_name, const std::string& recipe) {
    const Scene scene = load_scene(scene_name);
    return placement.stage == Stage::placement && placement.lights.has(scene.lights.front().shape.kind) &&
           (placement.refuses == nullptr ||
            placement.refuses(scene, scene.lights.front(), load_recipe(recipe)).empty());
}

/// The light's points are found where a view puts them, whatever it does to the map: every placement of every kind of light.
TEST(PcssRendered, RampsAreAsWideUnderEveryPlacement) {
    // That, and what 64 points of the truth err by themselves, half of the root of V (1 - V) / 64.
    const double noise = 2.0 / 32 + 0.5 * std::sqrt(0.25 / 64);
    struct Row {
        const char* kind;
        uint number;
    };
    for (const Row& kind : {Row{"rectangle", GN_LIGHT_RECTANGLE}, Row{"spot", GN_LIGHT_SPOT},
                            Row{"point", GN_LIGHT_POINT}, Row{"directional", GN_LIGHT_DIRECTIONAL}}) {
        std::vector<std::string> placements;
        for (const Part* part : all_parts()) {
            if (part->stage == Stage::placement && serves(*part, fmt::format("half-plane:light={}", kind.kind),
                                                          fmt::format("pcss,placement={}", part->id))) {
                placements.push_back(std::string(part->id));
            }
        }
        if (kind.number == GN_LIGHT_DIRECTIONAL) {
            placements.emplace_back("cascades,cascades.split=sdsm-minmax");
            placements.emplace_back("cascades,cascades.fit=warped");
        }
        EXPECT_GE(placements.size(), 2U);
        for (const std::string& placement : placements) {
            expect_ramp(fmt::format("half-plane:light={}", kind.kind).c_str(), "pcss,placement=" + placement, 512,
                        {.width = 64, .height = 48, .samples = 64}, noise);
        }
    }
}

/// What lies behind the edge of a cube's face is as far away as it is, in whatever face it is seen.
TEST(PcssRendered, DistancesAreTheSameBeyondAnEdgeOfACube) {
    Scene scene = test::built_in("courtyard");
    std::swap(scene.lights.at(0), scene.lights.at(1));
    const test::ComparisonOptions size{.width = 64, .height = 48, .samples = 4};
    const auto crossing = test::compare(scene, "pcss,resolution=512,cube.edges=cross", size);
    const auto bordered = test::compare(std::move(scene), "pcss,resolution=512,cube.edges=guard", size);
    // What faces end with is clamped to their border, so that it can only be worse.
    EXPECT_LT(*crossing.errors.rmse, *bordered.errors.rmse + 0.01);
}

TEST(Pcss, NarrowKernelsAreLengthenedWhicheverWayTheLightsAxesRun) {
    const Scene scene = load_scene("half-plane");
    const LightViews views = test::place(scene, "pcss,placement=fit");
    glsl::GnLookup at{};
    at.receiver.p_ws = vec3(0.1F, 0, 0.2F);
    at.receiver.n_ws = vec3(0, 1, 0);
    at.view = views.views.front();
    at.projected = glsl::gn_project(at.receiver, at.view, GnBias{});
    for (const float side : {-1.0F, 1.0F}) {
        const glsl::GnExtentLight half_light{side * vec3(0.5F, 0, 0), side * vec3(0, 0, 0.5F), true};
        for (const float spread : {0.0F, 1e-4F, 0.5F}) {
            const glsl::GnExtentKernel kernel = glsl::gn_extent_kernel(at, half_light, spread);
            const glsl::GnExtentWiden widen = glsl::gn_extent_widen(kernel, 0, 0.01F);
            const vec2 right = glsl::gn_extent_way(kernel, vec2(1, 0)) + widen.right_ts;
            const vec2 up = glsl::gn_extent_way(kernel, vec2(0, 1)) + widen.up_ts;
            EXPECT_GE(glm::length(right), 0.01 - 1e-6) << spread;
            EXPECT_GE(glm::length(up), 0.01 - 1e-6) << spread;
        }
    }
}

/// Of a slanted ground that nothing stands on, no sample needs a texel of the map, and V is the same.
TEST(PcssRendered, SlantedGroundsAreKnownToBeLit) {
    const test::ValidationGuard guard;
    for (const char* scene : {"contact:radius=3", "contact:light=spot", "contact:radius=3,elevation=15"}) {
        const Scene made = load_scene(scene);
        SceneGpu gpu = upload_scene(test::device(), made);
        const std::vector<std::string> names{"search-class"};
        const Recipe recipe = load_recipe("pcss,pcss.planes=true");
        const FrameResult frame =
            render_frame(test::device(), gpu, made.camera(""), recipe,
                         {.width = 96, .height = 72, .repeat = 0, .only_light = 0, .picture = false});
        const Shown shown =
            show_hidden(test::device(), gpu, made.camera(""), recipe, names, {.width = 96, .height = 72}).front();
        const std::vector<float>& v = frame.visibility.front().values;
        int lit = 0, known = 0;
        for (std::size_t i = 0; i < v.size(); ++i) {
            const vec4 p_ws = frame.samples.position_ws[i];
            const bool ground = p_ws.w > 0.5F && p_ws.y < 1e-3F;
            const bool all_seen = shown.values.values[2 * i] == 1;
            lit += ground && v[i] == 1 ? 1 : 0;
            known += ground && all_seen ? 1 : 0;
            EXPECT_TRUE(!ground || !all_seen || v[i] == 1) << i;
        }
        // Blocks of 8 texels and more that the box or its shadow touches have to be read.
        EXPECT_GT(known, lit / 3) << scene;
        EXPECT_GT(lit, 500);
    }
}

/// What `--show` shows of the first light, two values a pixel: it, and whether it is there.
std::vector<float> hidden(const char* scene, const std::string& recipe, const std::string& name) {
    const Scene made = load_scene(scene);
    SceneGpu gpu = upload_scene(test::device(), made);
    const std::vector<std::string> names{name};
    const Recipe read = load_recipe(recipe);
    return show_hidden(test::device(), gpu, made.camera(""), read, names, {.width = 96, .height = 72})
        .front()
        .values.values;
}

bool holds(const std::vector<float>& values, float value) {
    return std::find(values.begin(), values.end(), value) != values.end();
}

/// Bars that stand three radii from a lantern have no one distance: one plane for all of them errs by as much as no search at all.
TEST(PcssRendered, RaysTellTheBarsOfACage) {
    Scene scene = test::built_in("courtyard");
    scene.lights = {scene.lights[1]};
    const test::ComparisonOptions size{.width = 96, .height = 54, .samples = 64};
    const std::string maps = "soft,resolution=1024,placement=cube,pcss.rays=";
    const auto plane = test::compare(scene, maps + "0", size);
    const auto rays = test::compare(std::move(scene), maps + "24", size);
    EXPECT_LT(*rays.errors.rmse, 0.6 * *plane.errors.rmse);
    EXPECT_LT(*rays.errors.penumbra, 0.5 * *plane.errors.penumbra);
}

/// They are those of smrt, with the same settings, and go nowhere else.
TEST(PcssRendered, RaysAreSmrtsAndGoWhereCastersAreNearTheLight) {
    const char* const scene = "contact:light=spot,radius=3";
    const test::ComparisonOptions size{.width = 96, .height = 72, .samples = 4};
    const std::string rays = "pcss,resolution=512,pcss.extremes=blocks,pcss.noise=pixel,pcss.least=1,pcss.rays=16";
    const auto all = test::compare(scene, rays + ",pcss.caged=1000", size);
    const auto smrt = test::compare(scene, "smrt,placement=fit,resolution=512,smrt.least=1,smrt.noise=pixel", size);
    EXPECT_EQ(all.visibility().values, smrt.visibility().values);

    const auto far = test::compare(scene, rays, size);
    const auto none = test::compare(scene, rays + ",pcss.rays=0", size);
    EXPECT_EQ(far.visibility().values, none.visibility().values);
    EXPECT_NE(far.visibility().values, all.visibility().values);
    EXPECT_TRUE(holds(hidden(scene, rays + ",pcss.caged=1000", "search-class"), 4));
    EXPECT_FALSE(holds(hidden(scene, rays, "search-class"), 4));
}

/// What pyramid and planes decide, the full loops would have found.
TEST(PcssRendered, EarlyOutsChangeNoSample) {
    for (const char* scene : {"half-plane", "contact:light=spot", "contact:light=point", "fence", "tilted:radius=3"}) {
        const test::ComparisonOptions size{.width = 96, .height = 72, .samples = 4};
        const auto without = test::compare(scene, "pcss,resolution=512,pcss.early_out=false", size);
        for (const char* planes : {",pcss.planes=false", ",pcss.planes=true"}) {
            const auto with = test::compare(scene, std::string("pcss,resolution=512") + planes, size);
            EXPECT_EQ(with.visibility().values, without.visibility().values) << scene << planes;
        }
    }
    const test::ComparisonOptions coarse{.width = 96, .height = 72, .samples = 4};
    for (const char* scene : {"half-plane", "contact:light=spot"}) {
        const std::string bilinear = "pcss,resolution=128,pcss.tap=bilinear,pcss.least=0.5,pcss.planes=true";
        EXPECT_EQ(test::compare(scene, bilinear, coarse).visibility().values,
                  test::compare(scene, bilinear + ",pcss.early_out=false", coarse).visibility().values)
            << scene << ", bilinear taps";
    }
    // Blocks know less, and what they decide is as certain.
    const test::ComparisonOptions size{.width = 96, .height = 72, .samples = 4};
    const std::string blocks = "pcss,resolution=512,pcss.extremes=blocks";
    EXPECT_EQ(test::compare("contact:light=spot", blocks, size).visibility().values,
              test::compare("contact:light=spot", blocks + ",pcss.early_out=false", size).visibility().values);
}

}  // namespace
}  // namespace gn::pcss_test
