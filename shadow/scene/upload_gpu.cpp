// SPDX-License-Identifier: MIT
// The scene on the GPU: five buffers and the base colour textures.
#include "shadow/frame/frame.h"

#include <atomic>
#include <bit>

namespace gn {
namespace {

template <class T>
Buffer upload(Device& device, const char* name, const std::vector<T>& values, VkBufferUsageFlags usage) {
    return upload_buffer(device, {.name = name, .bytes = values.size() * sizeof(T), .usage = usage},
                         std::as_bytes(std::span(values)));
}

Texture2D upload_rgba8(Device& device, const std::string& name, const Image8& image) {
    const auto width = static_cast<std::uint32_t>(image.width);
    const auto height = static_cast<std::uint32_t>(image.height);
    const TextureDesc desc{.name = name,
                           .format = VK_FORMAT_R8G8B8A8_SRGB,
                           .width = width,
                           .height = height,
                           .mips = static_cast<std::uint32_t>(std::bit_width(std::max(width, height))),
                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT};
    return upload_texture(device, desc, std::as_bytes(std::span(image.rgba)));
}

}  // namespace

std::uint64_t next_version() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

SceneGpu upload_scene(Device& device, const Scene& scene) {
    constexpr VkBufferUsageFlags vertex = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    SceneGpu gpu;
    gpu.scene = &scene;
    gpu.version = next_version();
    gpu.positions = upload(device, "positions", scene.positions_ws, vertex);
    gpu.normals = upload(device, "normals", scene.normals_ws, vertex);
    gpu.uvs = upload(device, "uvs", scene.uvs, vertex);
    gpu.colors = upload(device, "colors", scene.colors.empty() ? std::vector<vec4>{vec4(1.0F)} : scene.colors,
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    gpu.indices = upload(device, "indices", scene.triangles,
                         VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    for (const Texture& texture : scene.textures) {
        gpu.textures.push_back(upload_rgba8(device, texture.name, texture.image));
    }
    gpu.white = upload_rgba8(device, "white", {1, 1, {255, 255, 255, 255}});
    return gpu;
}

void refresh_scene(Device& device, SceneGpu& scene) {
    write_buffer(device, scene.positions, std::as_bytes(std::span(scene.scene->positions_ws)));
    write_buffer(device, scene.normals, std::as_bytes(std::span(scene.scene->normals_ws)));
    scene.version = next_version();
}

SceneHandles import_scene(FrameGraph& graph, SceneGpu& scene) {
    SceneHandles handles{.positions = graph.import(scene.positions),
                         .normals = graph.import(scene.normals),
                         .uvs = graph.import(scene.uvs),
                         .colors = graph.import(scene.colors),
                         .indices = graph.import(scene.indices)};
    for (Texture2D& texture : scene.textures) {
        handles.textures.push_back(graph.import(texture));
    }
    handles.white = graph.import(scene.white);
    handles.version = scene.version;
    handles.derived = scene.derived;
    return handles;
}

}  // namespace gn
