// SPDX-License-Identifier: MIT
#include "apps/compare/cache.h"

#include "apps/output.h"
#include "base/paths.h"
#include "gpu/hash.h"
#include "reference/truth_picture.h"

#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace gn {
namespace {

namespace fs = std::filesystem;

template <class T>
void add_values(Hasher& hasher, const std::vector<T>& values) {
    hasher.bytes(values.data(), values.size() * sizeof(T));
}

/// This program, its shaders and the device: what makes figures of today and yesterday comparable.
std::string program_stamp(const DeviceInfo& device) {
    Hasher hasher;
    std::error_code code;
    const fs::path program = fs::canonical("/proc/self/exe", code);
    hasher.text(GNOMON_VERSION).value(fs::file_size(program, code));
    hasher.value(fs::last_write_time(program, code).time_since_epoch().count());
    // Shaders are read at run time: their text counts, in an order that no file system changes.
    std::vector<fs::path> shaders;
    for (const char* folder : {"base", "shadow"}) {
        for (const auto& entry : fs::recursive_directory_iterator(data_root() / folder, code)) {
            const fs::path extension = entry.path().extension();
            if (extension == ".glsl" || extension == ".h") {
                shaders.push_back(entry.path());
            }
        }
    }
    std::sort(shaders.begin(), shaders.end());
    for (const fs::path& shader : shaders) {
        hasher.text(shader.lexically_relative(data_root()).string()).text(read_text(shader));
    }
    return hasher.text(device.name).text(device.driver).finish().hex();
}

void add_scene(Hasher& hasher, const Scene& scene) {
    add_values(hasher, scene.positions_ws);
    add_values(hasher, scene.normals_ws);
    add_values(hasher, scene.uvs);
    add_values(hasher, scene.colors);
    add_values(hasher, scene.triangles);
    for (const Object& object : scene.objects) {
        hasher.value(object.first_triangle).value(object.triangle_count).value(object.material);
        hasher.value(object.casts.has_value()).value(object.casts.value_or(true)).value(object.receives);
    }
    for (const Material& m : scene.materials) {
        hasher.bytes(&m.base_color, sizeof m.base_color).bytes(&m.emissive, sizeof m.emissive);
        hasher.value(m.metallic).value(m.roughness).value(m.alpha_mode).value(m.alpha_cutoff);
        hasher.value(m.base_color_texture).value(m.double_sided).value(m.casts);
    }
    for (const Texture& texture : scene.textures) {
        add_values(hasher, texture.image.rgba);
        hasher.value(texture.image.width).value(texture.repeat_u).value(texture.repeat_v);
    }
    for (const Light& light : scene.lights) {
        hasher.text(light.name).bytes(&light.shape, sizeof light.shape);
        add_values(hasher, light.spared);
    }
    hasher.value(scene.environment.has_value());
    if (scene.environment) {
        hasher.bytes(&scene.environment->shape, sizeof(GnLight)).bytes(&scene.environment->sky, sizeof(GnSky));
    }
}

/// A camera by its fields: between them there may be padding.
void add_camera(Hasher& hasher, const Camera& camera) {
    hasher.text(camera.name).bytes(&camera.position_ws, sizeof camera.position_ws);
    hasher.bytes(&camera.forward_ws, sizeof camera.forward_ws).bytes(&camera.up_ws, sizeof camera.up_ws);
    hasher.value(camera.yfov).value(camera.half_height).value(camera.near).value(camera.far);
}

void add_recipe(Hasher& hasher, const Recipe& recipe) {
    hasher.text(recipe.name).text(recipe.overrides).text(name_of(recipe.casters)).value(recipe.resolution);
    hasher.bytes(&recipe.bias, sizeof recipe.bias).text(recipe.title).text(recipe.paragraph);
    for (const Part* part : recipe.parts()) {
        hasher.text(stage_names[static_cast<std::size_t>(part->stage)]).text(part->id);
    }
    for (const Part* part : {recipe.translucent_map, recipe.translucent_lookup}) {
        hasher.text(part != nullptr ? part->id : "");
    }
    hasher.value(recipe.combine ? static_cast<int>(*recipe.combine) : -1);
    for (const auto& [id, block] : recipe.params) {
        hasher.text(id).bytes(block.bytes().data(), block.bytes().size());
    }
}

}  // namespace

ResultCache::ResultCache(fs::path folder, bool fresh, const CompareOptions& options, const DeviceInfo& device)
    : folder_(std::move(folder)),
      read_(!folder_.empty() && !fresh),
      width_(options.size.width),
      height_(options.size.height),
      samples_(options.samples),
      repeat_(options.repeat),
      threads_(options.threads),
      validate_(options.validate),
      shaded_(options.shaded),
      light_(options.light) {
    if (!folder_.empty()) {
        stamp_ = program_stamp(device);
    }
}

