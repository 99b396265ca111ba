// SPDX-License-Identifier: MIT
#include "shadow/geometry/draw.h"

namespace gn {
namespace {

const Material& material_of(const Scene& scene, const Object& object) {
    return scene.materials[static_cast<std::size_t>(object.material)];
}

}  // namespace

bool is_masked(const Scene& scene, const Object& object) {
    return material_of(scene, object).alpha_mode != AlphaMode::opaque;
}

std::vector<DrawRange> opaque_runs(const Scene& scene, std::span<const std::uint32_t> objects) {
    std::vector<DrawRange> runs;
    for (const std::uint32_t index : objects) {
        const Object& object = scene.objects[index];
        if (is_masked(scene, object) || object.triangle_count == 0) {
            continue;
        }
        const DrawRange range{object.first_triangle * 3, object.triangle_count * 3};
        if (!runs.empty() && runs.back().first_index + runs.back().index_count == range.first_index) {
            runs.back().index_count += range.index_count;
        } else {
            runs.push_back(range);
        }
    }
    return runs;
}

std::vector<std::uint32_t> masked_objects(const Scene& scene, std::span<const std::uint32_t> objects) {
    std::vector<std::uint32_t> masked;
    for (const std::uint32_t index : objects) {
        if (is_masked(scene, scene.objects[index])) {
            masked.push_back(index);
        }
    }
    return masked;
}

BaseColor base_color(const Scene& scene, const SceneHandles& handles, const Material& material) {
    if (material.base_color_texture < 0) {
        return {handles.white, linear()};
    }
    const auto index = static_cast<std::size_t>(material.base_color_texture);
    const auto mode = [](bool repeat) {
        return repeat ? VK_SAMPLER_ADDRESS_MODE_REPEAT : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    };
    SamplerDesc sampler = trilinear();
    sampler.address = mode(scene.textures[index].repeat_u);
    sampler.address_v = mode(scene.textures[index].repeat_v);
    return {handles.textures[index], sampler};
}

void sample_textures(PassBuilder& pass, const SceneHandles& handles) {
    for (const TextureHandle texture : handles.textures) {
        pass.sample(texture);
    }
    pass.sample(handles.white);
}

AlphaTest alpha_test(const Material& material) {
    return {material.base_color.a, material.alpha_mode == AlphaMode::blend ? 0.5F : material.alpha_cutoff};
}

}  // namespace gn
