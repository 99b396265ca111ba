// SPDX-License-Identifier: MIT
// The fixed-function state of a raster pipeline, from its description and the pass's attachments.
#pragma once

#include "gpu/pipeline_cache.h"

#include <array>

namespace gn {

inline VkPipelineColorBlendAttachmentState blend_state(const RasterDesc& desc) {
    VkPipelineColorBlendAttachmentState state{.colorWriteMask = desc.color_mask};
    const auto set = [&](VkBlendOp op, VkBlendFactor source, VkBlendFactor target, VkBlendFactor source_alpha) {
        state.blendEnable = VK_TRUE;
        state.colorBlendOp = state.alphaBlendOp = op;
        state.srcColorBlendFactor = source;
        state.srcAlphaBlendFactor = source_alpha;
        state.dstColorBlendFactor = state.dstAlphaBlendFactor = target;
    };
    switch (desc.blend) {
        case Blend::add: set(VK_BLEND_OP_ADD, VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE); break;
        case Blend::min: set(VK_BLEND_OP_MIN, VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE); break;
        case Blend::max: set(VK_BLEND_OP_MAX, VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_ONE); break;
        case Blend::alpha:
            set(VK_BLEND_OP_ADD, VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_FACTOR_ONE);
            break;
        case Blend::none:
        case Blend::logic_or: break;
    }
    return state;
}

/// Every fixed-function state of a raster pipeline; its members point at each other, so it stays where it is made.
struct FixedState {
    VkVertexInputBindingDescription vertex_binding{};
    std::vector<VkVertexInputAttributeDescription> vertex_attributes;
    std::vector<VkPipelineColorBlendAttachmentState> blends;
    VkPipelineVertexInputStateCreateInfo vertices{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};

    FixedState(const RasterDesc& desc, const AttachmentFormats& formats) {
        set_vertices(desc);
        set_raster(desc, formats);
        set_outputs(desc, formats);
    }
    FixedState(const FixedState&) = delete;
    FixedState& operator=(const FixedState&) = delete;

    void set_vertices(const RasterDesc& desc) {
        vertex_binding = {0, desc.vertex_stride, VK_VERTEX_INPUT_RATE_VERTEX};
        for (const RasterDesc::Attribute& attribute : desc.attributes) {
            vertex_attributes.push_back({attribute.location, 0, attribute.format, attribute.offset});
        }
        vertices.vertexBindingDescriptionCount = desc.attributes.empty() ? 0 : 1;
        vertices.pVertexBindingDescriptions = &vertex_binding;
        vertices.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(vertex_attributes.size());
        vertices.pVertexAttributeDescriptions = vertex_attributes.data();
        assembly.topology = desc.topology;
    }

    void set_raster(const RasterDesc& desc, const AttachmentFormats& formats) {
        viewport.viewportCount = viewport.scissorCount = 1;
        raster.depthClampEnable = desc.depth_clamp ? VK_TRUE : VK_FALSE;
        raster.polygonMode = VK_POLYGON_MODE_FILL;
        raster.cullMode = desc.cull;
        raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
        raster.depthBiasEnable = desc.depth_bias ? VK_TRUE : VK_FALSE;
        raster.lineWidth = 1.0F;
        samples.rasterizationSamples = static_cast<VkSampleCountFlagBits>(formats.samples);
        depth.depthTestEnable = desc.depth_test || desc.depth_write ? VK_TRUE : VK_FALSE;
        depth.depthWriteEnable = desc.depth_write ? VK_TRUE : VK_FALSE;
        depth.depthCompareOp = desc.depth_test ? desc.depth_compare : VK_COMPARE_OP_ALWAYS;
        depth.stencilTestEnable = desc.stencil ? VK_TRUE : VK_FALSE;
        if (desc.stencil) {
            depth.front = desc.stencil->front;
            depth.back = desc.stencil->back;
        }
    }

    void set_outputs(const RasterDesc& desc, const AttachmentFormats& formats) {
        blends.assign(formats.colors.size(), blend_state(desc));
        blend.logicOpEnable = desc.blend == Blend::logic_or ? VK_TRUE : VK_FALSE;
        blend.logicOp = VK_LOGIC_OP_OR;
        blend.attachmentCount = static_cast<std::uint32_t>(blends.size());
        blend.pAttachments = blends.data();
        static constexpr std::array states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                           VK_DYNAMIC_STATE_DEPTH_BIAS, VK_DYNAMIC_STATE_STENCIL_REFERENCE};
        dynamic.dynamicStateCount = static_cast<std::uint32_t>(states.size());
        dynamic.pDynamicStates = states.data();
        rendering.colorAttachmentCount = static_cast<std::uint32_t>(formats.colors.size());
        rendering.pColorAttachmentFormats = formats.colors.data();
        rendering.depthAttachmentFormat = formats.depth;
        rendering.stencilAttachmentFormat = has_stencil(formats.depth) ? formats.depth : VK_FORMAT_UNDEFINED;
    }
};

}  // namespace gn
