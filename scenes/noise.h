// SPDX-License-Identifier: MIT
// Deterministic randomness for generated scenes: the same bits on every machine.
#pragma once

#include <cstdint>

namespace gn::scenes {

/// A sequence of floats in [0,1) from a 32-bit seed (PCG output function over a counter).
class Dice {
  public:
    explicit Dice(std::uint32_t seed) : state_(seed * 747796405U + 2891336453U) {}
    float unit() { return static_cast<float>(next() >> 8U) * 0x1p-24F; }
    float between(float low, float high) { return low + (high - low) * unit(); }

  private:
    std::uint32_t next() {
        state_ = state_ * 747796405U + 2891336453U;
        const std::uint32_t word = ((state_ >> ((state_ >> 28U) + 4U)) ^ state_) * 277803737U;
        return (word >> 22U) ^ word;
    }
    std::uint32_t state_;
};

/// Smooth noise in [0,1] on a lattice that repeats after `period` cells.
float value_noise(float x, float y, int period, std::uint32_t seed);
/// Octaves of it, each half as strong and twice as fine as the one before.
float fractal_noise(float x, float y, int period, int octaves, std::uint32_t seed);

}  // namespace gn::scenes
