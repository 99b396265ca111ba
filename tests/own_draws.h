// SPDX-License-Identifier: MIT
// Casters that a renderer for tests draws itself, with pipelines of its own, from its own copy of the scene.
#pragma once

#include "gpu/pipeline_cache.h"
#include "tests/lent_renderer.h"

#include <set>

namespace gn::test {

/// As Push in the shaders below.
struct OwnPush {
    mat4 cs_from_ws;
    vec4 depth_from_ws;
    float grid;
};

inline constexpr const char* own_vertex_text = R"(
#include "shadow/light_view.h"
layout(location = 0) in vec3 p_ws;
layout(push_constant, scalar) uniform Push { mat4 cs_from_ws; vec4 depth_from_ws; float grid; } push;
#ifdef WRITES_DEPTH
layout(location = 0) out float out_depth;
#endif
void main() {
    GnLightView view;
    view.cs_from_ws = push.cs_from_ws;
    view.grid = push.grid;
    gl_Position = gn_clip(view, p_ws);
#ifdef WRITES_DEPTH
    out_depth = dot(push.depth_from_ws, vec4(p_ws, 1.0));
#endif
}
)";
inline constexpr const char* own_fragment_text = R"(
layout(location = 0) in float in_depth;
void main() { gl_FragDepth = clamp(in_depth, 0.0, 1.0); }
)";

/// Draws of the renderer's, with pipelines of its own.
class OwnDraws {
  public:
    explicit OwnDraws(const LentRenderer& renderer)
        : renderer_(renderer),
          vertices_(buffer("own vertices", VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                           std::as_bytes(std::span(renderer.scene.positions_ws)))),
          indices_(buffer("own indices", VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
                          std::as_bytes(std::span(renderer.scene.triangles)))) {}

    void operator()(const CasterView& view) {
        const Pipeline& pipeline = pipeline_of(view.writes_depth);
        vkCmdBindPipeline(view.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.vk);
        const OwnPush push{view.view.cs_from_ws, view.view.depth_from_ws, view.view.grid};
        vkCmdPushConstants(view.commands, pipeline.layout, pipeline.stages, 0, sizeof(OwnPush), &push);
        const VkBuffer vertices = vertices_.vk();
        const VkDeviceSize begin = 0;
        vkCmdBindVertexBuffers(view.commands, 0, 1, &vertices, &begin);
        vkCmdBindIndexBuffer(view.commands, indices_.vk(), 0, VK_INDEX_TYPE_UINT32);
        for (const Object& object : renderer_.scene.objects) {
            vkCmdDrawIndexed(view.commands, 3 * object.triangle_count, 1, 3 * object.first_triangle, 0, 0);
        }
        lights.insert(view.light_id);
        ++views;
    }

    std::set<std::uint64_t> lights;
    std::size_t views = 0;

  private:
    static Buffer buffer(const char* name, VkBufferUsageFlags usage, std::span<const std::byte> bytes) {
        return upload_buffer(device(), {.name = name, .bytes = bytes.size(), .usage = usage}, bytes);
    }
    static const Pipeline& pipeline_of(bool writes_depth) {
        RasterDesc desc;
        const std::string define = writes_depth ? "#define WRITES_DEPTH\n" : "";
        desc.vertex = {ShaderKind::vertex, "own.vert", define + own_vertex_text};
        if (writes_depth) {
            desc.fragment = ShaderSource{ShaderKind::fragment, "own.frag", own_fragment_text};
        }
        desc.depth_test = desc.depth_write = desc.depth_clamp = true;
        desc.depth_compare = VK_COMPARE_OP_LESS;
        desc.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT}};
        desc.vertex_stride = sizeof(vec3);
        const CasterFormats formats;
        return device().pipelines().get(desc, {.depth = formats.depth});
    }

    const LentRenderer& renderer_;
    Buffer vertices_, indices_;
};

}  // namespace gn::test
