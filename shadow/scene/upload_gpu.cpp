// SPDX-License-Identifier: MIT
// The scene on the GPU: its buffers and the base colour textures.
#include "gpu/upload.h"
#include "shadow/frame/frame.h"
#include "shadow/view/surface.glsl"

#include <algorithm>
#include <atomic>
#include <bit>

namespace gn {
namespace {

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

/// Unit, in double precision until it is rounded; 0 where the triangle has no area.
vec3 face_normal(const Scene& scene, const uvec3& t) {
    const dvec3 a_ws(scene.positions_ws[t.x]);
    const dvec3 n_ws = glm::cross(dvec3(scene.positions_ws[t.y]) - a_ws, dvec3(scene.positions_ws[t.z]) - a_ws);
    const double size = glm::length(n_ws);
    return size > 0 ? vec3(n_ws / size) : vec3(0);
}

std::vector<vec3> face_normals(const Scene& scene, std::uint32_t first, std::uint32_t count) {
    std::vector<vec3> normals_ws;
    normals_ws.reserve(count);
    for (const uvec3& t : std::span(scene.triangles).subspan(first, count)) {
        normals_ws.push_back(face_normal(scene, t));
    }
    return normals_ws;
}

std::vector<vec3> emission(const Scene& scene) {
    std::vector<vec3> radiance;
    for (const Object& object : scene.objects) {
        radiance.push_back(scene.materials[static_cast<std::size_t>(object.material)].emissive);
    }
    return radiance;
}

}  // namespace

std::uint64_t next_version() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

SceneGpu upload_scene(Device& device, const Scene& scene) {
    constexpr VkBufferUsageFlags vertex = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    if (scene.objects.size() > glsl::gn_surface_objects) {
        fail("scene '{}' has {} objects; view samples can tell {} apart", scene.name, scene.objects.size(),
             glsl::gn_surface_objects);
    }
    SceneGpu gpu;
    gpu.scene = &scene;
    gpu.version = next_version();
    gpu.moves->add(0, gpu.version, {});
    for (const Object& object : scene.objects) {
        gpu.objects.push_back({object.version, object.bounds_ws});
    }
    gpu.positions = upload(device, "positions", scene.positions_ws, vertex);
    gpu.normals = upload(device, "normals", scene.normals_ws, vertex);
    gpu.uvs = upload(device, "uvs", scene.uvs, vertex);
    gpu.colors = upload(device, "colors", scene.colors.empty() ? std::vector<vec4>{vec4(1.0F)} : scene.colors);
    gpu.indices = upload(device, "indices", scene.triangles,
                         VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    gpu.face_normals =
        upload(device, "face normals", face_normals(scene, 0, static_cast<std::uint32_t>(scene.triangles.size())));
    gpu.emission = upload(device, "emission", emission(scene));
    for (const Texture& texture : scene.textures) {
        gpu.textures.push_back(upload_rgba8(device, texture.name, texture.image));
    }
    gpu.white = upload_rgba8(device, "white", {1, 1, {255, 255, 255, 255}});
    return gpu;
}

namespace {

/// A range of vertices, end exclusive.
struct Vertices {
    std::uint32_t begin = ~0U, end = 0;
};

Vertices vertices_of(const Scene& scene, const Object& object) {
    Vertices range;
    for (const uvec3 t : std::span(scene.triangles).subspan(object.first_triangle, object.triangle_count)) {
        range.begin = std::min({range.begin, t.x, t.y, t.z});
        range.end = std::max({range.end, t.x + 1, t.y + 1, t.z + 1});
    }
    return range;
}

/// Ascending, joined where they touch or little lies between: a copy costs as much as some kilobytes.
std::vector<Vertices> joined(std::vector<Vertices> ranges) {
    constexpr std::uint32_t gap = 256;
    std::sort(ranges.begin(), ranges.end(), [](const Vertices& a, const Vertices& b) { return a.begin < b.begin; });
    std::vector<Vertices> joined;
    for (const Vertices& range : ranges) {
        if (joined.empty() || range.begin > joined.back().end + gap) {
            joined.push_back(range);
        } else {
            joined.back().end = std::max(joined.back().end, range.end);
        }
    }
    return joined;
}

void write_vertices(Device& device, const Buffer& buffer, const std::vector<vec3>& values,
                    const std::vector<Vertices>& ranges) {
    std::vector<PlacedBytes> placed;
    for (const Vertices& range : ranges) {
        placed.push_back({range.begin * sizeof(vec3),
                          std::as_bytes(std::span(values).subspan(range.begin, range.end - range.begin))});
    }
    write_buffer(device, buffer, placed);
}

/// Those of the objects' triangles.
void write_face_normals(Device& device, const Buffer& buffer, const Scene& scene,
                        std::span<const std::uint32_t> objects) {
    std::vector<std::vector<vec3>> normals_ws;
    std::vector<PlacedBytes> placed;
    for (const std::uint32_t i : objects) {
        const Object& object = scene.objects[i];
        normals_ws.push_back(face_normals(scene, object.first_triangle, object.triangle_count));
        placed.push_back({object.first_triangle * sizeof(vec3), std::as_bytes(std::span(normals_ws.back()))});
    }
    write_buffer(device, buffer, placed);
}

}  // namespace

void refresh_scene(Device& device, SceneGpu& scene) {
    std::vector<std::uint32_t> moved;
    std::vector<Vertices> vertices;
    std::vector<Box> touched_ws;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.scene->objects[i];
        SceneGpu::Uploaded& held = scene.objects[i];
        if (object.version == held.version || object.triangle_count == 0) {
            continue;
        }
        moved.push_back(static_cast<std::uint32_t>(i));
        vertices.push_back(vertices_of(*scene.scene, object));
        touched_ws.push_back(held.bounds_ws);
        touched_ws.push_back(object.bounds_ws);
        held = {object.version, object.bounds_ws};
    }
    if (moved.empty()) {
        return;
    }
    const std::vector<Vertices> ranges = joined(std::move(vertices));
    write_vertices(device, scene.positions, scene.scene->positions_ws, ranges);
    write_vertices(device, scene.normals, scene.scene->normals_ws, ranges);
    write_face_normals(device, scene.face_normals, *scene.scene, moved);
    const std::uint64_t before = scene.version;
    scene.version = next_version();
    scene.moves->add(before, scene.version, std::move(touched_ws));
}

SceneHandles import_scene(FrameGraph& graph, SceneGpu& scene) {
    SceneHandles handles{.positions = graph.import(scene.positions),
                         .normals = graph.import(scene.normals),
                         .uvs = graph.import(scene.uvs),
                         .colors = graph.import(scene.colors),
                         .indices = graph.import(scene.indices),
                         .face_normals = graph.import(scene.face_normals),
                         .emission = graph.import(scene.emission)};
    for (Texture2D& texture : scene.textures) {
        handles.textures.push_back(graph.import(texture));
    }
    handles.white = graph.import(scene.white);
    handles.version = scene.version;
    handles.derived = scene.derived;
    handles.moves = scene.moves;
    return handles;
}

}  // namespace gn
