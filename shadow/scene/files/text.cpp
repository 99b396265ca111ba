// SPDX-License-Identifier: MIT
#include "shadow/scene/files/text.h"

#include <algorithm>
#include <charconv>

namespace gn {

namespace {

void append_utf8(std::string& out, std::uint32_t code) {
    const auto put = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
    if (code < 0x80) {
        put(code);
    } else if (code < 0x800) {
        put(0xC0U | (code >> 6U));
        put(0x80U | (code & 0x3FU));
    } else if (code < 0x10000) {
        put(0xE0U | (code >> 12U));
        put(0x80U | ((code >> 6U) & 0x3FU));
        put(0x80U | (code & 0x3FU));
    } else {
        put(0xF0U | (code >> 18U));
        put(0x80U | ((code >> 12U) & 0x3FU));
        put(0x80U | ((code >> 6U) & 0x3FU));
        put(0x80U | (code & 0x3FU));
    }
}

std::string from_utf16(std::span<const std::byte> bytes, bool big_endian) {
    const auto unit = [&](std::size_t i) {
        const auto first = static_cast<std::uint32_t>(bytes[i]);
        const auto second = static_cast<std::uint32_t>(bytes[i + 1]);
        return big_endian ? (first << 8U) | second : (second << 8U) | first;
    };
    std::string text;
    text.reserve(bytes.size() / 2);
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
        // A high surrogate takes the low one after it; a lone one becomes the replacement character.
        std::uint32_t code = unit(i);
        const bool high = code >= 0xD800 && code < 0xDC00;
        if (high && i + 3 < bytes.size() && unit(i + 2) >= 0xDC00 && unit(i + 2) < 0xE000) {
            code = 0x10000U + ((code - 0xD800U) << 10U) + (unit(i + 2) - 0xDC00U);
            i += 2;
        } else if (code >= 0xD800 && code < 0xE000) {
            code = 0xFFFD;
        }
        append_utf8(text, code);
    }
    return text;
}

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\r' || c == '\n';
}

}  // namespace

std::string decode_text(std::span<const std::byte> bytes) {
    const auto starts = [&](unsigned a, unsigned b) {
        return bytes.size() >= 2 && bytes[0] == std::byte(a) && bytes[1] == std::byte(b);
    };
    std::string text;
    if (starts(0xFE, 0xFF) || starts(0xFF, 0xFE)) {
        text = from_utf16(bytes.subspan(2), starts(0xFE, 0xFF));
    } else {
        const std::size_t mark = starts(0xEF, 0xBB) && bytes.size() >= 3 && bytes[2] == std::byte{0xBF} ? 3 : 0;
        text.assign(reinterpret_cast<const char*>(bytes.data()) + mark, bytes.size() - mark);
    }
    std::replace(text.begin(), text.end(), '\0', ' ');
    return text;
}

bool Lines::next(std::string_view& line) {
    joined_.clear();
    bool joining = false;
    while (!rest_.empty()) {
        const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
        std::string_view part = rest_.substr(0, end);
        const bool crlf = rest_.substr(end, 2) == "\r\n";
        rest_.remove_prefix(std::min(rest_.size(), end + (crlf ? 2 : 1)));
        if (!part.empty() && part.back() == '\\') {
            joined_.append(part.substr(0, part.size() - 1)).push_back(' ');
            joining = true;
            continue;
        }
        if (joining) {
            joined_.append(part);
        }
        line = joining ? std::string_view(joined_) : part;
        return true;
    }
    line = joined_;
    return joining;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_space(text.front())) {
        text.remove_prefix(1);
    }
    while (!text.empty() && is_space(text.back())) {
        text.remove_suffix(1);
    }
    return text;
}

std::string_view take_word(std::string_view& line) {
    const auto* const begin = std::find_if_not(line.begin(), line.end(), is_space);
    const auto* const end = std::find_if(begin, line.end(), is_space);
    const std::string_view word(begin, static_cast<std::size_t>(end - begin));
    line.remove_prefix(static_cast<std::size_t>(end - line.begin()));
    return word;
}

std::optional<double> leading_number(std::string_view word) {
    word.remove_prefix(!word.empty() && word.front() == '+' ? 1 : 0);
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() ? std::optional(value) : std::nullopt;
}

}  // namespace gn
