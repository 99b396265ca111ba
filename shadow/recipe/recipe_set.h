// SPDX-License-Identifier: MIT
// One key of a recipe and its value, as files and overrides give them.
#pragma once

#include "shadow/recipe/recipe.h"

namespace gn {

/// The rows of GnBias with these values for defaults.
ParamTable bias_table(const GnBias& bias);
/// The text without blanks around it.
std::string_view without_blanks(std::string_view text);
/// Sets a top-level key; false when there is no such key. Throws Error naming `where`, the key, and what would be valid.
bool set_top_level(Recipe& recipe, std::string_view key, std::string_view value, const std::string& where);
/// Sets group.name: a part's parameter, or one of the bias. Throws Error likewise.
void set_group(Recipe& recipe, std::string_view group, std::string_view name, std::string_view value,
               const std::string& where);
[[noreturn]] void fail_unknown_key(const Recipe& recipe, std::string_view key, const std::string& where);

}  // namespace gn
