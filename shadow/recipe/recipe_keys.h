// SPDX-License-Identifier: MIT
// Which keys a recipe can use, asked when all of them are known: a key that changes nothing is a mistake of its writer.
#pragma once

#include "shadow/recipe/recipe.h"

namespace gn {

/// A key that was set: "placement" or "resolution" with an empty group, "bias" "normal", "pcf" "size".
struct RecipeKey {
    std::string group, name;
    [[nodiscard]] std::string text() const { return group.empty() ? name : group + "." + name; }
};

/// Throws Error naming all of `keys` that no part of the recipe reads, the parts, and the keys that they read.
void check_keys(const Recipe& recipe, std::span<const RecipeKey> keys, const std::string& where);

}  // namespace gn
