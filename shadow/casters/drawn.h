// SPDX-License-Identifier: MIT
// Casters that a renderer draws itself, with pipelines of its own, into views that are ready for it.
#pragma once

#include "gpu/device.h"
#include "shadow/light_view.h"

#include <functional>

namespace gn {

/// A view into which rendering has begun, with one depth attachment of one layer: cleared to 1, or where a map is kept to what
/// it keeps; depth is tested with LESS and clamped. Viewport and scissor are set, as dynamic state of the commands.
struct CasterView {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    std::uint64_t light_id = 0;  ///< as the frame's lights name it
    /// World space to clip space: gl_Position = view.cs_from_ws * vec4(p_ws, 1), and for bit-equal maps gn_clip(view, p_ws).
    GnLightView view;
    /// Whether gl_FragDepth must be clamp(dot(view.depth_from_ws, vec4(p_ws, 1)), 0, 1); else the rasterizer's depth is that.
    bool writes_depth = false;
};
using CasterFunction = std::function<void(const CasterView&)>;

/// What pipelines of such draws must match.
struct CasterFormats {
    VkFormat depth = VK_FORMAT_D32_SFLOAT;  ///< and no colour, no stencil
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    VkCullModeFlags culled = VK_CULL_MODE_NONE;  ///< with VK_FRONT_FACE_COUNTER_CLOCKWISE for the front
    bool affine = false;                         ///< there are views without CasterView::writes_depth
    bool bent = false;                           ///< there are views with it
};

/// How a frame's casters are drawn, and what its passes asked for.
struct DrawnCasters {
    CasterFunction draw;
    CasterFormats formats;
};

}  // namespace gn
