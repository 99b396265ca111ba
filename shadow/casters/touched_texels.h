// SPDX-License-Identifier: MIT
// Every texel that a triangle touches, without a rasterizer: an invocation a triangle walks few texels itself, and large
// triangles are shared out among many. For what is done at a texel that needs no image, and for triangles of few texels, of
// which a geometry stage serves far fewer a second.
//
// Based on: Hasselgren, Akenine-Moeller, Ohlsson. Conservative Rasterization. GPU Gems 2, 2005. [HAO05]
#pragma once

#include "gpu/shader_inputs.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/stages.h"

#include <string>

namespace gn {

struct TouchedTexels {
    std::string name;
    std::string includes;  ///< GLSL before everything
    ShaderInputs inputs;
    std::string functions;  ///< GLSL that needs the inputs
    /// GLSL once a triangle: of `uint triangle` and its corners `vec3 a_ws, b_ws, c_ws`.
    std::string triangle_body;
    /// GLSL at every texel that the triangle touches, `ivec3 texel` with the layer last; knows what triangle_body declares,
    /// and sets `bool gn_cut` where a loop of its own ended early.
    std::string body;
    /// GLSL: whether anything is done in `ivec3 block`, 8 x 8 texels and the layer last.
    std::string wanted = "true";
    /// GLSL: texels by which a triangle reaches further along both axes, of its corners `vec3 a, b, c` as gn_texel_position gives
    /// them, `vec3 a_ws, b_ws, c_ws`, and the `GnLightView view`.
    std::string margin = "0.0";
    int alone = 512;                ///< texels that a triangle's own invocation walks; more are shared out
    std::uint32_t shares = 1;       ///< workgroups that share one such triangle of at most 4096 texels
    std::vector<TriangleRun> runs;  ///< of Scene::triangles
};
/// Passes that do it in every view. Affine and perspective views.
void add_touched_texels(const FrameInput& input, const LightViews& views, const TouchedTexels& touched);
/// Says in the frame's remarks, when its answer arrives, that a driver ended a loop of pass `name` early: where the uint `cut`
/// is not 0.
void tell_cut(const FrameInput& input, const std::string& name, BufferHandle cut);

}  // namespace gn
