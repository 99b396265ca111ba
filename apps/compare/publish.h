// SPDX-License-Identifier: MIT
// Results out of the door: table, JSON, report.
#pragma once

#include "apps/compare/result.h"

#include <filesystem>
#include <string>

namespace gn {

/// Puts `value` where `text` says `{{name}}`.
void fill_in(std::string& text, const std::string& name, const std::string& value);
/// JSON that may stand inside a script element: no text in it can end the element.
std::string for_script_element(std::string json);

/// Throws InputError where DIR could not be made or written to. Touches nothing.
void check_report(const std::filesystem::path& folder);
/// Makes DIR with its folders and what the report always needs. Throws InputError when it cannot be written.
void prepare_report(const std::filesystem::path& folder);
/// Writes DIR/index.html, complete in itself but for the pictures beside it. Throws Error.
void write_report(const std::filesystem::path& folder, const Comparison& comparison);
/// The figures as a table for a terminal.
std::string summary_table(const Comparison& comparison);

}  // namespace gn
