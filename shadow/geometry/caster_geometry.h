// SPDX-License-Identifier: MIT
// What the parts without a map share: which objects cast, and the light as one homogeneous point.
#pragma once

#include "shadow/stages.h"

#include <cstdint>
#include <vector>

namespace gn {

/// How an object blocks light.
enum class CasterKind : std::uint8_t {
    opaque,  ///< everywhere: also alpha materials whose alpha nowhere falls below the cutoff
    masked,  ///< where its texture's alpha reaches the cutoff
    absent,  ///< nowhere: its alpha lies below the cutoff everywhere, or it casts no shadow of this light
};
/// One entry an object. Blended materials count as masked with cutoff 0.5. The input's light decides which objects it spares.
std::vector<CasterKind> caster_kinds(const FrameInput& input);
/// One number for what casts and from which sides: a key of what is derived of it.
std::uint64_t casters_key(const Scene& scene, const std::vector<CasterKind>& kinds);

/// The kinds of two-sided objects and those of one-sided ones, the others absent.
struct CasterSides {
    std::vector<CasterKind> both, one;
};
CasterSides split_sides(const Scene& scene, const std::vector<CasterKind>& kinds);

/// Runs of consecutive triangles, the opaque objects joined: what one draw can take.
struct TriangleRun {
    std::uint32_t first = 0, count = 0;
};
std::vector<TriangleRun> opaque_caster_runs(const Scene& scene, const std::vector<CasterKind>& kinds);

/// Where the light is, ws: w = 1 a point (the centre of an area light), w = 0 the direction towards the sun.
vec4 light_point_ws(const GnLight& light);

}  // namespace gn
