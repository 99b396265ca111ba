// SPDX-License-Identifier: MIT
#include "base/sobol.h"

#include <array>

namespace gn {
namespace sobol {
namespace {

/// Direction numbers of the second dimension: primitive polynomial x + 1, so every column is the last one plus itself
/// shifted by a digit (Pascal's triangle modulo 2); reversed like the coordinates.
constexpr std::array<std::uint32_t, 32> reversed_directions() {
    std::array<std::uint32_t, 32> columns{};
    std::uint32_t column = 1;
    for (std::uint32_t& c : columns) {
        c = column;
        column ^= column << 1U;
    }
    return columns;
}

constexpr std::array<std::uint32_t, 32> columns_reversed = reversed_directions();

}  // namespace

std::uint32_t second_reversed(std::uint32_t i) {
    std::uint32_t x = 0;
    for (std::size_t digit = 0; i != 0; ++digit, i >>= 1U) {
        x ^= (i & 1U) != 0U ? columns_reversed[digit] : 0U;
    }
    return x;
}

std::vector<std::uint32_t> second_reversed_table(std::uint32_t count) {
    std::vector<std::uint32_t> table(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        table[i] = second_reversed(i);
    }
    return table;
}

}  // namespace sobol

vec2 sobol_owen(uint i, uint seed) {
    const sobol::Seeds seeds(seed);
    return {sobol::unit_from_reversed(sobol::scramble_reversed(i, seeds.first)),
            sobol::unit_from_reversed(sobol::scramble_reversed(sobol::second_reversed(i), seeds.second))};
}

}  // namespace gn
