// SPDX-License-Identifier: MIT
// Comma-separated values, RFC 4180.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gn {

/// A field, quoted where it must be. One that a spreadsheet would take for a formula has an apostrophe before it; numbers have
/// none.
std::string csv_field(std::string_view text);
/// Fields with commas between and a line's end.
std::string csv_line(const std::vector<std::string>& fields);

}  // namespace gn
