// SPDX-License-Identifier: MIT
#include "apps/compare/session.h"

#include "apps/choose.h"
#include "apps/output.h"
#include "shadow/shading/illuminance.h"
#include "shadow/shading/tonemap.h"

#include <algorithm>
#include <array>

namespace gn {
namespace {

LightInfo describe(const Light& light) {
    const GnLight& shape = light.shape;
    std::string size = "no size";
    if (shape.kind == GN_LIGHT_DIRECTIONAL && shape.angular_radius > 0) {
        size = fmt::format("angular radius {:.3g} degrees", glm::degrees(shape.angular_radius));
    } else if (shape.kind == GN_LIGHT_RECTANGLE) {
        size = fmt::format("{:.3g} x {:.3g} m", 2 * shape.half_size.x, 2 * shape.half_size.y);
    } else if (shape.kind != GN_LIGHT_DIRECTIONAL && shape.radius > 0) {
        size = fmt::format("radius {:.3g} m", shape.radius);
    }
    return {light.name, std::string(light_kind_names.at(shape.kind)), size};
}

Image as_image(const std::vector<float>& values, const Size& size) {
    Image image(size.width, size.height, 1);
    image.channels = static_cast<int>(values.size() / image.pixels());
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

ViewSession::ViewSession(const std::string& asked, const CompareOptions& options, const Recipe* against)
    : options_(options), against_(against) {
    reading([&] {
        scene_ = std::make_unique<Scene>(load_asked(asked, options.file, options.size).scene);
        camera_ = scene_->camera(options.view);
        only_light_ = options.light.empty() ? -1 : static_cast<int>(find_light(*scene_, options.light));
        path_ = options.follow_path ? &find_path(*scene_, options.path) : nullptr;
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
    key_ = cache.view_key(*scene_, result.scene, camera_, path_);
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

void ViewSession::prepare(Bench& bench, const ResultCache& cache, Progress& progress) {
    if (ready_) {
        return;
    }
    cache_ = &cache;
    if (samples_.position_ws.empty()) {
        samples_ = render_samples(bench.device(), gpu(bench), camera_, static_cast<uint>(options_.size.width),
                                  static_cast<uint>(options_.size.height));
    }
    trace_lights(cache, progress);
    trace_path(bench, cache, progress);
    account(cache, bench);
    ready_ = true;
}

const Truth& ViewSession::tracer() {
    return tracer_ ? *tracer_ : tracer_.emplace(*scene_);
}

std::vector<std::uint8_t> ViewSession::beside_shadow(std::size_t light, std::span<const Surroundings> around) {
    std::vector<std::uint8_t> rims = tracer().blocked_around(samples_.position_ws, samples_.normal_ws, around,
                                                             scene_->lights[light], options_.threads, stop_requested);
    if (stop_requested()) {
        throw Stopped();
    }
    return rims;
}

TruthResult ViewSession::truth_of(const ResultCache& cache, const CpuSamples& samples, std::size_t light, int channels,
                                  const std::function<void(double)>& progress) {
    const std::string key = cache.truth_key(key_, samples, light, channels);
    std::optional<TruthResult> truth = cache.find_truth(key, options_.size.width, options_.size.height, channels);
    if (!truth) {
        truth = tracer().trace(
            samples.position_ws, samples.normal_ws, scene_->lights[light],
            {.samples = options_.samples, .threads = options_.threads, .stop = stop_requested, .channels = channels},
            progress);
        if (!truth->complete) {
            throw Stopped();
        }
        cache.store(key, *truth, options_.size.width, options_.size.height);
    }
    truth->standard_error = {};
    return std::move(*truth);
}

const TruthResult& ViewSession::truth(std::size_t light, int channels) {
    if (channels == 1) {
        return truth(light);
    }
    colour_truth_.resize(truth_.size());
    std::optional<TruthResult>& kept = colour_truth_.at(light);
    if (!kept) {
        kept = truth_of(*cache_, samples_, light, channels, {});
    }
    return *kept;
}

void ViewSession::trace_lights(const ResultCache& cache, Progress& progress) {
    const auto count = static_cast<double>(result.lights.size());
    double done = 0;
    for (std::size_t l = 0; l < truth_.size(); ++l) {
        if (!wanted(l) || truth_[l]) {
            continue;
        }
        truth_[l] = truth_of(cache, samples_, l, 1, [&](double part) { progress.within((done + part) / count); });
        done += 1;
    }
}

void ViewSession::trace_path(Bench& bench, const ResultCache& cache, Progress& progress) {
    const std::size_t frames = path_ != nullptr ? path_->frames.size() : 0;
    while (path_truth_.size() < frames) {
        const std::size_t frame = path_truth_.size();
        progress.within(static_cast<double>(frame) / static_cast<double>(frames));
        const CpuSamples samples =
            render_samples(bench.device(), gpu(bench), path_->frames[frame], static_cast<uint>(options_.size.width),
                           static_cast<uint>(options_.size.height));
        std::vector<PathTruth> lights(truth_.size());
        for (std::size_t l = 0; l < lights.size(); ++l) {
            if (wanted(l)) {
                TruthResult truth = truth_of(cache, samples, l, 1, {});
                path_seconds_ += truth.seconds;
                lights[l] = {std::move(truth.visibility), std::move(truth.counted)};
            }
        }
        path_truth_.push_back(std::move(lights));
    }
}

void ViewSession::account(const ResultCache& cache, Bench& bench) {
    // Sum up what tracing took and how sure it is.
    ReferenceResult& reference = result.reference;
    reference = {};
    reference.samples = options_.samples;
    reference.seconds = path_seconds_;
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

std::vector<Image> ViewSession::reference_visibility(const std::vector<bool>& served, bool colours) const {
    std::vector<Image> images;
    for (std::size_t l = 0; l < truth_.size(); ++l) {
        const bool coloured = colours && l < colour_truth_.size() && colour_truth_[l];
        const std::optional<TruthResult>& truth = coloured ? colour_truth_[l] : truth_[l];
        images.push_back(served[l] && truth ? as_image(truth->visibility, options_.size) : Image{});
    }
    return images;
}

std::vector<Image> ViewSession::shaded_visibility(const std::vector<bool>& served) {
    shaded_.resize(truth_.size());
    std::vector<Image> images(truth_.size());
    for (std::size_t l = 0; l < truth_.size(); ++l) {
        if (!served[l] || !wanted(l)) {
            continue;
        }
        if (!shaded_[l]) {
            const Light& light = scene_->lights[l];
            const TruthResult truth = tracer().trace(
                samples_.position_ws, samples_.normal_ws, light,
                {.samples = options_.samples, .threads = options_.threads, .stop = stop_requested, .integral = true});
            if (!truth.complete) {
                throw Stopped();
            }
            // The range's window is the shading's own, and not in the integral.
            GnLight unlimited = light.shape;
            unlimited.range = 0;
            const std::vector<float> centre = unshadowed_illuminance(samples_, unlimited);
            std::vector<float> share(centre.size(), 0.0F);
            for (std::size_t i = 0; i < share.size(); ++i) {
                // Where the centre gives nothing its share has no meaning: a grazing sample that does not count.
                share[i] = centre[i] > 0 ? truth.irradiance[i] / centre[i] : 0.0F;
            }
            shaded_[l] = as_image(share, options_.size);
        }
        images[l] = *shaded_[l];
    }
    return images;
}

const FrameResult* ViewSession::against(Bench& bench) {
    if (against_ != nullptr && !against_frame_) {
        FrameOptions options;
        options.width = static_cast<uint>(options_.size.width);
        options.height = static_cast<uint>(options_.size.height);
        options.repeat = 0;
        options.only_light = only_light_;
        options.samples = options.picture = false;
        try {
            against_frame_ = render_frame(bench.device(), gpu(bench), camera_, *against_, options);
        } catch (const Error& error) {
            throw Error(fmt::format("--against: {}", error.what()));
        }
    }
    return against_frame_ ? &*against_frame_ : nullptr;
}

Image ViewSession::picture_of(Bench& bench, std::span<const Image> visibility) {
    return tonemap(shade(bench.device(), gpu(bench), camera_, static_cast<uint>(options_.size.width),
                         static_cast<uint>(options_.size.height), visibility),
                   exposure_);
}

}  // namespace gn
