// SPDX-License-Identifier: MIT
// A renderer for tests: it has drawn depth and normals of a scene, has the scene's buffers, and lends all of it.
#pragma once

#include "gpu/features.h"
#include "shadow/embed/embed.h"
#include "shadow/view/read_back.h"
#include "tests/rig.h"

namespace gn::test {

/// What the suite's device was made with.
struct LentDevice {
    FeatureChain chain;
    std::vector<const char*> extensions;
    LentDevice() { enable(examine(device().physical()), chain, extensions); }
    [[nodiscard]] AdoptedDevice adopted() const {
        Device& d = device();
        return {d.instance(), d.physical(), d.vk(), d.queue(), d.queue_family(), &chain.core, extensions};
    }
};

/// Records a frame, waits, and gives what the lights were refused for.
inline std::vector<std::string> run(embed::Shadows& shadows, const embed::Frame& frame) {
    std::vector<std::string> refused;
    device().run([&](VkCommandBuffer commands) {
        const auto recorded = shadows.record(commands, frame);
        EXPECT_TRUE(recorded.ok()) << recorded.why();
        refused = recorded.ok() ? recorded.value() : std::vector<std::string>{};
    });
    return refused;
}

class LentRenderer {
  public:
    LentRenderer(Scene given, uint width, uint height) : scene(std::move(given)), width_(width), height_(height) {
        draw();
        upload();
    }

    /// The frame that lends the scene as it stands; spans stay with this object.
    [[nodiscard]] embed::Frame frame(std::uint32_t slot = 0) {
        lights_.clear();
        for (std::size_t i = 0; i < scene.lights.size(); ++i) {
            lights_.push_back({i, scene.lights[i].shape, lend(targets[i], VK_FORMAT_R32_SFLOAT)});
        }
        return {.slot = slot,
                .receivers = {.width = width_,
                              .height = height_,
                              .depth = lend(depth, VK_FORMAT_R32_SFLOAT),
                              .normals = lend(normals, VK_FORMAT_R32G32B32A32_SFLOAT),
                              .cs_from_ws = view_constants(scene.cameras.front(), width_, height_).cs_from_ws},
                .casters = {.positions = {positions.vk(), 0, positions.desc().bytes},
                            .indices = {indices.vk(), 0, indices.desc().bytes},
                            .transforms = {transforms.vk(), 0, transforms.desc().bytes},
                            .objects = objects,
                            .bounds_ws = scene.bounds_ws,
                            .topology = 1,
                            .poses = poses},
                .lights = lights_};
    }

    /// V of a light after its frame has completed.
    [[nodiscard]] std::vector<float> visibility(std::size_t light) {
        return values_of(download(device(), targets[light]));
    }

    Scene scene;
    CpuSamples seen;  ///< by the scene's first camera
    Texture2D depth, normals;
    std::vector<Texture2D> targets;
    Buffer positions, indices, transforms;
    std::vector<embed::CasterObject> objects;
    std::uint64_t poses = 1;

  private:
    static std::vector<float> values_of(const std::vector<std::byte>& bytes) {
        std::vector<float> values(bytes.size() / sizeof(float));
        std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    }

    static embed::LentImage lend(Texture2D& texture, VkFormat format) {
        const embed::LentImage lent{texture.vk(), format, texture.layouts.front(),
                                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        texture.layouts.front() = lent.after;
        return lent;
    }

    Texture2D texture(const char* name, VkFormat format, VkImageUsageFlags more, std::span<const std::byte> data) {
        return upload_texture(device(),
                              {.name = name,
                               .format = format,
                               .width = width_,
                               .height = height_,
                               .usage = VK_IMAGE_USAGE_SAMPLED_BIT | more},
                              data);
    }

    /// Depth and normals as the library's own view has them.
    void draw() {
        SceneGpu gpu = upload_scene(device(), scene);
        FrameGraph graph(device());
        const SceneHandles handles = import_scene(graph, gpu);
        const ViewSamples samples = add_view_samples(graph, gpu, handles, scene.cameras.front(), width_, height_);
        for (const TextureHandle kept : {samples.depth, samples.normal, samples.position}) {
            graph.keep(kept);
        }
        graph.execute(false);
        seen = read_samples(graph, samples);
        depth = texture("lent depth", VK_FORMAT_R32_SFLOAT, 0, graph.download(samples.depth));
        normals = texture("lent normals", VK_FORMAT_R32G32B32A32_SFLOAT, 0, graph.download(samples.normal));
        const std::vector<float> nothing(std::size_t{width_} * height_, -1.0F);
        for (std::size_t i = 0; i < scene.lights.size(); ++i) {
            targets.push_back(texture("V", VK_FORMAT_R32_SFLOAT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                      std::as_bytes(std::span(nothing))));
        }
    }

    /// Every object of the scene is one of the renderer's, under no transform.
    void upload() {
        const auto buffer = [](const char* name, std::span<const std::byte> bytes) {
            return upload_buffer(
                device(), {.name = name, .bytes = bytes.size(), .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}, bytes);
        };
        positions = buffer("os positions", std::as_bytes(std::span(scene.positions_ws)));
        std::vector<uvec3> triangles = scene.triangles;
        for (const Object& object : scene.objects) {
            // A mesh of its own: the range of vertices that the object uses, and indices from its beginning.
            const std::span<uvec3> own = std::span(triangles).subspan(object.first_triangle, object.triangle_count);
            std::uint32_t first = ~0U, last = 0;
            for (const uvec3 t : own) {
                first = std::min({first, t.x, t.y, t.z});
                last = std::max({last, t.x, t.y, t.z});
            }
            std::for_each(own.begin(), own.end(), [first](uvec3& t) { t -= first; });
            objects.push_back({.first_index = 3 * object.first_triangle,
                               .index_count = 3 * object.triangle_count,
                               .first_vertex = first,
                               .vertex_count = last - first + 1});
        }
        indices = buffer("indices", std::as_bytes(std::span(triangles)));
        const std::vector<mat4> still(scene.objects.size(), mat4(1));
        transforms = buffer("transforms", std::as_bytes(std::span(still)));
    }

    uint width_, height_;
    std::vector<embed::LentLight> lights_;
};

}  // namespace gn::test
