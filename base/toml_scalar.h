// SPDX-License-Identifier: MIT
// Keys of a TOML file, and values as one would type them.
#pragma once

#include "base/error.h"
#include "base/param.h"

#define TOML_HEADER_ONLY 1
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>

namespace gn {

/// The keys of a table are all among the known ones. Throws Error naming `where`, the key, and what comes near.
inline void check_toml_keys(const toml::table& table, std::span<const std::string_view> known,
                            const std::string& where) {
    for (const auto& [key, node] : table) {
        if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
            fail("{}: unknown key '{}'; {}", where, key.str(), suggest(key.str(), known));
        }
    }
}

/// A text, a whole number, a number, true or false; unset for lists, tables and dates.
inline std::optional<std::string> scalar_text(const toml::node& node) {
    if (const auto* text = node.as_string()) {
        return text->get();
    }
    if (const auto* integer = node.as_integer()) {
        return fmt::format("{}", integer->get());
    }
    if (const auto* real = node.as_floating_point()) {
        return fmt::format("{}", real->get());
    }
    if (const auto* boolean = node.as_boolean()) {
        return boolean->get() ? "true" : "false";
    }
    return {};
}

}  // namespace gn
