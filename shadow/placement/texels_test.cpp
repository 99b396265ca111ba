// SPDX-License-Identifier: MIT
// Pixels per texel along the corridor's floor, for docs/placement.md:
//
//     build/part_tests --gtest_filter=TexelsAlongTheView.* prints the tables, and writes the curves to the file that the
//     environment variable GNOMON_CURVES names: docs/curves/texels.json, which tools/draw_curves draws.
#include "shadow/placement/cascades/cascades.glsl"
#include "tests/rig.h"
#include "tests/warp_scene.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>

namespace gn::texels_test {
namespace {

constexpr std::array distances{2.5, 5.0, 10.0, 25.0, 50.0, 100.0, 250.0, 450.0};
const std::array<std::string, 7> placements{"single",         "fit", "lispsm,lispsm.near=0", "lispsm", "tsm",
                                            "psm,psm.back=0", "psm"};

struct Errors2 {
    double along = 0, across = 0;
};

/// The view that serves a point at a depth along the camera's axis.
const GnLightView& view_at(const LightViews& views, double depth) {
    if (views.views.size() == 1) {
        return views.views.front();
    }
    const auto data = views.data_as<GnCascadesData>();
    glsl::GnReceiver receiver{};
    receiver.view_depth = static_cast<float>(depth);
    return views.views[static_cast<std::size_t>(glsl::gn_cascades_choose(receiver, data).first)];
}

/// How many pixels of a picture with as many rows as the map has texels one texel covers, on the floor at a distance:
/// along the view and across it, or up and across for a light that shines along the view. Foreshortening on screen is left
/// out, as in perspective aliasing.
Errors2 pixels_per_texel(const Scene& scene, const LightViews& views, double distance) {
    const Camera& camera = scene.cameras.front();
    const dvec3 forward = glm::normalize(dvec3(camera.forward_ws));
    const dvec3 p_ws(camera.position_ws.x, 0, static_cast<double>(camera.position_ws.z) - distance);
    const double depth = glm::dot(p_ws - dvec3(camera.position_ws), forward);
    const double pixel = 2 * std::tan(0.5 * static_cast<double>(camera.yfov));
    const bool overhead = scene.lights[0].shape.direction_ws.y < -0.9F;
    const dvec3 up = glm::cross(dvec3(1, 0, 0), forward);
    const GnLightView& view = view_at(views, depth);
    return {test::error_along(view, p_ws, overhead ? dvec3(0, 0, 1) : up, depth) / pixel,
            test::error_along(view, p_ws, {1, 0, 0}, depth) / pixel};
}

/// The corridor lit from straight above, or along the view from behind.
Scene lit_corridor(bool overhead) {
    Scene scene = test::built_in("corridor");
    scene.lights[0].shape.direction_ws = overhead ? vec4(0, -1, 0, 0) : vec4(scene.cameras[0].forward_ws, 0);
    return scene;
}

LightViews placed(const Scene& scene, const std::string& placement) {
    return test::place(scene, fmt::format("hard,resolution=1024,placement={}", placement), 1024, 1024);
}

/// Sixty distances along the floor that the camera sees, in even ratios.
std::vector<double> dense_distances() {
    std::vector<double> all;
    for (int i = 0; i < 60; ++i) {
        all.push_back(2.3 * std::pow(450 / 2.3, i / 59.0));
    }
    return all;
}

/// Texels that all maps together need over the picture's pixels so that nowhere a texel covers more than a pixel: every
/// map's worst error along times its worst across.
double storage(const Scene& scene, const LightViews& views) {
    std::map<const GnLightView*, Errors2> worst;
    const Camera& camera = scene.cameras.front();
    for (const double distance : dense_distances()) {
        const dvec3 offset(0, -static_cast<double>(camera.position_ws.y), -distance);
        Errors2& of_map = worst[&view_at(views, glm::dot(offset, glm::normalize(dvec3(camera.forward_ws))))];
        const Errors2 here = pixels_per_texel(scene, views, distance);
        of_map = {std::max(of_map.along, here.along), std::max(of_map.across, here.across)};
    }
    double sum = 0;
    for (const auto& [view, error] : worst) {
        sum += error.along * error.across;
    }
    return sum;
}

using Table = std::map<std::string, std::vector<Errors2>>;

/// Prints a row a placement.
Table print_table(const Scene& scene, std::span<const std::string> names) {
    Table table;
    fmt::print("{:<90}", "along / across, at m");
    for (const double distance : distances) {
        fmt::print("{:>15}", distance);
    }
    for (const std::string& name : names) {
        const LightViews views = placed(scene, name);
        fmt::print("\n{:<90}", name);
        for (const double distance : distances) {
            const Errors2 error = pixels_per_texel(scene, views, distance);
            table[name].push_back(error);
            fmt::print("{:>15}", fmt::format("{:.2f} / {:.2f}", error.along, error.across));
        }
    }
    fmt::print("\n");
    return table;
}

std::string cascades_of(int count, const char* fit) {
    return fmt::format("cascades,cascades.split=log,cascades.transition=none,cascades.count={},cascades.fit={}", count,
                       fit);
}

TEST(TexelsAlongTheView, OfTheCorridor) {
    Table table = print_table(lit_corridor(true), placements);

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

/// C section 3.2.3: more slices lower the error everywhere but where a slice ends, warping each lowers its worst, and neither
/// slices nor fits without a warp care where the light is.
TEST(TexelsAlongTheView, OfTheCorridorsCascades) {
    const Scene scene = lit_corridor(true);
    std::vector<std::string> names;
    for (const char* fit : {"fitted", "warped"}) {
        for (int count = 1; count <= 4; ++count) {
            names.push_back(cascades_of(count, fit));
        }
    }
    names.emplace_back("cascades,cascades.transition=none");
    const Table table = print_table(scene, names);
    const auto worst = [&](const std::string& name) {
        double most = 0;
        for (const double distance : dense_distances()) {
            most = std::max(most, pixels_per_texel(scene, placed(scene, name), distance).along);
        }
        return most;
    };
    for (int count = 1; count < 4; ++count) {
        EXPECT_LT(worst(cascades_of(count + 1, "fitted")), 0.6 * worst(cascades_of(count, "fitted"))) << count;
        EXPECT_LT(worst(cascades_of(count, "warped")), 0.5 * worst(cascades_of(count, "fitted"))) << count;
    }

    // Across the view only the far end of a slice counts: at a slice's near end the error is its ratio, at its far end one.
    for (const Errors2& error : table.at(cascades_of(4, "fitted"))) {
        EXPECT_LT(error.across, 1.05 * table.at(cascades_of(1, "fitted")).front().across);
    }
}

/// C fig. 3.13: under a light overhead one warped map needs far less than one that is not, and the lead shrinks with every
/// slice; a light from behind leaves nothing to warp, and slices help as much as ever.
TEST(TexelsAlongTheView, StorageFallsWithSlicesAndWarping) {
    for (const bool overhead : {true, false}) {
        const Scene scene = lit_corridor(overhead);
        std::array<std::vector<double>, 2> needed;
        for (int warped = 0; warped < 2; ++warped) {
            fmt::print("storage, {} {:<7}", overhead ? "overhead" : "behind  ", warped != 0 ? "warped" : "fitted");
            for (int count = 1; count <= 8; ++count) {
                const char* fit = warped != 0 ? "warped" : "fitted";
                needed[static_cast<std::size_t>(warped)].push_back(
                    storage(scene, placed(scene, cascades_of(count, fit))));
                fmt::print("{:>10.2f}", needed[static_cast<std::size_t>(warped)].back());
            }
            fmt::print("\n");
        }
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_LT(needed[0][i + 1], needed[0][i]) << overhead << " maps " << i + 1;
            if (overhead) {
                EXPECT_LT(needed[1][i], needed[0][i]) << i;
            } else {
                EXPECT_NEAR(needed[1][i], needed[0][i], 0.01 * needed[0][i]) << i;
            }
        }
        if (overhead) {
            EXPECT_GT(needed[0][0] / needed[1][0], 2 * needed[0][3] / needed[1][3]);
        }
    }
}

nlohmann::ordered_json axis(const char* label, bool log) {
    return {{"label", label}, {"log", log}};
}

/// A curve of texels along the view for every named placement.
nlohmann::ordered_json panel_of(const char* title, const Scene& scene,
                                const std::vector<std::pair<std::string, std::string>>& placements_by_name) {
    const std::vector<double> x = dense_distances();
    nlohmann::ordered_json series = nlohmann::ordered_json::array();
    for (const auto& [name, placement] : placements_by_name) {
        const LightViews views = placed(scene, placement);
        std::vector<double> y;
        for (const double distance : x) {
            y.push_back(pixels_per_texel(scene, views, distance).along);
        }
        const bool dashed = placement.find("warped") != std::string::npos;
        series.push_back({{"name", name}, {"x", x}, {"y", y}, {"dashed", dashed}});
    }
    return {{"title", title},
            {"x", axis("distance, m", true)},
            {"y", axis("pixels per texel along the view", true)},
            {"series", series}};
}

TEST(TexelsAlongTheView, WritesItsCurves) {
    const char* file = std::getenv("GNOMON_CURVES");
    if (file == nullptr) {
        GTEST_SKIP() << "GNOMON_CURVES names no file";
    }
    const Scene scene = lit_corridor(true);
    std::vector<std::pair<std::string, std::string>> cascades;
    for (const int count : {1, 2, 4}) {
        cascades.emplace_back(fmt::format("{}, fitted", count), cascades_of(count, "fitted"));
        cascades.emplace_back(fmt::format("{}, warped", count), cascades_of(count, "warped"));
    }
    cascades.emplace_back("4, default", "cascades,cascades.transition=none");
    nlohmann::ordered_json sums = nlohmann::ordered_json::array();
    for (const bool overhead : {true, false}) {
        for (const char* fit : {"fitted", "warped"}) {
            std::vector<double> y;
            for (int count = 1; count <= 8; ++count) {
                const Scene lit = lit_corridor(overhead);
                y.push_back(storage(lit, placed(lit, cascades_of(count, fit))));
            }
            sums.push_back({{"name", fmt::format("{}, {}", overhead ? "overhead" : "from behind", fit)},
                            {"x", {1, 2, 3, 4, 5, 6, 7, 8}},
                            {"y", y},
                            {"dashed", std::string_view(fit) == "warped"}});
        }
    }
    const nlohmann::ordered_json curves{
        {"command", "GNOMON_CURVES=docs/curves/texels.json part_tests --gtest_filter=TexelsAlongTheView.*"},
        {"panels",
         {panel_of("One map, 1024 texels, light overhead", scene,
                   {{"single", "single"},
                    {"fit", "fit"},
                    {"psm", "psm,psm.back=0"},
                    {"tsm", "tsm"},
                    {"lispsm", "lispsm"},
                    {"lispsm, near=0.0044", "lispsm,lispsm.near=0.0044"}}),
          panel_of("Logarithmic cascades of 1024 texels each", scene, cascades),
          {{"title", "Storage: texels needed per pixel"},
           {"x", axis("maps", false)},
           {"y", axis("storage factor", true)},
           {"series", sums}}}}};
    std::ofstream(file) << curves.dump(1) << "\n";
}

}  // namespace
}  // namespace gn::texels_test
