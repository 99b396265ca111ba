// SPDX-License-Identifier: MIT
// A recipe made ready for one device: what its frames share and make once. Prepare it once, record many frames with it. What
// only changes a value that shaders are given, prepares anew without making anything on the device: pipelines are the
// device's own, by what they are made of.
#pragma once

#include "base/kept.h"
#include "gpu/pipeline.h"
#include "shadow/recipe/recipe.h"

namespace gn {

class PreparedRecipe {
  public:
    PreparedRecipe(Device& device, Recipe recipe) : device_(device), recipe_(std::move(recipe)) {}
    PreparedRecipe(const PreparedRecipe&) = delete;
    PreparedRecipe& operator=(const PreparedRecipe&) = delete;

    [[nodiscard]] Device& device() const { return device_; }
    [[nodiscard]] const Recipe& recipe() const { return recipe_; }

    /// What `make` gives, kept by a name and a key that say all, beside the recipe and the device, that it depends on. One
    /// name means one type. Not thread-safe, as recording is not.
    template <class Make>
    auto once(std::string_view name, std::uint64_t key, Make make) const {
        return made_.get(0, name, key, std::move(make));
    }

  private:
    Device& device_;
    Recipe recipe_;
    mutable Kept made_;
};

/// The same for a frame that may have been given no prepared recipe: then it is made on the spot.
template <class Make>
auto made_once(const PreparedRecipe* prepared, std::string_view name, std::uint64_t key, Make make) {
    return prepared != nullptr ? prepared->once(name, key, std::move(make))
                               : std::make_shared<const std::invoke_result_t<Make>>(make());
}

/// A compute shader of this name, of the text that `text` composes where there is none with this key yet.
template <class MakeText>
std::shared_ptr<const ComputeDesc> compute_once(const PreparedRecipe* prepared, std::string_view name,
                                                const Hasher& key, MakeText text) {
    return made_once(prepared, name, key.finish().low, [&] {
        return sealed(ComputeDesc{{ShaderKind::compute, std::string(name), text()}, {}});
    });
}

}  // namespace gn
