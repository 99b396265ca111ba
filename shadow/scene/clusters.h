// SPDX-License-Identifier: MIT
// Things that lie so far apart that one box around them all says nothing of any: a scene and what strayed from it.
#pragma once

#include "base/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace gn {

struct Scene;

/// The number of the cluster of each box. Clusters are apart, along some axis, by more than a tenth of all, and by more than
/// `apart` times the smaller side's size: what stands in a row, on a ground or around a court is one.
std::vector<std::uint32_t> clusters_of(std::span<const Box> boxes, float apart);

/// One box around each cluster of the scene's objects; the scene's bounds where there are no objects.
std::vector<Box> cluster_bounds(const Scene& scene);

/// The bounds of the cluster that has the most triangles.
Box largest_cluster(const Scene& scene);

/// Makes several objects of one from which triangles strayed, by a hundred times their own size.
void split_objects(Scene& scene);

}  // namespace gn
