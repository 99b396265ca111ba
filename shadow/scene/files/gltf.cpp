// SPDX-License-Identifier: MIT
// glTF 2.0: nodes become instances of primitives, lights and cameras.
#include "shadow/scene/files/gltf_pictures.h"

#include <algorithm>

namespace gn {

namespace {

using namespace gltf;

// Builds the meshes that nodes ask for, each primitive once.
class Builder {
  public:
    Builder(File& file, Model& model, Pictures& pictures)
        : file_(file), model_(model), uv_uses_(load_materials(file, model, pictures)) {}

    void add(const tinygltf::Node& node, const dmat4& ws_from_node, const Joints* joints) {
        if (node.mesh < 0) {
            return;
        }
        // The node's weights go before those of its mesh. [glTF 2.0, 3.7.2.2]
        const tinygltf::Mesh& data = at(file_.data.meshes, node.mesh, file_, "mesh");
        const std::string name = clean_text(!node.name.empty() ? node.name : data.name);
        const bool lit = node.extensions.count("KHR_lights_punctual") > 0;
        const Orders orders = read_orders(file_, node.extras, fmt::format("Node '{}'", name), lit);
        const std::vector<double>& weights = node.weights.empty() ? data.weights : node.weights;
        if (joints != nullptr) {
            // A posed mesh is already in the world: the node's own matrix plays no part.
            for (const std::size_t mesh : load(data, {joints, weights})) {
                add_instance(mesh, dmat4(1.0), name, orders);
            }
            return;
        }
        const std::pair key(node.mesh, weights);
        const auto known = meshes_.find(key);
        const auto& parts = known != meshes_.end() ? known->second : meshes_[key] = load(data, {nullptr, weights});
        for (const dmat4& node_from_instance : instance_matrices(file_, node)) {
            for (const std::size_t mesh : parts) {
                add_instance(mesh, ws_from_node * node_from_instance, name, orders);
            }
        }
    }

  private:
    std::vector<std::size_t> load(const tinygltf::Mesh& data, const Pose& pose) {
        std::vector<std::size_t> parts;
        const Orders of_mesh = read_orders(file_, data.extras, fmt::format("Mesh '{}'", clean_text(data.name)));
        for (const tinygltf::Primitive& primitive : data.primitives) {
            const bool known =
                primitive.material >= 0 && static_cast<std::size_t>(primitive.material) < file_.data.materials.size();
            if (!known && primitive.material >= 0) {
                add_note(file_.notes, fmt::format("Material {} does not exist; grey is used.", primitive.material));
            }
            const std::size_t material =
                known ? static_cast<std::size_t>(primitive.material) : file_.data.materials.size();
            Mesh mesh = load_primitive(file_, primitive, uv_uses_[material], pose);
            mesh.name = clean_text(data.name);
            mesh.material = with_factor(static_cast<int>(material), mesh);
            note_missing_uvs(primitive, material);
            if (!mesh.triangles.empty()) {
                parts.push_back(model_.meshes.size());
                model_.meshes.push_back(std::move(mesh));
                orders_.push_back(of_mesh.over(of_material(material)));
            }
        }
        return parts;
    }

    // One alpha for all vertices is a factor: what it covers is decided, and said, as for the material's own.
    int with_factor(int material, Mesh& mesh) {
        const Material& plain = model_.materials[static_cast<std::size_t>(material)];
        const float alpha = mesh.colors.empty() ? 1.0F : mesh.colors.front().a;
        const bool same = std::all_of(mesh.colors.begin(), mesh.colors.end(),
                                      [alpha](const vec4& color) { return color.a == alpha; });
        if (alpha == 1.0F || !same || plain.alpha_mode == AlphaMode::opaque) {
            return material;
        }
        for (vec4& color : mesh.colors) {
            color.a = 1.0F;
        }
        const auto [known, added] = with_factors_.try_emplace({material, alpha}, model_.materials.size());
        if (added) {
            Material covered = plain;
            covered.base_color.a *= alpha;
            model_.materials.push_back(std::move(covered));
        }
        return static_cast<int>(known->second);
    }

    // The node wins over the mesh, the mesh over the material.
    Orders of_material(std::size_t material) {
        if (material >= file_.data.materials.size()) {
            return {};
        }
        const auto known = of_materials_.find(material);
        if (known != of_materials_.end()) {
            return known->second;
        }
        const tinygltf::Material& data = file_.data.materials[material];
        return of_materials_[material] =
                   read_orders(file_, data.extras, fmt::format("Material '{}'", clean_text(data.name)));
    }

