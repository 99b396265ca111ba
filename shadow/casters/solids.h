// SPDX-License-Identifier: MIT
// Which triangles bound solids: where the light is outside of a solid, the faces that turn to it cast all that it casts, and
// the others need not be drawn (casters = auto).
#pragma once

#include "shadow/geometry/draw.h"
#include "shadow/stages.h"

namespace gn {

/// Triangles of an object that follow each other and belong together.
struct SolidRun {
    std::uint32_t first = 0, count = 0;
    int outward = 0;  ///< of a solid: +1 where windings show outwards, -1 inwards; 0: bounds none
    Box bounds_ws;    ///< of the whole solid
};
/// A list an object.
using Solids = std::vector<std::vector<SolidRun>>;

/// Of the input's light and its opaque casters; kept with the geometry. Null where the processor does not hold the triangles.
std::shared_ptr<const Solids> solids_of(const FrameInput& input);

/// What is drawn from both sides, by front faces alone, and by back faces alone.
struct SolidFaces {
    std::vector<DrawRange> both, front, back;
};
/// Of the opaque ones of `objects` (ascending) under the light. A light within the box of a solid may be inside.
SolidFaces solid_faces(const Scene& scene, const Solids& solids, std::span<const std::uint32_t> objects,
                       const GnLight& light);

}  // namespace gn
