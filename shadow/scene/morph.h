// SPDX-License-Identifier: MIT
// Morph targets: displacements of positions and normals, summed by weights. [glTF 2.0, 3.7.2.2]
#pragma once

#include "shadow/scene/rig.h"

namespace gn {

/// A shape under its targets.
struct Morphed {
    std::vector<dvec3> positions_os;
    std::vector<dvec3> normals_os;  ///< unit; 0 where the file gives none
};

/// v + sum of w_t d_t, in the targets' order; a weight of 0, or none for a target, adds nothing. Normals are of unit length
/// again; one of 0 stays so, and one that the targets cancel becomes 0.
void add_targets(std::span<const MorphTarget> targets, std::span<const double> weights, Morphed& morphed);

}  // namespace gn
