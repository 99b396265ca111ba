// SPDX-License-Identifier: MIT
#include "shadow/scene/files/polygon.h"

#include <numeric>

namespace gn {

namespace {

// Newell's normal: twice the area, whatever the polygon's shape.
dvec3 newell_normal(std::span<const dvec3> corners) {
    dvec3 normal(0.0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        normal += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
    }
    return normal;
}

// Drops the axis along which the normal is longest, keeping the turn's sign.
std::vector<dvec2> project(std::span<const dvec3> corners, dvec3 normal) {
    const dvec3 size = glm::abs(normal);
    const int dropped = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int u = (dropped + 1) % 3;
    const int v = (dropped + 2) % 3;
    const double sign = normal[dropped] < 0.0 ? -1.0 : 1.0;
    std::vector<dvec2> flat;
    flat.reserve(corners.size());
    for (const dvec3& p : corners) {
        flat.emplace_back((p[u] - corners[0][u]) * sign, p[v] - corners[0][v]);
    }
    return flat;
}

double turn(dvec2 a, dvec2 b, dvec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool is_convex(const std::vector<dvec2>& p) {
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (turn(p[i], p[(i + 1) % p.size()], p[(i + 2) % p.size()]) < 0.0) {
            return false;
        }
    }
    return true;
}

bool is_ear(const std::vector<dvec2>& p, const std::vector<std::uint32_t>& ring, std::size_t at) {
    const std::size_t n = ring.size();
    const dvec2 a = p[ring[(at + n - 1) % n]];
    const dvec2 b = p[ring[at]];
    const dvec2 c = p[ring[(at + 1) % n]];
    if (turn(a, b, c) <= 0.0) {
        return false;
    }
    for (std::size_t i = 0; i < n; ++i) {
        const dvec2 q = p[ring[i]];
        const bool corner = q == a || q == b || q == c;
        if (!corner && turn(a, b, q) >= 0.0 && turn(b, c, q) >= 0.0 && turn(c, a, q) >= 0.0) {
            return false;
        }
    }
    return true;
}

}  // namespace

std::vector<uvec3> triangulate(std::span<const dvec3> corners) {
    constexpr std::size_t most_cut = 128;
    std::vector<uvec3> triangles;
    if (corners.size() < 3) {
        return triangles;
    }
    triangles.reserve(corners.size() - 2);
    std::vector<std::uint32_t> ring(corners.size());
    std::iota(ring.begin(), ring.end(), 0U);

    // Cut ears until a triangle or nothing that is an ear remains.
    if (corners.size() > 3 && corners.size() <= most_cut) {
        const std::vector<dvec2> flat = project(corners, newell_normal(corners));
        std::size_t at = 0;
        std::size_t refused = is_convex(flat) ? ring.size() : 0;
        while (ring.size() > 3 && refused < ring.size()) {
            if (!is_ear(flat, ring, at)) {
                ++refused;
                at = (at + 1) % ring.size();
                continue;
            }
            const std::size_t n = ring.size();
            triangles.emplace_back(ring[(at + n - 1) % n], ring[at], ring[(at + 1) % n]);
            ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
            at %= ring.size();
            refused = 0;
        }
    }
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
        triangles.emplace_back(ring[0], ring[i], ring[i + 1]);
    }
    return triangles;
}

}  // namespace gn
