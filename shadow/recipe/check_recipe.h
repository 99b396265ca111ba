// SPDX-License-Identifier: MIT
// What is said of a recipe before anything is drawn, beside check_recipe (shadow/recipe/recipe.h).
#pragma once

#include "shadow/recipe/recipe.h"

namespace gn {

/// Throws Error when a map stands without a lookup, a lookup without a map, or what changes V without anything that makes
/// one: no scene can be drawn with it.
void check_complete(const Recipe& recipe);

/// Whether a direct part stands beside a map.
bool has_both(const Recipe& recipe);
/// Throws Error where a combination is named and there is nothing to combine. `where` names the source.
void check_combine(const Recipe& recipe, const std::string& where);

/// The sentence why the lookup cannot read the map, whatever the scene, or "".
std::string stages_misfit(const Recipe& recipe);

/// One sentence on the scene's lights that the named placement does not serve and another one places, or "".
std::string placement_remark(const Recipe& recipe, const Scene& scene);

}  // namespace gn
