// SPDX-License-Identifier: MIT
// Based on: McCool, Fiume. Hierarchical Poisson Disk Sampling Distributions. Graphics Interface 1992. [MF92]
#include "shadow/lookup/poisson.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

namespace gn {

PoissonSet poisson_disc(int count, unsigned seed) {
    std::mt19937 generator(seed);
    const auto uniform = [&] { return static_cast<float>(generator()) * (2.0F / 4294967296.0F) - 1.0F; };

    // Throw darts; after too many misses relax the spacing a little, keeping what has been placed.
    PoissonSet set;
    set.spacing = 2.0F / std::sqrt(static_cast<float>(count));
    int misses = 0;
    while (static_cast<int>(set.points.size()) < count) {
        const vec2 dart(uniform(), uniform());
        const bool inside = glm::dot(dart, dart) <= 1.0F;
        const bool free = std::all_of(set.points.begin(), set.points.end(),
                                      [&](vec2 p) { return glm::distance(p, dart) >= set.spacing; });
        if (inside && free) {
            set.points.push_back(dart);
            misses = 0;
        } else if (inside && ++misses > 200) {
            set.spacing *= 0.99F;
            misses = 0;
        }
    }
    spread(set.points);
    return set;
}

void spread(std::span<vec2> points) {
    for (std::size_t i = 1; i < points.size(); ++i) {
        const auto gap = [&](vec2 p) {
            float nearest = 4;
            for (const vec2 before : points.first(i)) {
                nearest = std::min(nearest, glm::distance(p, before));
            }
            return nearest;
        };
        const auto rest = points.subspan(i);
        std::iter_swap(rest.begin(),
                       std::max_element(rest.begin(), rest.end(), [&](vec2 a, vec2 b) { return gap(a) < gap(b); }));
    }
}

std::string glsl_fours(std::string_view name, std::span<const vec2> points) {
    std::string text = fmt::format("#define {}(take)", name);
    for (std::size_t first = 0; first < points.size(); first += 4) {
        const auto four = [&](const auto& value) {
            std::string list;
            for (std::size_t i = first; i < first + 4; ++i) {
                list += fmt::format("{}{:.8f}", i == first ? "" : ", ", i < points.size() ? value(points[i]) : 0.0F);
            }
            return list;
        };
        text += fmt::format(" take(vec4({}), vec4({}), vec4({}))", four([](vec2 p) { return p.x; }),
                            four([](vec2 p) { return p.y; }), four([](vec2) { return 1.0F; }));
    }
    return text + "\n";
}

}  // namespace gn
