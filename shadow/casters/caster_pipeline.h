// SPDX-License-Identifier: MIT
// The shaders that draw casters into light views, composed for what a pass draws.
#pragma once

#include "shadow/casters/caster_draw.h"

namespace gn {

struct CasterVariant {
    bool masked = false;
    ViewKind kind = ViewKind::perspective;
    bool layered = false, tiles = false;
    CasterFaces faces;
};

struct CasterPush {
    int view;
    float base_alpha, alpha_cutoff;
    int object;
    int draw;  ///< with tiles: of TileLists, by layer and object
};

/// How far faces that must lose ties are pushed: units of the depth's last place at the farthest corner, and pixels of the
/// rasterizer's grid, four each as in the view's samples.
inline constexpr float push_units = 4;
inline constexpr float push_pixels = 4.0F / 256;

/// What every stage of a pipeline that draws casters reads: the views, with tiles which of them an instance is of
/// (TileLists::views), and where alpha is tested what tells it.
ShaderInputs caster_inputs(const LightViews& views, const SceneHandles& handles, bool masked, bool tiles,
                           BufferHandle tile_lists);

/// A fragment stage stands only where depth is not affine, alpha is tested or the map asks.
RasterDesc caster_pipeline(const CasterPass& pass, const CasterVariant& variant);

}  // namespace gn
