// SPDX-License-Identifier: MIT
#include "shadow/scene/point_emission.h"

#include "shadow/scene/light_samples.h"

#include <algorithm>
#include <limits>
#include <span>

namespace gn {
namespace {

constexpr int cells = 128;  ///< along a side of the picture: 16 to each of a thousand points

vec2 middle_of(int cell) {
    return (vec2(cell % cells, cell / cells) + 0.5F) / static_cast<float>(cells);
}

/// The picture's means over its cells, row by row.
std::vector<vec3> means_of_cells(const Image8& picture) {
    const auto steps = [](int size) { return (size + cells - 1) / cells; };
    const ivec2 each(steps(picture.width), steps(picture.height));
    std::vector<vec3> means;
    means.reserve(static_cast<std::size_t>(cells) * cells);
    for (int cell = 0; cell < cells * cells; ++cell) {
        vec3 sum(0);
        for (int i = 0; i < each.x * each.y; ++i) {
            const vec2 within = (vec2(i % each.x, i / each.x) + 0.5F) / vec2(each) - 0.5F;
            sum += emission_at(picture, middle_of(cell) + within / static_cast<float>(cells));
        }
        means.push_back(sum / static_cast<float>(each.x * each.y));
    }
    return means;
}

/// Where the points lie on the picture: at the same shares of its sides, however large the light is and wherever it stands.
std::vector<vec2> places_on_picture(const GnLight& light, int count, int side) {
    GnLight square = light;
    square.position_ws = vec4(0, 0, 0, 1);
    square.right_ws = vec4(1, 0, 0, 0);
    square.up_ws = vec4(0, 1, 0, 0);
    square.half_size = vec2(1);
    std::vector<vec2> places;
    for (const GnLight& one : light_samples(square, count, side).points) {
        places.push_back(gn_emission_place(light, vec2(one.position_ws)));
    }
    return places;
}

/// The point of a run that is nearest to a place.
std::size_t nearest_of(std::span<const vec2> places, std::size_t first, std::size_t end, vec2 at) {
    std::size_t nearest = first;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t i = first; i < end; ++i) {
        const vec2 off = places[i] - at;
        if (const float distance2 = glm::dot(off, off); distance2 < least) {
            least = distance2;
            nearest = i;
        }
    }
    return nearest;
}

}  // namespace

std::vector<vec4> emission_of_points(const Image8& picture, const GnLight& light, int count, int side) {
    const std::vector<vec3> means = means_of_cells(picture);
    const std::vector<vec2> places = places_on_picture(light, count, side);

    // Every cell belongs to the nearest point of each pixel's.
    std::vector<vec4> sums(places.size(), vec4(0));
    for (std::size_t first = 0, end = 0; first < places.size(); first = end) {
        const auto pattern = [&](std::size_t i) { return gn_point_cell(static_cast<int>(i), count, side); };
        for (end = first; end < places.size() && pattern(end) == pattern(first);) {
            ++end;
        }
        for (int cell = 0; cell < cells * cells; ++cell) {
            sums[nearest_of(places, first, end, middle_of(cell))] += vec4(means[static_cast<std::size_t>(cell)], 1);
        }
    }

    // Of a colour that the picture lacks points count alike.
    const bvec3 dark = equal(mean_emission(picture), vec3(0));
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const vec3 mean = sums[i].w > 0 ? vec3(sums[i]) / sums[i].w : emission_at(picture, places[i]);
        sums[i] = vec4(mix(mean, vec3(1), dark), 0);
    }
    return sums;
}

}  // namespace gn
