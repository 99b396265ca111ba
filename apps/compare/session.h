// SPDX-License-Identifier: MIT
// One view of one scene, ready to be measured against: its samples, the truth per light, the reference picture.
#pragma once

#include "apps/compare/cache.h"
#include "apps/compare/result.h"
#include "apps/options.h"
#include "apps/terminal.h"
#include "reference/truth.h"
#include "shadow/frame.h"

#include <memory>

namespace gn {

/// The device, replaceable after it was lost.
class Bench {
  public:
    explicit Bench(bool validate);
    [[nodiscard]] Device& device() { return *device_; }
    /// Whether the device still answers.
    [[nodiscard]] bool alive();
    /// Throws Error when no device can be made any more.
    void replace();

  private:
    bool validate_;
    std::unique_ptr<Device> device_;
};

class ViewSession {
  public:
    /// Loads the scene and finds the view and the light that are asked for. Throws InputError.
    ViewSession(const std::string& asked, const CompareOptions& options);

    /// Traces (or finds in the cache) what is missing of the truth. May be called again. Throws Error;
    /// returns false when the user asked to stop.
    bool prepare(Bench& bench, const ResultCache& cache, Progress& progress);
    /// Forgets everything that lives on the device.
    void release_device() { gpu_.reset(); }
    [[nodiscard]] SceneGpu& gpu(Bench& bench);

    /// The radiance of given visibilities, one a light (empty: V = 1), as a display-ready picture.
    Image picture_of(Bench& bench, std::span<const Image> visibility);
    /// The traced visibilities; lights that are left out of `served` are empty.
    [[nodiscard]] std::vector<Image> reference_visibility(const std::vector<bool>& served) const;

    [[nodiscard]] const Scene& scene() const { return *scene_; }
    [[nodiscard]] const Camera& camera() const { return camera_; }
    [[nodiscard]] const std::string& key() const { return key_; }
    [[nodiscard]] const TruthResult& truth(std::size_t light) const { return *truth_.at(light); }
    [[nodiscard]] const Image& reference_picture() const { return picture_; }
    [[nodiscard]] float exposure() const { return exposure_; }
    [[nodiscard]] int only_light() const { return only_light_; }  ///< index, or -1 for all
    [[nodiscard]] bool wanted(std::size_t light) const { return only_light_ < 0 || std::size_t(only_light_) == light; }
    SceneResult result;  ///< filled as it becomes known

    /// Names the view's results; then what an earlier comparison knows about the reference is taken over.
    void name_in(const ResultCache& cache);

  private:
    bool trace_lights(const ResultCache& cache, Progress& progress);
    void account(const ResultCache& cache, Bench& bench);
    const CompareOptions& options_;
    std::unique_ptr<Scene> scene_;
    Camera camera_;
    int only_light_ = -1;
    std::string key_;
    std::optional<SceneGpu> gpu_;
    CpuSamples samples_;
    std::vector<std::optional<TruthResult>> truth_;
    Image picture_;
    float exposure_ = 1;
    bool ready_ = false;
};

}  // namespace gn
