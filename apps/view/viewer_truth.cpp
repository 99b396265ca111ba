// SPDX-License-Identifier: MIT
// The truth beside the frames: traced while nothing of it moves.
#include "apps/view/viewer.h"

#include "shadow/receiver/channels.h"
#include "shadow/view/read_back.h"

namespace gn {
namespace {

/// Frames that must look the same before rays are traced.
constexpr int still_frames = 3;

std::shared_ptr<TruthPictures> upload(Device& device, const TruthStage& stage) {
    auto pictures = std::make_shared<TruthPictures>();
    pictures->samples = stage.samples;
    pictures->standard_error = stage.standard_error;
    for (const Image& visibility : stage.visibility) {
        const Image texels = visibility.channels == 1 ? visibility : with_alpha(visibility);
        pictures->visibility.push_back(
            upload_texture(device,
                           {.name = "truth",
                            .format = visibility_format(visibility.channels == 1 ? 1 : 3),
                            .width = static_cast<std::uint32_t>(texels.width),
                            .height = static_cast<std::uint32_t>(texels.height),
                            .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT},
                           std::as_bytes(std::span(texels.values))));
    }
    return pictures;
}

}  // namespace

std::string Viewer::truth_key(const Viewport& viewport) const {
    return fmt::format("{} {}x{} {} {} {}", text_of(viewport.camera), viewport.width, viewport.height,
                       world_->lights_version, world_->gpu.version, viewport.coloured());
}

void Viewer::follow_truth() {
    if (against != Against::truth) {
        if (!truth_key_.empty()) {
            worker_->leave();
            truth_.reset();
            truth_key_.clear();
        }
        return;
    }
    if (worker_ == nullptr) {
        worker_ = std::make_unique<TruthWorker>(world_->scene);
    }
    Viewport& viewport = *viewports_.at(selected);
    const std::string key = truth_key(viewport);
    still_ = key == truth_key_ ? still_ + 1 : 0;
    if (still_ == 0) {
        worker_->leave();
        truth_.reset();
        truth_key_ = key;
    }
    if (still_ == still_frames) {
        viewport.ask_samples([this, key](CpuSamples samples) {
            if (key == truth_key_ && worker_ != nullptr) {
                worker_->begin({.samples = std::move(samples),
                                .lights = world_->scene.lights,
                                .channels = viewports_.at(selected)->coloured() ? 3 : 1});
            }
        });
    }
    take_stage();
}

void Viewer::take_stage() {
    try {
        if (const std::optional<TruthStage> stage = worker_->take()) {
            truth_ = upload(device_, *stage);
        }
    } catch (const Error& failed) {
        message = failed.what();
    }
}

}  // namespace gn
