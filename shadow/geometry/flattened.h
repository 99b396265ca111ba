// SPDX-License-Identifier: MIT
// Casters drawn flat onto planes, along the light's rays.
#pragma once

#include "gpu/shader_inputs.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/flattened.glsl"
#include "shadow/geometry/receiver_planes.h"

#include <array>
#include <string>

namespace gn {

/// The planes that a light (ws, homogeneous) shines on, turned towards it; `number[i]` is the plane's among all of them.
struct LitPlanes {
    std::vector<GnFlattening> planes;
    std::vector<std::uint32_t> number;
};
LitPlanes lit_planes(const mat4& cs_from_ws, const ReceiverPlanes& found, vec4 light_ws);

/// How flattened casters are drawn.
struct FlatDraw {
    std::string_view includes;  ///< GLSL before the inputs
    std::string_view fragment;  ///< GLSL in main: writes `float result`, may read what `extra` declares
    ShaderInputs extra;         ///< besides u.frame; the same declarations for every plane
    Blend blend = Blend::none;
    bool stencil = true;  ///< only where the stencil holds the reference, which is then set to zero: dark once
};

/// What draws them: made once for a pass, recorded for plane after plane.
class FlatCasters {
  public:
    FlatCasters(const FrameInput& input, const FlatDraw& draw);
    /// What the shaders read above one plane.
    [[nodiscard]] ShaderInputs inputs(const GnFlattening& frame, const ShaderInputs& extra) const;
    void declare(PassBuilder& pass) const;
    /// Draws all casters with these inputs; the stencil reference is the caller's.
    void record(Recorder& r, const ShaderInputs& inputs, std::uint32_t stencil_reference) const;

  private:
    const Scene* scene_;
    SceneHandles handles_;
    CasterSides sides_;
    ShaderInputs declared_;
    /// By way: + 1 where alpha is tested, + 2 where only fronts cast.
    std::array<std::shared_ptr<const RasterDesc>, 4> pipelines_;
};

/// Fullscreen: writes the plane's number into the stencil of its samples that count (`mark`), or 1 into the image where a
/// sample counts, and zero into the stencil.
std::shared_ptr<const RasterDesc> flat_receiver_pipeline(const FrameInput& input, const ShaderInputs& inputs,
                                                         bool mark);
/// What that reads, of one plane.
ShaderInputs flat_receiver_inputs(const FrameInput& input, const GnFlattening& frame);

/// The hard shadow of the light's centre on these planes; V = 1 elsewhere, 0 where no sample counts.
Visibility add_flat_shadow(const FrameInput& input, const ReceiverPlanes& found);

}  // namespace gn
