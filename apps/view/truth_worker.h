// SPDX-License-Identifier: MIT
// The truth of one view, traced by a thread while frames go on: again and again with more samples of the lights, until it is as
// exact as asked for or something moves.
#pragma once

#include "reference/truth.h"
#include "shadow/stages.h"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace gn {

/// What is to be traced.
struct TruthJob {
    CpuSamples samples;
    std::vector<Light> lights;
    int channels = 1;
};

/// What is known so far.
struct TruthStage {
    int samples = 0;                ///< of each light
    double standard_error = 0;      ///< mean over the counted samples, of the light where it is largest
    std::vector<Image> visibility;  ///< one a light
};

/// One at a time in a process: what asks a trace to stop is shared. The scene's triangles and materials must outlive it and stay
/// as they are; its lights are the job's own.
class TruthWorker {
  public:
    static constexpr int first_samples = 4, most_samples = 1024;

    explicit TruthWorker(const Scene& scene);
    ~TruthWorker();
    TruthWorker(const TruthWorker&) = delete;
    TruthWorker& operator=(const TruthWorker&) = delete;

    /// Leaves what it traces and begins with this.
    void begin(TruthJob job);
    /// Leaves what it traces.
    void leave();
    /// The newest stage that nobody took yet; nothing where there is none. Throws Error where tracing failed.
    std::optional<TruthStage> take();

  private:
    void work();

    const Scene& scene_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<TruthJob> job_;      ///< not begun yet
    std::optional<TruthStage> stage_;  ///< not taken yet
    std::uint64_t round_ = 0;          ///< of the job asked for last
    std::string failure_;
    bool ends_ = false;
    std::thread thread_;
};

}  // namespace gn
