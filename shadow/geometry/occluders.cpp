// SPDX-License-Identifier: MIT
#include "shadow/geometry/occluders.h"

#include "gpu/upload.h"
#include "shadow/geometry/draw.h"
#include "shadow/scene/casting.h"

#include <cstring>

namespace gn {
namespace {

/// A material's mask as shaders read it.
struct Mask {
    std::uint32_t first = 0;              ///< byte of its first texel's alpha
    std::uint32_t width = 0, height = 0;  ///< texels; 0: no texture
    std::uint32_t repeats = 0;            ///< 1: along u, 2: along v
    float base_alpha = 1, cutoff = 0;
};
/// Per triangle: its material * 4, + 2 where its front alone casts, + 1 where it is masked.
struct OccluderBuffers {
    Buffer kinds, masks, alpha;
};

std::uint64_t alpha_bytes(const Scene& scene) {
    std::uint64_t bytes = 0;
    for (const Material& material : scene.materials) {
        if (material.alpha_mode != AlphaMode::opaque && material.base_color_texture >= 0) {
            const Image8& image = scene.textures[static_cast<std::size_t>(material.base_color_texture)].image;
            bytes += static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
        }
    }
    return bytes;
}

/// Appends the alpha of a material's texture, level 0, row by row.
Mask mask_of(const Scene& scene, const Material& material, std::vector<std::uint8_t>& alpha) {
    const AlphaTest test = alpha_test(material);
    Mask mask{.base_alpha = test.base_alpha, .cutoff = test.cutoff};
    if (material.alpha_mode == AlphaMode::opaque || material.base_color_texture < 0) {
        return mask;
    }
    const Texture& texture = scene.textures[static_cast<std::size_t>(material.base_color_texture)];
    mask.first = static_cast<std::uint32_t>(alpha.size());
    mask.width = static_cast<std::uint32_t>(texture.image.width);
    mask.height = static_cast<std::uint32_t>(texture.image.height);
    mask.repeats = (texture.repeat_u ? 1U : 0U) + (texture.repeat_v ? 2U : 0U);
    for (std::size_t i = 3; i < texture.image.rgba.size(); i += 4) {
        alpha.push_back(texture.image.rgba[i]);
    }
    return mask;
}

OccluderBuffers make_buffers(Device& device, const Scene& scene) {
    std::vector<std::uint32_t> kinds(std::max<std::size_t>(scene.triangles.size(), 1));
    for (const Object& object : scene.objects) {
        const std::uint32_t kind = static_cast<std::uint32_t>(object.material) * 4 +
                                   (is_single_sided(scene, object) ? 2U : 0U) + (is_masked(scene, object) ? 1U : 0U);
        const auto first = kinds.begin() + object.first_triangle;
        std::fill(first, first + object.triangle_count, kind);
    }
    std::vector<Mask> masks;
    std::vector<std::uint8_t> alpha;
    for (const Material& material : scene.materials) {
        masks.push_back(mask_of(scene, material, alpha));
    }
    alpha.resize(alpha.size() / 4 * 4 + 4);  // whole words, and never none
    std::vector<std::uint32_t> words(alpha.size() / 4);
    std::memcpy(words.data(), alpha.data(), alpha.size());
    return {upload(device, "occluder kinds", kinds), upload(device, "occluder masks", masks),
            upload(device, "occluder alpha", words)};
}

// As the truth reads alpha: level 0, between four texels.
constexpr const char* functions_text = R"(
GnOccluder gn_occluder(uint triangle) {
    return GnOccluder(occluder_positions[occluder_indices[3u * triangle]],
                      occluder_positions[occluder_indices[3u * triangle + 1u]],
                      occluder_positions[occluder_indices[3u * triangle + 2u]],
                      (occluder_kinds[triangle] & 2u) != 0u);
}
int gn_mask_wrap(int i, int size, bool repeats) {
    return repeats ? ((i % size) + size) % size : clamp(i, 0, size - 1);
}
float gn_mask_texel(GnMask mask, ivec2 texel) {
    int x = gn_mask_wrap(texel.x, int(mask.width), (mask.repeats & 1u) != 0u);
    int y = gn_mask_wrap(texel.y, int(mask.height), (mask.repeats & 2u) != 0u);
    uint at = mask.first + uint(y) * mask.width + uint(x);
    return float((occluder_alpha[at / 4u] >> (8u * (at % 4u))) & 255u) / 255.0;
}
float gn_mask_alpha(GnMask mask, vec2 uv) {
    if (mask.width == 0u || mask.height == 0u) {
        return 1.0;
    }
    uv.x = (mask.repeats & 1u) != 0u ? uv.x - floor(uv.x) : clamp(uv.x, 0.0, 1.0);
    uv.y = (mask.repeats & 2u) != 0u ? uv.y - floor(uv.y) : clamp(uv.y, 0.0, 1.0);
    vec2 p = uv * vec2(mask.width, mask.height) - 0.5;
    vec2 base = floor(p);
    vec2 f = p - base;
    ivec2 texel = ivec2(base);
    return mix(mix(gn_mask_texel(mask, texel), gn_mask_texel(mask, texel + ivec2(1, 0)), f.x),
               mix(gn_mask_texel(mask, texel + ivec2(0, 1)), gn_mask_texel(mask, texel + ivec2(1, 1)), f.x), f.y);
}
bool gn_mask_solid(uint triangle, vec3 shares) {
    GnMask mask = occluder_masks[occluder_kinds[triangle] >> 2];
    vec3 share = shares / (shares.x + shares.y + shares.z);
    uvec3 t = uvec3(occluder_indices[3u * triangle], occluder_indices[3u * triangle + 1u],
                    occluder_indices[3u * triangle + 2u]);
    vec2 uv = share.x * occluder_uvs[t.x] + share.y * occluder_uvs[t.y] + share.z * occluder_uvs[t.z];
    uvec3 c = min(t, uvec3(occluder_colors.length() - 1));
    float own = share.x * occluder_colors[c.x].a + share.y * occluder_colors[c.y].a + share.z * occluder_colors[c.z].a;
    return (occluder_kinds[triangle] & 1u) == 0u || mask.base_alpha * own * gn_mask_alpha(mask, uv) >= mask.cutoff;
}
)";

}  // namespace

