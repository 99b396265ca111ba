// SPDX-License-Identifier: MIT
#include "tests/performance/bench.h"

#include "shadow/frame/history.h"

#include <algorithm>
#include <cstdio>

namespace gn::performance {
namespace {

constexpr double never = 1e300;

bool named(const std::vector<std::string>& names, const PassTime& pass) {
    return names.empty() ? pass.group == "shadow" : std::find(names.begin(), names.end(), pass.name) != names.end();
}

}  // namespace

Bench::Bench() : device_(Device::create()) {}

SceneGpu& Bench::scene(const std::string& name) {
    std::unique_ptr<Kept>& kept = scenes_[name];
    if (kept == nullptr) {
        kept = std::make_unique<Kept>();
        kept->scene = load_scene(name);
        kept->gpu = upload_scene(*device_, kept->scene);
    }
    return kept->gpu;
}

void Bench::print_head() const {
    std::printf("Device: %s (%s)\n", device_->info().name.c_str(), device_->info().driver.c_str());
}

namespace {

/// The least sum over a frame's timed runs.
double least_of(const FrameResult& frame, const std::vector<std::string>& names) {
    double least = never;
    for (std::size_t run = 0; run < frame.pass_ms.front().size(); ++run) {
        double ms = 0;
        for (std::size_t pass = 0; pass < frame.statistics.passes.size(); ++pass) {
            ms += named(names, frame.statistics.passes[pass]) ? frame.pass_ms[pass][run] : 0;
        }
        least = std::min(least, ms);
    }
    return least;
}

FrameOptions timed_options(const Bench& bench, int light) {
    return {.width = bench.size().x,
            .height = bench.size().y,
            .repeat = bench.repeats(),
            .only_light = light,
            .picture = false};
}

}  // namespace

Timed passes(Bench& bench, std::string scene, Recipe recipe, std::vector<std::string> names, int light) {
    return [&bench, scene = std::move(scene), recipe = std::move(recipe), names = std::move(names), light] {
        SceneGpu& gpu = bench.scene(scene);
        return least_of(render_frame(bench.device(), gpu, gpu.scene->cameras[0], recipe, timed_options(bench, light)),
                        names);
    };
}

Timed still_passes(Bench& bench, std::string scene, Recipe recipe, int light) {
    return [&bench, scene = std::move(scene), recipe = std::move(recipe), light] {
        SceneGpu& gpu = bench.scene(scene);
        History history(bench.device());
        FrameOptions options = timed_options(bench, light);
        options.history = &history;
        static_cast<void>(render_frame(bench.device(), gpu, gpu.scene->cameras[0], recipe, options));
        return least_of(render_frame(bench.device(), gpu, gpu.scene->cameras[0], recipe, options), {});
    };
}

Timed graph_passes(Bench& bench, std::function<void(FrameGraph&)> build, std::vector<std::string> names) {
    return [&bench, build = std::move(build), names = std::move(names)] {
        FrameGraph graph(bench.device());
        build(graph);
        graph.execute(false);
        double least = never;
        for (int run = 0; run < bench.repeats(); ++run) {
            graph.execute(true);
            double ms = 0;
            for (const PassTime& pass : graph.statistics().passes) {
                ms += named(names, pass) ? pass.ms : 0;
            }
            least = std::min(least, ms);
        }
        return least;
    };
}

void print_title(const char* title) {
    std::printf("\n| %s | ratio |\n| --- | ---: |\n", title);
}

void print_ratio(const std::string& what, const Timed& a, const Timed& b, double copies) {
    double least_a = never;
    double least_b = never;
    for (int round = 0; round < rounds; ++round) {
        least_a = std::min(least_a, a());
        least_b = std::min(least_b, b());
    }
    std::printf("| %s | %.2f |\n", what.c_str(), least_a / (copies * least_b));
    std::fflush(stdout);
}

void print_over_added(const std::string& what, const Timed& ours, const Timed& with, const Timed& without) {
    double least = never;
    double least_with = never;
    double least_without = never;
    for (int round = 0; round < rounds; ++round) {
        least = std::min(least, ours());
        least_with = std::min(least_with, with());
        least_without = std::min(least_without, without());
    }
    // What a shadow adds to a pass is noise where it is a hundredth of it.
    const double added = least_with - least_without;
    const std::string ratio = added > 0.01 * least_with ? fmt::format("{:.2f}", least / added) : "within noise";
    std::printf("| %s (%.3f ms over %.3f - %.3f) | %s |\n", what.c_str(), least, least_with, least_without,
                ratio.c_str());
    std::fflush(stdout);
}

}  // namespace gn::performance
