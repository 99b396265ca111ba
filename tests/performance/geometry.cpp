// SPDX-License-Identifier: MIT
// What shadows from geometry cost over a map of 1024 x 1024, and over shadow volumes, as scenes grow in objects and in triangles.
#include "tests/performance/bench.h"

#include <algorithm>
#include <cstdio>

namespace gn::performance {
namespace {

constexpr uint width = 480, height = 270;
constexpr double long_ms = 1000;  ///< what takes longer is timed once,
constexpr int turns = 2;          ///< all else so often: twenty methods in turn take long

constexpr std::array methods{"hard,resolution=1024",
                             "volumes",
                             "volumes,volumes.mode=z-fail",
                             "split-volumes",
                             "hybrid-volumes",
                             "irregular-z",
                             "planar",
                             "planar-soft",
                             "plateaus",
                             "blob",
                             "projective-texture",
                             "soft-volumes",
                             "soft-volumes-split",
                             "wedges",
                             "single-sample",
                             "smoothies",
                             "penumbra-maps",
                             "soft-irregular",
                             "depth-complexity",
                             "view-samples"};

/// The least time of the passes of a light's shadow; the first run of each recipe makes what later ones keep. V is read back: of
/// what nobody reads no pass runs.
double shadow_ms(Bench& bench, const std::string& scene, const Recipe& recipe) {
    SceneGpu& gpu = bench.scene(scene);
    const FrameResult frame = render_frame(
        bench.device(), gpu, gpu.scene->cameras[0], recipe,
        {.width = width, .height = height, .repeat = 1, .only_light = 0, .samples = false, .picture = false});
    if (!frame.refused.front().empty()) {
        fail("{} with {}: {}", scene, recipe.name, frame.refused.front());
    }
    return frame.shadow_ms.front();
}

}  // namespace

void geometry(Bench& bench) {
    std::vector<std::array<double, methods.size()>> columns;
    std::printf("\n| over `hard` at 1024 x 1024, over `volumes`; `grid` with objects x triangles, %u x %u |", width,
                height);
    for (const int triangles : {100, 1600}) {
        for (const int objects : {1, 10, 50, 200}) {
            const std::string scene = fmt::format("grid:objects={},triangles={}", objects, triangles);
            std::printf(" %d x %d |", objects, triangles);
            std::array<double, methods.size()>& least = columns.emplace_back();
            least.fill(1e300);
            for (int round = 0; round < turns; ++round) {
                for (std::size_t i = 0; i < methods.size(); ++i) {
                    if (round == 0 || least[i] < long_ms) {
                        least[i] = std::min(least[i], shadow_ms(bench, scene, load_recipe(methods.at(i))));
                    }
                }
            }
            std::fflush(stdout);
            std::fprintf(stderr, "%s, ms:", scene.c_str());
            for (const double ms : least) {
                std::fprintf(stderr, " %.2f", ms);
            }
            std::fprintf(stderr, "\n");
        }
    }
    std::printf("\n| --- |");
    for (std::size_t i = 0; i < columns.size(); ++i) {
        std::printf(" ---: |");
    }
    for (std::size_t i = 0; i < methods.size(); ++i) {
        std::printf("\n| %s |", methods.at(i));
        for (const auto& ms : columns) {
            std::printf(" %.2f, %.2f |", ms[i] / ms[0], ms[i] / ms[1]);
        }
    }
    std::printf("\n| ms of `hard` |");
    for (const auto& ms : columns) {
        std::printf(" %.1f |", ms[0]);
    }
    std::printf("\n");
}

}  // namespace gn::performance
