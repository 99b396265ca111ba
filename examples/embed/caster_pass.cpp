// SPDX-License-Identifier: MIT
#include "caster_pass.h"

#include "caster_frag.h"
#include "caster_vert.h"

#include <algorithm>
#include <cstddef>

namespace {

/// As Push in caster.vert.
struct CasterPush {
    glm::mat4 cs_from_ws;
    glm::vec4 depth_from_ws;
    float grid;
};

PipelineDesc described(std::span<const std::uint32_t> fragment) {
    return {.vertex = caster_vert,
            .fragment = fragment,
            .bindings = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
            .push_bytes = sizeof(CasterPush),
            .attributes = {offsetof(Vertex, position_os)},
            .stride = sizeof(Vertex),
            .depth = gn::CasterFormats{}.depth,
            .of_light = true};
}

}  // namespace

CasterPass::CasterPass(const HostDevice& host, const World& world)
    : world_(world), affine_(host, described({})), bent_(host, described(caster_frag)) {}

void CasterPass::draw(const gn::CasterView& view, const ScenePass& scene, const HostBuffer& transforms) const {
    const Pipeline& pipeline = view.writes_depth ? bent_ : affine_;
    const CasterPush push{view.view.cs_from_ws, view.view.depth_from_ws, view.view.grid};
    pipeline.bind(view.commands);
    pipeline.push_constants(view.commands, std::as_bytes(std::span(&push, 1)));
    pipeline.push_buffer(view.commands, 0, transforms.whole());
    scene.bind_meshes(view.commands);
    for (const Group& group : world_.groups) {
        // The lamp's own ball, behind all that casts, lets its light out.
        if (group.first < world_.casters) {
            vkCmdDrawIndexed(view.commands, group.mesh.index_count, std::min(group.count, world_.casters - group.first),
                             group.mesh.first_index, static_cast<std::int32_t>(group.mesh.first_vertex), group.first);
        }
    }
}
