// SPDX-License-Identifier: MIT
#include "shadow/geometry/convex_hull.h"

#include <algorithm>

namespace gn {
namespace {

double cross_of(dvec2 a, dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

}  // namespace

// Andrew's monotone chain.
std::vector<dvec2> convex_hull(std::vector<dvec2> points) {
    std::sort(points.begin(), points.end(), [](dvec2 a, dvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    std::vector<dvec2> hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t start = hull.size();
        for (const dvec2 p : points) {
            while (hull.size() >= start + 2 && cross_of(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) {
                hull.pop_back();
            }
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

}  // namespace gn
