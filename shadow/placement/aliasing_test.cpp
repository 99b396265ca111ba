// SPDX-License-Identifier: MIT
// C fig. 3.7 and 3.13 measured: perspective aliasing of every placement along the view, against its closed form, and the texels that
// whole frusta need. For docs/placement.md:
//
//     build/part_tests --gtest_filter=PerspectiveAliasing.* prints what is measured, and writes the curves to the file that the
//     environment variable GNOMON_CURVES names: docs/curves/aliasing.json, which tools/draw_curves draws.
#include "shadow/placement/cascades/cascades.glsl"
#include "shadow/placement/faces/faces.glsl"
#include "shadow/show/show.h"
#include "tests/direct_scenes.h"
#include "tests/warp_scene.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>

namespace gn::aliasing_test {
namespace {

constexpr double near = 1;
constexpr double far = 1000;
constexpr double length = far - near;

/// A floor from near to far, wider than what is seen; or a box that holds all of the frustum.
Scene floor_scene() {
    Scene scene = test::long_floor(near, far);
    scene.bounds_ws = Box{vec3(-700, -1e-3F, static_cast<float>(-far)), vec3(700, 0, static_cast<float>(-near))};
    return scene;
}

Scene space_scene(vec3 to_light) {
    Scene scene = test::long_floor(near, far, to_light);
    scene.bounds_ws = Box{vec3(-700, -700, static_cast<float>(-far)), vec3(700, 700, static_cast<float>(-near))};
    scene.cameras[0].position_ws = vec3(0);
    scene.cameras[0].near = static_cast<float>(near);
    scene.cameras[0].far = static_cast<float>(far);
    return scene;
}

const GnLightView& view_at(const LightViews& views, dvec3 p_ws) {
    if (views.views.size() == 1) {
        return views.views.front();
    }
    glsl::GnReceiver receiver{};
    receiver.p_ws = vec3(p_ws);
    receiver.view_depth = static_cast<float>(-p_ws.z);
    const int first = views.part->id == "faces"
                          ? glsl::gn_frustum_face(receiver.p_ws, views.data_as<GnFrustumFaces>())
                          : glsl::gn_cascades_choose(receiver, views.data_as<GnCascadesData>()).first;
    return views.views[static_cast<std::size_t>(first)];
}

LightViews placed(const Scene& scene, const std::string& placement) {
    return test::place(scene, fmt::format("hard,resolution=16384,placement={}", placement));
}

/// dp/ds of C eq. 3.1 along the view on the floor, or across it.
double error_at(const LightViews& views, double z, bool along) {
    const dvec3 p_ws(0, 0, -z);
    return test::error_along(view_at(views, p_ws), p_ws, along ? dvec3(0, 0, 1) : dvec3(1, 0, 0), z);
}

struct Curve {
    std::string name, placement;
    double (*closed)(double z);  ///< SPECS of dp/ds; null where there is none
};

double even(double z) {
    const double n = near + std::sqrt(far * near);
    return (n + z - near) * (n + z - near) * length / (n * (n + length) * z);
}

const std::vector<Curve>& curves() {
    static const std::vector<Curve> all{
        {"fit", "fit", [](double z) { return length / z; }},
        {"psm", "psm,psm.back=0", [](double z) { return length * z / (near * far); }},
        {"tsm", "tsm,tsm.near=0", nullptr},
        {"lispsm", "lispsm,lispsm.near=0", even},
        {"logpsm", "logpsm,logpsm.near=0", [](double) { return std::log(far / near); }},
        {"faces", "faces,faces.near=0", even},
    };
    return all;
}

std::vector<double> distances() {
    std::vector<double> z;
    for (int i = 0; i < 40; ++i) {
        z.push_back(1.002 * near * std::pow(0.997 * far / near, i / 39.0));
    }
    return z;
}

/// C fig. 3.7: each curve is its closed form, and the ends of the even one are 8.41 times its minimum.
TEST(PerspectiveAliasing, AlongTheViewIsTheClosedForm) {
    const Scene scene = floor_scene();
    for (const Curve& curve : curves()) {
        const LightViews views = placed(scene, curve.placement);
        double worst = 0;
        double least = 1e300;
        for (const double z : distances()) {
            const double measured = error_at(views, z, true);
            worst = std::max(worst, measured);
            least = std::min(least, measured);
            // A map's texels end within its border's two texels, and the strongest warp keeps its kernel before the horizon.
            const double slack = curve.name == "psm" ? 0.1 : 0.03;
            if (curve.closed != nullptr) {
                EXPECT_NEAR(measured, curve.closed(z), slack * curve.closed(z)) << curve.name << " at " << z;
            }
        }
        fmt::print("{:<8} worst {:8.2f}  least {:8.2f}\n", curve.name, worst, least);
        if (curve.closed == even) {
            EXPECT_NEAR(worst / least, 8.41, 0.3) << curve.name;
        }
    }
}

/// dp/ds of tiles that follow the samples of a picture, with a texel of memory for every pixel of a square of one radian. Their texels
/// are square, and a pixel covers least across the view, so that m of eq. 3.2 is dp/ds along and across.
struct TilesAlong {
    std::vector<double> z, error;
};

const TilesAlong& tiles_along() {
    static const TilesAlong measured = [] {
        constexpr double high = 0.5;
        constexpr uint texels = 512;
        const double tangent = std::tan(0.6);
        const auto side = static_cast<uint>(std::round(2 * tangent * texels));
        constexpr auto half = static_cast<float>(far);
        Scene scene = by_hand::SceneBuilder()
                          .quad({-half, 0, -1}, {half, 0, -1}, {half, 0, -half}, {-half, 0, -half})
                          .light(by_hand::sun({0, -1, 0}))
                          .scene();
        scene.cameras = {{.position_ws = vec3(0, high, 0), .forward_ws = vec3(0, 0, -1), .yfov = 1.2F}};
        SceneGpu gpu = upload_scene(test::device(), scene);
        const std::vector<float> m =
            undersampling(test::device(), gpu, scene.cameras[0],
                          load_recipe(fmt::format("rmsm,adaptive.maps=1,adaptive.density=1,resolution={}", texels)),
                          {.width = side, .height = side});
        TilesAlong along;
        double last = far;
        for (uint row = side / 2; row < side; ++row) {
            const double z = high * side / (tangent * (2 * row + 1 - static_cast<double>(side)));
            const double error = static_cast<double>(m[static_cast<std::size_t>(row) * side + side / 2]);
            if (z >= near && z < 0.85 * last && error > 0) {
                along.z.push_back(z);
                along.error.push_back(error);
                last = z;
            }
        }
        return along;
    }();
    return measured;
}

/// Tiles have no closed form. Over the budget all distances get texels that are larger than their pixels, and none by much more
/// than another: the ends of the even curve are 8.41 times its minimum, these lie closer.
TEST(PerspectiveAliasing, TilesAreFlatterThanTheEvenWarp) {
    const std::vector<double>& error = tiles_along().error;
    const auto [least, worst] = std::minmax_element(error.begin(), error.end());
    fmt::print("rmsm     worst {:8.2f}  least {:8.2f}\n", *worst, *least);
    EXPECT_GT(error.size(), 20U);
    EXPECT_LT(*worst / *least, 8.41);
}

/// At equal texels tiles err less in a picture than cascades that follow the samples: 0.83 of them at 640 x 360 pixels
/// (docs/adaptive.md), 0.93 here. Fewer pixels than these ask for less than the budget, all of which cascades spend.
TEST(PerspectiveAliasing, TilesErrNoMoreThanCascadesOfAsManyTexels) {
    const auto rmse = [](const char* recipe) {
        return *test::compare("corridor", recipe, {.width = 240, .height = 135, .samples = 1}).errors.rmse;
    };
    EXPECT_LT(rmse("rmsm"), rmse("sdsm"));
}

/// Texels of all maps that the whole frustum needs over the picture's pixels so that nowhere a texel is wider or longer than a
/// pixel: of every map its worst width times its worst length. Pseudo-random points, the corners of the frustum among them.
double storage(const Scene& scene, const LightViews& views) {
    std::map<const GnLightView*, dvec2> worst;
    const double tangent = std::tan(0.5 * static_cast<double>(scene.cameras[0].yfov));
    for (int i = 0; i < 60; ++i) {
        const double z = 1.001 * near * std::pow(0.998 * far / near, i / 59.0);
        for (int j = 0; j < 25; ++j) {
            const dvec3 p_ws(0.499 * (j % 5 - 2) * tangent * z, 0.499 * (j / 5 - 2) * tangent * z, -z);
            const GnLightView& view = view_at(views, p_ws);
            vec3 du_ws;
            vec3 dv_ws;
            glsl::gn_uv_gradients(view, vec3(p_ws), du_ws, dv_ws);
            const dvec2 texel = 1.0 / dvec2(glm::length(dvec3(du_ws)), glm::length(dvec3(dv_ws)));
            dvec2& of_map = worst[&view];
            of_map = glm::max(of_map, texel / (2 * tangent * z));
        }
    }
    double sum = 0;
    for (const auto& [view, error] : worst) {
        sum += error.x * error.y;
    }
    return sum;
}

std::string cascades_of(int count, const char* fit) {
    return fmt::format("cascades,cascades.split=log,cascades.transition=none,cascades.count={},cascades.fit={}", count,
                       fit);
}

struct Scheme {
    std::string name;
    std::vector<double> maps, needed;
};

std::vector<Scheme> schemes(bool overhead) {
    const Scene scene = space_scene(overhead ? vec3(0, 1, 0) : vec3(0, 0, 1));
    std::vector<Scheme> all;
    for (const char* fit : {"fitted", "warped"}) {
        Scheme scheme{std::string("ZP ") + fit, {}, {}};
        for (int count = 1; count <= 8; ++count) {
            scheme.maps.push_back(count);
            scheme.needed.push_back(storage(scene, placed(scene, cascades_of(count, fit))));
        }
        all.push_back(scheme);
    }
    for (const auto& [name, placement] : {std::pair{"FP uniform", "faces,faces.near=0,faces.warp=none"},
                                          {"FP warped", "faces,faces.near=0"},
                                          {"lispsm", "lispsm,lispsm.near=0"},
                                          {"logpsm", "logpsm,logpsm.near=0"}}) {
        const LightViews views = placed(scene, placement);
        all.push_back({name, {static_cast<double>(views.layers)}, {storage(scene, views)}});
    }
    for (const Scheme& scheme : all) {
        fmt::print("{} {:<11}", overhead ? "overhead" : "behind  ", scheme.name);
        for (std::size_t i = 0; i < scheme.maps.size(); ++i) {
            fmt::print(" {}: {:.3g}", scheme.maps[i], scheme.needed[i]);
        }
        fmt::print("\n");
    }
    return all;
}

/// C fig. 3.13: one warp is worth most for one map under a light overhead; with the light behind nothing but partitions helps,
/// warped faces far more than uniform ones, and slices more than faces for as many maps.
TEST(PerspectiveAliasing, StorageIsOrderedAsInTheLiterature) {
    const auto needed = [](const std::vector<Scheme>& all, std::string_view name, std::size_t i = 0) {
        return std::find_if(all.begin(), all.end(), [&](const Scheme& s) { return s.name == name; })->needed.at(i);
    };
    const std::vector<Scheme> overhead = schemes(true);
    EXPECT_LT(needed(overhead, "lispsm"), 0.05 * needed(overhead, "ZP fitted"));
    EXPECT_LT(needed(overhead, "logpsm"), 0.2 * needed(overhead, "lispsm"));
    EXPECT_LT(needed(overhead, "FP warped"), 0.05 * needed(overhead, "FP uniform"));

    const std::vector<Scheme> behind = schemes(false);
    EXPECT_NEAR(needed(behind, "lispsm"), needed(behind, "ZP fitted"), 0.02 * needed(behind, "ZP fitted"));
    EXPECT_NEAR(needed(behind, "logpsm"), needed(behind, "ZP fitted"), 0.02 * needed(behind, "ZP fitted"));
    EXPECT_LT(needed(behind, "FP warped"), 0.05 * needed(behind, "FP uniform"));
    EXPECT_LT(needed(behind, "ZP fitted", 4), needed(behind, "FP warped"));
}

nlohmann::ordered_json axis(const char* label, bool log) {
    return {{"label", label}, {"log", log}};
}

nlohmann::ordered_json panel_of(const char* title, bool along) {
    const Scene scene = floor_scene();
    nlohmann::ordered_json series = nlohmann::ordered_json::array();
    for (const Curve& curve : curves()) {
        const LightViews views = placed(scene, curve.placement);
        std::vector<double> y;
        std::vector<double> closed;
        for (const double z : distances()) {
            y.push_back(error_at(views, z, along));
            closed.push_back(curve.closed != nullptr && along ? curve.closed(z) : 0);
        }
        series.push_back({{"name", curve.name}, {"x", distances()}, {"y", y}, {"dashed", false}});
        if (curve.closed != nullptr && along && curve.name != "faces") {
            series.push_back(
                {{"name", curve.name + ", closed form"}, {"x", distances()}, {"y", closed}, {"dashed", true}});
        }
    }
    series.push_back({{"name", "rmsm"}, {"x", tiles_along().z}, {"y", tiles_along().error}, {"dashed", false}});
    return {{"title", title},
            {"x", axis("distance over the near plane's", true)},
            {"y", axis(along ? "dp/ds along the view" : "dp/ds across the view", true)},
            {"series", series}};
}

nlohmann::ordered_json storage_panel(const char* title, bool overhead) {
    nlohmann::ordered_json series = nlohmann::ordered_json::array();
    for (const Scheme& scheme : schemes(overhead)) {
        series.push_back({{"name", scheme.name},
                          {"x", scheme.maps},
                          {"y", scheme.needed},
                          {"dashed", scheme.name.find("warped") != std::string::npos}});
    }
    return {{"title", title}, {"x", axis("maps", false)}, {"y", axis("storage factor", true)}, {"series", series}};
}

TEST(PerspectiveAliasing, WritesItsCurves) {
    const char* file = std::getenv("GNOMON_CURVES");
    if (file == nullptr) {
        GTEST_SKIP() << "GNOMON_CURVES names no file";
    }
    const nlohmann::ordered_json all{
        {"command", "GNOMON_CURVES=docs/curves/aliasing.json part_tests --gtest_filter=PerspectiveAliasing.*"},
        {"panels",
         {panel_of("Light overhead, 1 to 1000", true), panel_of("The same across the view", false),
          storage_panel("All maps, light overhead", true), storage_panel("All maps, light behind", false)}}};
    std::ofstream(file) << all.dump(1) << "\n";
}

}  // namespace
}  // namespace gn::aliasing_test