std::string ResultCache::view_key(const Scene& scene, const std::string& asked, const Camera& camera,
                                  const CameraPath* path) const {
    Hasher hasher;
    hasher.text(stamp_).text(asked).text(light_);
    hasher.value(width_).value(height_).value(samples_).value(repeat_).value(threads_).value(validate_).value(shaded_);
    add_camera(hasher, camera);
    hasher.value(path != nullptr ? path->frames.size() : 0);
    for (const Camera& frame : path != nullptr ? path->frames : std::vector<Camera>{}) {
        add_camera(hasher, frame);
    }
    add_scene(hasher, scene);
    return hasher.finish().hex();
}

std::string ResultCache::run_key(const std::string& view_key, const Recipe& recipe, const Recipe* against) const {
    Hasher hasher;
    hasher.text(view_key);
    add_recipe(hasher, recipe);
    hasher.value(against != nullptr);
    if (against != nullptr) {
        add_recipe(hasher, *against);
    }
    return hasher.finish().hex();
}

std::string ResultCache::truth_key(const std::string& view_key, const CpuSamples& samples, std::size_t light,
                                   int channels) const {
    Hasher hasher;
    hasher.text(view_key).value(light).value(channels);
    add_values(hasher, samples.position_ws);
    add_values(hasher, samples.normal_ws);
    return hasher.finish().hex();
}

fs::path ResultCache::file(const std::string& kind, const std::string& key, const std::string& extension) const {
    return folder_ / "results" / fmt::format("{}-{}.{}", kind, key, extension);
}

void ResultCache::keep(const std::function<void()>& body) const {
    try {
        body();
    } catch (const Error& error) {
        if (!warned_) {
            spdlog::warn("results are not kept for a later run: {}", error.what());
        }
        warned_ = true;
    }
}

bool ResultCache::picture_exists(const std::string& name) const {
    std::error_code code;
    return name.empty() || fs::is_regular_file(folder_ / name, code);
}

std::optional<RunResult> ResultCache::find_run(const std::string& key) const {
    std::error_code code;
    if (!read_ || !fs::is_regular_file(file("run", key, "json"), code)) {
        return std::nullopt;
    }
    try {
        RunResult run = run_from_json(nlohmann::ordered_json::parse(read_text(file("run", key, "json"))));
        bool complete = picture_exists(run.picture) && picture_exists(run.error_map);
        for (const LightResult& light : run.lights) {
            complete = complete && picture_exists(light.error_map);
        }
        for (const InsideResult& shown : run.inside) {
            complete = complete && picture_exists(shown.picture);
        }
        return complete ? std::optional<RunResult>(std::move(run)) : std::nullopt;
    } catch (const std::exception& error) {
        spdlog::info("results of an earlier run are not usable, so it is measured again: {}", error.what());
        return std::nullopt;
    }
}

void ResultCache::store(const std::string& key, const RunResult& run) const {
    if (!folder_.empty()) {
        keep([&] { write_text(file("run", key, "json"), dump(run_json(run, true), 1)); });
    }
}

std::optional<ReferenceResult> ResultCache::find_reference(const std::string& key) const {
    std::error_code code;
    if (!read_ || !fs::is_regular_file(file("reference", key, "json"), code)) {
        return std::nullopt;
    }
    try {
        ReferenceResult found =
            reference_from_json(nlohmann::ordered_json::parse(read_text(file("reference", key, "json"))));
        return picture_exists(found.picture) ? std::optional<ReferenceResult>(std::move(found)) : std::nullopt;
    } catch (const std::exception& error) {
        spdlog::info("an earlier reference is not usable, so it is traced again: {}", error.what());
        return std::nullopt;
    }
}

void ResultCache::store(const std::string& key, const ReferenceResult& reference) const {
    if (!folder_.empty()) {
        keep([&] { write_text(file("reference", key, "json"), dump(reference_json(reference), 1)); });
    }
}

std::optional<TruthResult> ResultCache::find_truth(const std::string& key, int width, int height, int channels) const {
    std::error_code code;
    if (!read_ || !fs::is_regular_file(file("truth", key, "json"), code)) {
        return std::nullopt;
    }
    try {
        // V, its standard error and whether the sample counts stand in one picture.
        const Image stored = read_exr(file("truth", key, "exr"));
        const auto numbers = nlohmann::ordered_json::parse(read_text(file("truth", key, "json")));
        if (stored.width != width || stored.height != height || stored.channels != truth_picture_channels(channels)) {
            return std::nullopt;
        }
        TruthResult truth = truth_of_picture(stored);
        truth.seconds = numbers.at("seconds");
        truth.mean_standard_error = numbers.at("mean_standard_error");
        return truth;
    } catch (const std::exception& error) {
        spdlog::info("an earlier truth is not usable, so it is traced again: {}", error.what());
        return std::nullopt;
    }
}

void ResultCache::store(const std::string& key, const TruthResult& truth, int width, int height) const {
    if (folder_.empty()) {
        return;
    }
    const Image stored = picture_of_truth(truth, width, height);
    // The numbers come last: they say that the picture is complete.
    const nlohmann::ordered_json numbers{{"seconds", truth.seconds},
                                         {"mean_standard_error", truth.mean_standard_error}};
    keep([&] {
        write_exr(file("truth", key, "exr"), stored, truth_picture_names(stored.channels));
        write_text(file("truth", key, "json"), dump(numbers, 1));
    });
}

}  // namespace gn
