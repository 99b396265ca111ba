// SPDX-License-Identifier: MIT
// One picture: load, render, tone-map, write.
#include "apps/choose.h"
#include "apps/notes.h"
#include "apps/options.h"
#include "apps/output.h"
#include "apps/reach.h"
#include "apps/terminal.h"
#include "shadow/frame/frame.h"
#include "shadow/metrics/metrics.h"
#include "shadow/recipe/check_recipe.h"
#include "shadow/shading/tonemap.h"
#include "shadow/show/show.h"

#include <algorithm>
#include <array>
#include <filesystem>

namespace gn {
namespace {

void check_extensions(const RenderOptions& options) {
    const std::string picture = std::filesystem::path(options.output).extension().string();
    if (picture != ".png" && picture != ".exr") {
        throw InputError(fmt::format("-o {}: the picture's name must end in .png or .exr", options.output));
    }
    if (!options.visibility.empty() && std::filesystem::path(options.visibility).extension() != ".exr") {
        throw InputError(fmt::format("--visibility {}: the file's name must end in .exr", options.visibility));
    }
    if (options.show.empty() && !options.light.empty()) {
        throw InputError(fmt::format("--light {}: it names the light of --show, which is not given", options.light));
    }
    if (!options.show.empty() && !options.visibility.empty()) {
        throw InputError("--visibility: it cannot be written together with --show; run the command once for each");
    }
    check_writable_parent("-o", options.output);
    check_writable_parent("--visibility", options.visibility);
}

/// One channel a light; lights that were refused are lit throughout.
void write_visibility(const std::filesystem::path& path, const Scene& scene, const FrameResult& frame) {
    const int width = frame.picture.width, height = frame.picture.height;
    // A light has one layer, or three where its V has colours; what was refused is lit.
    std::vector<std::string> names;
    std::vector<std::vector<float>> channels;
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        const Image& visibility = frame.visibility.at(l);
        for (int c = 0; c < std::max(1, visibility.channels); ++c) {
            const std::string name = fmt::format("V.{}.{}", l, slug(scene.lights[l].name));
            names.push_back(visibility.channels == 3 ? name + fmt::format(".{}", "RGB"[c]) : name);
            channels.push_back(visibility.values.empty() ? std::vector<float>{}
                                                         : channel_of(visibility.values, visibility.channels, c));
        }
    }
    Image layers(width, height, static_cast<int>(channels.size()), 1.0F);
    for (std::size_t c = 0; c < channels.size(); ++c) {
        for (std::size_t p = 0; p < channels[c].size(); ++p) {
            layers.values[p * channels.size() + c] = channels[c][p];
        }
    }
    write_exr(path, layers, names);
}

/// Says on standard error which lights are refused, a line a reason, and returns how many.
std::size_t say_refusals(const Scene& scene, const FrameResult& frame) {
    const std::vector<LightReason> refused = refused_lights(scene, frame);
    const bool all = refused.size() == scene.lights.size();
    for (const std::string& sentence : grouped_reasons(refused)) {
        fmt::print(stderr, "gnomon: refused, {}: {}\n",
                   all ? "so that no picture is written" : "and drawn without a shadow", sentence);
    }
    return refused.size();
}

/// Says what the picture does not show by itself: limits of the recipe, lights that reach nothing, lights that leave all
/// dark.
void say_remarks(const Scene& scene, const Camera& camera, const Recipe& recipe, const FrameResult& frame) {
    std::vector<std::string> notes = frame.remarks;
    for (std::size_t l = 0; l < frame.visibility.size(); ++l) {
        if (!frame.refused[l].empty()) {
            continue;
        }
        const Light& light = scene.lights[l];
        const Reach reach = reach_of(frame.samples, light.shape, frame.visibility[l].values);
        for (const std::string& note :
             {empty_reason(reach, light.name, camera.name), shadow_remark(reach, light.name)}) {
            if (!note.empty() && std::find(notes.begin(), notes.end(), note) == notes.end()) {
                notes.push_back(note);
            }
        }
    }
    say_notes(fmt::format("{} with {}", scene.name, recipe.name), notes);
}

/// "; it tells volume-count", what a part without a map can show.
std::string told_instead(const Recipe& recipe) {
    std::string names;
    for (const Side& side : recipe.direct != nullptr ? recipe.direct->sides : std::vector<Side>{}) {
        names += (names.empty() ? "; it tells " : ", ") + std::string(side.name);
    }
    return names;
}

/// What is wrong with the recipe whatever the scene.
void check_recipe_alone(const Recipe& recipe, const RenderOptions& options) {
    if (const std::string sentence = stages_misfit(recipe); !sentence.empty()) {
        throw InputError(fmt::format("-r {}: {}", recipe.name, sentence));
    }
    const bool told = recipe.direct != nullptr && tells(*recipe.direct, options.show);
    if (!options.show.empty() && recipe.map == nullptr && !told) {
        throw InputError(fmt::format("--show {}: recipe '{}' has no map that this could be a picture of{}",
                                     options.show, recipe.name, told_instead(recipe)));
    }
}

/// Point k of a sequence that fills the unit square evenly, within half a unit of zero; the first is zero.
vec2 even_shift(int k) {
    // The steps are the powers of the number whose cube is one more than itself, the golden ratio's sister.
    const dvec2 point = static_cast<double>(k) * dvec2(0.7548776662466927, 0.5698402909980532);
    return vec2(point - glm::round(point));
}

/// The frame, its picture smoothed: the mean radiance of `frames` frames, each moved by a part of a pixel. V, samples and
/// refusals are those of the first, which is not moved.
FrameResult render_smooth(Device& device, SceneGpu& gpu, const Camera& camera, const Recipe& recipe, const Size& size,
                          int frames) {
    FrameOptions options;
    options.width = static_cast<uint>(size.width);
    options.height = static_cast<uint>(size.height);
    options.repeat = 0;
    const PreparedRecipe prepared(device, recipe);
    FrameResult result = render_frame(gpu, camera, prepared, options);
    const bool served =
        std::any_of(result.refused.begin(), result.refused.end(), [](const auto& r) { return r.empty(); });
    options.samples = options.visibility = false;
    for (int k = 1; served && k < frames; ++k) {
        Camera moved = camera;
        moved.shift_cs = 2.0F * even_shift(k) / vec2(size.width, size.height);
        const FrameResult frame = render_frame(gpu, moved, prepared, options);
        for (std::size_t i = 0; i < result.picture.values.size(); ++i) {
            result.picture.values[i] += frame.picture.values[i];
        }
    }
    for (float& value : result.picture.values) {
        value /= static_cast<float>(frames);
    }
    return result;
}

/// Writes one picture of the hidden, or as .exr the values behind it, and says what its colours mean.
int show(const RenderOptions& options, Device& device, const Scene& scene, const Camera& camera, const Recipe& recipe,
         std::size_t light, Progress& progress) {
    SceneGpu gpu = upload_scene(device, scene);
    HiddenOptions hidden;
    hidden.width = static_cast<uint>(options.size.width);
    hidden.height = static_cast<uint>(options.size.height);
    hidden.light = light;
    const Shown shown = show_hidden(device, gpu, camera, recipe, {&options.show, 1}, hidden).front();
    if (std::filesystem::path(options.output).extension() == ".exr") {
        const std::array<std::string, 2> names{options.show, "state"};
        write_exr(options.output, shown.values, shown.values.channels == 2 ? names : std::span<const std::string>{});
    } else {
        write_png(options.output, shown.picture);
    }
    progress.clear();
    fmt::print("{}: {} of light '{}' in {} with {}\n{}\n", options.output, options.show, scene.lights.at(light).name,
               scene.name, recipe.name, shown.legend);
    for (const std::string& message : device.messages()) {
        fmt::print(stderr, "gnomon: validation: {}\n", message);
    }
    return device.messages().empty() ? exit_done : exit_failed;
}

}  // namespace

