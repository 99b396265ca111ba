// SPDX-License-Identifier: MIT
#include "shadow/view/surface.glsl"
#include "tests/rig.h"

namespace gn::view_test {
namespace {

/// Each sample must lie in its triangle's plane to the rounding of its three coordinates, half a unit in the last place each, or of
/// the triangle's edges where these are larger: measured against the nearest plane of the scene in double precision.
TEST(ViewSamples, LieInTheScenesPlanesToRounding) {
    const test::ValidationGuard guard;
    for (const char* name : {"contact", "tilted:angle=80", "corridor"}) {
        const Scene scene = load_scene(name);
        SceneGpu gpu = upload_scene(test::device(), scene);
        const CpuSamples samples = render_samples(test::device(), gpu, scene.cameras[0], 64, 64);
        double worst_ulps = 0;
        for (std::size_t i = 0; i < samples.position_ws.size(); i += 7) {
            if (samples.position_ws[i].w < 0.5F) {
                continue;
            }
            const dvec3 p_ws(vec3(samples.position_ws[i]));
            double least_ulps = 1e9;
            for (const uvec3& t : scene.triangles) {
                const dvec3 a(scene.positions_ws[t.x]);
                const dvec3 edge0 = dvec3(scene.positions_ws[t.y]) - a;
                const dvec3 edge1 = dvec3(scene.positions_ws[t.z]) - a;
                const dvec3 n = glm::cross(edge0, edge1);
                const double size = std::max({glm::length(p_ws), glm::length(edge0), glm::length(edge1)});
                if (glm::length(n) > 0) {
                    least_ulps =
                        std::min(least_ulps, std::abs(glm::dot(p_ws - a, glm::normalize(n))) / (size * 0x1p-23));
                }
            }
            worst_ulps = std::max(worst_ulps, least_ulps);
        }
        RecordProperty(std::string("worst_ulps_") + name, std::to_string(worst_ulps));
        EXPECT_LT(worst_ulps, 0.87) << name;
    }
}

/// Every number that a surface is packed from comes back: the object's exactly, roughness to half of its step.
TEST(ViewSamples, ASurfaceComesBackFromSixtyFourBits) {
    for (const std::uint32_t object : {0U, 1U, 65536U, glsl::gn_surface_objects - 1}) {
        for (const float roughness : {0.0F, 0.3F, 1.0F}) {
            const uvec2 surface = glsl::gn_surface(vec3(0.6F, -0.8F, 0), object, roughness);
            EXPECT_EQ(glsl::gn_surface_object(surface), object);
            EXPECT_NEAR(glsl::gn_surface_roughness(surface), roughness, 0.5 / 255 + 1e-6);
            EXPECT_NEAR(glsl::gn_surface_normal(surface).y, -0.8F, 1e-4);
        }
    }
}

TEST(ViewSamples, NormalsFaceTheCameraAndAreUnit) {
    const Scene scene = load_scene("contact");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const CpuSamples samples = render_samples(test::device(), gpu, scene.cameras[0], 64, 64);
    std::size_t seen = 0;
    for (std::size_t i = 0; i < samples.position_ws.size(); ++i) {
        if (samples.position_ws[i].w > 0.5F) {
            ++seen;
            const vec3 n_ws(samples.normal_ws[i]);
            EXPECT_NEAR(glm::length(n_ws), 1, 1e-5);
            EXPECT_GT(glm::dot(n_ws, scene.cameras[0].position_ws - vec3(samples.position_ws[i])), 0);
        }
    }
    EXPECT_GT(seen, samples.position_ws.size() / 2);
}

}  // namespace
}  // namespace gn::view_test
