// SPDX-License-Identifier: MIT
// Values of a TOML file as one would type them.
#pragma once

#define TOML_HEADER_ONLY 1
#include <fmt/format.h>
#include <toml++/toml.h>

#include <optional>
#include <string>

namespace gn {

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
