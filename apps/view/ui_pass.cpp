// SPDX-License-Identifier: MIT
#include "apps/view/ui_pass.h"

#include "gpu/shader_inputs.h"

#include <imgui.h>

#include <memory>

namespace gn {
namespace {

constexpr const char* vertex_struct = R"(
struct UiVertex {
    vec2 at_pixels;
    vec2 uv;
    uint color;
};
)";

constexpr const char* vertex_text = R"(
layout(location = 0) out vec2 uv;
layout(location = 1) out vec4 color;
void main() {
    UiVertex vertex = vertices[indices[gl_VertexIndex]];
    uv = vertex.uv;
    color = unpackUnorm4x8(vertex.color);
    gl_Position = vec4(vertex.at_pixels * u.scale + u.shift, 0.0, 1.0);
}
)";

constexpr const char* fragment_text = R"(
layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 shown;
void main() {
    shown = color * texture(image, uv);
}
)";

/// Triangles with one texture inside one rectangle.
struct UiDraw {
    TextureHandle texture;
    ivec4 clip{0};  ///< x, y, width, height in pixels
    std::uint32_t first = 0, count = 0;
};

/// All lists of a frame in one.
struct UiLists {
    std::vector<ImDrawVert> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<UiDraw> draws;
};

UiLists lists_of(const ImDrawData& data, std::span<const TextureHandle> textures, uvec2 size) {
    UiLists lists;
    for (int n = 0; n < data.CmdListsCount; ++n) {
        const ImDrawList& list = *data.CmdLists[n];
        const auto first_vertex = static_cast<std::uint32_t>(lists.vertices.size());
        const auto first_index = static_cast<std::uint32_t>(lists.indices.size());
        lists.vertices.insert(lists.vertices.end(), list.VtxBuffer.begin(), list.VtxBuffer.end());
        lists.indices.resize(first_index + static_cast<std::size_t>(list.IdxBuffer.Size));
        for (const ImDrawCmd& command : list.CmdBuffer) {
            // Its indices count from a vertex of its own.
            for (std::uint32_t i = command.IdxOffset; i < command.IdxOffset + command.ElemCount; ++i) {
                lists.indices[first_index + i] = first_vertex + command.VtxOffset + list.IdxBuffer[static_cast<int>(i)];
            }
            const vec2 low = glm::max(vec2(command.ClipRect.x, command.ClipRect.y), vec2(0));
            const vec2 high = glm::min(vec2(command.ClipRect.z, command.ClipRect.w), vec2(size));
            const auto texture = reinterpret_cast<std::uintptr_t>(command.GetTexID());
            if (high.x <= low.x || high.y <= low.y || command.ElemCount == 0 || texture == 0 ||
                texture > textures.size()) {
                continue;
            }
            lists.draws.push_back({textures[texture - 1], ivec4(ivec2(low), ivec2(high) - ivec2(low)),
                                   first_index + command.IdxOffset, command.ElemCount});
        }
    }
    // Blocks grow in steps, so that a digit more makes nothing on the device.
    const auto round_up = [](std::size_t count, std::size_t step) { return (count + step - 1) / step * step; };
    lists.vertices.resize(round_up(lists.vertices.size(), 4096));
    lists.indices.resize(round_up(lists.indices.size(), 8192));
    return lists;
}

}  // namespace

Texture2D upload_fonts(Device& device) {
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.GetTexDataAsRGBA32(&texels, &width, &height);
    fonts.SetTexID(reinterpret_cast<ImTextureID>(std::uintptr_t{1}));
    const std::size_t bytes = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    return upload_texture(device,
                          {.name = "fonts",
                           .format = VK_FORMAT_R8G8B8A8_UNORM,
                           .width = static_cast<std::uint32_t>(width),
                           .height = static_cast<std::uint32_t>(height),
                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT},
                          {reinterpret_cast<const std::byte*>(texels), bytes});
}

void add_ui(FrameGraph& graph, const ImDrawData& draw_data, std::span<const TextureHandle> textures,
            TextureHandle target, vec4 background) {
    const uvec2 size(graph.desc(target).width, graph.desc(target).height);
    const auto lists = std::make_shared<const UiLists>(lists_of(draw_data, textures, size));
    ShaderInputs inputs;
    inputs.texture("sampler2D", "image", textures.front(), linear())
        .block("readonly buffer", "Vertices", "UiVertex vertices[];", std::as_bytes(std::span(lists->vertices)))
        .block("readonly buffer", "Indices", "uint indices[];", std::as_bytes(std::span(lists->indices)))
        .constant("vec2", "scale", 2.0F / vec2(size))
        .constant("vec2", "shift", vec2(-1));
    static const RasterDesc desc = [&] {
        const std::string declared = vertex_struct + inputs.text();
        RasterDesc raster;
        raster.vertex = {ShaderKind::vertex, "ui", declared + vertex_text};
        raster.fragment = ShaderSource{ShaderKind::fragment, "ui", declared + fragment_text};
        raster.blend = Blend::alpha;
        return sealed(raster);
    }();
    graph.add_pass(
        "ui",
        [&](PassBuilder& pass) {
            pass.color(target, Load::clear, {.color = background});
            for (const TextureHandle texture : textures) {
                pass.sample(texture);
            }
            pass.keep();
        },
        [lists, inputs](Recorder& r) {
            if (lists->draws.empty()) {
                return;
            }
            r.bind(desc);
            inputs.set(r);
            for (const UiDraw& draw : lists->draws) {
                r.set("image", draw.texture, linear());
                r.scissor(draw.clip.x, draw.clip.y, static_cast<std::uint32_t>(draw.clip.z),
                          static_cast<std::uint32_t>(draw.clip.w));
                r.draw(draw.count, 1, draw.first);
            }
        });
}

}  // namespace gn
