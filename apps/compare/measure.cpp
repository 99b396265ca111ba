// SPDX-License-Identifier: MIT
#include "apps/compare/measure.h"

#include "apps/compare/path.h"
#include "apps/compare/pictures.h"
#include "apps/notes.h"
#include "apps/output.h"
#include "apps/reach.h"
#include "shadow/metrics/few.h"
#include "shadow/recipe/recipe_set.h"
#include "shadow/shading/illuminance.h"
#include "shadow/shading/tonemap.h"
#include "shadow/show/show.h"

#include <algorithm>
#include <cmath>

namespace gn {
namespace {

/// Parameters of all parts that take part, as `gnomon show` names them.
void add_parameters(RunResult& run, const Recipe& recipe) {
    for (const Part* part : recipe.parts()) {
        for (const ParamRow& row : part->params.rows) {
            run.parameters.emplace_back(fmt::format("{}.{}", part->id, row.name), recipe.block(*part).get(row.name));
        }
    }
    if (recipe.map == nullptr) {
        return;
    }
    // Resolution, casters and bias belong to every map.
    run.parameters.emplace_back("placement", recipe.placement_name());
    run.parameters.emplace_back("resolution", fmt::format("{}", recipe.resolution));
    run.parameters.emplace_back("casters", name_of(recipe.casters));
    const ParamTable bias = bias_table(recipe.bias);
    for (const ParamRow& row : bias.rows) {
        run.parameters.emplace_back(fmt::format("bias.{}", row.name), ParamBlock(bias).get(row.name));
    }
}

std::string command_for(const std::string& scene, const std::string& recipe, const CompareOptions& options) {
    std::string command =
        fmt::format("gnomon compare {} -r {} --size {}x{} --samples {} --repeat {}", shell_word(scene),
                    shell_word(recipe), options.size.width, options.size.height, options.samples, options.repeat);
    command += options.file.ground.height       ? fmt::format(" --ground {}", *options.file.ground.height)
               : !options.file.ground.automatic ? " --ground none"
                                                : "";
    command += options.file.up == UpAxis::y ? "" : " --up z";
    for (const std::string& folder : options.file.assets) {
        command += " --assets " + shell_word(folder);
    }
    command += options.view.empty() ? "" : " --view " + shell_word(options.view);
    command += options.light.empty() ? "" : " --light " + shell_word(options.light);
    command += options.shaded ? " --reference shaded" : "";
    command += options.against.empty() ? "" : " --against " + shell_word(options.against);
    command += !options.follow_path ? "" : options.path.empty() ? " --path" : " --path " + shell_word(options.path);
    return command + (options.validate ? " --validate" : "") + " -o report";
}

/// Signed errors of one light, and at every pixel the largest so far.
struct SignedErrors {
    std::vector<float> largest;
    std::vector<std::uint8_t> counted;

    std::vector<float> add(const Image& technique, const TruthResult& truth) {
        std::vector<float> errors(truth.counted.size());
        largest.resize(errors.size());
        counted.resize(errors.size());
        for (std::size_t p = 0; p < errors.size(); ++p) {
            if (truth.counted[p] == 0) {
                continue;
            }
            // Of several channels the one that is farthest off.
            const auto channels = static_cast<std::size_t>(truth.channels);
            for (std::size_t k = channels * p; k < channels * (p + 1); ++k) {
                const float error = technique.values[k] - truth.visibility[k];
                errors[p] = std::abs(error) > std::abs(errors[p]) ? error : errors[p];
            }
            counted[p] = 1;
            largest[p] = std::abs(errors[p]) > std::abs(largest[p]) ? errors[p] : largest[p];
        }
        return errors;
    }
};

struct PictureNames {
    std::filesystem::path folder;
    std::string stem;  ///< "pictures/courtyard-pcf-0a1b2c3d"

