// SPDX-License-Identifier: MIT
// Vectors, boxes and the conventions of spaces (docs/spaces.md has the whole story).
//
// Every vector's name ends in its space: _ws world, _vs view (the camera's), _ls light, _cs clip, _ts texture of a
// shadow map, _ss screen. Matrices chain: `p_cs = cs_from_vs * vs_from_ws * p_ws`. Metres, right-handed, +y up.
// Clip space is Vulkan's: y down, z in [0, w].
#pragma once

#include "base/shared.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace gn {

using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

inline constexpr float pi = std::numbers::pi_v<float>;

/// An axis-aligned box; empty (min > max) until grown.
struct Box {
    vec3 min{std::numeric_limits<float>::max()};
    vec3 max{std::numeric_limits<float>::lowest()};

    [[nodiscard]] bool empty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
    [[nodiscard]] vec3 centre() const { return 0.5F * (min + max); }
    [[nodiscard]] vec3 extent() const { return max - min; }
    [[nodiscard]] float diagonal() const { return empty() ? 0.0F : glm::length(extent()); }
    void grow(vec3 p) {
        min = glm::min(min, p);
        max = glm::max(max, p);
    }
    void grow(const Box& b) {
        min = glm::min(min, b.min);
        max = glm::max(max, b.max);
    }
    [[nodiscard]] bool contains(vec3 p) const {
        return glm::all(glm::lessThanEqual(min, p)) && glm::all(glm::lessThanEqual(p, max));
    }
    /// The eight corners; bit 0 of the index chooses x, bit 1 y, bit 2 z.
    [[nodiscard]] std::array<vec3, 8> corners() const {
        std::array<vec3, 8> c{};
        for (unsigned i = 0; i < 8; ++i) {
            c[i] = vec3((i & 1U) != 0U ? max.x : min.x, (i & 2U) != 0U ? max.y : min.y, (i & 4U) != 0U ? max.z : min.z);
        }
        return c;
    }
};

/// Two unit vectors that complete the unit vector `n` to a right-handed frame (x, y, n).
/// Duff et al. Building an Orthonormal Basis, Revisited. JCGT 2017. [DBC+17]
inline void complete_frame(vec3 n, vec3& x, vec3& y) {
    const float sign = std::copysign(1.0F, n.z);
    const float a = -1.0F / (sign + n.z);
    const float b = n.x * n.y * a;
    x = vec3(1.0F + sign * n.x * n.x * a, sign * b, -sign * n.x);
    y = vec3(b, sign + n.y * n.y * a, -n.y);
}

inline bool finite(vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace gn
