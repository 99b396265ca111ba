// SPDX-License-Identifier: MIT
#include "shadow/embed/host.h"

namespace gn::host {

struct Session::State {
    std::unique_ptr<Device> device;
    std::optional<Scene> scene;
    std::optional<SceneGpu> uploaded;
    std::string recipe;                        ///< what `prepared` was asked for as
    std::unique_ptr<PreparedRecipe> prepared;  ///< of the frame before
};

Session::Session(std::unique_ptr<State> state) : state_(std::move(state)) {}
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() = default;

Result<Session> Session::adopt(const AdoptedDevice& host) noexcept {
    return guarded<Session>([&] {
        auto state = std::make_unique<State>();
        state->device = Device::adopt(host);
        return Session(std::move(state));
    });
}

Result<Session> Session::create(const std::string& pick) noexcept {
    return guarded<Session>([&] {
        auto state = std::make_unique<State>();
        state->device = Device::create({.pick = pick});
        return Session(std::move(state));
    });
}

Result<Done> Session::set_scene(Scene scene) noexcept {
    return guarded<Done>([&] {
        finish_host_scene(scene);
        state_->uploaded.reset();
        state_->scene = std::move(scene);
        state_->uploaded = upload_scene(*state_->device, *state_->scene);
        return Done{};
    });
}

Result<Done> Session::load_scene(const std::string& name_or_path, const LoadOptions& options) noexcept {
    return guarded<Done>([&] {
        Scene scene = gn::load_scene(name_or_path, options);
        state_->uploaded.reset();
        state_->scene = std::move(scene);
        state_->uploaded = upload_scene(*state_->device, *state_->scene);
        return Done{};
    });
}

const Scene* Session::scene() const noexcept {
    return state_->scene ? &*state_->scene : nullptr;
}

Result<FrameResult> Session::render(const Camera& camera, const std::string& recipe,
                                    const FrameOptions& options) noexcept {
    return guarded<FrameResult>([&] {
        if (!state_->uploaded) {
            fail("render before set_scene: there is no scene to render");
        }
        if (options.width == 0 || options.height == 0) {
            fail("render at {} x {} pixels; at least 1 x 1 is needed", options.width, options.height);
        }
        if (state_->prepared == nullptr || state_->recipe != recipe) {
            state_->prepared = std::make_unique<PreparedRecipe>(*state_->device, load_recipe(recipe));
            state_->recipe = recipe;
        }
        return render_frame(*state_->uploaded, camera, *state_->prepared, options);
    });
}

}  // namespace gn::host
