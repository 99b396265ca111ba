// SPDX-License-Identifier: MIT
// The truth against the closed form of every analytic scene that has one, at the view samples of its cameras.
#include "base/error.h"
#include "reference/quads_test.h"
#include "reference/truth.h"
#include "tests/thorough.h"

#include <gtest/gtest.h>

#include <optional>

namespace gn::builtin_test {
namespace {

struct Hit {
    double t = std::numeric_limits<double>::infinity();
    std::size_t triangle = 0;
};

/// The nearest triangle along a ray, by trying all of them in double precision.
Hit nearest_hit(const Scene& scene, dvec3 origin, dvec3 direction) {
    Hit hit;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const uvec3 t = scene.triangles[i];
        const dvec3 a(scene.positions_ws[t.x]);
        const dvec3 ab = dvec3(scene.positions_ws[t.y]) - a;
        const dvec3 ac = dvec3(scene.positions_ws[t.z]) - a;
        const dvec3 p = glm::cross(direction, ac);
        const double determinant = glm::dot(ab, p);
        const double u = glm::dot(origin - a, p) / determinant;
        const dvec3 q = glm::cross(origin - a, ab);
        const double v = glm::dot(direction, q) / determinant;
        const double distance = glm::dot(ac, q) / determinant;
        if (u >= 0 && v >= 0 && u + v <= 1 && distance > 0 && distance < hit.t) {
            hit = {distance, i};
        }
    }
    return hit;
}

/// What a camera sees through the centres of width x height pixels, without a GPU.
Samples view_samples(const Scene& scene, const Camera& camera, int width, int height) {
    const dvec3 forward(camera.forward_ws);
    const dvec3 right = glm::normalize(glm::cross(forward, dvec3(camera.up_ws)));
    const dvec3 up = glm::cross(right, forward);
    const double half = std::tan(0.5 * static_cast<double>(camera.yfov));
    Samples samples;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double sx = (2.0 * (x + 0.5) / width - 1.0) * half * width / height;
            const double sy = (1.0 - 2.0 * (y + 0.5) / height) * half;
            const dvec3 direction = glm::normalize(forward + sx * right + sy * up);
            const Hit hit = nearest_hit(scene, dvec3(camera.position_ws), direction);
            if (!std::isfinite(hit.t)) {
                continue;
            }
            const uvec3 t = scene.triangles[hit.triangle];
            const dvec3 a(scene.positions_ws[t.x]);
            const dvec3 n =
                glm::normalize(glm::cross(dvec3(scene.positions_ws[t.y]) - a, dvec3(scene.positions_ws[t.z]) - a));
            samples.add(vec3(dvec3(camera.position_ws) + hit.t * direction), vec3(glm::dot(n, direction) < 0 ? n : -n));
        }
    }
    return samples;
}

/// Truth and closed form side by side.
struct Comparison {
    std::size_t known = 0, partial = 0, wrong = 0;
    double squares = 0, explained = 0;
    [[nodiscard]] double rmse() const {
        return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(known, 1)));
    }
    [[nodiscard]] double reported() const {
        return std::sqrt(explained / static_cast<double>(std::max<std::size_t>(known, 1)));
    }
};

/// Whether the closed form takes another value within a distance around p: then p lies on a shadow's border.
bool on_border(const Scene& scene, std::size_t light, dvec3 p, double value, double distance) {
    for (int i = 0; i < 27; ++i) {
        const dvec3 offset(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        const std::optional<double> there = scene.closed_form(light, p + distance * offset);
        if (!there.has_value() || std::abs(*there - value) > 0.5) {
            return true;
        }
    }
    return false;
}

Comparison compare(const Scene& scene, const Truth& truth, const Samples& samples, std::size_t light, int n) {
    TruthOptions options;
    options.samples = n;
    const TruthResult result = truth.trace(samples.position_ws, samples.normal_ws, scene.lights[light].shape, options);
    Comparison c;
    for (std::size_t i = 0; i < samples.position_ws.size(); ++i) {
        const dvec3 p(vec3(samples.position_ws[i]));
        const std::optional<double> expected = scene.closed_form(light, p);
        if (result.counted[i] == 0 || !expected.has_value()) {
            continue;
        }
        const double error = static_cast<double>(result.visibility[i]) - *expected;
        const auto se = static_cast<double>(result.standard_error[i]);
        // Closed forms of solids shrink them by 0.1 mm a side, so that faces do not shadow themselves; within that of a
        // border, twice as far for slanting light, they settle nothing.
        if (se == 0 && std::abs(error) > 0.5 && on_border(scene, light, p, *expected, 2e-4)) {
            continue;
        }
        ++c.known;
        c.partial += *expected > 0 && *expected < 1 ? 1U : 0U;
        c.wrong += se == 0 && std::abs(error) > 0.5 ? 1U : 0U;
        c.squares += error * error;
        c.explained += se * se;
    }
    return c;
}

class Analytic : public testing::TestWithParam<const char*> {};

TEST_P(Analytic, TruthMeetsTheClosedForm) {
    const Scene scene = make_builtin_scene(GetParam());
    ASSERT_TRUE(scene.closed_form) << "an analytic scene has a closed form";
    const Truth truth(scene);
    for (const Camera& camera : scene.cameras) {
        const Samples samples = view_samples(scene, camera, 96, 54);
        for (std::size_t light = 0; light < scene.lights.size(); ++light) {
            const Comparison coarse = compare(scene, truth, samples, light, 64);
            const Comparison fine = compare(scene, truth, samples, light, 1024);
            const std::string where =
                fmt::format("{}, view {}, light {}: {} samples, {} in penumbra, rmse {} -> {}, reported {} -> {}",
                            GetParam(), camera.name, scene.lights[light].name, fine.known, fine.partial, coarse.rmse(),
                            fine.rmse(), coarse.reported(), fine.reported());
            RecordProperty(camera.name + " " + scene.lights[light].name, where);
            EXPECT_EQ(coarse.wrong, 0U) << where;
            if (coarse.known == 0) {
                continue;  // no closed form for this light's shape
            }
            if (coarse.partial < 50) {
                EXPECT_LT(coarse.rmse(), 1e-6) << where;  // a hard shadow is exact
                continue;
            }
            // The error is the reported one (a few hundred samples determine their ratio to within 15 percent), and
            // sixteen times the samples bring it down by four, the rate of chance, or better.
            EXPECT_NEAR(fine.rmse() / fine.reported(), 1.0, 0.15) << where;
            EXPECT_NEAR(coarse.rmse() / coarse.reported(), 1.0, 0.15) << where;
            EXPECT_LT(fine.rmse(), coarse.rmse() / 4) << where;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Analytic,
                         testing::ValuesIn(test::picked<const char*>({"half-plane", "slab", "slab:light=spot", "stack",
                                                                      "overlap", "overlap:light=spot", "tilted:angle=0",
                                                                      "tilted:angle=60", "tilted:angle=85", "contact",
                                                                      "fence", "corridor", "duel"})));

}  // namespace
}  // namespace gn::builtin_test
