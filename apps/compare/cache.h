// SPDX-License-Identifier: MIT
// Finished results on disk, so that a comparison that was cut short goes on where it stopped.
#pragma once

#include "apps/compare/result.h"
#include "apps/options.h"
#include "reference/truth.h"
#include "shadow/recipe/recipe.h"
#include "shadow/stages.h"

#include <filesystem>
#include <functional>
#include <optional>

namespace gn {

/// Files in DIR/results, named by the hash of everything that a figure depends on: the scene's contents, the camera,
/// the recipe with all parameters, sizes, samples, the device, this program and its shaders.
class ResultCache {
  public:
    /// An empty folder turns the cache off; `fresh` only writes.
    ResultCache(std::filesystem::path folder, bool fresh, const CompareOptions& options, const DeviceInfo& device);

    [[nodiscard]] std::string view_key(const Scene& scene, const std::string& asked, const Camera& camera,
                                       const CameraPath* path) const;
    [[nodiscard]] std::string run_key(const std::string& view_key, const Recipe& recipe, const Recipe* against) const;
    /// The truth, of 1 channel or 3, depends on the very samples that were rendered.
    [[nodiscard]] std::string truth_key(const std::string& view_key, const CpuSamples& samples, std::size_t light,
                                        int channels = 1) const;

    /// Nothing when absent, unreadable, or when a picture that it names is gone.
    [[nodiscard]] std::optional<RunResult> find_run(const std::string& key) const;
    void store(const std::string& key, const RunResult& run) const;
    [[nodiscard]] std::optional<ReferenceResult> find_reference(const std::string& key) const;
    void store(const std::string& key, const ReferenceResult& reference) const;
    [[nodiscard]] std::optional<TruthResult> find_truth(const std::string& key, int width, int height,
                                                        int channels = 1) const;
    void store(const std::string& key, const TruthResult& truth, int width, int height) const;

  private:
    [[nodiscard]] std::filesystem::path file(const std::string& kind, const std::string& key,
                                             const std::string& extension) const;
    [[nodiscard]] bool picture_exists(const std::string& name) const;
    std::filesystem::path folder_;
    bool read_ = false;
    int width_ = 0, height_ = 0, samples_ = 0, repeat_ = 0, threads_ = 0;
    /// Writes by `body`; where that fails, says once that nothing is kept: it costs a repetition, not the run.
    void keep(const std::function<void()>& body) const;
    bool validate_ = false, shaded_ = false;
    mutable bool warned_ = false;
    std::string light_, stamp_;
};

}  // namespace gn