int run(const RenderOptions& options) {
    // Everything that the user may have got wrong is found before the first pixel.
    check_extensions(options);
    reading([&] { options.show.empty() ? void() : void(find_hidden(options.show)); });
    Progress progress;
    progress.step(0, 3, "reading " + options.scene);
    const Recipe recipe = reading([&] { return load_recipe(options.recipe); });
    check_recipe_alone(recipe, options);
    const Scene scene = reading([&] { return load_asked(options.scene, options.file, options.size).scene; });
    const Camera camera = reading([&] { return scene.camera(options.view); });
    const std::size_t light =
        reading([&] { return options.light.empty() ? std::size_t{0} : find_light(scene, options.light); });
    progress.clear();
    say_notes(options.scene, scene.notes);
    // Draw the frame.
    progress.step(1, 3, fmt::format("drawing {} with {}", options.scene, recipe.name));
    const std::unique_ptr<Device> device = Device::create({.validation = options.validate});
    say_notes("device", device->info().notes);
    if (!options.show.empty()) {
        return show(options, *device, scene, camera, recipe, light, progress);
    }
    SceneGpu gpu = upload_scene(*device, scene);
    const FrameResult frame = render_smooth(*device, gpu, camera, recipe, options.size, options.antialias);
    progress.clear();
    const std::size_t refused = say_refusals(scene, frame);
    if (refused == scene.lights.size()) {
        return exit_failed;
    }
    // Expose it and write it.
    if (std::filesystem::path(options.output).extension() == ".exr") {
        write_exr(options.output, frame.picture);
    } else {
        write_png(options.output, tonemap(frame.picture, automatic_exposure(frame.picture)));
    }
    if (!options.visibility.empty()) {
        write_visibility(options.visibility, scene, frame);
    }
    fmt::print("{}: {} with {}, {}x{}, {} lights, on {}\n", options.output, scene.name, recipe.name, options.size.width,
               options.size.height, scene.lights.size(), device->info().name);
    say_remarks(scene, camera, recipe, frame);
    for (const std::string& message : device->messages()) {
        fmt::print(stderr, "gnomon: validation: {}\n", message);
    }
    const bool failed = (options.strict && refused > 0) || !device->messages().empty();
    return failed ? exit_failed : exit_done;
}

}  // namespace gn
