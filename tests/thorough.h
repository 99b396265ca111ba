// SPDX-License-Identifier: MIT
// How much of a long sweep runs: what fits into every change, or all of it.
#pragma once

#include "shadow/recipe/recipe.h"

#include <cstdlib>
#include <string>
#include <vector>

namespace gn::test {

/// Whether GNOMON_THOROUGH is set, as `make measure` does. Without it a sweep looks at each of its rows once, and leaves
/// their combinations out.
inline bool thorough() {
    return std::getenv("GNOMON_THOROUGH") != nullptr;
}

/// Whether this suite is built with the address sanitizer, under which the processor's half costs several times as much.
#ifdef __SANITIZE_ADDRESS__
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

/// Every shipped recipe; with sanitizers every fourth, since the sweep over parameters draws each of them there.
inline std::vector<std::string> drawn_recipes() {
    std::vector<std::string> names = recipe_names();
    if (sanitized && !thorough()) {
        std::size_t i = 0;
        std::erase_if(names, [&](const std::string&) { return i++ % 4 != 0; });
    }
    return names;
}

}  // namespace gn::test