    std::string write(const std::string& what, const Image& image) const {
        if (folder.empty()) {
            return {};
        }
        std::string name = fmt::format("{}-{}.png", stem, what);
        write_png(folder / name, image);
        return name;
    }
};

HiddenOptions hidden_options(const Image& technique, std::size_t light) {
    HiddenOptions options;
    options.width = static_cast<uint>(technique.width);
    options.height = static_cast<uint>(technique.height);
    options.light = light;
    return options;
}

/// Pixels under a texel, of the counted samples that the map holds; nothing without a map.
std::vector<float> counted_texels(ViewSession& view, Bench& bench, const Recipe& recipe, const Image& technique,
                                  std::size_t light, const TruthResult& truth) {
    const std::vector<float> all =
        undersampling(bench.device(), view.gpu(bench), view.camera(), recipe, hidden_options(technique, light));
    std::vector<float> counted;
    for (std::size_t p = 0; p < all.size(); ++p) {
        if (truth.counted[p] != 0 && all[p] >= 0) {
            counted.push_back(all[p]);
        }
    }
    return counted;
}

/// Which lit but darkened samples lie beside a shadow, within the kernel's reach; nothing where no map is looked up.
std::vector<std::uint8_t> explained_acne(ViewSession& view, Bench& bench, const Recipe& recipe, const Image& technique,
                                         std::size_t light, const TruthResult& truth) {
    const std::vector<KernelRegion> regions =
        kernel_regions(bench.device(), view.gpu(bench), view.camera(), recipe, hidden_options(technique, light));
    const auto channels = static_cast<std::size_t>(truth.channels);
    std::vector<Surroundings> around(regions.size());
    for (std::size_t k = 0; k < channels * around.size(); ++k) {
        if (truth.visibility[k] >= 1 && technique.values[k] < 1) {
            around[k / channels] = {regions[k / channels].a_ws, regions[k / channels].b_ws};
        }
    }
    return around.empty() ? std::vector<std::uint8_t>{} : view.beside_shadow(light, around);
}

/// The errors of one light: of every channel of V as if it were a light, pooled. `explained`: see explained_acne; `other`: what
/// V is held against too, of as many channels, or empty.
Errors errors_of(const Image& image, const CpuSamples& samples, const GnLight& shape, const TruthResult& truth,
                 const std::vector<std::uint8_t>& explained, std::span<const float> other) {
    const std::vector<float> lux = unshadowed_illuminance(samples, shape);
    std::vector<Errors> channels;
    for (int c = 0; c < image.channels; ++c) {
        const std::vector<float> technique = channel_of(image.values, image.channels, c);
        const std::vector<float> traced = channel_of(truth.visibility, truth.channels, c);
        Errors& errors =
            channels.emplace_back(visibility_errors(technique, traced, truth.counted, image.width, image.height));
        weigh_errors(errors, technique, traced, truth.counted, lux);
        if (!explained.empty()) {
            split_acne(errors, technique, traced, truth.counted, explained);
        }
        if (!other.empty()) {
            hold_against(errors, technique, channel_of(other, image.channels, c), truth.counted);
        }
    }
    return channels.size() == 1 ? channels.front() : pool_channels(channels);
}

/// V of the recipe that all are held against, where it served the light with as many channels; else a remark why not.
std::span<const float> other_of(RunResult& run, const FrameResult* against, std::size_t light, const std::string& name,
                                int channels) {
    if (against == nullptr) {
        return {};
    }
    if (!against->refused[light].empty()) {
        run.remarks.push_back(fmt::format("'against' leaves light '{}' out, which the other recipe refused: {}", name,
                                          against->refused[light]));
        return {};
    }
    if (against->visibility[light].channels != channels) {
        run.remarks.push_back(fmt::format("'against' leaves light '{}' out: one recipe's V has colours", name));
        return {};
    }
    return against->visibility[light].values;
}

/// Errors and error map of every light that is asked for; returns which of the scene's lights were served.
std::vector<bool> measure_lights(RunResult& run, ViewSession& view, Bench& bench, const Recipe& recipe,
                                 const FrameResult& frame, const PictureNames& names) {
    const FrameResult* against = view.against(bench);
    SignedErrors combined;
    std::vector<Errors> errors;
    std::vector<float> texels;
    std::vector<bool> served(view.scene().lights.size(), false);
    for (std::size_t l = 0; l < served.size(); ++l) {
        if (!view.wanted(l)) {
            continue;
        }
        LightResult light{view.scene().lights[l].name};
        if (!frame.refused[l].empty()) {
            light.status = Status::refused;
            light.reason = frame.refused[l];
        } else {
            const TruthResult& truth = view.truth(l, frame.visibility[l].channels);
            const Reach reach = reach_of(view.samples(), view.scene().lights[l].shape, truth.visibility);
            light.reason = empty_reason(reach, light.name, view.camera().name);
            light.status = light.reason.empty() ? Status::ok : Status::empty;
            if (const std::string remark = shadow_remark(reach, light.name); !remark.empty()) {
                run.remarks.push_back(remark);
            }
            light.errors = errors_of(frame.visibility[l], view.samples(), view.scene().lights[l].shape, truth,
                                     explained_acne(view, bench, recipe, frame.visibility[l], l, truth),
                                     other_of(run, against, l, light.name, frame.visibility[l].channels));
            for (std::string& remark : few_samples(light.errors, light.name)) {
                run.remarks.push_back(std::move(remark));
            }
            const std::vector<float> m = counted_texels(view, bench, recipe, frame.visibility[l], l, truth);
            judge_texels(light.errors, m);
            texels.insert(texels.end(), m.begin(), m.end());
            errors.push_back(light.errors);
            served[l] = true;
            const std::vector<float> map = combined.add(frame.visibility[l], truth);
            if (view.result.lights.size() > 1) {
                light.error_map =
                    names.write(fmt::format("error-{}", l), error_map(map, truth.counted, run.width, run.height));
            }
        }
        run.lights.push_back(light);
    }
    // Pool the served lights.
    if (!errors.empty()) {
        run.errors = pool(errors);
        judge_texels(run.errors, texels);
        run.error_map = names.write("error", error_map(combined.largest, combined.counted, run.width, run.height));
    }
    return served;
}

/// Both pictures with the same lights shadowed: what was refused stays lit in the technique's and in the reference's.
void measure_pictures(RunResult& run, ViewSession& view, Bench& bench, const FrameResult& frame,
                      const std::vector<bool>& served, const PictureNames& names) {
    const bool all = std::none_of(run.lights.begin(), run.lights.end(),
                                  [](const LightResult& light) { return light.status == Status::refused; });
    const Image technique = tonemap(frame.picture, view.exposure());
    const bool colours = std::any_of(frame.visibility.begin(), frame.visibility.end(),
                                     [](const Image& visibility) { return visibility.channels == 3; });
    const Image reference =
        all && !colours ? view.reference_picture() : view.picture_of(bench, view.reference_visibility(served, colours));
    run.errors.luma_rms = luma_rms(technique, reference);
    run.errors.flip = flip(technique, reference);
    if (view.shaded() && !colours) {
        const Image shaded = view.picture_of(bench, view.shaded_visibility(served));
        run.shaded_luma_rms = luma_rms(technique, shaded);
        run.shaded_flip = flip(technique, shaded);
        names.write("shaded-reference", shaded);
    }
    run.picture = names.write("picture", technique);
}

/// Pictures of what the recipe hides, for the first light that it served.
void show_inside(RunResult& run, ViewSession& view, Bench& bench, const Recipe& recipe, const std::vector<bool>& served,
                 const PictureNames& names) {
    if (names.folder.empty() || recipe.map == nullptr) {
        return;
    }
    HiddenOptions options;
    options.width = static_cast<uint>(run.width);
    options.height = static_cast<uint>(run.height);
    options.light = static_cast<std::size_t>(std::find(served.begin(), served.end(), true) - served.begin());
    std::vector<std::string> asked;
    for (const HiddenPicture& picture : hidden_pictures()) {
        asked.emplace_back(picture.name);
    }
    for (const Shown& shown : show_hidden(bench.device(), view.gpu(bench), view.camera(), recipe, asked, options)) {
        run.inside.push_back({shown.name, view.scene().lights[options.light].name,
                              names.write(shown.name, shown.picture), shown.legend, find_hidden(shown.name).of_view});
    }
}

void account(RunResult& run, const FrameResult& frame) {
    run.shadow = spread_of(frame.shadow_ms);
    run.frame = spread_of(frame.frame_ms);
    for (const PassTime& pass : frame.statistics.passes) {
        run.passes.push_back({pass.name, pass.group, pass.ms});
    }
    for (const ResourceBytes& resource : frame.statistics.resources) {
        if (resource.group == "shadow") {
            run.resources.push_back({resource.name, resource.bytes});
            run.bytes += resource.bytes;
        }
    }
}

/// Settles what the run as a whole is: ok where something was measured for some light.
void judge(RunResult& run) {
    const auto any = [&](Status status) {
        return std::any_of(run.lights.begin(), run.lights.end(), [&](const auto& l) { return l.status == status; });
    };
    run.status = any(Status::ok) ? Status::ok : any(Status::empty) ? Status::empty : Status::refused;
    if (run.status == Status::ok) {
        return;
    }
    // One reason for all, as where the view sees nothing, needs no list of lights.
    std::vector<LightReason> reasons;
    bool same = true;
    for (const LightResult& light : run.lights) {
        reasons.emplace_back(light.name, light.reason);
        same = same && light.reason == run.lights.front().reason;
    }
    run.reason = same && run.status == Status::empty ? run.lights.front().reason : joined_reasons(reasons);
}

/// Frames that take longer than this are timed once: they repeat well, and a recipe may draw 64 maps a light.
constexpr double long_frame_ms = 2'000;

/// The frame, timed as often as its options say, where one timed frame does not already take long.
FrameResult draw_timed(ViewSession& view, Bench& bench, const PreparedRecipe& recipe, FrameOptions options) {
    const int repeat = options.repeat;
    options.repeat = std::min(repeat, 1);
    FrameResult frame = render_frame(view.gpu(bench), view.camera(), recipe, options);
    if (repeat <= 1 || frame.frame_ms.front() > long_frame_ms) {
        return frame;
    }
    options.repeat = repeat;
    return render_frame(view.gpu(bench), view.camera(), recipe, options);
}

}  // namespace

RunResult describe_run(const std::string& scene, const AskedRecipe& asked, const CompareOptions& options) {
    const Recipe& recipe = asked.recipe;
    RunResult run;
    run.scene = scene;
    run.view = options.view;
    run.recipe = recipe.name;
    run.overrides = recipe.overrides;
    run.width = options.size.width;
    run.height = options.size.height;
    run.title = recipe.title;
    run.citation = recipe.citation;
    run.paragraph = recipe.paragraph;
    run.command = command_for(scene, asked.text, options);
    add_parameters(run, recipe);
    return run;
}

RunResult measure(ViewSession& view, Bench& bench, const AskedRecipe& asked, const std::string& run_key,
                  const CompareOptions& options) {
    RunResult run = describe_run(view.result.scene, asked, options);
    run.view = view.camera().name;
    const std::size_t messages_before = bench.device().messages().size();

    // Draw, and time.
    FrameOptions frame_options;
    frame_options.width = static_cast<uint>(run.width);
    frame_options.height = static_cast<uint>(run.height);
    frame_options.repeat = options.repeat;
    frame_options.only_light = view.only_light();
    frame_options.samples = false;
    const PreparedRecipe prepared(bench.device(), asked.recipe);
    const FrameResult frame = draw_timed(view, bench, prepared, frame_options);

    run.remarks = frame.remarks;
    if (static_cast<int>(frame.frame_ms.size()) < options.repeat) {
        run.remarks.push_back(fmt::format("times are those of one frame, not of {}: it takes {:.0f} s", options.repeat,
                                          frame.frame_ms.front() / 1000));
    }

    // Hold every light against the truth, then the pictures.
    const PictureNames names{options.folder, fmt::format("pictures/{}-{}-{}", slug(view.result.name),
                                                         slug(asked.recipe.name), run_key.substr(0, 8))};
    const std::vector<bool> served = measure_lights(run, view, bench, asked.recipe, frame, names);
    judge(run);
    if (run.status == Status::refused) {
        return run;
    }
    measure_pictures(run, view, bench, frame, served, names);
    account(run, frame);
    if (run.status == Status::empty) {
        run.errors = {};
        return run;
    }
    show_inside(run, view, bench, asked.recipe, served, names);
    if (view.path() != nullptr) {
        measure_path(run, view, bench, prepared);
    }

    // What the validation layers say makes every figure doubtful.
    const std::vector<std::string>& messages = bench.device().messages();
    if (messages.size() > messages_before) {
        run.status = Status::failed;
        run.reason = fmt::format("{} validation messages, the first: {}", messages.size() - messages_before,
                                 messages[messages_before]);
    }
    return run;
}

}  // namespace gn
