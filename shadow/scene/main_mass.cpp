// SPDX-License-Identifier: MIT
#include "shadow/scene/main_mass.h"

#include <algorithm>

namespace gn {
namespace {

struct Weighted {
    double value, weight;
};

/// The values below which the given shares of the weight lie. Sorts the samples.
dvec2 quantiles(std::vector<Weighted>& samples, double low, double high) {
    std::sort(samples.begin(), samples.end(), [](Weighted a, Weighted b) { return a.value < b.value; });
    double total = 0.0;
    for (const Weighted s : samples) {
        total += s.weight;
    }
    dvec2 found(samples.front().value, samples.back().value);
    double sum = 0.0;
    bool below = true;
    for (const Weighted s : samples) {
        sum += s.weight;
        if (below && sum > low * total) {
            found.x = s.value;
            below = false;
        }
        if (sum >= high * total) {
            found.y = s.value;
            break;
        }
    }
    return found;
}

/// The largest weight that one triangle gets.
double cap_of(const std::vector<TriangleSample>& samples) {
    std::vector<double> sizes;
    double total = 0.0;
    for (const TriangleSample& s : samples) {
        sizes.push_back(s.size);
        total += s.size;
    }
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    return std::max(0.0025 * total, *middle);
}

/// The shares of the corners' weight on each axis.
std::array<dvec2, 3> spans(const std::vector<TriangleSample>& samples, double low, double high) {
    const double cap = cap_of(samples);
    std::array<dvec2, 3> found{};
    std::vector<Weighted> weighted;
    for (int axis = 0; axis < 3; ++axis) {
        weighted.clear();
        for (const TriangleSample& s : samples) {
            for (const dvec3& corner : s.corners) {
                weighted.push_back({corner[axis], std::min(s.size, cap)});
            }
        }
        found[static_cast<std::size_t>(axis)] = quantiles(weighted, low, high);
    }
    return found;
}

TriangleSample sample_of(const Scene& scene, uvec3 t) {
    const std::array corners{dvec3(scene.positions_ws[t.x]), dvec3(scene.positions_ws[t.y]),
                             dvec3(scene.positions_ws[t.z])};
    return {corners, std::sqrt(0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])))};
}

/// Triangles of the scene within a box, evenly chosen.
std::vector<TriangleSample> samples_of(const Scene& scene, const Box& within) {
    const std::size_t step = std::max<std::size_t>(1, scene.triangles.size() / most_triangle_samples);
    std::vector<TriangleSample> samples;
    for (std::size_t i = 0; i < scene.triangles.size(); i += step) {
        const uvec3 t = scene.triangles[i];
        if (within.contains(scene.positions_ws[t.x]) && within.contains(scene.positions_ws[t.y]) &&
            within.contains(scene.positions_ws[t.z])) {
            samples.push_back(sample_of(scene, t));
        }
    }
    return samples;
}

}  // namespace

Fence find_fence(std::vector<TriangleSample> samples) {
    if (samples.empty()) {
        return {};
    }
    const std::array<dvec2, 3> middle = spans(samples, 0.35, 0.65);
    const double spread = std::max({middle[0].y - middle[0].x, middle[1].y - middle[1].x, middle[2].y - middle[2].x});
    if (!(spread > 0.0)) {
        return {};
    }
    const dvec3 room(64.0 * spread);
    // A ground may be a hundred thousand times as wide as what stands on it; a million times is a vertex left at zero.
    return {dvec3(middle[0].x, middle[1].x, middle[2].x) - room, dvec3(middle[0].y, middle[1].y, middle[2].y) + room,
            0x1p20 * spread};
}

std::vector<TriangleSample> triangle_samples(const Scene& scene) {
    return samples_of(scene, Box{vec3(std::numeric_limits<float>::lowest()), vec3(std::numeric_limits<float>::max())});
}

Fence find_fence(const Scene& scene) {
    return find_fence(triangle_samples(scene));
}

