// SPDX-License-Identifier: MIT
#include "shadow/geometry/caster_geometry.h"

#include "gpu/hash.h"
#include "shadow/geometry/draw.h"
#include "shadow/scene/casting.h"

#include <algorithm>
#include <limits>

namespace gn {

namespace {

struct AlphaRange {
    float low = 1, high = 1;
};

// The smallest and the largest alpha that any lookup into a texture can give, of 255.
AlphaRange alpha_range(const Texture& texture) {
    const std::vector<std::uint8_t>& rgba = texture.image.rgba;
    std::uint8_t low = 255, high = rgba.size() < 4 ? 255 : 0;
    for (std::size_t i = 3; i < rgba.size(); i += 4) {
        low = std::min(low, rgba[i]);
        high = std::max(high, rgba[i]);
    }
    return {static_cast<float>(low), static_cast<float>(high)};
}

// The same of an object's vertices.
AlphaRange alpha_range(const Scene& scene, const Object& object) {
    AlphaRange range{std::numeric_limits<float>::max(), 0};
    for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
        const uvec3 t = scene.triangles[object.first_triangle + i];
        for (int corner = 0; corner < 3; ++corner) {
            range.low = std::min(range.low, scene.colors[t[corner]].a);
            range.high = std::max(range.high, scene.colors[t[corner]].a);
        }
    }
    return range;
}

// Of all textures and, where vertices have colours, of all objects: what takes long to find and changes with the upload.
struct AlphaRanges {
    std::vector<AlphaRange> textures, objects;
};
AlphaRanges alpha_ranges(const Scene& scene) {
    AlphaRanges ranges;
    for (const Texture& texture : scene.textures) {
        ranges.textures.push_back(alpha_range(texture));
    }
    for (std::size_t i = 0; !scene.colors.empty() && i < scene.objects.size(); ++i) {
        ranges.objects.push_back(alpha_range(scene, scene.objects[i]));
    }
    return ranges;
}

CasterKind kind_of(const Scene& scene, std::size_t object, const AlphaRanges& ranges) {
    const Material& material = scene.materials[static_cast<std::size_t>(scene.objects[object].material)];
    if (material.alpha_mode == AlphaMode::opaque) {
        return CasterKind::opaque;
    }
    const int texture = material.base_color_texture;
    const float base = material.base_color.a, cutoff = alpha_test(material).cutoff;
    AlphaRange worn{base, base};
    if (texture >= 0) {
        const AlphaRange texels = ranges.textures[static_cast<std::size_t>(texture)];
        worn = {base * texels.low / 255.0F, base * texels.high / 255.0F};
    }
    const AlphaRange own = ranges.objects.empty() ? AlphaRange{} : ranges.objects[object];
    if (own.low * worn.low >= cutoff) {
        return CasterKind::opaque;
    }
    return own.high * worn.high < cutoff ? CasterKind::absent : CasterKind::masked;
}

}  // namespace

std::vector<CasterKind> caster_kinds(const FrameInput& input) {
    const Scene& scene = input.scene;
    const auto ranges = input.derive("alpha ranges", 0, [&] { return alpha_ranges(scene); });
    std::vector<CasterKind> kinds;
    kinds.reserve(scene.objects.size());
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        kinds.push_back(casts(scene, i, &input.light()) ? kind_of(scene, i, *ranges) : CasterKind::absent);
    }
    return kinds;
}

std::uint64_t casters_key(const Scene& scene, const std::vector<CasterKind>& kinds) {
    Hasher hasher;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        hasher.value(static_cast<std::uint64_t>(kinds[i]) + (is_single_sided(scene, scene.objects[i]) ? 4 : 0));
    }
    return hasher.finish().low;
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

}  // namespace gn
