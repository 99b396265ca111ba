// SPDX-License-Identifier: MIT
// Pixels per texel along the corridor's floor, for docs/placement.md:
//
//     build/part_tests --gtest_filter=TexelsAlongTheView.* prints the table.
#include "shadow/placement/faces.glsl"
#include "tests/warp_scene.h"

#include <fmt/core.h>

namespace gn {
namespace {

constexpr std::array distances{2.5, 5.0, 10.0, 25.0, 50.0, 100.0, 250.0, 450.0};
constexpr std::array<const char*, 7> placements{"single",         "fit", "lispsm,lispsm.near=0", "lispsm", "tsm",
                                                "psm,psm.back=0", "psm"};

struct Errors2 {
    double along = 0, across = 0;
};

/// How many pixels of a picture with as many rows as the map has texels one texel covers, on the floor at a distance:
/// along the view and across it. Foreshortening on screen is left out, as in perspective aliasing.
Errors2 pixels_per_texel(const Scene& scene, const GnLightView& view, double distance) {
    const Camera& camera = scene.cameras.front();
    const dvec3 p_ws(camera.position_ws.x, 0, static_cast<double>(camera.position_ws.z) - distance);
    const double depth = glm::dot(p_ws - dvec3(camera.position_ws), glm::normalize(dvec3(camera.forward_ws)));
    const double pixel = 2 * std::tan(0.5 * static_cast<double>(camera.yfov));
    return {test::error_along(view, p_ws, {0, 0, 1}, depth) / pixel,
            test::error_along(view, p_ws, {1, 0, 0}, depth) / pixel};
}

TEST(TexelsAlongTheView, OfTheCorridor) {
    Scene scene = load_scene("corridor");
    scene.lights[0].shape.direction_ws = vec4(0, -1, 0, 0);
    std::map<std::string, std::vector<Errors2>> table;
    fmt::print("{:<22}", "along / across, at m");
    for (const double distance : distances) {
        fmt::print("{:>15}", distance);
    }
    fmt::print("\n");
    for (const char* placement : placements) {
        const LightViews views =
            test::place(scene, fmt::format("hard,resolution=1024,placement={}", placement), 1024, 1024);
        fmt::print("{:<22}", placement);
        for (const double distance : distances) {
            table[placement].push_back(pixels_per_texel(scene, views.views[0], distance));
            fmt::print("{:>15}",
                       fmt::format("{:.2f} / {:.2f}", table[placement].back().along, table[placement].back().across));
        }
        fmt::print("\n");
    }

    // C fig. 3.7: the uniform map's error falls as 1/z; psm's is constant across and rises as z along; the optimal warp's
    // worst is the least of them.
    const auto worst = [&](const char* placement) {
        double most = 0;
        for (const Errors2& e : table[placement]) {
            most = std::max({most, e.along, e.across});
        }
        return most;
    };
    for (std::size_t i = 1; i < distances.size(); ++i) {
        const double ratio = table["fit"][i].along / table["fit"][i - 1].along;
        EXPECT_NEAR(ratio, distances[i - 1] / distances[i], 0.15 * ratio);
    }
    EXPECT_LT(worst("lispsm"), 0.25 * worst("fit"));
    EXPECT_LT(worst("lispsm"), worst("psm,psm.back=0"));
    EXPECT_GT(table["psm,psm.back=0"].back().along, table["psm,psm.back=0"].front().along);
}

}  // namespace
}  // namespace gn
