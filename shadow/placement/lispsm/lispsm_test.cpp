// SPDX-License-Identifier: MIT
// Closed forms of the warp, its fallback, and what a warped map may not break.
#include "shadow/placement/lispsm/lispsm.h"
#include "shadow/placement/warp.h"
#include "shadow/receiver/receiver.glsl"
#include "tests/warp_scene.h"

#include <random>

namespace gn::lispsm_test {
namespace {

constexpr const char* plain = "hard,placement=fit,resolution=4096";
constexpr const char* warped = "hard,placement=lispsm,resolution=4096";

/// Wimmer et al.: the distance with the same error at both ends, and the parameter's three landmarks.
TEST(Lispsm, ParameterRunsFromUniformOverOptimalToPerspective) {
    EXPECT_DOUBLE_EQ(warp::optimal_distance(1, 100), 11);
    EXPECT_DOUBLE_EQ(warp::strength_of(-1, 1, 100, 99), 0);
    EXPECT_DOUBLE_EQ(1 / warp::strength_of(0, 1, 100, 99), 11);
    EXPECT_DOUBLE_EQ(1 / warp::strength_of(1, 1, 100, 99), 1);
    // No jump where the two formulas meet.
    EXPECT_NEAR(warp::strength_of(-1e-9, 1, 100, 99), warp::strength_of(1e-9, 1, 100, 99), 1e-9);
}

/// Lloyd: no warp until a third of the half field, -0.2 where a side of the frustum is parallel to the light.
TEST(Lispsm, FalloffPassesLloydsPoints) {
    const double half = glm::radians(30.0);
    const auto at = [&](double degrees) { return warp::falloff(glm::radians(degrees), half); };
    EXPECT_EQ(at(0), -1);
    EXPECT_EQ(at(9.99), -1);
    EXPECT_NEAR(at(20), -0.6, 1e-12);
    EXPECT_NEAR(at(30), -0.2, 1e-12);
    EXPECT_NEAR(at(39), -0.2 + 0.2 * std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(at(48), 0, 1e-12);
    EXPECT_EQ(at(90), 0);
    for (double angle = 0; angle < 90; angle += 0.01) {
        EXPECT_LT(std::abs(at(angle + 0.01) - at(angle)), 0.001) << angle;
    }
}

/// Wimmer et al.: under an angle gamma of view and light the centre of projection lies n_opt / sin(gamma) before the nearest
/// receiver, metres on the light's plane; there w = 1 + (y - y_near) / n.
TEST(Lispsm, OriginalFalloffDividesTheDistanceByTheSineOfTheAngle) {
    const double near = 2;
    const double far = 200;
    for (const double tilt : {0.0, 0.5, 1.0, -2.0}) {
        const Scene scene = test::long_floor(near, far, vec3(dvec3(0, 1, tilt)));
        for (const double eta : {0.0, -0.5}) {
            const GnLightView view =
                test::place(scene, fmt::format("{},lispsm.falloff=wsp04,lispsm.eta={}", warped, eta)).views[0];
            const dmat4 rows = glm::transpose(dmat4(view.cs_from_ws));
            const double w_near =
                std::min(glm::dot(rows[3], dvec4(0, 0, -near, 1)), glm::dot(rows[3], dvec4(0, 0, -far, 1)));
            const double sine = 1 / std::sqrt(1 + tilt * tilt);
            const double n = (near + std::sqrt(near * far)) / (sine * (1 + eta));
            EXPECT_NEAR(w_near / glm::length(dvec3(rows[3])), n, 0.01 * n) << "tilt " << tilt << " eta " << eta;
        }
    }
}

/// C fig. 3.7 for a light overhead: e(z) = (n + z - z_n)^2 / (n (n + d) z / d) with n = z_n + sqrt(z_f z_n).
TEST(Lispsm, ErrorAlongTheViewIsEqualAtBothEndsAndAtMostTheRootOfTheBest) {
    const double near = 2;
    const double far = 200;
    const GnLightView view = test::place(test::long_floor(near, far), warped).views[0];
    const auto error = [&](double z) { return test::error_along(view, {0, 0, -z}, {0, 0, 1}, z); };
    const double ends = (far - near) / std::sqrt(near * far);
    EXPECT_NEAR(error(1.001 * near), ends, 0.02 * ends);
    EXPECT_NEAR(error(0.999 * far), ends, 0.02 * ends);
    const double middle = std::sqrt(near * far);
    EXPECT_NEAR(error(middle), 4 * ends / std::pow(std::sqrt(far / near) + 1, 2) * std::sqrt(far / near), 0.02 * ends);

    // The best parametrization is logarithmic and has the same error everywhere.
    const double best = std::log(far / near);
    for (double z = 1.001 * near; z < 0.999 * far; z *= 1.1) {
        EXPECT_LE(error(z), std::sqrt(far / near) * best) << z;
        EXPECT_LE(error(z), 1.02 * ends) << z;
    }
    // And the unwarped map is worse by the root again.
    const GnLightView uniform = test::place(test::long_floor(near, far), plain).views[0];
    EXPECT_NEAR(test::error_along(uniform, {0, 0, -2.002}, {0, 0, 1}, 2.002), (far - near) / near, 2);
}

class RayLaw : public ::testing::TestWithParam<const char*> {};

/// The light keeps its direction and its type: all points of a ray fall on one texel, at rising depths.
TEST_P(RayLaw, PointsOfALightRayKeepTheirTexel) {
    const Scene scene = load_scene(GetParam());
    const LightViews views = test::place(scene, warped);
    ASSERT_EQ(views.views.size(), 1U);
    const GnLightView& view = views.views[0];
    const GnLightView fitted = test::place(scene, plain).views[0];
    EXPECT_EQ(view.eye_ws, fitted.eye_ws);
    EXPECT_EQ(view.depth_from_ws, fitted.depth_from_ws);
    EXPECT_NE(view.cs_from_ws, fitted.cs_from_ws) << "nothing was warped";

    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const Camera& camera = scene.cameras[0];
    for (int i = 0; i < 200; ++i) {
        const double distance = 2 + 8 * (uniform(random) + 1);
        const dvec3 aside(uniform(random), uniform(random), uniform(random));
        const dvec3 p_ws = dvec3(camera.position_ws) + distance * (dvec3(camera.forward_ws) + 0.2 * aside);
        const dvec3 ray = -dvec3(glsl::gn_to_eye(fitted, vec3(p_ws)));
        const dvec3 q_ws = p_ws + 0.7 * ray;
        EXPECT_LT(glm::length(test::uv_of(view, p_ws) - test::uv_of(view, q_ws)) * 4096, 0.25) << i;
        const auto depth = [&](dvec3 r_ws) { return glm::dot(dvec4(view.depth_from_ws), dvec4(r_ws, 1)); };
        EXPECT_GT(depth(q_ws), depth(p_ws));
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, RayLaw, ::testing::Values("corridor", "duel:light=spot,elevation=50", "contact"));

TEST(Lispsm, HullTouchesAllFourBorders) {
    for (const vec3 to_light : {vec3(0, 1, 0), vec3(0.4F, 1, 0.3F), vec3(1, 0.4F, -0.2F)}) {
        const Scene scene = test::long_floor(2, 90, to_light);
        const int resolution = 1024;
        const LightViews views = test::place(scene, "pcf,pcf.size=9,placement=lispsm,resolution=1024");
        FrameGraph graph(test::device());
        const SceneHandles handles;
        const ViewSamples samples{.width = 256, .height = 256, .camera = scene.cameras.front()};
        const FrameInput input{test::device(), graph, scene, handles, samples, scene.lights.data()};
        dvec2 low(1e9);
        dvec2 high(-1e9);
        for (const dvec3& p : potential_receivers(input).vertices()) {
            low = glm::min(low, test::uv_of(views.views[0], p));
            high = glm::max(high, test::uv_of(views.views[0], p));
        }
        const double guard = static_cast<double>(guard_of(load_recipe("pcf,pcf.size=9"), {}, {}).texels) / resolution;
        for (int axis = 0; axis < 2; ++axis) {
            EXPECT_NEAR(low[axis], guard, 1.0 / resolution) << to_light.x << " axis " << axis;
            EXPECT_NEAR(high[axis], 1 - guard, 1.0 / resolution) << to_light.x << " axis " << axis;
        }
    }
}

/// The view turns into the light: warped texels meet the fitted ones, and below a third of the field they are the same.
TEST(Lispsm, FallsBackToFitSmoothlyAsTheViewTurnsIntoTheLight) {
    Scene scene = test::long_floor(2, 60);
    scene.bounds_ws.max.y = 3;
    // The light leaves the view to one side, so that the fitted rectangle is turned against the view.
    const double aside = 0.5;
    const double third = std::atan(std::tan(0.6) / std::cos(aside)) / 3;
    const auto turned = [&](double angle) {
        scene.lights[0].shape.direction_ws =
            vec4(dvec4(-std::sin(angle) * std::sin(aside), -std::sin(angle) * std::cos(aside), -std::cos(angle), 0));
    };
    turned(0.99 * third);
    EXPECT_EQ(test::place(scene, warped).views[0].cs_from_ws, test::place(scene, plain).views[0].cs_from_ws);

    // Close above the threshold texels are nearly the fitted ones, and get closer still.
    double before = 1;
    for (const double above : {0.1, 0.03, 0.01, 0.003}) {
        turned((1 + above) * third);
        const GnLightView a = test::place(scene, warped).views[0];
        const GnLightView b = test::place(scene, plain).views[0];
        double difference = 0;
        for (const double z : {5.0, 20.0, 50.0}) {
            glsl::GnReceiver receiver{};
            receiver.p_ws = vec3(0, 0, -z);
            receiver.n_ws = vec3(0, 1, 0);
            const auto in_a = glsl::gn_project(receiver, a, {});
            const auto in_b = glsl::gn_project(receiver, b, {});
            const float area = glm::length(glm::cross(in_a.du_ws, in_a.dv_ws));
            const float fitted = glm::length(glm::cross(in_b.du_ws, in_b.dv_ws));
            difference = std::max(difference, static_cast<double>(std::abs(area / fitted - 1)));
            // The map's axes turn into the fitted ones, up to quarter turns.
            const vec3 u = glm::normalize(in_a.du_ws);
            const float cosine = std::max(std::abs(glm::dot(u, glm::normalize(in_b.du_ws))),
                                          std::abs(glm::dot(u, glm::normalize(in_b.dv_ws))));
            difference = std::max(difference, static_cast<double>(1 - cosine));
        }
        EXPECT_LT(difference, before) << above;
        before = difference;
    }
    EXPECT_LT(before, 0.05);
}

TEST(Lispsm, EveryViewSampleProjectsInsideTheMap) {
    std::size_t asked = 0;
    for (const char* name : {"contact", "corridor", "duel", "duel:light=spot", "tilted", "slab"}) {
        const Scene scene = load_scene(name);
        SceneGpu gpu = upload_scene(test::device(), scene);
        const CpuSamples cpu = render_samples(test::device(), gpu, scene.cameras[0], 64, 64);
        for (const char* placement : {"lispsm", "tsm", "psm", "psm,psm.back=0"}) {
            const LightViews views = test::place(scene, fmt::format("pcf,pcf.size=7,placement={}", placement), 64, 64);
            for (std::size_t i = 0; i < cpu.position_ws.size(); ++i) {
                const vec3 p_ws(cpu.position_ws[i]);
                if (cpu.position_ws[i].w < 0.5F || !gn_counted(scene.lights[0].shape, p_ws, vec3(cpu.normal_ws[i]))) {
                    continue;
                }
                // A light among its receivers has six views, and one of them holds the sample.
                const bool held = std::any_of(views.views.begin(), views.views.end(), [&](const GnLightView& view) {
                    const vec4 p_cs = view.cs_from_ws * vec4(p_ws, 1);
                    return p_cs.w > 0 && std::max(std::abs(p_cs.x), std::abs(p_cs.y)) <= p_cs.w;
                });
                ASSERT_TRUE(held) << name << " " << placement << " sample " << i << " of " << views.views.size()
                                  << " views";
                ++asked;
            }
        }
    }
    EXPECT_GT(asked, 6U * 4U * 500U)
        << "the scenes fill at least an eighth of their pictures with what the light reaches";
}

/// Wherever the light stands, no receiver beyond the pseudo-near plane gets a coarser texel on screen than the coarsest of
/// the unwarped map.
TEST(Lispsm, WorstTexelOnScreenIsNeverWorseThanFits) {
    Scene scene = load_scene("duel");
    const Camera& camera = scene.cameras.front();
    FrameGraph graph(test::device());
    const SceneHandles handles;
    const ViewSamples samples{.width = 256, .height = 256, .camera = camera};
    const FrameInput input{test::device(), graph, scene, handles, samples, scene.lights.data()};
    // Of the receivers that steer the warp: those beyond the pseudo-near plane.
    double end = 0;
    for (const dvec3& p : potential_receivers(input).vertices()) {
        end = std::max(end, glm::dot(p - dvec3(camera.position_ws), dvec3(camera.forward_ws)));
    }
    const double first = static_cast<double>(GnLispsmParams{}.near) * end;
    const ConvexBody body = potential_receivers(input, first, static_cast<double>(camera.far));
    const auto worst = [&](const GnLightView& view) {
        double most = 0;
        for (const dvec3& p : body.vertices()) {
            glsl::GnReceiver receiver{};
            receiver.p_ws = vec3(p);
            const auto projected = glsl::gn_project(receiver, view, {});
            const double depth = glm::dot(p - dvec3(camera.position_ws), dvec3(camera.forward_ws));
            most = std::max(most, static_cast<double>(projected.texel_ws) / depth);
        }
        return most;
    };
    int warped_views = 0;
    std::mt19937 random(9);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 200; ++i) {
        const vec3 to_light = glm::normalize(vec3(normal(random), std::abs(normal(random)) + 0.1F, normal(random)));
        scene.lights[0].shape.direction_ws = vec4(-to_light, 0);
        const GnLightView fitted = test::place(scene, plain).views[0];
        GnLightView view;
        for (const char* eta : {",lispsm.eta=1", ",lispsm.eta=0"}) {
            view = test::place(scene, std::string(warped) + eta).views[0];
            EXPECT_LE(worst(view), 1.01 * worst(fitted)) << to_light.x << " " << to_light.y << " " << to_light.z << eta;
        }
        warped_views += view.cs_from_ws != fitted.cs_from_ws ? 1 : 0;
    }
    EXPECT_GT(warped_views, 100);
}

/// Duelling frusta: no warp helps, and none may harm.
TEST(Lispsm, NeverWorseThanFitInDuel) {
    for (const char* scene : {"duel:elevation=5", "duel", "duel:elevation=30", "duel:light=spot"}) {
        const auto fitted = test::compare(scene, "hard,placement=fit,resolution=512");
        const auto perspective = test::compare(scene, "hard,placement=lispsm,resolution=512");
        EXPECT_LE(*perspective.errors.mismatch, 1.02 * *fitted.errors.mismatch) << scene;
    }
}

/// Where it should help: half the wrong pixels of `fit`, at the same map.
TEST(Lispsm, HalvesTheWrongPixelsOfTheCorridor) {
    const auto fitted = test::compare("corridor", "hard,placement=fit,resolution=1024");
    const auto perspective = test::compare("corridor", "hard,placement=lispsm,resolution=1024");
    EXPECT_LT(*perspective.errors.mismatch, 0.5 * *fitted.errors.mismatch);
}

class WarpedMap : public ::testing::TestWithParam<const char*> {};

TEST_P(WarpedMap, NoAcneWithTheDefaultBias) {
    for (const char* scene : {"tilted", "tilted:angle=85", "tilted:angle=89", "tilted:light=spot"}) {
        const auto c = test::compare(scene, fmt::format("hard,placement={}", GetParam()));
        EXPECT_LE(*c.errors.acne, 1e-3) << scene;
    }

    // The corridor has edges, whose staircase is no acne: ask two pixels away from them.
    const auto c = test::compare("corridor", fmt::format("hard,resolution=4096,placement={}", GetParam()));
    const int size = 192;
    int lit = 0;
    int dark = 0;
    for (int y = 2; y < size - 2; ++y) {
        for (int x = 2; x < size - 2; ++x) {
            bool inside = true;
            for (int i = 0; i < 25; ++i) {
                const auto near = static_cast<std::size_t>((y + i / 5 - 2) * size + x + i % 5 - 2);
                inside = inside && c.truth.counted[near] != 0 && c.truth.visibility[near] == 1;
            }
            lit += inside ? 1 : 0;
            dark += inside && c.visibility().values[static_cast<std::size_t>(y * size + x)] < 1 ? 1 : 0;
        }
    }
    EXPECT_GT(lit, 2000);
    EXPECT_LE(dark, 1e-3 * lit);
}

/// A slab high above all that the camera sees: no receiver, nearer to the light than the map's near plane.
TEST_P(WarpedMap, CasterBeforeTheNearPlaneStillCasts) {
    const auto c = test::compare("slab", fmt::format("hard,placement={}", GetParam()));
    std::size_t dark = 0;
    for (std::size_t i = 0; i < c.truth.visibility.size(); ++i) {
        dark += c.truth.counted[i] != 0 && c.truth.visibility[i] == 0 ? 1 : 0;
    }
    EXPECT_GT(dark, 200U);
    // What is wholly dark lies half a penumbra from the edge of a hard shadow.
    EXPECT_EQ(*c.errors.leak, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Placements, WarpedMap, ::testing::Values("lispsm", "tsm", "psm"));

}  // namespace
}  // namespace gn::lispsm_test