Box bounds_without_strays(const Scene& scene) {
    const Fence fence = find_fence(scene);
    Box bounds;
    for (const uvec3 t : scene.triangles) {
        Box box;
        for (int corner = 0; corner < 3; ++corner) {
            box.grow(scene.positions_ws[t[corner]]);
        }
        if (fence.meets(dvec3(box.min), dvec3(box.max))) {
            bounds.grow(box);
        }
    }
    return bounds;
}

namespace {

/// The multiple of a power of two, no larger than `about`, that is nearest to p.
dvec3 rounded(dvec3 p, double about) {
    const double step = about > 0.0 ? std::exp2(std::floor(std::log2(about))) : 0.0;
    return step > 0.0 ? glm::round(p / step) * step : p;
}

double median_size(const std::vector<TriangleSample>& samples) {
    std::vector<double> sizes;
    for (const TriangleSample& s : samples) {
        sizes.push_back(s.size);
    }
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    return *middle;
}

}  // namespace

dvec3 choose_origin(const std::vector<TriangleSample>& samples, dvec3 min, dvec3 max, const dvec3* camera_ws) {
    // The main mass, unless zero is near enough.
    const dvec3 centre = 0.5 * (min + max);
    const double extent = glm::length(max - min);
    const double distance = glm::length(centre);
    if (samples.empty() || !std::isfinite(distance)) {
        return dvec3(0.0);
    }
    const dvec3 mass = distance > 16.0 * extent ? rounded(centre, extent) : dvec3(0.0);

    // The camera, where what stands before it would lose its last ten bits: 2^-23 x 2^13 = 2^-10. One that stands beyond
    // the reach of coordinates sees nothing, and would take the scene out of theirs.
    const double feature = median_size(samples);
    const double away = camera_ws == nullptr ? 0.0 : glm::length(*camera_ws - mass);
    if (!(away > 0x1p13 * feature) || !(feature > 0.0) || away > 1e9) {
        return mass;
    }
    return rounded(*camera_ws, 8.0 * feature);
}

void note_lost_precision(Scene& scene) {
    // A corner is rounded by half a unit of its coordinate; sixteen units are the least that still has a shape.
    std::size_t lost = 0;
    double step = 0.0;
    for (const uvec3 t : scene.triangles) {
        const TriangleSample sample = sample_of(scene, t);
        double largest = 0.0;
        for (const dvec3& corner : sample.corners) {
            largest = std::max({largest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
        }
        const double longest = std::max({glm::distance(sample.corners[0], sample.corners[1]),
                                         glm::distance(sample.corners[1], sample.corners[2]),
                                         glm::distance(sample.corners[2], sample.corners[0])});
        if (longest < 16.0 * 0x1p-23 * largest) {
            ++lost;
            step = std::max(step, 0x1p-23 * largest);
        }
    }
    if (lost > 0) {
        add_note(
            scene.notes,
            fmt::format("{} triangle{} smaller than what coordinates in floats tell apart where {} ({:.3g} m): such "
                        "detail cannot be told from its neighbours, nor its shadow; load the far part by itself.",
                        lost, lost == 1 ? " is" : "s are", lost == 1 ? "it lies" : "they lie", step));
    }
}

Box main_bounds(const Scene& scene) {
    // Trim 2 % of the weight at both ends of each axis.
    const Box all = bounds_without_strays(scene);
    const std::vector<TriangleSample> samples = samples_of(scene, all);
    if (all.empty() || samples.empty()) {
        return all;
    }
    const std::array<dvec2, 3> kept = spans(samples, 0.02, 0.98);
    const Box box{vec3(kept[0].x, kept[1].x, kept[2].x), vec3(kept[0].y, kept[1].y, kept[2].y)};

    // Where trimming takes little away there are no outliers: show everything.
    if (box.empty() || box.diagonal() > 0.7F * all.diagonal()) {
        return all;
    }
    const vec3 margin(0.1F * box.extent());
    return {box.min - margin, box.max + margin};
}

}  // namespace gn
