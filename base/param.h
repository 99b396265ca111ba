// SPDX-License-Identifier: MIT
// Parameters: a field in a shared struct (with its default) and a row that describes it. Command line, recipe files,
// manual pages, report and tests are derived from the rows.
#pragma once

#include "base/error.h"

#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace gn {

enum class ParamType { integer, real, boolean, choice };

/// One parameter. `choice` values are stored as the int index into `choices`; `boolean` as int 0 or 1.
struct ParamRow {
    std::string_view name;  ///< as users type it, without the part's id
    ParamType type = ParamType::real;
    std::size_t offset = 0;     ///< of the field in the struct
    double min = 0, max = 0;    ///< inclusive range
    std::string_view unit;      ///< "m", "texels", "rad", "" for plain numbers
    std::string_view sentence;  ///< the consequence of raising it, one sentence
    std::vector<std::string_view> choices{};
};

/// The rows of one struct with its default bytes. Make it with `param_table<GnPcfParams>({...})`.
struct ParamTable {
    std::vector<ParamRow> rows;
    std::vector<std::byte> defaults;

    [[nodiscard]] const ParamRow* find(std::string_view name) const;
    /// "radius, taps, kernel"
    [[nodiscard]] std::string names() const;
};

template <class Params>
ParamTable param_table(std::vector<ParamRow> rows) {
    static_assert(std::is_trivially_copyable_v<Params>);
    const Params defaults{};
    ParamTable table{std::move(rows), std::vector<std::byte>(sizeof(Params))};
    std::memcpy(table.defaults.data(), &defaults, sizeof(Params));
    return table;
}

/// A value of a table's struct, without its type.
class ParamBlock {
  public:
    ParamBlock() = default;
    explicit ParamBlock(const ParamTable& table) : bytes_(table.defaults), table_(&table) {}

    /// Sets one field from text. `where` names the source for the error sentence ("recipe pcf", "-r").
    /// Throws Error for unknown names (listing the known), values that do not parse, or values out of range.
    void set(std::string_view name, std::string_view value, std::string_view where);
    [[nodiscard]] std::string get(std::string_view name) const;
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }
    [[nodiscard]] const ParamTable* table() const { return table_; }

    template <class Params>
    [[nodiscard]] Params as() const {
        GN_CHECK_EQ(sizeof(Params), bytes_.size());
        Params params{};
        std::memcpy(&params, bytes_.data(), sizeof(Params));
        return params;
    }

  private:
    std::vector<std::byte> bytes_;
    const ParamTable* table_ = nullptr;
};

/// "valid names are a, b, c" with the nearest one suggested first, for error sentences.
std::string suggest(std::string_view wrong, std::span<const std::string_view> known);

}  // namespace gn

/// Describes one field: GN_PARAM(GnPcfParams, radius, real, 0, 64, "texels", "Wider penumbrae and more leaking.")
#define GN_PARAM(Struct, field, kind, low, high, unit_, sentence_)                            \
    gn::ParamRow {                                                                            \
#field, gn::ParamType::kind, offsetof(Struct, field), low, high, unit_, sentence_, {} \
    }
/// The same for a field that chooses by name: GN_CHOICE(GnPcfParams, kernel, "What the taps form.", "2x2", "3x3")
#define GN_CHOICE(Struct, field, sentence_, ...)                                       \
    gn::ParamRow {                                                                     \
#field, gn::ParamType::choice, offsetof(Struct, field), 0, 0, "", sentence_, { \
            __VA_ARGS__                                                                \
        }                                                                              \
    }
