// SPDX-License-Identifier: MIT
#include "shade_pass.h"

#include "check.h"
#include "shade_frag.h"
#include "shade_vert.h"
#include "world.h"

namespace {

/// As Push in shade.frag.
struct ShadePush {
    glm::mat4 ws_from_cs;
    glm::vec4 eye_ws, towards_sun_ws, lamp_ws;
};

}  // namespace

ShadePass::ShadePass(const HostDevice& host)
    : device_(host.device),
      pipeline_(host, {.vertex = shade_vert,
                       .fragment = shade_frag,
                       .bindings = std::vector(5, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER),
                       .push_bytes = sizeof(ShadePush),
                       .colors = {picture_format}}) {
    VkSamplerCreateInfo nearest{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    nearest.addressModeU = nearest.addressModeV = nearest.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    check(vkCreateSampler(device_, &nearest, nullptr, &sampler_), "vkCreateSampler");
}

ShadePass::~ShadePass() {
    vkDestroySampler(device_, sampler_, nullptr);
}

void ShadePass::record(VkCommandBuffer commands, const Targets& targets, const HostCamera& camera) const {
    change_layout(commands, targets.picture, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                  VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT);
    const VkRenderingAttachmentInfo picture = cleared(targets.picture.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    begin_drawing(commands, targets.size, std::span(&picture, 1), nullptr);
    pipeline_.bind(commands);
    const float aspect = static_cast<float>(targets.size.width) / static_cast<float>(targets.size.height);
    const ShadePush push{glm::mat4(glm::inverse(glm::dmat4(camera.cs_from_ws(aspect)))), glm::vec4(camera.eye_ws, 1),
                         glm::vec4(World::towards_sun(), 0), glm::vec4(World::lamp_ws, World::lamp_range)};
    pipeline_.push_constants(commands, std::as_bytes(std::span(&push, 1)));
    std::uint32_t binding = 0;
    for (const HostImage* image :
         {&targets.depth, &targets.normals, &targets.albedo, &targets.visibility[sun], &targets.visibility[lamp]}) {
        pipeline_.push_image(commands, binding++, {sampler_, image->view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    }
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRendering(commands);
    change_layout(commands, targets.picture, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                  VK_PIPELINE_STAGE_2_TRANSFER_BIT);
}
