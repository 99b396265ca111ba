// SPDX-License-Identifier: MIT
#include "apps/compare/session.h"

#include "apps/output.h"
#include "shadow/shading/tonemap.h"

#include <algorithm>
#include <array>

namespace gn {
namespace {

LightInfo describe(const Light& light) {
    constexpr std::array<std::string_view, 4> kinds{"directional", "spot", "point", "rectangle"};
    const GnLight& shape = light.shape;
    std::string size = "no size";
    if (shape.kind == GN_LIGHT_DIRECTIONAL && shape.angular_radius > 0) {
        size = fmt::format("angular radius {:.3g} degrees", glm::degrees(shape.angular_radius));
    } else if (shape.kind == GN_LIGHT_RECTANGLE) {
        size = fmt::format("{:.3g} x {:.3g} m", 2 * shape.half_size.x, 2 * shape.half_size.y);
    } else if (shape.kind != GN_LIGHT_DIRECTIONAL && shape.radius > 0) {
        size = fmt::format("radius {:.3g} m", shape.radius);
    }
    return {light.name, std::string(kinds.at(shape.kind)), size};
}

int find_light(const Scene& scene, const std::string& name) {
    std::vector<std::string_view> known;
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        if (scene.lights[l].name == name) {
            return static_cast<int>(l);
        }
        known.push_back(scene.lights[l].name);
    }
    fail("--light: scene '{}' has no light '{}'; {}", scene.name, name, suggest(name, known));
}

Image as_image(const std::vector<float>& values, const Size& size) {
    Image image(size.width, size.height, 1);
    image.values = values;
    return image;
}

}  // namespace

Bench::Bench(bool validate) : validate_(validate), device_(Device::create({.validation = validate})) {}

bool Bench::alive() {
    try {
        device_->run([](VkCommandBuffer) {});
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

void Bench::replace() {
    device_.reset();
    device_ = Device::create({.validation = validate_});
}

ViewSession::ViewSession(const std::string& asked, const CompareOptions& options) : options_(options) {
    reading([&] {
        scene_ = std::make_unique<Scene>(load_scene(asked));
        camera_ = scene_->camera(options.view);
        only_light_ = options.light.empty() ? -1 : find_light(*scene_, options.light);
    });
    truth_.resize(scene_->lights.size());
    result.scene = asked;
    result.name = scene_->name;
    result.view = camera_.name;
    result.width = options.size.width;
    result.height = options.size.height;
    result.triangles = scene_->triangles.size();
    result.notes = scene_->notes;
    for (std::size_t l = 0; l < scene_->lights.size(); ++l) {
        if (wanted(l)) {
            result.lights.push_back(describe(scene_->lights[l]));
        }
    }
}

void ViewSession::name_in(const ResultCache& cache) {
    key_ = cache.view_key(*scene_, result.scene, camera_);
    if (const auto known = cache.find_reference(key_)) {
        result.reference = *known;
    }
}

SceneGpu& ViewSession::gpu(Bench& bench) {
    if (!gpu_) {
        gpu_.emplace(upload_scene(bench.device(), *scene_));
    }
    return *gpu_;
}

bool ViewSession::prepare(Bench& bench, const ResultCache& cache, Progress& progress) {
    if (ready_) {
        return true;
    }
    if (samples_.position_ws.empty()) {
        samples_ = render_samples(bench.device(), gpu(bench), camera_, static_cast<uint>(options_.size.width),
                                  static_cast<uint>(options_.size.height));
    }
    if (!trace_lights(cache, progress)) {
        return false;
    }
    account(cache, bench);
    ready_ = true;
    return true;
}

bool ViewSession::trace_lights(const ResultCache& cache, Progress& progress) {
    // The acceleration structure is built only when a light is not in the cache.
    std::optional<Truth> tracer;
    const auto count = static_cast<double>(result.lights.size());
    double done = 0;
    for (std::size_t l = 0; l < truth_.size(); ++l) {
        if (!wanted(l) || truth_[l]) {
            continue;
        }
        if (stop_requested()) {
            return false;
        }
        const std::string key = cache.truth_key(key_, samples_, l);
        truth_[l] = cache.find_truth(key, options_.size.width, options_.size.height);
        if (!truth_[l]) {
            if (!tracer) {
                tracer.emplace(*scene_);
            }
            truth_[l] = tracer->trace(samples_.position_ws, samples_.normal_ws, scene_->lights[l].shape,
                                      {.samples = options_.samples, .threads = options_.threads},
                                      [&](double part) { progress.within((done + part) / count); });
            cache.store(key, *truth_[l], options_.size.width, options_.size.height);
        }
        truth_[l]->standard_error = {};
        done += 1;
    }
    return true;
}

void ViewSession::account(const ResultCache& cache, Bench& bench) {
    // Sum up what tracing took and how sure it is.
    ReferenceResult& reference = result.reference;
    reference = {};
    reference.samples = options_.samples;
    for (const auto& truth : truth_) {
        if (truth) {
            reference.seconds += truth->seconds;
            reference.standard_error += truth->mean_standard_error / static_cast<double>(result.lights.size());
        }
    }
    // Expose the reference by itself; every recipe is shown with its exposure.
    const std::vector<Image> visibility = reference_visibility(std::vector<bool>(truth_.size(), true));
    const Image radiance = shade(bench.device(), gpu(bench), camera_, static_cast<uint>(options_.size.width),
                                 static_cast<uint>(options_.size.height), visibility);
    exposure_ = automatic_exposure(radiance);
    picture_ = tonemap(radiance, exposure_);
    if (!options_.folder.empty()) {
        reference.picture = fmt::format("pictures/{}-{}-reference.png", slug(result.name), key_.substr(0, 8));
        write_png(std::filesystem::path(options_.folder) / reference.picture, picture_);
    }
    cache.store(key_, reference);
}

std::vector<Image> ViewSession::reference_visibility(const std::vector<bool>& served) const {
    std::vector<Image> images;
    for (std::size_t l = 0; l < truth_.size(); ++l) {
        images.push_back(served[l] && truth_[l] ? as_image(truth_[l]->visibility, options_.size) : Image{});
    }
    return images;
}

Image ViewSession::picture_of(Bench& bench, std::span<const Image> visibility) {
    return tonemap(shade(bench.device(), gpu(bench), camera_, static_cast<uint>(options_.size.width),
                         static_cast<uint>(options_.size.height), visibility),
                   exposure_);
}

}  // namespace gn
