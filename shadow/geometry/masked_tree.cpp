// SPDX-License-Identifier: MIT
#include "shadow/geometry/masked_tree.h"

#include "gpu/upload.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/draw.h"
#include "shadow/scene/casting.h"

#include <algorithm>

namespace gn {

namespace {

constexpr std::uint32_t leaf_triangles = 4;

struct Builder {
    std::vector<Box> boxes;  // by place in the list of triangles that is given
    std::vector<vec3> middles;
    std::vector<std::uint32_t> order;  // such places
    TriangleTree tree;

    void node(std::uint32_t first, std::uint32_t count) {
        Box box, centres;
        for (std::uint32_t i = first; i < first + count; ++i) {
            box.grow(boxes[order[i]].min);
            box.grow(boxes[order[i]].max);
            centres.grow(middles[order[i]]);
        }
        const vec3 slack = 1e-6F * glm::max(glm::abs(box.min), glm::abs(box.max)) + 1e-5F * (box.max - box.min);
        const std::size_t at = tree.nodes.size();
        tree.nodes.push_back({box.min - slack, 0, box.max + slack, count <= leaf_triangles ? first * 8 + count : 0});
        if (count > leaf_triangles) {
            const vec3 size = centres.max - centres.min;
            const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
            const std::uint32_t half = count / 2;
            std::nth_element(order.begin() + first, order.begin() + first + half, order.begin() + first + count,
                             [&](std::uint32_t a, std::uint32_t b) { return middles[a][axis] < middles[b][axis]; });
            node(first, half);
            node(first + half, count - half);
        }
        tree.nodes[at].behind = static_cast<std::uint32_t>(tree.nodes.size());
    }
};

// A material's alpha as the truth reads it: where its texels begin, its size, how it wraps.
struct MaskedMaterial {
    std::uint32_t first = 0, width = 1, height = 1;
    std::uint32_t ways = 0;  ///< 1: repeats along u, 2: along v, 4: casts from its front alone
    AlphaTest alpha;
};

}  // namespace

TriangleTree build_tree(std::span<const vec3> positions_ws, std::span<const uvec3> all,
                        std::vector<std::uint32_t> triangles) {
    Builder builder;
    for (const std::uint32_t t : triangles) {
        Box box;
        for (int i = 0; i < 3; ++i) {
            box.grow(positions_ws[all[t][i]]);
        }
        builder.order.push_back(static_cast<std::uint32_t>(builder.order.size()));
        builder.boxes.push_back(box);
        builder.middles.push_back(box.centre());
    }
    if (!triangles.empty()) {
        builder.node(0, static_cast<std::uint32_t>(triangles.size()));
    }
    for (const std::uint32_t i : builder.order) {
        builder.tree.triangles.push_back(triangles[i]);
    }
    return std::move(builder.tree);
}

struct MaskedTree::Buffers {
    bool none = true;
    Buffer nodes, items, materials, texels;
};

namespace {

// Every masked material of the scene, its texels' alpha four to a word.
struct MaskedMaterials {
    std::vector<MaskedMaterial> materials;
    std::vector<std::uint8_t> texels;

    void add(const Scene& scene, const Object& object) {
        const Material& material = scene.materials[static_cast<std::size_t>(object.material)];
        MaskedMaterial made{.first = static_cast<std::uint32_t>(texels.size()),
                            .ways = is_single_sided(scene, object) ? 4U : 0U,
                            .alpha = alpha_test(material)};
        if (material.base_color_texture >= 0) {
            const Texture& texture = scene.textures[static_cast<std::size_t>(material.base_color_texture)];
            made.width = static_cast<std::uint32_t>(texture.image.width);
            made.height = static_cast<std::uint32_t>(texture.image.height);
            made.ways |= (texture.repeat_u ? 1U : 0U) | (texture.repeat_v ? 2U : 0U);
            for (std::size_t i = 3; i < texture.image.rgba.size(); i += 4) {
                texels.push_back(texture.image.rgba[i]);
            }
        }
        // White, where there is no texture or nothing in it.
        if (texels.size() == made.first) {
            made.width = made.height = 1;
            texels.push_back(255);
        }
        materials.push_back(made);
    }
};

}  // namespace

std::optional<MaskedTree> MaskedTree::of(const FrameInput& input) {
    const Scene& scene = input.scene;
    const std::vector<CasterKind> kinds = caster_kinds(input);
    MaskedTree found;
    found.buffers_ = input.derive("masked tree", casters_key(scene, kinds), [&] {
        MaskedMaterials worn;
        std::vector<std::int32_t> of_material(scene.materials.size(), -1);
        std::vector<std::uint32_t> triangles, material_of(scene.triangles.size(), 0);
        for (std::size_t i = 0; i < kinds.size(); ++i) {
            const Object& object = scene.objects[i];
            if (kinds[i] != CasterKind::masked) {
                continue;
            }
            std::int32_t& material = of_material[static_cast<std::size_t>(object.material)];
            if (material < 0) {
                material = static_cast<std::int32_t>(worn.materials.size());
                worn.add(scene, object);
            }
            for (std::uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count; ++t) {
                triangles.push_back(t);
                material_of[t] = static_cast<std::uint32_t>(material);
            }
        }
        Buffers made{.none = triangles.empty()};
        if (made.none) {
            return made;
        }
        const TriangleTree tree = build_tree(scene.positions_ws, scene.triangles, std::move(triangles));
        std::vector<uvec2> items;
        for (const std::uint32_t t : tree.triangles) {
            items.emplace_back(t, material_of[t]);
        }
        worn.texels.resize((worn.texels.size() + 3) / 4 * 4);
        made.nodes = upload(input.device, "masked tree", tree.nodes);
        made.items = upload(input.device, "masked triangles", items);
        made.materials = upload(input.device, "masked materials", worn.materials);
        made.texels = upload(input.device, "masked texels", worn.texels);
        return made;
    });
    return found.buffers_->none ? std::nullopt : std::optional(found);
}

void MaskedTree::add_to(ShaderInputs& inputs, const FrameInput& input) const {
    input.graph.hold(buffers_);
    inputs.buffer("readonly buffer", "Positions", "vec3 positions[];", input.handles.positions)
        .buffer("readonly buffer", "Indices", "uint indices[];", input.handles.indices)
        .buffer("readonly buffer", "Uvs", "vec2 uvs[];", input.handles.uvs)
        .buffer("readonly buffer", "Colors", "vec4 colors[];", input.handles.colors)
        .buffer("readonly buffer", "MaskedNodes", "MaskedNode masked_nodes[];", input.graph.import(buffers_->nodes))
        .buffer("readonly buffer", "MaskedItems", "uvec2 masked_items[];", input.graph.import(buffers_->items))
        .buffer("readonly buffer", "MaskedMaterials", "MaskedMaterial masked_materials[];",
                input.graph.import(buffers_->materials))
        .buffer("readonly buffer", "MaskedTexels", "uint masked_texels[];", input.graph.import(buffers_->texels));
}

std::string MaskedTree::types(const Device& device) {
    return std::string(device.has(Feature::shader_float64) ? "#define GN_VOLUMES_DOUBLE\n" : "") +
           "#include \"shadow/geometry/triangle.glsl\"\n"
           "struct MaskedNode { vec3 low_ws; uint behind; vec3 high_ws; uint held; };\n"
           "struct MaskedMaterial { uint first; uint width; uint height; uint ways; float base_alpha; float cutoff; "
           "};\n";
}

std::string MaskedTree::functions() {
    return "#include \"shadow/geometry/masked_tree.glsl\"\n";
}

}  // namespace gn
