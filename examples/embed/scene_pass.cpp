// SPDX-License-Identifier: MIT
#include "scene_pass.h"

#include "scene_frag.h"
#include "scene_vert.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace {

template <class T>
HostBuffer filled(const HostDevice& host, const std::vector<T>& data, VkBufferUsageFlags usage) {
    HostBuffer buffer(host, data.size() * sizeof(T), usage);
    std::copy(data.begin(), data.end(), buffer.as<T>().begin());
    return buffer;
}

}  // namespace

// What is lent to Gnomon is read by its shaders: vertices and indices are storage buffers besides.
ScenePass::ScenePass(const HostDevice& host, const World& world)
    : world_(world),
      vertices_(filled(host, world.vertices, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)),
      indices_(filled(host, world.indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)),
      colors_(filled(host, world.colors, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)),
      pipeline_(host, {.vertex = scene_vert,
                       .fragment = scene_frag,
                       .bindings = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                       .push_bytes = sizeof(glm::mat4),
                       .attributes = {offsetof(Vertex, position_os), offsetof(Vertex, normal_os)},
                       .stride = sizeof(Vertex),
                       .colors = {normals_format, albedo_format},
                       .depth = depth_format}) {}

void ScenePass::bind_meshes(VkCommandBuffer commands) const {
    const VkBuffer vertices = vertices_.vk();
    const VkDeviceSize begin = 0;
    vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &begin);
    vkCmdBindIndexBuffer(commands, indices_.vk(), 0, VK_INDEX_TYPE_UINT32);
}

void ScenePass::record(VkCommandBuffer commands, const Targets& targets, const HostBuffer& transforms,
                       const glm::mat4& cs_from_ws) const {
    // Images begin anew; what read them in the frame before, Gnomon's passes and the shading, comes first.
    constexpr VkPipelineStageFlags2 everything = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    constexpr VkPipelineStageFlags2 colors_out = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    change_layout(commands, targets.depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                  everything,
                  VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT);
    for (const HostImage* image : {&targets.normals, &targets.albedo}) {
        change_layout(commands, *image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, everything,
                      colors_out);
    }

    const VkRenderingAttachmentInfo depth = cleared(targets.depth.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    const std::array colors{cleared(targets.normals.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL),
                            cleared(targets.albedo.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL)};
    begin_drawing(commands, targets.size, colors, &depth);
    pipeline_.bind(commands);
    pipeline_.push_constants(commands, std::as_bytes(std::span(&cs_from_ws, 1)));
    pipeline_.push_buffer(commands, 0, transforms.whole());
    pipeline_.push_buffer(commands, 1, colors_.whole());
    bind_meshes(commands);
    for (const Group& group : world_.groups) {
        vkCmdDrawIndexed(commands, group.mesh.index_count, group.count, group.mesh.first_index,
                         static_cast<std::int32_t>(group.mesh.first_vertex), group.first);
    }
    vkCmdEndRendering(commands);
    change_layout(commands, targets.albedo, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, colors_out, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
}
