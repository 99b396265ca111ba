// SPDX-License-Identifier: MIT
// A recipe as it is written, "pcf,resolution=2048,pcf.taps=25", key by key: what sliders change.
#pragma once

#include "shadow/recipe/recipe.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gn {

struct RecipeText {
    std::string base;                                              ///< a name or a file
    std::vector<std::pair<std::string, std::string>> overrides{};  ///< each key once, in the order in which they came

    static RecipeText parse(std::string_view text);
    [[nodiscard]] std::string text() const;
    /// Gives a key another value.
    void set(std::string_view key, std::string value);
    void drop(std::string_view key);
};

/// What a key of a recipe has for its value now: "map", "pcf.size", "bias.normal", "resolution".
std::string value_of(const Recipe& recipe, std::string_view key);

/// The text with a key at another value, loaded. Where a part goes, the parameters that no part reads any more go too. Throws
/// Error where there is no such recipe.
struct ChangedRecipe {
    RecipeText text;
    Recipe recipe;
};
ChangedRecipe change_recipe(const RecipeText& text, std::string_view key, const std::string& value);

/// The parts that draw a light's shadow with a recipe, those that stand in for a placement included; each once.
std::vector<const Part*> serving_parts(const Recipe& recipe, std::span<const Light> lights);

}  // namespace gn
