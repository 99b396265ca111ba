// SPDX-License-Identifier: MIT
// Lights and cameras of the files that Assimp reads.
#pragma once

#include "shadow/scene/model.h"

#include <assimp/scene.h>

namespace gn {

dmat4 matrix_from_assimp(const aiMatrix4x4& m);

/// Each stands where the node of its name does. Such formats give intensities no unit: what a file says counts as candela,
/// lux or candela per square metre by kind, and a note says so, as one says what is left out.
void place_assimp_lights(const aiScene& data, Model& model);
void place_assimp_cameras(const aiScene& data, Model& model);

}  // namespace gn
