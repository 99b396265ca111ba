// SPDX-License-Identifier: MIT
// glTF 2.0: nodes become instances of primitives, lights and cameras.
#include "shadow/scene/files/gltf_pictures.h"

#include <algorithm>

namespace gn {

namespace {

using namespace gltf;

// What holds a mesh that hangs on bones.
struct Hold {
    Joints joints;            ///< at rest
    std::optional<int> skin;  ///< of the rig, where something moves a joint
};

// Builds the meshes that nodes ask for, each primitive once.
class Builder {
  public:
    Builder(File& file, Model& model, Pictures& pictures)
        : file_(file), model_(model), uv_uses_(load_materials(file, model, pictures)) {}

    // `hold`: null without a skin. `moved`, `morphed`: the node's place in the rig, where something moves it, and where curves
    // move the weights of its mesh.
    void add(const tinygltf::Node& node, const dmat4& ws_from_node, const Hold* hold, std::optional<int> moved,
             std::optional<int> morphed) {
        if (node.mesh < 0) {
            return;
        }
        // The node's weights go before those of its mesh. [glTF 2.0, 3.7.2.2]
        const tinygltf::Mesh& data = at(file_.data.meshes, node.mesh, file_, "mesh");
        const std::string name = clean_text(!node.name.empty() ? node.name : data.name);
        const bool lit = node.extensions.count("KHR_lights_punctual") > 0;
        const Orders orders = read_orders(file_, node.extras, fmt::format("Node '{}'", name), lit);
        const std::vector<double>& weights = node.weights.empty() ? data.weights : node.weights;
        if (hold != nullptr) {
            // A posed mesh is already in the world: the node's own matrix plays no part.
            std::vector<RigShape> shapes;
            const std::vector<std::size_t> meshes =
                load(data, {&hold->joints, weights, nullptr, morphed.has_value()}, hold->skin ? &shapes : nullptr);
            for (std::size_t i = 0; i < meshes.size(); ++i) {
                Instance& instance = add_instance(meshes[i], dmat4(1.0), name, orders);
                if (hold->skin) {
                    const int weighted = shapes[i].targets.empty() ? -1 : *morphed;
                    instance.follower = follow(keep(std::move(shapes[i])), {.skin = *hold->skin, .weights = weighted});
                }
            }
            return;
        }
        const std::tuple key(node.mesh, weights, morphed.has_value());
        const auto known = meshes_.find(key);
        const auto& parts =
            known != meshes_.end() ? known->second : meshes_[key] = load_parts(data, weights, morphed.has_value());
        for (const dmat4& node_from_instance : instance_matrices(file_, node)) {
            for (const Part& part : parts) {
                Instance& instance = add_instance(part.mesh, ws_from_node * node_from_instance, name, orders);
                if (part.shape) {
                    instance.follower = follow(
                        *part.shape, {.node = *morphed, .node_from_os = node_from_instance, .weights = *morphed});
                } else if (moved) {
                    instance.follower =
                        follow(shape_of(part.mesh), {.node = *moved, .node_from_os = node_from_instance});
                }
            }
        }
    }

  private:
    // A primitive's mesh, and its shape where curves move the weights of its targets.
    struct Part {
        std::size_t mesh = 0;
        std::optional<std::size_t> shape;
    };
    std::vector<Part> load_parts(const tinygltf::Mesh& data, const std::vector<double>& weights, bool morphs) {
        std::vector<RigShape> shapes;
        const std::vector<std::size_t> meshes =
            load(data, {nullptr, weights, nullptr, morphs}, morphs ? &shapes : nullptr);
        std::vector<Part> parts;
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            Part& part = parts.emplace_back(Part{meshes[i], {}});
            if (morphs && !shapes[i].targets.empty()) {
                part.shape = keep(std::move(shapes[i]));
            }
        }
        return parts;
    }

    // The vertices that a rig moves: all instances of a mesh by one copy.
    std::size_t shape_of(std::size_t mesh) {
        const auto [known, added] = shapes_.try_emplace(mesh, model_.rig.shapes.size());
        if (added) {
            keep({.positions_os = model_.meshes[mesh].positions_os});
        }
        return known->second;
    }

