// SPDX-License-Identifier: MIT
// One view of one scene, ready to be measured against: its samples, the truth per light, the reference picture.
#pragma once

#include "apps/compare/cache.h"
#include "apps/compare/result.h"
#include "apps/options.h"
#include "apps/terminal.h"
#include "reference/truth.h"
#include "shadow/frame/frame.h"

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

/// Thrown where the user asked to stop while something was traced.
struct Stopped {};

/// The truth of one light in one frame of a path.
struct PathTruth {
    std::vector<float> visibility;
    std::vector<std::uint8_t> counted;
};

class ViewSession {
  public:
    /// Loads the scene and finds the view and the light that are asked for. Throws InputError.
    /// `against`: what all recipes are held against besides the truth, or null.
    ViewSession(const std::string& asked, const CompareOptions& options, const Recipe* against);

    /// Traces (or finds in the cache) what is missing of the truth. May be called again. The cache must outlive the session.
    /// Throws Error, and Stopped.
    void prepare(Bench& bench, const ResultCache& cache, Progress& progress);
    /// Forgets everything that lives on the device.
    void release_device() { gpu_.reset(); }
    [[nodiscard]] SceneGpu& gpu(Bench& bench);

    /// The radiance of given visibilities, one a light (empty: V = 1), as a display-ready picture.
    Image picture_of(Bench& bench, std::span<const Image> visibility);
    /// The traced visibilities, in colour where that was asked for by truth(light, 3) and is here; lights that are left out
    /// of `served` are empty.
    [[nodiscard]] std::vector<Image> reference_visibility(const std::vector<bool>& served, bool colours = false) const;

    /// Whether light shaded by all of the area was asked for.
    [[nodiscard]] bool shaded() const { return options_.shaded; }
    /// What takes V's place so that the shading's light of the centre becomes that of all of the area: [EASW09] eq. 1.3 over the
    /// light of the unshadowed centre, one a light; lights that are left out of `served` are empty. Highlights stay those of the
    /// centre. Traced when first asked for. Throws Stopped.
    [[nodiscard]] std::vector<Image> shaded_visibility(const std::vector<bool>& served);

    /// The frame of the recipe that others are held against, or null when there is none. Drawn when first asked for.
    /// Throws Error.
    const FrameResult* against(Bench& bench);

    /// 1 where some place within a sample's surroundings is hidden from the light. Throws Error, and Stopped.
    [[nodiscard]] std::vector<std::uint8_t> beside_shadow(std::size_t light, std::span<const Surroundings> around);

    [[nodiscard]] const Scene& scene() const { return *scene_; }
    [[nodiscard]] const Camera& camera() const { return camera_; }
    [[nodiscard]] const std::string& key() const { return key_; }
    [[nodiscard]] const TruthResult& truth(std::size_t light) const { return *truth_.at(light); }
    /// The same with 1 or 3 channels; three are traced, or found in the cache, when they are first asked for. Throws Stopped.
    const TruthResult& truth(std::size_t light, int channels);
    [[nodiscard]] const CpuSamples& samples() const { return samples_; }
    [[nodiscard]] const CameraPath* path() const { return path_; }  ///< null where none is followed
    [[nodiscard]] const PathTruth& path_truth(std::size_t frame, std::size_t light) const {
        return path_truth_.at(frame).at(light);
    }
    [[nodiscard]] const Image& reference_picture() const { return picture_; }
    [[nodiscard]] float exposure() const { return exposure_; }
    [[nodiscard]] int only_light() const { return only_light_; }  ///< index, or -1 for all
    [[nodiscard]] bool wanted(std::size_t light) const { return only_light_ < 0 || std::size_t(only_light_) == light; }
    SceneResult result;  ///< filled as it becomes known

    /// Names the view's results; then what an earlier comparison knows about the reference is taken over.
    void name_in(const ResultCache& cache);

  private:
    /// Made when first asked for: where all is in the cache, nothing is traced.
    const Truth& tracer();
    void trace_lights(const ResultCache& cache, Progress& progress);
    void trace_path(Bench& bench, const ResultCache& cache, Progress& progress);
    /// From the cache, or traced. Throws Stopped.
    TruthResult truth_of(const ResultCache& cache, const CpuSamples& samples, std::size_t light, int channels,
                         const std::function<void(double)>& progress);
    void account(const ResultCache& cache, Bench& bench);
    const CompareOptions& options_;
    const Recipe* against_;
    std::optional<FrameResult> against_frame_;
    std::unique_ptr<Scene> scene_;
    Camera camera_;
    int only_light_ = -1;
    std::string key_;
    const ResultCache* cache_ = nullptr;  ///< of prepare
    std::optional<SceneGpu> gpu_;
    CpuSamples samples_;
    std::optional<Truth> tracer_;
    std::vector<std::optional<TruthResult>> truth_, colour_truth_;
    std::vector<std::optional<Image>> shaded_;  ///< per light, of shaded_visibility
    const CameraPath* path_ = nullptr;
    std::vector<std::vector<PathTruth>> path_truth_;  ///< per frame and light
    double path_seconds_ = 0;
    Image picture_;
    float exposure_ = 1;
    bool ready_ = false;
};

}  // namespace gn