void add_occluders(ShaderInputs& inputs, const FrameInput& input) {
    const std::uint64_t most = input.device.properties().limits.maxStorageBufferRange;
    if (const std::uint64_t bytes = alpha_bytes(input.scene); bytes > most) {
        refuse(
            "the masks of this scene hold {} bytes of alpha, and a storage block of device '{}' holds {}; smaller "
            "textures fit",
            bytes, input.device.info().name, most);
    }
    const auto made = input.derive("occluders", 0, [&] { return make_buffers(input.device, input.scene); });
    input.graph.hold(made);
    inputs.buffer("readonly buffer", "OccluderPositions", "vec3 occluder_positions[];", input.handles.positions)
        .buffer("readonly buffer", "OccluderIndices", "uint occluder_indices[];", input.handles.indices)
        .buffer("readonly buffer", "OccluderUvs", "vec2 occluder_uvs[];", input.handles.uvs)
        .buffer("readonly buffer", "OccluderColors", "vec4 occluder_colors[];", input.handles.colors)
        .buffer("readonly buffer", "OccluderKinds", "uint occluder_kinds[];", input.graph.import(made->kinds))
        .buffer("readonly buffer", "OccluderMasks", "GnMask occluder_masks[];", input.graph.import(made->masks))
        .buffer("readonly buffer", "OccluderAlpha", "uint occluder_alpha[];", input.graph.import(made->alpha));
}

std::string occluder_includes() {
    return "#include \"shadow/geometry/occluder.glsl\"\nstruct GnMask { uint first; uint width; uint height; uint "
           "repeats; "
           "float base_alpha; float cutoff; };\n";
}

std::string occluder_functions() {
    return functions_text;
}

}  // namespace gn
