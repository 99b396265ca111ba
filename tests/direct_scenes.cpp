// SPDX-License-Identifier: MIT
#include "tests/direct_scenes.h"

#include <random>

namespace gn::by_hand {

SceneBuilder::SceneBuilder() {
    scene_.name = "by hand";
    scene_.materials.emplace_back();
}

SceneBuilder& SceneBuilder::mesh(const std::vector<vec3>& corners, const std::vector<uvec3>& triangles, int material,
                                 const std::vector<vec2>& uvs) {
    const auto base = static_cast<std::uint32_t>(scene_.positions_ws.size());
    Object object{.name = "object",
                  .first_triangle = static_cast<std::uint32_t>(scene_.triangles.size()),
                  .triangle_count = static_cast<std::uint32_t>(triangles.size()),
                  .material = material};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        scene_.positions_ws.push_back(corners[i]);
        scene_.normals_ws.emplace_back(0.0F);
        scene_.uvs.push_back(i < uvs.size() ? uvs[i] : vec2(0));
        object.bounds_ws.grow(corners[i]);
    }
    for (const uvec3 t : triangles) {
        scene_.triangles.push_back(t + uvec3(base));
    }
    scene_.bounds_ws.grow(object.bounds_ws);
    scene_.objects.push_back(object);
    return *this;
}

SceneBuilder& SceneBuilder::quad(vec3 a, vec3 b, vec3 c, vec3 d, int material) {
    return mesh({a, b, c, d}, {{0, 1, 2}, {0, 2, 3}}, material, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
}

SceneBuilder& SceneBuilder::ground(float half, float y) {
    return quad({-half, y, half}, {half, y, half}, {half, y, -half}, {-half, y, -half});
}

SceneBuilder& SceneBuilder::box(vec3 low, vec3 high, bool inverted) {
    std::vector<vec3> corners;
    std::vector<uvec3> triangles;
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool upper : {false, true}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const auto base = static_cast<std::uint32_t>(corners.size());
            for (const vec2 at : {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)}) {
                vec3 p;
                p[axis] = upper ? high[axis] : low[axis];
                p[u] = at.x > 0 ? high[u] : low[u];
                p[v] = at.y > 0 ? high[v] : low[v];
                corners.push_back(p);
            }
            for (uvec3 t : {uvec3(0, 1, 2), uvec3(0, 2, 3)}) {
                triangles.push_back(base + (upper != inverted ? t : uvec3(t.x, t.z, t.y)));
            }
        }
    }
    return mesh(corners, triangles);
}

SceneBuilder& SceneBuilder::torus(vec3 centre, float radius, float tube, std::uint32_t n) {
    std::vector<vec3> corners;
    std::vector<uvec3> triangles;
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
            const float a = 2 * pi * static_cast<float>(i) / static_cast<float>(n);
            const float b = 2 * pi * static_cast<float>(j) / static_cast<float>(n);
            const float r = radius + tube * std::cos(b);
            corners.push_back(centre + vec3(r * std::cos(a), tube * std::sin(b), r * std::sin(a)));
            const std::uint32_t i1 = (i + 1) % n, j1 = (j + 1) % n;
            triangles.emplace_back(i * n + j, i * n + j1, i1 * n + j1);
            triangles.emplace_back(i * n + j, i1 * n + j1, i1 * n + j);
        }
    }
    return mesh(corners, triangles);
}

SceneBuilder& SceneBuilder::soup(Box box, float size, int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    const auto point = [&] { return vec3(unit(random), unit(random), unit(random)); };
    for (int i = 0; i < count; ++i) {
        const vec3 middle = box.min + point() * box.extent();
        mesh({middle + size * (point() - 0.5F), middle + size * (point() - 0.5F), middle + size * (point() - 0.5F)},
             {{0, 1, 2}});
    }
    return *this;
}

SceneBuilder& SceneBuilder::light(const GnLight& shape) {
    scene_.lights.push_back({"light " + std::to_string(scene_.lights.size()), shape});
    return *this;
}

SceneBuilder& SceneBuilder::camera(vec3 from, vec3 at, float near, float far) {
    const vec3 forward = glm::normalize(at - from);
    const vec3 up = std::abs(forward.y) > 0.99F ? vec3(0, 0, -1) : vec3(0, 1, 0);
    scene_.cameras.push_back({.position_ws = from, .forward_ws = forward, .up_ws = up, .near = near, .far = far});
    return *this;
}

int SceneBuilder::material(const Material& material, const Texture* texture) {
    scene_.materials.push_back(material);
    if (texture != nullptr) {
        scene_.materials.back().base_color_texture = static_cast<int>(scene_.textures.size());
        scene_.textures.push_back(*texture);
    }
    return static_cast<int>(scene_.materials.size()) - 1;
}

GnLight sun(vec3 direction) {
    GnLight light{};
    light.kind = GN_LIGHT_DIRECTIONAL;
    light.direction_ws = vec4(glm::normalize(direction), 0);
    return light;
}

GnLight point(vec3 at) {
    GnLight light{};
    light.kind = GN_LIGHT_POINT;
    light.position_ws = vec4(at, 1);
    return light;
}

GnLight spot(vec3 at, vec3 target, float half_angle) {
    GnLight light = point(at);
    light.kind = GN_LIGHT_SPOT;
    light.direction_ws = vec4(glm::normalize(target - at), 0);
    light.cos_outer = std::cos(half_angle);
    light.cos_inner = std::cos(0.8F * half_angle);
    return light;
}

