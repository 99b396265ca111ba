// SPDX-License-Identifier: MIT
// Where a scene is: the main mass of its triangles, told from strays.
//
// Files carry strays: a vertex left at zero, a marker kilometres away. What serves the scene as a whole (its origin, the
// view that shows it, depth ranges) follows the main mass. A stray is drawn and casts as everything else does.
#pragma once

#include "shadow/scene/model.h"

#include <vector>

namespace gn {

/// A box in double precision around the main mass, with room: what lies wholly outside is a stray.
struct Fence {
    dvec3 min{std::numeric_limits<double>::lowest()}, max{std::numeric_limits<double>::max()};
    double longest =
        std::numeric_limits<double>::max();  ///< a triangle longer than this ties the scene to a stray vertex
    /// Whether the box of a triangle meets the fence.
    [[nodiscard]] bool meets(dvec3 low, dvec3 high) const {
        const dvec3 size = high - low;
        return glm::all(glm::lessThanEqual(low, max)) && glm::all(glm::lessThanEqual(min, high)) &&
               std::max({size.x, size.y, size.z}) <= longest;
    }
};

/// A sample of triangles: three corners each, and the square root of its area.
struct TriangleSample {
    std::array<dvec3, 3> corners;
    double size = 0;
};

/// Triangles to look at, evenly over the scene: enough for quantiles.
inline constexpr std::size_t most_triangle_samples = 30'000;

/// The fence: on each axis the middle 30 % of the corners' weight, and 64 times the widest axis' spread beyond it. Evenly
/// spread triangles span three such spreads, so that nothing nearer than 19 extents of the scene is taken for a stray; up
/// to a third of the weight may be strays. Weights are sizes, each at most a quarter percent of all or the median size, so
/// that neither a crumb nor one vast plane decides.
Fence find_fence(std::vector<TriangleSample> samples);
Fence find_fence(const Scene& scene);
/// Of a scene, evenly chosen.
std::vector<TriangleSample> triangle_samples(const Scene& scene);

/// The bounds of everything but strays.
Box bounds_without_strays(const Scene& scene);

/// Where zero should lie: at the main mass, or at zero itself where the mass lies within 16 of its own extents of it, which
/// costs floats no more than four of their 24 bits; but at the camera where coordinates there would be so large against the
/// triangles (of the median size) that fewer than ten bits told them apart. A multiple of a power of two, so that
/// subtracting it rounds nothing that matters. [min, max]: the bounds without strays.
dvec3 choose_origin(const std::vector<TriangleSample>& samples, dvec3 min, dvec3 max, const dvec3* camera_ws);

/// One note where triangles are so small against their coordinates that floats cannot tell their corners apart to a
/// sixteenth.
void note_lost_precision(Scene& scene);

}  // namespace gn
