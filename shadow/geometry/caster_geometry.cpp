// SPDX-License-Identifier: MIT
#include "shadow/geometry/caster_geometry.h"

#include "shadow/scene/casting.h"
#include "shadow/view/draw.h"

#include <bit>
#include <cstring>
#include <limits>

namespace gn {

namespace {

// The smallest and the largest alpha that any lookup into the texture can give.
std::pair<float, float> alpha_range(const Scene& scene, const Material& material) {
    if (material.base_color_texture < 0) {
        return {material.base_color.a, material.base_color.a};
    }
    const auto& rgba = scene.textures[static_cast<std::size_t>(material.base_color_texture)].image.rgba;
    std::uint8_t low = 255, high = 0;
    for (std::size_t i = 3; i < rgba.size(); i += 4) {
        low = std::min(low, rgba[i]);
        high = std::max(high, rgba[i]);
    }
    if (rgba.size() < 4) {
        low = high = 255;
    }
    return {material.base_color.a * static_cast<float>(low) / 255.0F,
            material.base_color.a * static_cast<float>(high) / 255.0F};
}

// The same of an object's vertices.
std::pair<float, float> vertex_alpha_range(const Scene& scene, const Object& object) {
    if (scene.colors.empty()) {
        return {1.0F, 1.0F};
    }
    float low = std::numeric_limits<float>::max(), high = 0.0F;
    for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
        const uvec3 t = scene.triangles[object.first_triangle + i];
        for (int corner = 0; corner < 3; ++corner) {
            low = std::min(low, scene.colors[t[corner]].a);
            high = std::max(high, scene.colors[t[corner]].a);
        }
    }
    return {low, high};
}

CasterKind kind_of(const Scene& scene, const Object& object, std::pair<float, float> of_material) {
    const Material& material = scene.materials[static_cast<std::size_t>(object.material)];
    if (material.alpha_mode == AlphaMode::opaque) {
        return CasterKind::opaque;
    }
    const auto [low, high] = vertex_alpha_range(scene, object);
    const float cutoff = alpha_test(material).cutoff;
    if (low * of_material.first >= cutoff) {
        return CasterKind::opaque;
    }
    return high * of_material.second < cutoff ? CasterKind::absent : CasterKind::masked;
}

// A multiplicative mix of eight bytes at a time; the tail is padded with zeros.
std::uint64_t mix(std::uint64_t hash, const void* data, std::size_t bytes) {
    const auto* at = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; i += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, at + i, std::min<std::size_t>(8, bytes - i));
        hash = std::rotl((hash ^ word) * 0x9E3779B97F4A7C15ULL, 29) * 0xBF58476D1CE4E5B9ULL;
    }
    return hash ^ (hash >> 31U);
}

}  // namespace

std::vector<CasterKind> caster_kinds(const Scene& scene, const Light& light) {
    // Look through each texture once, however many objects wear it.
    std::vector<std::pair<float, float>> of_material;
    of_material.reserve(scene.materials.size());
    for (const Material& material : scene.materials) {
        of_material.push_back(alpha_range(scene, material));
    }
    std::vector<CasterKind> kinds;
    kinds.reserve(scene.objects.size());
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        kinds.push_back(casts(scene, i, &light)
                            ? kind_of(scene, object, of_material[static_cast<std::size_t>(object.material)])
                            : CasterKind::absent);
    }
    return kinds;
}

CasterSides split_sides(const Scene& scene, const std::vector<CasterKind>& kinds) {
    CasterSides sides{kinds, kinds};
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        (is_single_sided(scene, scene.objects[i]) ? sides.both : sides.one)[i] = CasterKind::absent;
    }
    return sides;
}

std::vector<TriangleRun> opaque_caster_runs(const Scene& scene, const std::vector<CasterKind>& kinds) {
    std::vector<TriangleRun> runs;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        if (kinds[i] != CasterKind::opaque || object.triangle_count == 0) {
            continue;
        }
        if (!runs.empty() && runs.back().first + runs.back().count == object.first_triangle) {
            runs.back().count += object.triangle_count;
        } else {
            runs.push_back({object.first_triangle, object.triangle_count});
        }
    }
    return runs;
}

vec4 light_point_ws(const GnLight& light) {
    return light.kind == uint(GN_LIGHT_DIRECTIONAL) ? vec4(-vec3(light.direction_ws), 0.0F)
                                                    : vec4(vec3(light.position_ws), 1.0F);
}

std::uint64_t geometry_hash(const Scene& scene, std::uint64_t salt) {
    std::uint64_t hash = mix(0x243F6A8885A308D3ULL, &salt, sizeof salt);
    hash = mix(hash, scene.positions_ws.data(), scene.positions_ws.size() * sizeof(vec3));
    return mix(hash, scene.triangles.data(), scene.triangles.size() * sizeof(uvec3));
}

}  // namespace gn
