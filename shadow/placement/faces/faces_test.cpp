// SPDX-License-Identifier: MIT
// Which face a ray goes through, the error's closed form where nothing else can be warped, and pictures.
#include "shadow/placement/faces/faces.glsl"
#include "shadow/geometry/convex_body.h"
#include "shadow/receiver/receiver.glsl"
#include "tests/warp_scene.h"

#include <random>
#include <set>

namespace gn::faces_test {
namespace {

constexpr double no_key = 1e29;

/// A box that holds the camera's whole frustum from near to far, looked at along -z.
Scene long_space(double near, double far, vec3 to_light) {
    Scene scene = test::long_floor(near, far, to_light);
    scene.bounds_ws = Box{vec3(-400, -400, static_cast<float>(-far)), vec3(400, 400, static_cast<float>(-near))};
    scene.cameras[0].position_ws = vec3(0);
    scene.cameras[0].near = static_cast<float>(near);
    scene.cameras[0].far = static_cast<float>(far);
    return scene;
}

std::vector<Plane> planes_of(const Scene& scene) {
    const Camera& camera = scene.cameras[0];
    return frustum_planes(camera, 1, static_cast<double>(camera.near), static_cast<double>(camera.far));
}

/// The plane of the frustum that a ray from inside meets first.
std::size_t first_met(const std::vector<Plane>& planes, dvec3 p_ws, dvec3 way) {
    std::size_t first = 0;
    double least = 1e300;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const double towards = -glm::dot(planes[i].normal_ws, way);
        const double t = (glm::dot(planes[i].normal_ws, p_ws) + planes[i].offset) / towards;
        if (towards > 0 && t < least) {
            first = i;
            least = t;
        }
    }
    return first;
}

struct Points {
    std::mt19937 random{7};
    std::uniform_real_distribution<double> uniform{-1, 1};
    /// In the frustum of a camera at the origin that looks along -z.
    dvec3 operator()(const Camera& camera) {
        const double z = 1.02 * static_cast<double>(camera.near) *
                         std::pow(0.96 * static_cast<double>(camera.far / camera.near), 0.5 + 0.5 * uniform(random));
        const double half = 0.98 * z * std::tan(0.5 * static_cast<double>(camera.yfov));
        return {half * uniform(random), half * uniform(random), -z};
    }
};

/// [LTYM06] 4: the ray of every point leaves by its face, or enters by it, before any other.
TEST(Faces, EveryPointBelongsToTheFaceThatItsRayMeetsFirst) {
    Points point;
    int compared = 0;
    std::set<int> met;
    for (const vec3 to_light :
         {vec3(0.2F, 1, 0.3F), vec3(0.1F, 0.2F, 1), vec3(-0.2F, 0.1F, -1), vec3(1, 0.3F, -0.4F)}) {
        for (const char* side : {"back", "front"}) {
            for (const bool sun : {true, false}) {
                Scene scene = long_space(1, 50, to_light);
                if (!sun) {
                    scene.lights[0].shape.kind = GN_LIGHT_POINT;
                    scene.lights[0].shape.position_ws = vec4(150.0F * to_light + vec3(0, 0, -25), 1);
                }
                const LightViews views =
                    test::place(scene, fmt::format("hard,placement=faces,resolution=512,faces.side={}", side));
                const auto data = views.data_as<GnFrustumFaces>();
                if (data.eye_ws.w > 0.5F) {
                    continue;  // too wide an angle: the six faces around the light serve
                }
                const bool leaves = std::string_view(side) == "back";
                for (int i = 0; i < 200; ++i) {
                    const dvec3 p_ws = point(scene.cameras[0]);
                    const dvec3 from = sun ? -dvec3(vec3(scene.lights[0].shape.direction_ws))
                                           : dvec3(vec3(scene.lights[0].shape.position_ws)) - p_ws;
                    const auto expected = static_cast<int>(first_met(planes_of(scene), p_ws, leaves ? -from : from));
                    const int face = glsl::gn_frustum_face(vec3(p_ws), data);
                    met.insert(face);
                    ++compared;
                    ASSERT_EQ(face, expected) << side << (sun ? " sun " : " point ") << to_light.x << " at " << p_ws.x
                                              << " " << p_ws.y << " " << p_ws.z;
                    const dvec2 uv = test::uv_of(views.views[static_cast<std::size_t>(face)], p_ws);
                    ASSERT_TRUE(std::min(uv.x, uv.y) >= 0 && std::max(uv.x, uv.y) <= 1);
                }
            }
        }
    }
    EXPECT_GT(compared, 2000);
    EXPECT_EQ(met.size(), 6U);
}

/// A sun from behind leaves nothing to warp in one map. The side faces still run from near to far: along each the error is
/// that of a floor under a light overhead, tan(a) L / sqrt(z_n z_f) at both ends, where a uniform map has tan(a) L / z_n.
TEST(Faces, ErrorAlongASideIsEqualAtBothEndsWithTheLightBehind) {
    const double near = 2;
    const double far = 200;
    const Scene scene = long_space(near, far, vec3(0, 0, 1));
    const LightViews views = test::place(scene, "hard,placement=faces,resolution=4096");
    const auto data = views.data_as<GnFrustumFaces>();
    EXPECT_LT(data.keys_ws[0].w, no_key) << "the rays enter by the near face";
    EXPECT_GT(data.keys_ws[1].w, no_key) << "the far face alone would be one uniform map";
    const double tangent = std::tan(0.6);
    const double ends = tangent * (far - near) / std::sqrt(near * far);
    for (const dvec3 side : {dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(0, 1, 0), dvec3(0, -1, 0)}) {
        const auto error = [&](double z) {
            const dvec3 p_ws = 0.999 * tangent * z * side - dvec3(0, 0, z);
            const auto face = static_cast<std::size_t>(glsl::gn_frustum_face(vec3(p_ws), data));
            EXPECT_GE(face, 2U);
            return test::error_along(views.views[face], p_ws, side, z);
        };
        EXPECT_NEAR(error(1.01 * near), ends, 0.05 * ends);
        EXPECT_NEAR(error(0.99 * far), ends, 0.05 * ends);
    }
    const GnLightView uniform = test::place(scene, "hard,placement=lispsm,resolution=4096").views[0];
    EXPECT_GT(test::error_along(uniform, {0, 0, -near}, {0, 1, 0}, near), 9 * ends);
}

/// Whichever side of the frustum is asked for, `auto` needs no more texels than it.
TEST(Faces, TheSetThatServesNeedsTheFewerTexels) {
    const auto needed = [](const Scene& scene, const char* side) {
        const LightViews views =
            test::place(scene, fmt::format("hard,placement=faces,resolution=1024,faces.near=0,faces.side={}", side));
        const auto data = views.data_as<GnFrustumFaces>();
        Points point;
        double worst = 0;
        for (int i = 0; i < 3000; ++i) {
            const dvec3 p_ws = point(scene.cameras[0]);
            const auto& view = views.views[static_cast<std::size_t>(glsl::gn_frustum_face(vec3(p_ws), data))];
            glsl::GnReceiver receiver{};
            receiver.p_ws = vec3(p_ws);
            receiver.n_ws = vec3(0, 0, 1);
            worst = std::max(worst, static_cast<double>(glsl::gn_project(receiver, view, {}).texel_ws) / -p_ws.z);
        }
        return views.layers * worst * worst;
    };
    for (const vec3 to_light : {vec3(0.05F, 0.1F, 1), vec3(0.05F, 0.1F, -1), vec3(0.1F, 1, 0.2F)}) {
        const Scene scene = long_space(1, 100, to_light);
        const double least = std::min(needed(scene, "back"), needed(scene, "front"));
        EXPECT_LE(needed(scene, "auto"), 1.2 * least) << to_light.x << " " << to_light.y << " " << to_light.z;
    }
}

/// Every sample that the light reaches lies in the view of its face, kernel and all.
TEST(Faces, EveryViewSampleProjectsInsideItsFacesMap) {
    std::size_t asked = 0;
    for (const char* name : {"contact", "corridor", "duel", "duel:light=spot", "contact:light=point", "slab"}) {
        const Scene scene = load_scene(name);
        SceneGpu gpu = upload_scene(test::device(), scene);
        const CpuSamples cpu = render_samples(test::device(), gpu, scene.cameras[0], 64, 64);
        const LightViews views = test::place(scene, "pcf,pcf.size=7,placement=faces", 64, 64);
        const auto data = views.data_as<GnFrustumFaces>();
        const double reach = 3.5 / views.resolution;
        for (std::size_t i = 0; i < cpu.position_ws.size(); ++i) {
            glsl::GnReceiver receiver{};
            receiver.p_ws = vec3(cpu.position_ws[i]);
            if (cpu.position_ws[i].w < 0.5F ||
                !gn_counted(scene.lights[0].shape, receiver.p_ws, vec3(cpu.normal_ws[i]))) {
                continue;
            }
            const auto view = static_cast<std::size_t>(glsl::gn_faces_choose(receiver, data).first);
            const dvec2 uv = test::uv_of(views.views[view], dvec3(receiver.p_ws));
            ASSERT_TRUE(std::min(uv.x, uv.y) >= reach && std::max(uv.x, uv.y) <= 1 - reach)
                << name << " sample " << i << " view " << view << " at " << uv.x << " " << uv.y;
            ++asked;
        }
    }
    EXPECT_GT(asked, 6U * 500U);
}

/// Where one map cannot be warped and is coarse near the camera.
TEST(FacesRendered, FewerWrongPixelsThanOneMapWithTheLightBehind) {
    Scene scene = test::built_in("corridor");
    scene.lights[0].shape.direction_ws = vec4(glm::normalize(vec3(0.1F, -0.25F, -1)), 0);
    const test::ComparisonOptions options{.width = 128, .height = 128, .samples = 1};
    const auto one = test::compare(scene, "hard,placement=lispsm,resolution=512", options);
    const auto faces = test::compare(scene, "hard,placement=faces,resolution=512", options);
    EXPECT_LT(*faces.errors.mismatch, 0.7 * *one.errors.mismatch);
}

TEST(FacesRendered, NoAcneWithTheDefaultBias) {
    const test::ComparisonOptions options{.width = 128, .height = 128, .samples = 1};
    for (const char* scene : {"tilted", "tilted:angle=85", "tilted:light=spot"}) {
        const auto c = test::compare(scene, "hard,placement=faces", options);
        EXPECT_LE(*c.errors.acne, 1e-3) << scene;
    }
}

}  // namespace
}  // namespace gn::faces_test
