// SPDX-License-Identifier: MIT
// Pipelines, made once per description and kept.
#pragma once

#include "gpu/device.h"
#include "gpu/shader.h"

#include <optional>

namespace gn {

/// Specialization constants by id (layout(constant_id = 0) const int TAPS = 9;).
using SpecConstants = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

struct ComputeDesc {
    ShaderSource shader;
    SpecConstants constants;
};

enum class Blend { none, add, min, max, logic_or, alpha };

struct StencilOps {
    VkStencilOpState front{}, back{};
};

/// Fixed state of a raster pipeline. Attachment formats come from the pass it is used in; vertices are pulled from
/// buffers or come through one vertex binding described by `attributes`.
struct RasterDesc {
    ShaderSource vertex;
    std::optional<ShaderSource> geometry;
    std::optional<ShaderSource> fragment;  ///< none: depth only
    SpecConstants constants;               ///< given to all stages
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkCullModeFlags cull = VK_CULL_MODE_NONE;  ///< front faces are counter-clockwise seen in world space
    bool depth_test = false, depth_write = false, depth_clamp = false;
    VkCompareOp depth_compare = VK_COMPARE_OP_GREATER;
    bool depth_bias = false;  ///< slope and constant set through the recorder
    std::optional<StencilOps> stencil;
    Blend blend = Blend::none;  ///< for every colour attachment
    VkColorComponentFlags color_mask = 0xF;
    struct Attribute {
        std::uint32_t location, offset;
        VkFormat format;
    };
    std::vector<Attribute> attributes;
    std::uint32_t vertex_stride = 0;
};

/// The same with its shaders' fingerprints worked out, for descriptions that are made once and bound often.
ComputeDesc sealed(ComputeDesc desc);
RasterDesc sealed(RasterDesc desc);

/// A full-screen triangle: gl_Position without any vertex buffer, uv in location 0 (0,0 top left).
ShaderSource fullscreen_vertex_shader();
RasterDesc fullscreen(ShaderSource fragment);

}  // namespace gn