    std::size_t keep(RigShape shape) {
        model_.rig.shapes.push_back(std::move(shape));
        return model_.rig.shapes.size() - 1;
    }

    std::size_t follow(std::size_t shape, Follower follower) {
        follower.shape = shape;
        model_.rig.followers.push_back(std::move(follower));
        return model_.rig.followers.size() - 1;
    }

    // `shapes`: null, or takes the meshes as they are before they are posed.
    std::vector<std::size_t> load(const tinygltf::Mesh& data, const Pose& pose,
                                  std::vector<RigShape>* shapes = nullptr) {
        std::vector<std::size_t> parts;
        note_weights(data, pose.weights);
        const Orders of_mesh = read_orders(file_, data.extras, fmt::format("Mesh '{}'", clean_text(data.name)));
        for (const tinygltf::Primitive& primitive : data.primitives) {
            const bool known =
                primitive.material >= 0 && static_cast<std::size_t>(primitive.material) < file_.data.materials.size();
            if (!known && primitive.material >= 0) {
                add_note(file_.notes, fmt::format("Material {} does not exist; grey is used.", primitive.material));
            }
            const std::size_t material =
                known ? static_cast<std::size_t>(primitive.material) : file_.data.materials.size();
            RigShape shape;
            Mesh mesh = load_primitive(file_, primitive, uv_uses_[material],
                                       {pose.joints, pose.weights, shapes != nullptr ? &shape : nullptr, pose.morphs},
                                       clean_text(data.name));
            mesh.material = with_factor(static_cast<int>(material), mesh);
            note_missing_uvs(primitive, material);
            if (!mesh.triangles.empty()) {
                if (shapes != nullptr) {
                    shapes->push_back(std::move(shape));
                }
                parts.push_back(model_.meshes.size());
                model_.meshes.push_back(std::move(mesh));
                orders_.push_back(of_mesh.over(of_material(material)));
            }
        }
        return parts;
    }

    void note_weights(const tinygltf::Mesh& data, std::span<const double> weights) {
        const std::size_t targets = count_targets(data);
        if (!weights.empty() && weights.size() != targets) {
            add_note(file_.notes,
                     fmt::format("Mesh '{}' has {} morph targets and {} weights: those without a partner do nothing.",
                                 clean_text(data.name), targets, weights.size()));
        }
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

    Instance& add_instance(std::size_t mesh, const dmat4& ws_from_os, const std::string& name, const Orders& of_node) {
        triangles_ += model_.meshes[mesh].triangles.size();
        if (model_.instances.size() >= max_instances || triangles_ > max_triangles) {
            fail("{}: more than {} instances or {} triangles after instancing", file_.shown, max_instances,
                 max_triangles);
        }
        const Orders orders = of_node.over(orders_[mesh]);
        model_.instances.push_back({mesh, ws_from_os, name, orders.casts, orders.receives, std::nullopt});
        return model_.instances.back();
    }

    File& file_;
    Model& model_;
    std::vector<UvUse> uv_uses_;
    std::map<std::tuple<int, std::vector<double>, bool>, std::vector<Part>> meshes_;
    std::vector<Orders> orders_;  ///< of model_.meshes
    std::map<std::size_t, Orders> of_materials_;
    std::map<std::size_t, std::size_t> shapes_;                  ///< of meshes that move whole
    std::map<std::pair<int, float>, std::size_t> with_factors_;  ///< materials with the alpha of vertices
    std::size_t triangles_ = 0;
};

// Skins, each read once.
class Skins {
  public:
    Skins(const File& file, Rig& rig, std::span<const PlacedNode> nodes, const std::vector<bool>& moved)
        : file_(file), rig_(rig), moved_(moved), walked_(file.data.nodes.size(), -1) {
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            walked_[static_cast<std::size_t>(nodes[i].index)] = static_cast<int>(i);
            rest_.push_back(nodes[i].ws_from_node);
        }
    }

