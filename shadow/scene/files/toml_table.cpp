// SPDX-License-Identifier: MIT
#include "shadow/scene/files/toml_table.h"

#include <algorithm>

namespace gn {

void TomlTable::check_keys(std::span<const std::string_view> known) const {
    for (const auto& [key, node] : table_) {
        if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
            fail("{}: unknown key '{}'; known are {}", where_, clean_text(key.str()), fmt::join(known, ", "));
        }
    }
}

std::string TomlTable::text(std::string_view key, std::string otherwise) const {
    if (!has(key)) {
        return otherwise;
    }
    const auto* value = table_.get_as<std::string>(key);
    if (value == nullptr) {
        wrong(key, "a string");
    }
    return value->get();
}

double TomlTable::number(std::string_view key, double otherwise) const {
    if (!has(key)) {
        return otherwise;
    }
    const std::optional<double> value = table_.get(key)->value<double>();
    if (!value || !std::isfinite(*value) || std::abs(*value) > 1e30) {
        wrong(key, "a finite number");
    }
    return *value;
}

bool TomlTable::flag(std::string_view key) const {
    const auto* value = table_.get_as<bool>(key);
    if (value == nullptr) {
        wrong(key, "true or false");
    }
    return value->get();
}

std::optional<std::vector<double>> TomlTable::numbers(std::string_view key, std::size_t count) const {
    if (!has(key)) {
        return std::nullopt;
    }
    const toml::array* array = table_.get_as<toml::array>(key);
    const std::string expected = fmt::format("a list of {} finite numbers", count);
    if (array == nullptr || array->size() != count) {
        wrong(key, expected);
    }
    std::vector<double> values;
    for (const toml::node& node : *array) {
        const std::optional<double> value = node.value<double>();
        if (!value || !std::isfinite(*value) || std::abs(*value) > 1e30) {
            wrong(key, expected);
        }
        values.push_back(*value);
    }
    return values;
}

dvec3 TomlTable::vector(std::string_view key, dvec3 otherwise) const {
    const auto values = numbers(key, 3);
    return values ? dvec3((*values)[0], (*values)[1], (*values)[2]) : otherwise;
}

std::optional<TomlTable> TomlTable::inner(std::string_view key) const {
    if (!has(key)) {
        return std::nullopt;
    }
    const toml::table* table = table_.get_as<toml::table>(key);
    if (table == nullptr) {
        wrong(key, fmt::format("a table, written [{}]", key));
    }
    return TomlTable(*table, fmt::format("{}: [{}]", where_, key));
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
    std::vector<TomlTable> found;
    if (!has(key)) {
        return found;
    }
    const toml::array* array = table_.get_as<toml::array>(key);
    if (array == nullptr) {
        wrong(key, fmt::format("a list of tables, written [[{}]]", key));
    }
    for (std::size_t i = 0; i < array->size(); ++i) {
        const toml::table* table = (*array)[i].as_table();
        if (table == nullptr) {
            wrong(key, fmt::format("a list of tables, written [[{}]]", key));
        }
        found.emplace_back(*table, fmt::format("{}: [[{}]] {}", where_, key, i + 1));
    }
    return found;
}

}  // namespace gn
