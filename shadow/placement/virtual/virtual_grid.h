// SPDX-License-Identifier: MIT
// The faces whose parts are pages: fixed to the light and the scene, so that pages outlive frames.
#pragma once

#include "shadow/recipe/recipe.h"
#include "shadow/stages.h"

namespace gn::virtual_pages {

/// One orthographic face of a sun, one of a narrow spot, else six around the light.
struct Grid {
    std::vector<GnLightView> faces;
    bool around = false;
    GnLight shape;              ///< of the light, without colour and intensity
    Box seen_ws;                ///< what the faces cover
    double reach = 0;           ///< metres: how far those of a lamp see
    std::uint64_t version = 0;  ///< of the geometry that the pages were last drawn of
    std::uint64_t casting = 0;  ///< what casts, and how, beside the geometry
};

/// The grid that an earlier frame left, where it still serves the light and all that the camera can see; else a new one.
Grid grid_of(const FrameInput& input, const Recipe& recipe, const Grid* before);
/// Whether pages of one are pages of the other.
bool same_faces(const Grid& a, const Grid& b);

/// Rectangles of the faces (0 to 1 across them), each followed by its face, within which casters moved since the grid's version;
/// unset where all may have.
std::optional<std::vector<vec4>> touched_parts(const FrameInput& input, const Grid& before);

}  // namespace gn::virtual_pages
