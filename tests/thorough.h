// SPDX-License-Identifier: MIT
// How much of a long sweep runs: what fits into every change, or all of it.
#pragma once

#include <cstdlib>
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

/// What a suite goes through: all of it, or every fourth with sanitizers, to which another figure tells nothing new.
template <class T>
std::vector<T> picked(std::vector<T> all) {
    if (sanitized && !thorough()) {
        std::size_t i = 0;
        std::erase_if(all, [&](const T&) { return i++ % 4 != 0; });
    }
    return all;
}

}  // namespace gn::test
