// SPDX-License-Identifier: MIT
// One picture: load, render, tone-map, write.
#include "apps/choose.h"
#include "apps/options.h"
#include "apps/output.h"
#include "apps/terminal.h"
#include "shadow/frame.h"
#include "shadow/lookup/show.h"
#include "shadow/shading/tonemap.h"

#include <spdlog/spdlog.h>

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
    const int lights = static_cast<int>(scene.lights.size());
    Image layers(width, height, lights, 1.0F);
    std::vector<std::string> names;
    for (int l = 0; l < lights; ++l) {
        const Image& visibility = frame.visibility.at(static_cast<std::size_t>(l));
        for (std::size_t p = 0; p < visibility.pixels(); ++p) {
            layers.values[p * static_cast<std::size_t>(lights) + static_cast<std::size_t>(l)] = visibility.values[p];
        }
        names.push_back(fmt::format("V.{}.{}", l, slug(scene.lights[static_cast<std::size_t>(l)].name)));
    }
    write_exr(path, layers, names);
}

/// Says on standard error which lights have no shadow, and returns how many.
std::size_t report_refusals(const Scene& scene, const FrameResult& frame) {
    std::size_t refused = 0;
    for (std::size_t l = 0; l < frame.refused.size(); ++l) {
        if (!frame.refused[l].empty()) {
            fmt::print(stderr, "gnomon: refused, and drawn without a shadow: light '{}': {}\n", scene.lights.at(l).name,
                       frame.refused[l]);
            ++refused;
        }
    }
    return refused;
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
    const Scene scene = reading([&] { return load_scene(options.scene); });
    const Camera camera = reading([&] { return scene.camera(options.view); });
    const std::size_t light =
        reading([&] { return options.light.empty() ? std::size_t{0} : find_light(scene, options.light); });
    for (const std::string& note : scene.notes) {
        spdlog::info("{}: {}", options.scene, note);
    }
    // Draw the frame.
    progress.step(1, 3, fmt::format("drawing {} with {}", options.scene, recipe.name));
    const std::unique_ptr<Device> device = Device::create({.validation = options.validate});
    if (!options.show.empty()) {
        return show(options, *device, scene, camera, recipe, light, progress);
    }
    SceneGpu gpu = upload_scene(*device, scene);
    FrameOptions frame_options;
    frame_options.width = static_cast<uint>(options.size.width);
    frame_options.height = static_cast<uint>(options.size.height);
    const FrameResult frame = render_frame(*device, gpu, camera, recipe, frame_options);
    // Expose it and write it.
    progress.step(2, 3, "writing " + options.output);
    if (std::filesystem::path(options.output).extension() == ".exr") {
        write_exr(options.output, frame.picture);
    } else {
        write_png(options.output, tonemap(frame.picture, automatic_exposure(frame.picture)));
    }
    if (!options.visibility.empty()) {
        write_visibility(options.visibility, scene, frame);
    }
    progress.clear();
    fmt::print("{}: {} with {}, {}x{}, {} lights, on {}\n", options.output, scene.name, recipe.name, options.size.width,
               options.size.height, scene.lights.size(), device->info().name);
    const std::size_t refused = report_refusals(scene, frame);
    for (const std::string& remark : frame.remarks) {
        fmt::print(stderr, "gnomon: note: {}\n", remark);
    }
    for (const std::string& message : device->messages()) {
        fmt::print(stderr, "gnomon: validation: {}\n", message);
    }
    const bool failed = (options.strict && refused > 0) || !device->messages().empty();
    return failed ? exit_failed : exit_done;
}

}  // namespace gn
