// SPDX-License-Identifier: MIT
// A recipe that changes while frames go on: a thread makes what the new one binds (gpu/pipeline_compiler.h).
#include "apps/view/viewport.h"
#include "shadow/recipe/check_recipe.h"

#include <chrono>
#include <thread>

namespace gn {

void LiveRecipe::ask(const RecipeText& text) {
    ask(text, load_recipe(text.text()));
}

void LiveRecipe::ask(const RecipeText& text, Recipe recipe) {
    check_complete(recipe);
    if (const std::string sentence = stages_misfit(recipe); !sentence.empty()) {
        fail("-r {}: {}", text.text(), sentence);
    }
    text_ = text;
    awaited_ = std::make_shared<const PreparedRecipe>(device_, std::move(recipe));
}

void LiveRecipe::forget() {
    history_ = std::make_shared<History>(device_);
}

void LiveRecipe::take(PipelineCompiler& compiler,
                      const std::function<void(FrameGraph&, const PreparedRecipe&, History&)>& declare) {
    // The second frame may bind other pipelines: it finds what the first one left.
    const auto ready = [&] {
        History history(device_);
        for (int i = 0; i < 2; ++i) {
            FrameGraph graph(device_);
            declare(graph, *awaited_, history);
            if (!compiler.ready(graph)) {
                return false;
            }
            history.advance();
        }
        return true;
    };
    while (awaited_ != nullptr) {
        try {
            if (!compiler.busy() && ready()) {
                now_ = std::exchange(awaited_, nullptr);
                forget();
            }
        } catch (...) {
            awaited_.reset();
            throw;
        }
        if (now_ != nullptr) {
            return;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

}  // namespace gn
