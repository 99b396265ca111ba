// SPDX-License-Identifier: MIT
// A fast 128-bit fingerprint for cache keys: sources, pipeline descriptions. Not cryptographic.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace gn {

struct Fingerprint {
    std::uint64_t low = 0, high = 0;
    auto operator<=>(const Fingerprint&) const = default;  // NOLINT(modernize-use-nullptr): of the default itself
    /// 32 hexadecimal digits.
    [[nodiscard]] std::string hex() const;
};

/// Two independent lanes, eight bytes a step; every field carries its length, so that neighbours cannot blend.
class Hasher {
  public:
    Hasher& bytes(const void* data, std::size_t count) {
        const auto* p = static_cast<const unsigned char*>(data);
        absorb(count);
        for (; count >= 8; p += 8, count -= 8) {
            std::uint64_t word = 0;
            std::memcpy(&word, p, 8);
            absorb(word);
        }
        std::uint64_t tail = 0;
        if (count > 0) {
            std::memcpy(&tail, p, count);
        }
        absorb(tail);
        return *this;
    }
    Hasher& text(std::string_view value) { return bytes(value.data(), value.size()); }
    template <class T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T> Hasher& value(T v) {
        std::uint64_t word = 0;
        std::memcpy(&word, &v, sizeof(T));
        absorb(word);
        return *this;
    }
    [[nodiscard]] Fingerprint finish() const { return {mix(a_, 0x9E3779B97F4A7C15U), mix(b_, 0xD6E8FEB86659FD93U)}; }

  private:
    __extension__ using Wide = unsigned __int128;
    static std::uint64_t mix(std::uint64_t x, std::uint64_t y) {
        const Wide product = static_cast<Wide>(x ^ 0xA0761D6478BD642FU) * (y ^ 0xE7037ED1A0B428DBU);
        return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64U);
    }
    void absorb(std::uint64_t word) {
        a_ = mix(a_ + 0x8EBC6AF09C88C6E3U, word);
        b_ = mix(b_ ^ 0x589965CC75374CC3U, word + 0x1D8E4E27C47D124FU) + word;
    }
    std::uint64_t a_ = 0x2D358DCCAA6C78A5U, b_ = 0x8BB84B93962EACC9U;
};

inline std::string Fingerprint::hex() const {
    static constexpr char digits[] = "0123456789abcdef";
    std::string text(32, '0');
    for (unsigned i = 0; i < 32; ++i) {
        const std::uint64_t word = i < 16 ? high : low;
        text[i] = digits[(word >> (4U * (15U - i % 16U))) & 0xFU];
    }
    return text;
}

}  // namespace gn
