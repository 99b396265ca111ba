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
                       VkExtent2D largest, bool draw_casters)
    : world_(world), shadows_(create(host, recipe, baked, largest)) {
    for (const Group& group : world.groups) {
        const gn::embed::CasterObject object{group.mesh.first_index, group.mesh.index_count, group.mesh.first_vertex,
                                             group.mesh.vertex_count, true};
        objects_.insert(objects_.end(), group.count, object);
    }
    objects_.resize(world.casters);  // the lamp's own ball lets its light out
    if (draw_casters) {
        casters_.emplace(host, world);
    }
    foresee(largest);
}

gn::embed::Frame ShadowPass::outline(VkExtent2D size, const glm::mat4& cs_from_ws, const Lights& lights) const {
    return {.receivers = {.width = size.width,
                          .height = size.height,
                          .depth = {.format = depth_format},
                          .normals = {.format = normals_format},
                          .cs_from_ws = cs_from_ws},
            .casters = {.bounds_ws = {world_.least_ws, world_.greatest_ws}, .topology = 1},
            .lights = lights};
}

void ShadowPass::foresee(VkExtent2D size) const {
    const Lights lights{
        {{sun, sun_light(), {.format = visibility_format}}, {lamp, lamp_light(), {.format = visibility_format}}}};
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    gn::embed::Frame frame = outline(size, HostCamera::on_path(0).cs_from_ws(aspect), lights);
    if (casters_) {
        frame.casters.draw = [](const gn::CasterView&) {};  // nothing is drawn yet
    }
    const auto foreseen = shadows_.foresee(frame);
    if (!foreseen.ok()) {
        throw Refused(foreseen.why());
    }
    for (const std::string& why : foreseen.value().refused) {
        if (!why.empty()) {
            throw Refused(why);
        }
    }
    if (casters_ && foreseen.value().casters.depth != gn::CasterFormats{}.depth) {
        throw Refused("the casters' pipelines draw another depth than the maps are made of");
    }
}

void ShadowPass::record(VkCommandBuffer commands, std::uint32_t slot, std::uint64_t number, const Targets& targets,
                        const ScenePass& scene, const HostBuffer& transforms, const glm::mat4& cs_from_ws) {
    Lights lights{{
        {sun, sun_light(), lend(targets.visibility[sun], VK_IMAGE_LAYOUT_UNDEFINED)},
        {lamp, lamp_light(), lend(targets.visibility[lamp], VK_IMAGE_LAYOUT_UNDEFINED)},
    }};
    if (number % 3 == 2) {
        std::reverse(lights.begin(), lights.end());
    }
    gn::embed::Frame frame = outline(targets.size, cs_from_ws, lights);
    frame.slot = slot;
    frame.receivers.depth = lend(targets.depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    frame.receivers.normals = lend(targets.normals, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    frame.casters.poses = number + 1;
    if (casters_) {
        frame.casters.draw = [&](const gn::CasterView& view) { casters_->draw(view, scene, transforms); };
    } else {
        frame.casters.positions = lend(scene.vertices());
        frame.casters.stride = sizeof(Vertex);
        frame.casters.indices = lend(scene.indices());
        frame.casters.transforms = lend(transforms);
        frame.casters.objects = objects_;
    }
    const auto recorded = shadows_.record(commands, frame);
    if (!recorded.ok()) {
        throw std::runtime_error(recorded.why());
    }
    for (const std::string& why : recorded.value()) {
        if (!why.empty()) {
            throw std::runtime_error("a light has no shadow: " + why);
        }
    }
}