GnLight rectangle(vec3 at, vec3 target) {
    GnLight light = point(at);
    light.kind = GN_LIGHT_RECTANGLE;
    const vec3 axis = glm::normalize(target - at);
    vec3 right, up;
    complete_frame(axis, right, up);
    light.direction_ws = vec4(axis, 0);
    light.right_ws = vec4(right, 0);
    light.up_ws = vec4(up, 0);
    return light;
}

SceneBuilder garden() {
    SceneBuilder b;
    Texture holes{.name = "holes",
                  .image = {2, 2, {255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 0, 255, 255, 255, 255}}};
    const int leaf = b.material({.name = "leaf", .alpha_mode = AlphaMode::mask}, &holes);
    const int one = b.material({.name = "one side", .double_sided = false});
    b.ground(10).box({-1, 0, -1}, {0, 1.3F, 0.2F}).torus({1.4F, 1, 0}, 0.7F, 0.25F, 12);
    b.soup({{-2, 0.3F, 1}, {2, 2, 2}}, 0.8F, 30, 4);
    b.quad({-2, 1.6F, -2}, {-0.6F, 1.7F, -2}, {-0.6F, 1.7F, -0.8F}, {-2, 1.6F, -0.8F}, leaf);
    b.quad({0.8F, 1.9F, -2}, {1.9F, 1.9F, -2}, {1.9F, 1.9F, -1}, {0.8F, 1.9F, -1}, one);
    b.camera({3.4F, 3.6F, 4.4F}, {0, 0.4F, 0});
    return b;
}

Scene lit_garden() {
    GnLight sunlight = sun({0.4F, -1, -0.3F}), lamp = point({-1, 3, 1}), beam = spot({-1.5F, 4, 1}, {0, 0, 0}, 0.8F);
    sunlight.angular_radius = 0.03F;
    lamp.radius = beam.radius = 0.2F;
    return garden().light(sunlight).light(lamp).light(beam).scene();
}

Scene box_on_ground() {
    SceneBuilder b;
    b.ground(8).box({-1, 0.5F, -1}, {1, 2.5F, 1}).light(sun({0.3F, -1, 0.2F}));
    Scene scene = b.scene();
    scene.cameras = {{.position_ws = vec3(0, 9, 9), .forward_ws = glm::normalize(vec3(0, -1, -1))}};
    return scene;
}

Recipe direct_recipe(const Part& part, const std::vector<std::pair<std::string, std::string>>& values) {
    Recipe recipe;
    recipe.name = std::string(part.id);
    recipe.direct = &part;
    ParamBlock block(part.params);
    for (const auto& [name, value] : values) {
        block.set(name, value, "test");
    }
    recipe.params.emplace(std::string(part.id), block);
    return recipe;
}

Comparison judge(const Scene& scene, const FrameResult& frame, std::size_t light) {
    const Truth truth(scene);
    const CpuSamples& samples = frame.samples;
    const TruthResult traced =
        truth.trace(samples.position_ws, samples.normal_ws, scene.lights[light].shape, {.samples = 1});
    const auto edges = edge_pixels(traced.visibility, traced.counted, static_cast<int>(samples.width),
                                   static_cast<int>(samples.height));
    Comparison result;
    const std::vector<float>& seen = frame.visibility[light].values;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        // Whether a sample faces the light is rounding's choice where its plane holds the light.
        const vec3 p_ws(samples.position_ws[i]), n_ws(samples.normal_ws[i]);
        if (std::abs(glm::dot(n_ws, gn_to_light(scene.lights[light].shape, p_ws))) < 1e-5F) {
            continue;
        }
        if (traced.counted[i] == 0) {
            EXPECT_EQ(seen[i], 0.0F) << "an uncounted sample at pixel " << i % samples.width << ", "
                                     << i / samples.width;
            continue;
        }
        if (edges[i] != 0) {
            ++result.edge;
            continue;
        }
        ++result.judged;
        ++(traced.visibility[i] > 0.5F ? result.lit : result.shadowed);
        if (seen[i] != traced.visibility[i]) {
            if (result.wrong++ == 0) {
                result.first =
                    fmt::format("light {}, pixel {}, {}: V = {}, traced {}, at ({}, {}, {})", light, i % samples.width,
                                i / samples.width, seen[i], traced.visibility[i], p_ws.x, p_ws.y, p_ws.z);
            }
        }
    }
    return result;
}

std::vector<Comparison> render_and_judge(const Scene& scene, const Recipe& recipe, uint width, uint height) {
    Device& gpu = device();
    const std::size_t messages = gpu.messages().size();
    SceneGpu uploaded = upload_scene(gpu, scene);
    const FrameResult frame = render_frame(gpu, uploaded, scene.cameras.front(), recipe,
                                           {.width = width, .height = height, .picture = false});
    for (std::size_t i = messages; i < gpu.messages().size(); ++i) {
        ADD_FAILURE() << gpu.messages()[i];
    }
    std::vector<Comparison> results;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        EXPECT_EQ(frame.refused[i], "");
        if (frame.refused[i].empty()) {
            results.push_back(judge(scene, frame, i));
        }
    }
    return results;
}

}  // namespace gn::by_hand
