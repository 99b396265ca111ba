// SPDX-License-Identifier: MIT
// The scene on the GPU: its buffers and the base colour textures.
#include "gpu/memory_barrier.h"
#include "gpu/upload.h"
#include "shadow/frame/frame.h"
#include "shadow/frame/refresh.h"
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

/// What one buffer of the scene gets.
struct Written {
    const Buffer& buffer;
    std::vector<PlacedBytes> places;
};

/// All that a refresh writes, with what it points into.
struct Refresh {
    std::vector<Written> written;
    std::vector<std::vector<vec3>> face_normals_ws;
};

Written vertices_in(const Buffer& buffer, const std::vector<vec3>& values, const std::vector<Vertices>& ranges) {
    Written written{buffer, {}};
    for (const Vertices& range : ranges) {
        written.places.push_back({range.begin * sizeof(vec3),
                                  std::as_bytes(std::span(values).subspan(range.begin, range.end - range.begin))});
    }
    return written;
}

/// Of the objects whose version is another than what was brought before, which it takes as brought.
Refresh take_moved(SceneGpu& scene) {
    Refresh refresh;
    std::vector<Vertices> vertices;
    std::vector<Box> touched_ws;
    Written faces{scene.face_normals, {}};
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.scene->objects[i];
        SceneGpu::Uploaded& held = scene.objects[i];
        if (object.version == held.version || object.triangle_count == 0) {
            continue;
        }
        vertices.push_back(vertices_of(*scene.scene, object));
        touched_ws.push_back(held.bounds_ws);
        touched_ws.push_back(object.bounds_ws);
        held = {object.version, object.bounds_ws};
        refresh.face_normals_ws.push_back(face_normals(*scene.scene, object.first_triangle, object.triangle_count));
        faces.places.push_back(
            {object.first_triangle * sizeof(vec3), std::as_bytes(std::span(refresh.face_normals_ws.back()))});
    }
    if (vertices.empty()) {
        return refresh;
    }
    const std::vector<Vertices> ranges = joined(std::move(vertices));
    refresh.written.push_back(vertices_in(scene.positions, scene.scene->positions_ws, ranges));
    refresh.written.push_back(vertices_in(scene.normals, scene.scene->normals_ws, ranges));
    refresh.written.push_back(std::move(faces));
    const std::uint64_t before = scene.version;
    scene.version = next_version();
    scene.moves->add(before, scene.version, std::move(touched_ws));
    return refresh;
}

}  // namespace

void refresh_scene(Device& device, SceneGpu& scene) {
    const Refresh refresh = take_moved(scene);
    for (const Written& written : refresh.written) {
        write_buffer(device, written.buffer, written.places);
    }
}

void record_refresh(VkCommandBuffer commands, SceneGpu& scene, UploadArena& staging) {
    const Refresh refresh = take_moved(scene);
    if (refresh.written.empty()) {
        return;
    }
    // Frames before this one may read what is written over, and this one reads what is written.
    constexpr BarrierSide copies{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
    memory_barrier(commands, all_writes, copies);
    for (const Written& written : refresh.written) {
        for (const PlacedBytes& placed : written.places) {
            const UploadedBytes from = staging.put(placed.bytes);
            const VkBufferCopy region{from.offset, placed.offset, placed.bytes.size()};
            vkCmdCopyBuffer(commands, from.buffer, written.buffer.vk(), 1, &region);
        }
    }
    memory_barrier(commands, copies, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT});
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
