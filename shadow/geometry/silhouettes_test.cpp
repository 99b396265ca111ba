// SPDX-License-Identifier: MIT
// How many edges of a mesh of n triangles are silhouettes, which is what volumes draw: n^0.5 of a sphere, and by McGuire's count
// n^0.8 of models as they are [EASW09] 5.3.4.
#include "base/paths.h"
#include "shadow/geometry/edges.h"
#include "shadow/geometry/volumes.glsl"
#include "tests/direct_scenes.h"
#include "tests/thorough.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

namespace gn::silhouettes_test {
namespace {

using namespace by_hand;

/// Edges that are silhouettes, the mean over suns from all around, per component.
std::vector<double> silhouettes(std::span<const vec3> positions_ws, std::span<const uvec3> triangles,
                                const EdgeList& list, int directions) {
    std::vector<double> sums(list.components.size(), 0.0);
    for (int i = 0; i < directions; ++i) {
        // Even steps of height and golden angles spread them.
        const float height = 1 - 2 * (static_cast<float>(i) + 0.5F) / static_cast<float>(directions);
        const float angle = 2.399963F * static_cast<float>(i), across = std::sqrt(1 - height * height);
        const vec4 light_ws(across * std::cos(angle), height, across * std::sin(angle), 0);
        std::vector<std::int8_t> sides(triangles.size());
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            sides[t] = static_cast<std::int8_t>(gn_volumes_side(
                positions_ws[triangles[t].x], positions_ws[triangles[t].y], positions_ws[triangles[t].z], light_ws));
        }
        for (std::size_t e = 0; e < list.edges.size(); ++e) {
            int sum = 0;
            for (std::uint32_t k = list.first[e]; k < list.first[e + 1]; ++k) {
                const int m = sides[list.around[k] / 2];
                sum += (list.around[k] & 1U) != 0U ? -m : m;
            }
            sums[list.component_of[list.around[list.first[e]] / 2]] += sum != 0 ? 1.0 / directions : 0.0;
        }
    }
    return sums;
}

/// The line through points by least squares: slope and height at 0.
struct Line {
    double slope = 0, at_zero = 0;
};
Line fit(const std::vector<dvec2>& points) {
    dvec2 mean(0);
    for (const dvec2 p : points) {
        mean += p / static_cast<double>(points.size());
    }
    double along = 0, spread = 0;
    for (const dvec2 p : points) {
        along += (p.x - mean.x) * (p.y - mean.y);
        spread += (p.x - mean.x) * (p.x - mean.x);
    }
    return {along / spread, mean.y - along / spread * mean.x};
}

/// An octahedron whose triangles are divided into four, `times` times, on the unit sphere.
void make_sphere(int times, std::vector<vec3>& positions, std::vector<uvec3>& triangles) {
    std::vector<std::array<dvec3, 3>> faces;
    for (const double x : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) {
            for (const double z : {-1.0, 1.0}) {
                const dvec3 a(x, 0, 0), b(0, y, 0), c(0, 0, z);
                faces.push_back(x * y * z > 0 ? std::array{a, b, c} : std::array{a, c, b});
            }
        }
    }
    for (int i = 0; i < times; ++i) {
        std::vector<std::array<dvec3, 3>> finer;
        for (const auto& [a, b, c] : faces) {
            const dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }
    for (const auto& face : faces) {
        const auto first = static_cast<uint>(positions.size());
        positions.insert(positions.end(), {vec3(face[0]), vec3(face[1]), vec3(face[2])});
        triangles.emplace_back(first, first + 1, first + 2);
    }
}

TEST(Silhouettes, OfSpheresGrowAsTheRootOfTheirTriangles) {
    std::vector<dvec2> points;
    for (int times = 2; times <= (test::thorough() ? 7 : 5); ++times) {
        std::vector<vec3> positions;
        std::vector<uvec3> triangles;
        make_sphere(times, positions, triangles);
        const std::vector<std::uint8_t> casts(triangles.size(), casts_from_both_sides);
        const EdgeList list = build_edges(positions, triangles, casts);
        ASSERT_EQ(list.components.size(), 1U);
        EXPECT_TRUE(list.components[0].closed);
        const double edges = silhouettes(positions, triangles, list, 24)[0];
        const auto n = static_cast<double>(triangles.size());
        // A circle of 2 pi crosses triangles whose sides are about sqrt(16 pi / sqrt(3) / n) long: at least 1.17 sqrt(n) of them.
        EXPECT_GT(edges, 1.17 * std::sqrt(n)) << n;
        EXPECT_LT(edges, 2 * std::sqrt(n)) << n;
        points.emplace_back(std::log(n), std::log(edges));
        if (test::thorough()) {
            fmt::print("sphere of {} triangles: {:.1f} silhouette edges, {:.3f} n^0.5\n", n, edges,
                       edges / std::sqrt(n));
        }
    }
    const Line line = fit(points);
    fmt::print("silhouette edges of spheres: {:.3f} n^{:.4f}\n", std::exp(line.at_zero), line.slope);
    EXPECT_NEAR(line.slope, 0.5, 0.02);
}

TEST(Silhouettes, OfModels) {
    if (!test::thorough()) {
        GTEST_SKIP() << "skipped: a table of minutes, for thorough runs";
    }
    const auto root = data_root() / "../shared/scenes";
    if (!std::filesystem::exists(root)) {
        GTEST_SKIP() << "skipped: no scenes lie beside the source tree";
    }
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
        const std::string type = entry.path().extension().string();
        if ((type == ".glb" || type == ".gltf" || type == ".obj") &&
            entry.path().string().find("/bad/") == std::string::npos) {
            files.push_back(entry.path().string());
        }
    }
    std::sort(files.begin(), files.end());
    std::vector<dvec2> of_files, of_parts;
    for (const std::string& file : files) {
        try {
            const Scene scene = load_scene(file);
            if (scene.triangles.size() > 3'000'000) {
                fmt::print("{}: {} triangles, left out\n", file, scene.triangles.size());
                continue;
            }
            const std::vector<std::uint8_t> casts(scene.triangles.size(), casts_from_both_sides);
            const EdgeList list = build_edges(scene.positions_ws, scene.triangles, casts);
            const std::vector<double> edges = silhouettes(scene.positions_ws, scene.triangles, list, 12);
            double all = 0;
            for (std::size_t c = 0; c < edges.size(); ++c) {
                all += edges[c];
                if (list.components[c].closed && list.components[c].triangles >= 100) {
                    of_parts.emplace_back(std::log(list.components[c].triangles), std::log(std::max(edges[c], 1.0)));
                }
            }
            const auto n = static_cast<double>(scene.triangles.size());
            of_files.emplace_back(std::log(n), std::log(all));
            fmt::print("{}: {} triangles, {} components, {:.0f} silhouette edges, n^{:.3f}\n",
                       std::filesystem::path(file).filename().string(), n, edges.size(), all,
                       std::log(all) / std::log(n));
        } catch (const std::exception& error) {
            fmt::print("{}: {}\n", file, error.what());
        }
    }
    for (const auto& [name, points] :
         {std::pair("models", &of_files), std::pair("closed components of 100 and more", &of_parts)}) {
        const Line line = fit(*points);
        double power = 0;
        for (const dvec2 p : *points) {
            power += p.y / p.x / static_cast<double>(points->size());
        }
        fmt::print("{} {}: {:.3f} n^{:.3f} by least squares; n^{:.3f} in the mean\n", points->size(), name,
                   std::exp(line.at_zero), line.slope, power);
    }
}

}  // namespace
}  // namespace gn::silhouettes_test
