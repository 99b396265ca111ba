// SPDX-License-Identifier: MIT
// Reading the tables of a .toml scene: typed, finite, with the place and the known keys in every error.
#pragma once

#include "base/error.h"
#include "base/math.h"
#include "shadow/scene/files/files.h"

#include <toml++/toml.h>

#include <optional>

namespace gn {

class TomlTable {
  public:
    /// `where` is shown in errors: "scene.toml: [[light]] 2".
    TomlTable(const toml::table& table, std::string where) : table_(table), where_(std::move(where)) {}

    /// Throws Error for any key that is not in `known`.
    void check_keys(std::span<const std::string_view> known) const;

    [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }
    [[nodiscard]] bool is_list(std::string_view key) const { return table_.get_as<toml::array>(key) != nullptr; }
    [[nodiscard]] std::string text(std::string_view key, std::string otherwise) const;
    [[nodiscard]] double number(std::string_view key, double otherwise) const;
    /// True or false; the key is there.
    [[nodiscard]] bool flag(std::string_view key) const;
    /// `count` numbers.
    [[nodiscard]] std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count) const;
    [[nodiscard]] dvec3 vector(std::string_view key, dvec3 otherwise) const;
    /// The table [key] inside this one; nothing where there is none.
    [[nodiscard]] std::optional<TomlTable> inner(std::string_view key) const;
    /// The tables of [[key]] inside this one.
    [[nodiscard]] std::vector<TomlTable> tables(std::string_view key) const;
    [[nodiscard]] const std::string& where() const { return where_; }
    /// Throws Error.
    [[noreturn]] void wrong(std::string_view key, std::string_view expected) const {
        fail("{}: key '{}' must be {}", where_, key, expected);
    }

  private:
    const toml::table& table_;
    std::string where_;
};

}  // namespace gn
