// SPDX-License-Identifier: MIT
// What the tests of warped placements share: placing without a GPU's samples, and measuring texels on the CPU.
#pragma once

#include "shadow/placement/place.h"

#include "tests/rig.h"

namespace gn::test {

/// The views that a recipe's placement chooses for a scene's camera and first light.
LightViews place(const Scene& scene, const std::string& text, uint width = 256, uint height = 256,
                 const Camera* camera = nullptr);

/// A floor, a thin slab from z = -near to -far under a camera that looks along it, and the sun from `to_light`.
Scene long_floor(double near, double far, vec3 to_light = vec3(0, 1, 0));

dvec2 uv_of(const GnLightView& view, dvec3 p_ws);

/// Perspective error at a point: texels' length along a direction, over the distance from the camera, in pixels of a
/// camera with as many pixels as the map has texels and a field of view of one radian.
double error_along(const GnLightView& view, dvec3 p_ws, dvec3 direction_ws, double depth);

}  // namespace gn::test