    void note_missing_uvs(const tinygltf::Primitive& primitive, std::size_t material) {
        const std::string name = fmt::format("TEXCOORD_{}", uv_uses_[material].set);
        if (model_.materials[material].base_color_texture >= 0 && primitive.attributes.count(name) == 0) {
            add_note(file_.notes, fmt::format("A mesh of material '{}' lacks {}; the texture's corner (0, 0) is used.",
                                              model_.materials[material].name, name));
        }
    }

    void add_instance(std::size_t mesh, const dmat4& ws_from_os, const std::string& name, const Orders& of_node) {
        triangles_ += model_.meshes[mesh].triangles.size();
        if (model_.instances.size() >= max_instances || triangles_ > max_triangles) {
            fail("{}: more than {} instances or {} triangles after instancing", file_.shown, max_instances,
                 max_triangles);
        }
        const Orders orders = of_node.over(orders_[mesh]);
        model_.instances.push_back({mesh, ws_from_os, name, orders.casts, orders.receives});
    }

    File& file_;
    Model& model_;
    std::vector<UvUse> uv_uses_;
    std::map<std::pair<int, std::vector<double>>, std::vector<std::size_t>> meshes_;
    std::vector<Orders> orders_;  ///< of model_.meshes
    std::map<std::size_t, Orders> of_materials_;
    std::map<std::pair<int, float>, std::size_t> with_factors_;  ///< materials with the alpha of vertices
    std::size_t triangles_ = 0;
};

// joint matrix = world from joint x joint from mesh, all at rest.
std::optional<Joints> rest_joints(File& file, int skin_index, const std::vector<std::optional<dmat4>>& world) {
    if (skin_index < 0) {
        return std::nullopt;
    }
    const tinygltf::Skin& skin = at(file.data.skins, skin_index, file, "skin");
    std::optional<Elements> inverses;
    if (skin.inverseBindMatrices >= 0) {
        inverses.emplace(file, skin.inverseBindMatrices);
    }
    Joints joints;
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        at(file.data.nodes, skin.joints[i], file, "node");
        const std::optional<dmat4>& ws_from_joint = world[static_cast<std::size_t>(skin.joints[i])];
        const bool given = inverses && i < inverses->size() && inverses->components() == 16;
        joints.push_back(ws_from_joint.value_or(dmat4(1.0)) * (given ? inverses->matrix(i) : dmat4(1.0)));
    }
    return joints.empty() ? std::nullopt : std::optional(std::move(joints));
}

}  // namespace

namespace {

void note_coarse(File& file) {
    if (file.coarse_triangles > 0) {
        add_note(file.notes,
                 fmt::format("{} triangle{} edges of less than four steps of the floats that the file holds positions "
                             "in (steps of {:.3g}): what shape they had is lost in the file; store the mesh near zero "
                             "and let its node move it.",
                             file.coarse_triangles, file.coarse_triangles == 1 ? " has" : "s have", file.coarse_step));
    }
}

void note_left_out(File& file) {
    if (file.data.scenes.size() > 1) {
        add_note(file.notes, fmt::format("The file holds {} scenes; the {} is shown.", file.data.scenes.size(),
                                         file.data.defaultScene > 0 ? "one that it names" : "first"));
    }
    if (!file.data.animations.empty()) {
        add_note(file.notes,
                 fmt::format("{} animation{} not played: everything stands as at rest.", file.data.animations.size(),
                             file.data.animations.size() == 1 ? " is" : "s are"));
    }
}

}  // namespace

Model load_gltf(const std::filesystem::path& path, const Assets& assets) {
    File file = parse_file(path, assets);
    Model model;
    note_left_out(file);
    Pictures pictures(file, model);
    Builder builder(file, model, pictures);

    // Where every node stands; joints are nodes too.
    const std::vector<PlacedNode> nodes = walk_nodes(file);
    std::vector<std::optional<dmat4>> world(file.data.nodes.size());
    for (const PlacedNode& node : nodes) {
        world[static_cast<std::size_t>(node.index)] = node.ws_from_node;
    }

    // What every node carries.
    for (const PlacedNode& node : nodes) {
        const tinygltf::Node& data = file.data.nodes[static_cast<std::size_t>(node.index)];
        if (node.visible) {
            const std::optional<Joints> joints = rest_joints(file, data.mesh >= 0 ? data.skin : -1, world);
            builder.add(data, node.ws_from_node, joints ? &*joints : nullptr);
            if (std::optional<PlacedLight> light = load_light(file, data, node.ws_from_node, pictures)) {
                model.lights.push_back(std::move(*light));
            }
        }
        if (std::optional<PlacedCamera> camera = load_camera(file, data, node.ws_from_node)) {
            model.cameras.push_back(std::move(*camera));
        }
    }
    model.environment = load_environment(file);
    note_coarse(file);
    for (std::string& sentence : file.notes) {
        add_note(model.notes, std::move(sentence));
    }
    return model;
}

}  // namespace gn
