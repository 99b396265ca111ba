// SPDX-License-Identifier: MIT
// Files that the command writes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace gn {

/// Throws InputError when `path` (may be empty) cannot be written because its folder does not exist or is not
/// writable, or because it is a folder itself. `option` names the option for the sentence.
void check_writable_parent(std::string_view option, const std::filesystem::path& path);

/// Writes through a temporary name, so that a reader never sees half a file. Throws Error.
void write_text(const std::filesystem::path& path, std::string_view text);

/// Throws Error when the file cannot be read.
std::string read_text(const std::filesystem::path& path);

/// Letters, digits and single dashes, lower case, at most 40: for file names and channel names.
std::string slug(std::string_view text);

/// The word as it is typed into a POSIX shell: quoted only where it must be.
std::string shell_word(std::string_view word);

}  // namespace gn
