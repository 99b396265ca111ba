// SPDX-License-Identifier: MIT
// Cascades as rendered: passes, casters far away, acne and seams.
#include "tests/cascade_frame.h"
#include "tests/warp_scene.h"

namespace gn::picture_test {
namespace {

using namespace cascades;
using namespace test;
using glsl::GnChoice;
using glsl::GnProjected;
using glsl::GnReceiver;

TEST(CascadesRendered, LayeredPassDrawsTheSameMaps) {
    if (!test::device().has(Feature::layer_from_vertex_shader)) {
        GTEST_SKIP() << "the device writes no layer from the vertex stage";
    }
    const Scene& scene = test::built_in("corridor");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const Camera& camera = scene.camera("");
    for (const char* split : {"split=practical", "split=sdsm-minmax", "fit=warped"}) {
        const std::string recipe =
            std::string("hard,resolution=256,placement=cascades,cascades.") + split + ",cascades.passes=";
        const Rendered layered = render(gpu, camera, camera, recipe + "layered");
        const Rendered separate = render(gpu, camera, camera, recipe + "separate");
        EXPECT_EQ(differing(layered.map, separate.map), 0U) << split;
    }
}

/// A small roof high above, far outside of what the camera sees, between the sun and the near plane of every tight fit.
TEST(CascadesRendered, CasterBeforeTheNearPlaneStillCasts) {
    Scene scene;
    const auto square = [&](const char* name, float y, float half) {
        const auto base = static_cast<uint>(scene.positions_ws.size());
        const auto first = static_cast<std::uint32_t>(scene.triangles.size());
        for (const vec2 corner : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)}) {
            scene.positions_ws.emplace_back(half * corner.x, y, half * corner.y);
            scene.normals_ws.emplace_back(0, 1, 0);
            scene.uvs.emplace_back(0);
        }
        scene.triangles.emplace_back(base, base + 2, base + 1);
        scene.triangles.emplace_back(base, base + 3, base + 2);
        scene.objects.push_back({name, first, 2, 0, Box{vec3(-half, y, -half), vec3(half, y, half)}});
    };
    scene.materials.emplace_back();
    square("ground", 0, 40);
    square("roof", 90, 1.5F);
    Light light{"sun", {}};
    light.shape.kind = GN_LIGHT_DIRECTIONAL;
    light.shape.direction_ws = vec4(0, -1, 0, 0);
    scene.lights = {light};
    scene.cameras = {Camera{.position_ws = vec3(0, 2, 8), .forward_ws = glm::normalize(vec3(0, -2, -8)), .far = 60}};
    finish_scene(scene);
    for (const char* fit : {"fit=plain", "fit=fitted", "fit=stable", "fit=warped", "split=sdsm-minmax"}) {
        const auto c = test::compare(scene, std::string("hard,placement=cascades,cascades.") + fit);
        // The roof's shadow has a border of some hundred pixels, along which a texel may lie on the other side: 4 were measured,
        // one in ten may.
        const auto dark = static_cast<double>(c.errors.dark);
        EXPECT_GT(dark, 500) << fit;
        EXPECT_LE(*c.errors.leak * dark, 10) << fit;
        EXPECT_LE(*c.errors.mismatch * static_cast<double>(c.errors.samples), 10) << fit;
    }
}

/// With the default bias, lit samples that are not beside a shadow's edge are lit.
TEST(CascadesRendered, DefaultBiasLeavesNoAcne) {
    for (const char* name : {"corridor", "courtyard"}) {
        for (const char* recipe : {"pcf,resolution=2048,placement=cascades",
                                   "pcf,resolution=2048,placement=cascades,cascades.split=sdsm-minmax"}) {
            const auto c = test::compare(with_hard_sun(name), recipe);
            const std::size_t w = c.frame.samples.width;
            dvec2 acne(0);
            for (std::size_t y = 4; y + 4 < c.frame.samples.height; ++y) {
                for (std::size_t x = 4; x + 4 < w; ++x) {
                    bool lit = true;
                    for (std::size_t i = 0; i < 81 && lit; ++i) {
                        const std::size_t p = (y - 4 + i / 9) * w + x - 4 + i % 9;
                        lit = c.truth.counted[p] != 0 && c.truth.visibility[p] == 1;
                    }
                    acne += lit ? dvec2(1 - static_cast<double>(c.visibility().values[y * w + x]), 1) : dvec2(0);
                }
            }
            ASSERT_GT(acne.y, 500) << name;
            // Measured: what two samples of 2389 lose in the corridor, whose far stable windows are coarse; 2e-5 elsewhere.
            EXPECT_LE(acne.x / acne.y, 1e-3) << name << " " << recipe << " of " << acne.y;
        }
    }
}

/// Samples within 3 pixels of a change of cascade, or elsewhere.
struct Region {
    double error = 0, samples = 0, edges = 0;  ///< sum of errors; counts, of all and of those at a shadow's edge
};
struct Seam {
    Region band, rest;
};

Seam seam_of(const Scene& scene, const std::string& recipe) {
    const ComparisonOptions options{.width = 480, .height = 270, .samples = 1};
    const auto c = compare(scene, recipe, options);
    const LightViews views = place(scene, recipe, options.width, options.height);
    auto data = views.data_as<GnCascadesData>();
    data.transition = GN_TRANSITION_NONE;
    const auto cascade = [&](std::size_t pixel) {
        return glsl::gn_cascades_choose(receiver_at(c.frame.samples.normal_ws[pixel].w), data).first;
    };
    const auto edges = edge_pixels(c.truth.visibility, c.truth.counted, static_cast<int>(options.width),
                                   static_cast<int>(options.height));
    Seam seam;
    const std::size_t w = options.width;
    for (std::size_t y = 3; y + 3 < options.height; ++y) {
        for (std::size_t x = 3; x + 3 < w; ++x) {
            const std::size_t p = y * w + x;
            if (c.truth.counted[p] == 0) {
                continue;
            }
            const bool near_split = cascade(p - 3 * w) != cascade(p + 3 * w) || cascade(p - 3) != cascade(p + 3);
            const double error =
                std::abs(static_cast<double>(c.visibility().values[p]) - static_cast<double>(c.truth.visibility[p]));
            Region& region = near_split ? seam.band : seam.rest;
            region.error += error;
            region.samples += 1;
            region.edges += edges[p];
        }
    }
    return seam;
}

/// The mean error in a band of 3 pixels around a change of cascade is no higher than elsewhere, by more than a fifth. In the
/// corridor that asks where the edges are: a third of the samples in the band lie at one, of the others a twentieth. So
/// there, and everywhere, the same is asked of the error per sample at an edge.
TEST(CascadesRendered, NoSeamWhereCascadesMeet) {
    for (const char* scene : {"courtyard", "corridor"}) {
        for (const char* more : {"", ",cascades.transition=dither", ",cascades.fit=fitted", ",cascades.fit=warped"}) {
            const auto [band, rest] = seam_of(with_hard_sun(scene), std::string("pcf,placement=cascades") + more);
            ASSERT_GT(band.samples, 500) << scene;
            EXPECT_LE(band.error / band.edges, 1.2 * rest.error / rest.edges) << scene << more;
            if (std::string_view(scene) == "courtyard") {
                EXPECT_LE(band.error / band.samples, 1.2 * rest.error / rest.samples) << more;
            }
        }
    }
}

}  // namespace
}  // namespace gn::picture_test
