// SPDX-License-Identifier: MIT
#include "shadow_pass.h"

#include "frames.h"

#include <algorithm>

namespace {

gn::embed::Shadows create(const HostDevice& host, const std::string& recipe, const std::string& baked,
                          VkExtent2D largest) {
    auto created = gn::embed::Shadows::create(
        {.device = {.instance = host.instance,
                    .physical = host.physical,
                    .device = host.device,
                    .queue = host.queue,
                    .queue_family = host.queue_family,
                    .features = &host.features,
                    .extensions = {host.extensions.begin(), host.extensions.end()}},
         .recipe = recipe,
         .limits = {.width = largest.width,
                    .height = largest.height,
                    .lights = light_count,
                    .frames_in_flight = frames_in_flight},
         .receivers = {.reversed_depth = true, .normals = gn::embed::Normals::signed_octahedral},
         .baked = baked});
    if (!created.ok()) {
        throw Refused(created.why());
    }
    return std::move(created.value());
}

/// An image that is in one layout and shall be read afterwards.
gn::embed::LentImage lend(const HostImage& image, VkImageLayout before) {
    return {image.vk(), image.format(), before, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

gn::embed::LentBuffer lend(const HostBuffer& buffer) {
    return {buffer.vk(), 0, buffer.bytes()};
}

GnLight sun_light() {
    GnLight light;
    light.kind = GN_LIGHT_DIRECTIONAL;
    light.direction_ws = glm::vec4(-World::towards_sun(), 0);
    return light;
}

GnLight lamp_light() {
    GnLight light;
    light.kind = GN_LIGHT_POINT;
    light.position_ws = glm::vec4(World::lamp_ws, 1);
    light.range = World::lamp_range;
    return light;
}

}  // namespace

ShadowPass::ShadowPass(const HostDevice& host, const World& world, const std::string& recipe, const std::string& baked,
                       VkExtent2D largest)
    : world_(world), shadows_(create(host, recipe, baked, largest)) {
    for (const Group& group : world.groups) {
        const gn::embed::CasterObject object{group.mesh.first_index, group.mesh.index_count, group.mesh.first_vertex,
                                             group.mesh.vertex_count, true};
        objects_.insert(objects_.end(), group.count, object);
    }
    objects_.resize(world.casters);  // the lamp's own ball lets its light out
}

void ShadowPass::record(VkCommandBuffer commands, std::uint32_t slot, std::uint64_t number, const Targets& targets,
                        const ScenePass& scene, const HostBuffer& transforms, const glm::mat4& cs_from_ws) {
    std::array<gn::embed::LentLight, light_count> lights{{
        {sun, sun_light(), lend(targets.visibility[sun], VK_IMAGE_LAYOUT_UNDEFINED)},
        {lamp, lamp_light(), lend(targets.visibility[lamp], VK_IMAGE_LAYOUT_UNDEFINED)},
    }};
    if (number % 3 == 2) {
        std::reverse(lights.begin(), lights.end());
    }
    const auto recorded = shadows_.record(
        commands, {.slot = slot,
                   .receivers = {.width = targets.size.width,
                                 .height = targets.size.height,
                                 .depth = lend(targets.depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL),
                                 .normals = lend(targets.normals, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL),
                                 .cs_from_ws = cs_from_ws},
                   .casters = {.positions = lend(scene.vertices()),
                               .stride = sizeof(Vertex),
                               .indices = lend(scene.indices()),
                               .transforms = lend(transforms),
                               .objects = objects_,
                               .bounds_ws = {world_.least_ws, world_.greatest_ws},
                               .topology = 1,
                               .poses = number + 1},
                   .lights = lights});
    if (!recorded.ok()) {
        throw std::runtime_error(recorded.why());
    }
    for (const std::string& why : recorded.value()) {
        if (!why.empty()) {
            throw std::runtime_error("a light has no shadow: " + why);
        }
    }
}
