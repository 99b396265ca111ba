// SPDX-License-Identifier: MIT
#include "base/param.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace gn {
namespace {

/// Levenshtein's distance, for suggestions.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
        }
    }
    return row.back();
}

double parse_number(std::string_view text, std::string_view name, std::string_view where) {
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
        fail("{}: '{}' is not a number for {}", where, text, name);
    }
    return value;
}

int parse_choice(const ParamRow& row, std::string_view text, std::string_view where) {
    const auto found = std::find(row.choices.begin(), row.choices.end(), text);
    if (found == row.choices.end()) {
        fail("{}: '{}' is not a value of {}; {}", where, text, row.name, suggest(text, row.choices));
    }
    return static_cast<int>(found - row.choices.begin());
}

int parse_boolean(const ParamRow& row, std::string_view text, std::string_view where) {
    if (text == "true" || text == "on" || text == "1") {
        return 1;
    }
    if (text == "false" || text == "off" || text == "0") {
        return 0;
    }
    fail("{}: '{}' is not a value of {}; valid are true and false", where, text, row.name);
}

}  // namespace

const ParamRow* ParamTable::find(std::string_view name) const {
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const ParamRow& row) { return row.name == name; });
    return found == rows.end() ? nullptr : &*found;
}

std::string ParamTable::names() const {
    std::string list;
    for (const ParamRow& row : rows) {
        list += list.empty() ? "" : ", ";
        list += row.name;
    }
    return list;
}

void ParamBlock::set(std::string_view name, std::string_view value, std::string_view where) {
    const ParamRow* row = table_ != nullptr ? table_->find(name) : nullptr;
    if (row == nullptr) {
        std::vector<std::string_view> known;
        for (const ParamRow& r : table_ != nullptr ? table_->rows : std::vector<ParamRow>{}) {
            known.push_back(r.name);
        }
        fail("{}: unknown parameter '{}'; {}", where, name, suggest(name, known));
    }
    std::byte* field = bytes_.data() + row->offset;
    if (row->type == ParamType::choice || row->type == ParamType::boolean) {
        const int index =
            row->type == ParamType::choice ? parse_choice(*row, value, where) : parse_boolean(*row, value, where);
        std::memcpy(field, &index, sizeof index);
        return;
    }
    const double number = parse_number(value, name, where);
    const bool whole = row->type != ParamType::integer || std::floor(number) == number;
    if (!whole || number < row->min || number > row->max) {
        fail("{}: {} = {} is out of range; valid is {}{} to {}{}", where, name, value,
             row->type == ParamType::integer ? "a whole number from " : "", row->min, row->max,
             row->unit.empty() ? "" : fmt::format(" {}", row->unit));
    }
    if (row->type == ParamType::integer) {
        const int integer = static_cast<int>(number);
        std::memcpy(field, &integer, sizeof integer);
    } else {
        const auto real = static_cast<float>(number);
        std::memcpy(field, &real, sizeof real);
    }
}

std::string ParamBlock::get(std::string_view name) const {
    const ParamRow* row = table_ != nullptr ? table_->find(name) : nullptr;
    GN_CHECK(row != nullptr);
    int integer = 0;
    float real = 0;
    std::memcpy(&integer, bytes_.data() + row->offset, sizeof integer);
    std::memcpy(&real, bytes_.data() + row->offset, sizeof real);
    switch (row->type) {
        case ParamType::integer: return fmt::format("{}", integer);
        case ParamType::real: return fmt::format("{}", real);
        case ParamType::boolean: return integer != 0 ? "true" : "false";
        case ParamType::choice: return std::string(row->choices.at(static_cast<std::size_t>(integer)));
    }
    return {};
}

std::string suggest(std::string_view wrong, std::span<const std::string_view> known) {
    if (known.empty()) {
        return "there are none to choose from";
    }
    const auto nearest = std::min_element(known.begin(), known.end(), [&](std::string_view a, std::string_view b) {
        return edit_distance(wrong, a) < edit_distance(wrong, b);
    });
    std::string sentence;
    if (edit_distance(wrong, *nearest) <= 2) {
        sentence = fmt::format("did you mean '{}'? ", *nearest);
    }
    sentence += "valid names are ";
    for (std::size_t i = 0; i < known.size(); ++i) {
        sentence += fmt::format("{}{}", i == 0 ? "" : ", ", known[i]);
    }
    return sentence;
}

}  // namespace gn
