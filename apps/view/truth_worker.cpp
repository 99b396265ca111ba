// SPDX-License-Identifier: MIT
#include "apps/view/truth_worker.h"

#include <algorithm>
#include <atomic>

namespace gn {
namespace {

// TruthOptions::stop is a plain function.
std::atomic<bool> leaves{false};

/// Frames need a processor too.
int threads_beside_frames() {
    return static_cast<int>(std::max(1U, std::thread::hardware_concurrency() / 2));
}

/// Every light with so many samples; nothing where it was told to leave.
std::optional<TruthStage> trace(const Truth& truth, const TruthJob& job, int samples) {
    TruthStage stage{.samples = samples};
    for (const Light& light : job.lights) {
        TruthOptions options;
        options.samples = samples;
        options.threads = threads_beside_frames();
        options.channels = job.channels;
        options.stop = [] { return leaves.load(); };
        TruthResult result = truth.trace(job.samples.position_ws, job.samples.normal_ws, light, options);
        if (!result.complete || leaves) {
            return std::nullopt;
        }
        Image visibility;
        visibility.width = static_cast<int>(job.samples.width);
        visibility.height = static_cast<int>(job.samples.height);
        visibility.channels = result.channels;
        visibility.values = std::move(result.visibility);
        stage.visibility.push_back(std::move(visibility));
        stage.standard_error = std::max(stage.standard_error, result.mean_standard_error);
    }
    return stage;
}

}  // namespace

TruthWorker::TruthWorker(const Scene& scene) : scene_(scene), thread_([this] { work(); }) {}

TruthWorker::~TruthWorker() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        leaves = true;
    }
    changed_.notify_all();
    thread_.join();
    leaves = false;
}

void TruthWorker::begin(TruthJob job) {
    const std::lock_guard lock(mutex_);
    leaves = true;
    ++round_;
    stage_.reset();
    job_ = std::move(job);
    changed_.notify_all();
}

void TruthWorker::leave() {
    const std::lock_guard lock(mutex_);
    leaves = true;
    ++round_;
    stage_.reset();
    job_.reset();
}

std::optional<TruthStage> TruthWorker::take() {
    const std::lock_guard lock(mutex_);
    if (!failure_.empty()) {
        throw Error(std::exchange(failure_, ""));
    }
    return std::exchange(stage_, std::nullopt);
}

void TruthWorker::work() {
    std::optional<Truth> truth;
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return ends_ || job_.has_value(); });
        if (ends_) {
            return;
        }
        const TruthJob job = *std::exchange(job_, std::nullopt);
        const std::uint64_t round = round_;
        leaves = false;
        // Four times the samples a stage: the last one costs three quarters of all.
        for (int samples = first_samples; samples <= most_samples && round == round_; samples *= 4) {
            lock.unlock();
            std::optional<TruthStage> stage;
            std::string failure;
            try {
                if (!truth) {
                    truth.emplace(scene_);
                }
                stage = trace(*truth, job, samples);
            } catch (const std::exception& error) {
                failure = error.what();
            }
            lock.lock();
            if (round != round_ || ends_) {
                break;
            }
            failure_ = failure;
            if (!stage) {
                break;
            }
            stage_ = std::move(stage);
        }
    }
}

}  // namespace gn