    // Null without a skin that has joints. `morphs`: what it holds changes even where no joint moves.
    const Hold* find(int index, bool morphs) {
        if (index < 0) {
            return nullptr;
        }
        const auto known = holds_.find(index);
        if (known != holds_.end() && (known->second.skin || !morphs)) {
            return &known->second;
        }
        Skin skin = load_skin(file_, index, walked_);
        if (skin.joints.empty()) {
            return nullptr;
        }
        Hold& hold = holds_[index];
        hold.joints = joint_matrices(skin, rest_);
        if (morphs || std::any_of(skin.joints.begin(), skin.joints.end(),
                                  [&](int joint) { return joint >= 0 && moved_[static_cast<std::size_t>(joint)]; })) {
            hold.skin = static_cast<int>(rig_.skins.size());
            rig_.skins.push_back(std::move(skin));
        }
        return &hold;
    }

  private:
    const File& file_;
    Rig& rig_;
    const std::vector<bool>& moved_;
    std::vector<int> walked_;
    std::vector<dmat4> rest_;
    std::map<int, Hold> holds_;
};

// By each node: whether a curve moves it, or one above it; weights move vertices alone.
std::vector<bool> find_moved(const Rig& rig, std::span<const PlacedNode> nodes) {
    std::vector<bool> moved(nodes.size(), false);
    for (const Animation& animation : rig.animations) {
        for (const Channel& channel : animation.channels) {
            moved[channel.node] = moved[channel.node] || channel.path != Channel::weight;
        }
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        moved[i] = moved[i] || (nodes[i].parent >= 0 && moved[static_cast<std::size_t>(nodes[i].parent)]);
    }
    return moved;
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
}

void note_animations(File& file, const Rig& rig) {
    if (rig.moves()) {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < std::min<std::size_t>(rig.animations.size(), 5); ++i) {
            names.push_back(fmt::format("'{}' of {:.3g} s", rig.animations[i].name, rig.animations[i].seconds));
        }
        add_note(file.notes,
                 fmt::format("{} animation{} ({}{}): everything stands as at rest where --animation names none.",
                             rig.animations.size(), rig.animations.size() == 1 ? "" : "s", fmt::join(names, ", "),
                             rig.animations.size() > names.size() ? ", ..." : ""));
    }
}

}  // namespace

Model load_gltf(const std::filesystem::path& path, const Assets& assets) {
    File file = parse_file(path, assets);
    Model model;
    note_left_out(file);
    Pictures pictures(file, model);
    Builder builder(file, model, pictures);

    // Where every node stands, and which of them move; joints are nodes too.
    const std::vector<PlacedNode> nodes = walk_nodes(file);
    model.rig = load_rig(file, nodes);
    note_animations(file, model.rig);
    const std::vector<bool> moved = find_moved(model.rig, nodes);
    const std::vector<bool> morphed = find_morphed(model.rig, nodes.size());
    Skins skins(file, model.rig, nodes, moved);

    // What every node carries.
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const PlacedNode& node = nodes[i];
        const tinygltf::Node& data = file.data.nodes[static_cast<std::size_t>(node.index)];
        if (node.visible) {
            const auto place_if = [i](bool so) { return so ? std::optional(static_cast<int>(i)) : std::nullopt; };
            builder.add(data, node.ws_from_node, data.mesh >= 0 ? skins.find(data.skin, morphed[i]) : nullptr,
                        place_if(moved[i]), place_if(morphed[i]));
            if (std::optional<PlacedLight> light = load_light(file, data, node.ws_from_node, pictures)) {
                if (moved[i]) {
                    model.rig.lights.push_back({model.lights.size(), i, {}});
                }
                model.lights.push_back(std::move(*light));
            }
        }
        if (std::optional<PlacedCamera> camera = load_camera(file, data, node.ws_from_node)) {
            if (moved[i]) {
                model.rig.cameras.push_back({model.cameras.size(), i, {}});
            }
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
