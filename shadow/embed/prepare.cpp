// SPDX-License-Identifier: MIT
// A recipe that is asked for ahead: a thread makes its pipelines while frames go on without it.
#include "shadow/embed/twins.h"

#include <utility>

namespace gn::embed {

const PreparedRecipe& Shadows::State::present() const {
    const PreparedRecipe* there = recipe != nullptr ? recipe.get() : awaited.get();
    if (there == nullptr) {
        fail("{}", failed);
    }
    return *there;
}

void Shadows::State::await(std::shared_ptr<const PreparedRecipe> next) {
    failed.clear();
    awaited = std::move(next);
}

bool Shadows::State::is_ready(const Frame& frame) const {
    // The second frame may bind other pipelines: it finds what the first one left.
    Twins twins(*device, casters);
    for (int i = 0; i < 2; ++i) {
        FrameGraph graph(*device);
        static_cast<void>(declare(graph, twins.lend(frame), frame, *awaited));
        if (!compiler->ready(graph)) {
            return false;
        }
        twins.advance();
    }
    return true;
}

void Shadows::State::take_awaited(const Frame& frame) {
    if (awaited == nullptr) {
        return;
    }
    if (compiler == nullptr) {
        compiler = std::make_unique<PipelineCompiler>(*device);
    }
    if (compiler->busy()) {
        return;
    }
    try {
        if (is_ready(frame)) {
            set(std::exchange(awaited, nullptr));
        }
    } catch (const MissingShader& missing) {
        failed = missing_from(*std::exchange(awaited, nullptr), missing);
    } catch (const Error& error) {
        failed = error.what();
        awaited.reset();
    }
}

Result<Done> Shadows::prepare_recipe(const std::string& recipe) noexcept {
    return guarded<Done>([&] {
        state_->await(state_->load(recipe));
        return Done{};
    });
}

Preparation Shadows::preparation() const noexcept {
    const auto asked = guarded<Preparation>([&] {
        const PreparedRecipe* awaited = state_->awaited.get();
        return Preparation{awaited != nullptr ? text_of(awaited->recipe()) : "", state_->failed};
    });
    return asked.ok() ? asked.value() : Preparation{};
}

}  // namespace gn::embed
