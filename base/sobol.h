// SPDX-License-Identifier: MIT
// Based on: Brent Burley. Practical Hash-based Owen Scrambling. JCGT 2020. [Bur20]
//
// Based on: Nathan Vegdahl. Building a Better LK Hash. psychopath.io 2021. [Veg21]
//
// The first two dimensions of the Sobol sequence, scrambled by nested uniform (Owen) scrambling. Everything happens on
// bit-reversed words: there the most significant digit is bit 0, and a carry of an addition or multiplication runs from
// a digit to the finer ones only, which is what nested scrambling asks for (section 3).
#pragma once

#include "base/math.h"

#include <cstdint>
#include <vector>

namespace gn {

/// Owen-scrambled Sobol point i of the 2D sequence with this seed, in [0,1)^2.
vec2 sobol_owen(uint i, uint seed);

namespace sobol {

/// Bits in opposite order.
inline std::uint32_t reverse_bits(std::uint32_t x) {
    x = ((x & 0x55555555U) << 1U) | ((x >> 1U) & 0x55555555U);
    x = ((x & 0x33333333U) << 2U) | ((x >> 2U) & 0x33333333U);
    x = ((x & 0x0F0F0F0FU) << 4U) | ((x >> 4U) & 0x0F0F0F0FU);
    x = ((x & 0x00FF00FFU) << 8U) | ((x >> 8U) & 0x00FF00FFU);
    return (x << 16U) | (x >> 16U);
}

/// Scrambles a bit-reversed coordinate: digit k is flipped or not by a hash of the coarser digits and the seed.
/// [Bur20, section 3] with the multipliers of [Veg21].
inline std::uint32_t scramble_reversed(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3D20ADEAU;
    x += seed;
    x *= (seed >> 16U) | 1U;
    x ^= x * 0x05526C56U;
    x ^= x * 0x53A22864U;
    return x;
}

/// Decorrelates integers: every output bit depends on every bit of both inputs.
inline std::uint32_t mix(std::uint32_t a, std::uint32_t b) {
    std::uint64_t x = (static_cast<std::uint64_t>(a) << 32U | b) + 0x9E3779B97F4A7C15ULL;
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
    return static_cast<std::uint32_t>((x ^ (x >> 31U)) >> 32U);
}

/// In [0,1): the 24 leading digits, so that the conversion is exact.
inline float unit_from_reversed(std::uint32_t x) {
    return static_cast<float>(reverse_bits(x) >> 8U) * 0x1p-24F;
}

/// Coordinate 1 of point i, bit-reversed (coordinate 0 is i itself).
std::uint32_t second_reversed(std::uint32_t i);
/// Coordinate 1 of the first `count` points, bit-reversed.
std::vector<std::uint32_t> second_reversed_table(std::uint32_t count);

/// The two seeds of one scramble.
struct Seeds {
    std::uint32_t first, second;
    explicit Seeds(std::uint32_t seed) : first(mix(seed, 0x5851F42DU)), second(mix(seed, 0x14057B7EU)) {}
};

}  // namespace sobol
}  // namespace gn
