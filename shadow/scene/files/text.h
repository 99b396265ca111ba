// SPDX-License-Identifier: MIT
// Line-oriented text files (OBJ, MTL): decoded, cut into words, never longer than the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gn {

/// UTF-8 text of a file that may be UTF-8 or UTF-16 with a byte order mark. NULs become spaces.
std::string decode_text(std::span<const std::byte> bytes);

/// Hands out logical lines: CRLF, LF or CR ends one, a backslash before the end joins it with the next.
class Lines {
  public:
    explicit Lines(std::string_view text) : rest_(text) {}
    /// False at the end. The view holds until the next call.
    bool next(std::string_view& line);

  private:
    std::string_view rest_;
    std::string joined_;
};

/// Takes the next word off `line`; empty at its end.
std::string_view take_word(std::string_view& line);
std::string_view trimmed(std::string_view text);

/// The number at the start of a word ("+1", "2.", "1E2"; what follows it is ignored); nothing where there is none.
std::optional<double> leading_number(std::string_view word);

}  // namespace gn
