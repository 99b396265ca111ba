// SPDX-License-Identifier: MIT
#include "apps/compare/path.h"

#include "shadow/frame/history.h"
#include "shadow/metrics/few.h"
#include "shadow/metrics/flicker.h"

#include <cmath>

namespace gn {
namespace {

/// T - R over samples of several frames or lights; edges of R count as any sample does.
struct Squares {
    std::size_t samples = 0;
    double sum = 0;
    void add(const Squares& more) {
        samples += more.samples;
        sum += more.sum;
    }
    [[nodiscard]] std::optional<double> root_mean() const {
        return samples == 0 ? std::nullopt : std::optional(std::sqrt(sum / static_cast<double>(samples)));
    }
};

Squares squares_of(const SignedError& error, const std::vector<std::uint8_t>& counted) {
    Squares found;
    for (std::size_t i = 0; i < counted.size(); ++i) {
        if (counted[i] != 0) {
            found.sum += static_cast<double>(error.values[i]) * static_cast<double>(error.values[i]);
            ++found.samples;
        }
    }
    return found;
}

/// What the next frame is held against.
struct PathFrame {
    CpuSamples samples;
    std::vector<std::optional<SignedError>> errors;  ///< one a light; absent where the recipe did not serve it
    std::vector<Squares> squares;                    ///< one a light
    [[nodiscard]] PathView view() const {
        const Camera& camera = samples.camera;
        const float aspect = static_cast<float>(samples.width) / static_cast<float>(samples.height);
        return {static_cast<int>(samples.width),
                static_cast<int>(samples.height),
                cs_from_vs(camera, aspect) * vs_from_ws(camera),
                static_cast<float>(2 * half_height_at(camera, 1) / samples.height),
                samples.normal_ws,
                samples.position_ws};
    }
};

PathFrame draw(ViewSession& view, Bench& bench, const PreparedRecipe& recipe, std::size_t index, const RunResult& run,
               History& history) {
    FrameOptions options;
    options.width = static_cast<uint>(run.width);
    options.height = static_cast<uint>(run.height);
    options.repeat = 0;
    options.only_light = view.only_light();
    options.picture = false;
    options.history = &history;
    FrameResult frame = render_frame(view.gpu(bench), view.path()->frames[index], recipe, options);
    PathFrame kept{std::move(frame.samples), {}, {}};
    for (std::size_t l = 0; l < frame.visibility.size(); ++l) {
        kept.errors.emplace_back();
        kept.squares.emplace_back();
        // The truth along a path knows no colours.
        if (view.wanted(l) && frame.refused[l].empty() && frame.visibility[l].channels == 1) {
            const PathTruth& truth = view.path_truth(index, l);
            kept.errors.back() =
                signed_error(frame.visibility[l].values, truth.visibility, truth.counted, run.width, run.height);
            kept.squares.back() = squares_of(*kept.errors.back(), truth.counted);
        }
    }
    return kept;
}

/// What the frame drew of each light's map, where its placement chooses.
void add_chosen_texels(RunResult& run, const ViewSession& view, const History& history) {
    std::size_t at = 0;
    for (std::size_t l = 0; l < view.scene().lights.size(); ++l) {
        if (view.wanted(l)) {
            LightResult& light = run.lights[at++];
            if (const ivec2* texels = history.before<ivec2>(chosen_texels(l))) {
                light.path_texels.push_back(*texels);
            }
        }
    }
}

}  // namespace

void measure_path(RunResult& run, ViewSession& view, Bench& bench, const PreparedRecipe& recipe) {
    const std::size_t frames = view.path()->frames.size();
    std::vector<Flicker> of_light(view.scene().lights.size());
    std::vector<Squares> squares(of_light.size());
    History history(bench.device());
    PathFrame before;
    for (std::size_t k = 0; k < frames; ++k) {
        PathFrame frame = draw(view, bench, recipe, k, run, history);
        for (std::size_t l = 0; l < squares.size(); ++l) {
            squares[l].add(frame.squares[l]);
        }
        if (k > 0) {
            const std::vector<int> same = same_points(before.view(), frame.view());
            Flicker step;
            for (std::size_t l = 0; l < of_light.size(); ++l) {
                if (before.errors[l] && frame.errors[l]) {
                    const Flicker found = flicker_between(*before.errors[l], *frame.errors[l], same);
                    of_light[l] += found;
                    step += found;
                }
            }
            run.path_flicker.push_back(step.root_mean_square());
        }
        before = std::move(frame);
        add_chosen_texels(run, view, history);
    }

    // All lights pooled as one list of samples.
    Flicker all;
    Squares all_squares;
    std::size_t at = 0;
    for (std::size_t l = 0; l < of_light.size(); ++l) {
        if (view.wanted(l)) {
            Errors& errors = run.lights[at++].errors;
            errors.flicker = of_light[l].root_mean_square();
            errors.path_rmse = squares[l].root_mean();
            if (std::string remark = few_changes(of_light[l], view.scene().lights[l].name); !remark.empty()) {
                run.remarks.push_back(std::move(remark));
            }
            all += of_light[l];
            all_squares.add(squares[l]);
        }
    }
    run.errors.flicker = all.root_mean_square();
    run.errors.path_rmse = all_squares.root_mean();
    run.path = view.path()->name;
}

}  // namespace gn
