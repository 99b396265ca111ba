// SPDX-License-Identifier: MIT
#include "shadow/scene/clusters.h"

#include "shadow/scene/scene.h"

#include <algorithm>
#include <numeric>

namespace gn {
namespace {

using Some = std::span<std::uint32_t>;

constexpr int bins = 64;            ///< of an axis, in which things are found in one sweep
constexpr int least_run = 7;        ///< empty bins in a row: a tenth of all
constexpr float usual_apart = 3;    ///< sizes of the smaller side, between clusters of objects
constexpr float stray_apart = 100;  ///< likewise, between what strayed from an object and the rest of it

Box around(std::span<const Box> boxes, Some some) {
    Box all;
    for (const std::uint32_t i : some) {
        all.grow(boxes[i]);
    }
    return all;
}

/// The longest run of bins along an axis that no box touches.
struct Gap {
    int axis = 0, length = 0;
    float begin = 0, end = 0;
};

Gap widest_gap(std::span<const Box> boxes, Some some, const Box& all, int axis) {
    Gap widest{axis};
    const float size = (all.max[axis] - all.min[axis]) / bins;
    if (!(size > 0)) {
        return widest;
    }
    std::array<bool, bins> taken{};
    const auto bin = [&](float at) { return std::clamp(static_cast<int>((at - all.min[axis]) / size), 0, bins - 1); };
    for (const std::uint32_t i : some) {
        for (int k = bin(boxes[i].min[axis]); k <= bin(boxes[i].max[axis]); ++k) {
            taken[static_cast<std::size_t>(k)] = true;
        }
    }
    int run = 0;
    for (int k = 0; k < bins; ++k) {
        run = taken[static_cast<std::size_t>(k)] ? 0 : run + 1;
        if (run > widest.length) {
            const auto edge = [&](int b) { return all.min[axis] + static_cast<float>(b) * size; };
            widest = {axis, run, edge(k + 1 - run), edge(k + 1)};
        }
    }
    return widest;
}

/// Moves what lies beyond the widest gap to the end, and says where it begins; the end where there is no such gap.
Some::iterator cut(std::span<const Box> boxes, Some some, float apart) {
    const Box all = around(boxes, some);
    Gap widest;
    for (int axis = 0; axis < 3; ++axis) {
        const Gap gap = widest_gap(boxes, some, all, axis);
        widest = gap.length > widest.length ? gap : widest;
    }
    if (widest.length < least_run) {
        return some.end();
    }
    const float middle = 0.5F * (widest.begin + widest.end);
    const auto beyond =
        std::partition(some.begin(), some.end(), [&](std::uint32_t i) { return boxes[i].min[widest.axis] < middle; });
    const float low = around(boxes, {some.begin(), beyond}).diagonal();
    const float high = around(boxes, {beyond, some.end()}).diagonal();
    return widest.end - widest.begin > apart * std::min(low, high) ? beyond : some.end();
}

}  // namespace

std::vector<std::uint32_t> clusters_of(std::span<const Box> boxes, float apart) {
    std::vector<std::uint32_t> cluster(boxes.size(), 0);
    std::vector<std::uint32_t> order(boxes.size());
    std::iota(order.begin(), order.end(), 0U);
    std::uint32_t count = 0;
    std::vector<Some> open{Some(order)};
    while (!open.empty()) {
        // Cut in two as long as there is a gap; both sides may fall apart further.
        const Some some = open.back();
        open.pop_back();
        const auto beyond = some.size() > 1 ? cut(boxes, some, apart) : some.end();
        if (beyond != some.end()) {
            open.push_back({beyond, some.end()});
            open.push_back({some.begin(), beyond});
            continue;
        }
        for (const std::uint32_t i : some) {
            cluster[i] = count;
        }
        ++count;
    }
    return cluster;
}

namespace {

struct Cluster {
    Box bounds_ws;
    std::size_t triangles = 0;
};

std::vector<Cluster> clusters_of(const Scene& scene) {
    if (scene.objects.empty()) {
        return {{scene.bounds_ws, scene.triangles.size()}};
    }
    std::vector<Box> boxes;
    boxes.reserve(scene.objects.size());
    for (const Object& object : scene.objects) {
        boxes.push_back(object.bounds_ws);
    }
    const std::vector<std::uint32_t> numbers = clusters_of(boxes, usual_apart);
    std::vector<Cluster> clusters(*std::max_element(numbers.begin(), numbers.end()) + std::size_t{1});
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        clusters[numbers[i]].bounds_ws.grow(boxes[i]);
        clusters[numbers[i]].triangles += scene.objects[i].triangle_count;
    }
    return clusters;
}

}  // namespace

std::vector<Box> cluster_bounds(const Scene& scene) {
    std::vector<Box> bounds;
    for (const Cluster& cluster : clusters_of(scene)) {
        bounds.push_back(cluster.bounds_ws);
    }
    return bounds;
}

Box largest_cluster(const Scene& scene) {
    const std::vector<Cluster> clusters = clusters_of(scene);
    return std::max_element(clusters.begin(), clusters.end(),
                            [](const Cluster& a, const Cluster& b) { return a.triangles < b.triangles; })
        ->bounds_ws;
}

void split_objects(Scene& scene) {
    std::vector<Object> objects;
    std::vector<Box> boxes;
    for (const Object& object : scene.objects) {
        boxes.clear();
        for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
            Box& box = boxes.emplace_back();
            for (int corner = 0; corner < 3; ++corner) {
                box.grow(scene.positions_ws[scene.triangles[object.first_triangle + t][corner]]);
            }
        }
        const std::vector<std::uint32_t> numbers = clusters_of(boxes, stray_apart);
        const std::uint32_t count = numbers.empty() ? 1 : *std::max_element(numbers.begin(), numbers.end()) + 1;
        if (count == 1) {
            objects.push_back(object);
            continue;
        }
        // The triangles of each cluster, in their order.
        const std::vector<uvec3> triangles(scene.triangles.begin() + object.first_triangle,
                                           scene.triangles.begin() + object.first_triangle + object.triangle_count);
        std::uint32_t next = object.first_triangle;
        for (std::uint32_t c = 0; c < count; ++c) {
            Object& piece = objects.emplace_back(object);
            piece.first_triangle = next;
            piece.bounds_ws = Box{};
            for (std::size_t t = 0; t < triangles.size(); ++t) {
                if (numbers[t] == c) {
                    scene.triangles[next++] = triangles[t];
                    piece.bounds_ws.grow(boxes[t]);
                }
            }
            piece.triangle_count = next - piece.first_triangle;
        }
    }
    scene.objects = std::move(objects);
}

}  // namespace gn
