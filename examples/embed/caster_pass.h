// SPDX-License-Identifier: MIT
// Draws the casters into views of lights, with pipelines of the host's own: instead of lending their buffers.
#pragma once

#include "scene_pass.h"

#include "shadow/casters/drawn.h"

class CasterPass {
  public:
    CasterPass(const HostDevice& host, const World& world);

    void draw(const gn::CasterView& view, const ScenePass& scene, const HostBuffer& transforms) const;

  private:
    const World& world_;
    Pipeline affine_, bent_;  ///< where the rasterizer's depth is linear, and where a fragment must write it
};
