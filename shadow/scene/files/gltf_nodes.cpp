// SPDX-License-Identifier: MIT
// The node hierarchy: a forest, walked without recursion, multiplied out in double precision.
#include "shadow/scene/files/gltf_data.h"

namespace gn::gltf {

namespace {

double entry(const std::vector<double>& values, std::size_t index, double otherwise) {
    return index < values.size() ? values[index] : otherwise;
}

dmat4 local_matrix(const tinygltf::Node& node) {
    return gn::local_matrix(node_at_rest(node));
}

// KHR_node_visibility: what is hidden hides all below it.
bool hides(const tinygltf::Node& node) {
    const auto found = node.extensions.find("KHR_node_visibility");
    if (found == node.extensions.end() || !found->second.IsObject() || !found->second.Has("visible")) {
        return false;
    }
    const tinygltf::Value& visible = found->second.Get("visible");
    return visible.IsBool() && !visible.Get<bool>();
}

// Who is whose parent; -1 for roots. Two parents make no tree.
std::vector<int> find_parents(const File& file) {
    const auto& nodes = file.data.nodes;
    std::vector<int> parents(nodes.size(), -1);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        for (const int child : nodes[n].children) {
            at(nodes, child, file, "node");
            int& parent = parents[static_cast<std::size_t>(child)];
            if (parent == static_cast<int>(n)) {
                fail("{}: node {} lists node {} twice; nodes must form trees", file.shown, n, child);
            }
            if (parent >= 0) {
                fail("{}: node {} is a child of nodes {} and {}; nodes must form trees", file.shown, child, parent, n);
            }
            parent = static_cast<int>(n);
        }
    }
    return parents;
}

// With one parent each, a loop shows by climbing: mark every node with the climb that met it first.
void check_loops(const File& file, const std::vector<int>& parents) {
    std::vector<int> climb(parents.size(), -1);
    for (std::size_t n = 0; n < parents.size(); ++n) {
        int at_node = static_cast<int>(n);
        while (at_node >= 0 && climb[static_cast<std::size_t>(at_node)] < 0) {
            climb[static_cast<std::size_t>(at_node)] = static_cast<int>(n);
            at_node = parents[static_cast<std::size_t>(at_node)];
        }
        if (at_node >= 0 && climb[static_cast<std::size_t>(at_node)] == static_cast<int>(n)) {
            fail("{}: node {} is its own ancestor; nodes must form trees", file.shown, at_node);
        }
    }
}

std::vector<int> find_roots(const File& file, const std::vector<int>& parents) {
    if (!file.data.scenes.empty()) {
        const int scene = file.data.defaultScene >= 0 ? file.data.defaultScene : 0;
        return at(file.data.scenes, scene, file, "scene").nodes;
    }
    std::vector<int> roots;
    for (std::size_t n = 0; n < parents.size(); ++n) {
        if (parents[n] < 0) {
            roots.push_back(static_cast<int>(n));
        }
    }
    return roots;
}

}  // namespace

RigNode node_at_rest(const tinygltf::Node& node) {
    RigNode rest;
    if (node.matrix.size() == 16) {
        dmat4 m(1.0);
        for (std::size_t i = 0; i < 16; ++i) {
            m[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = node.matrix[i];
        }
        rest.matrix = m;
        return rest;
    }
    rest.translation = {entry(node.translation, 0, 0), entry(node.translation, 1, 0), entry(node.translation, 2, 0)};
    rest.scale = {entry(node.scale, 0, 1), entry(node.scale, 1, 1), entry(node.scale, 2, 1)};
    rest.rotation = glm::dquat(entry(node.rotation, 3, 1), entry(node.rotation, 0, 0), entry(node.rotation, 1, 0),
                               entry(node.rotation, 2, 0));
    return rest;
}

std::vector<PlacedNode> walk_nodes(const File& file) {
    const std::vector<int> parents = find_parents(file);
    check_loops(file, parents);
    const std::vector<int> roots = find_roots(file, parents);

    // Depth first with a stack of our own, children in the file's order.
    std::vector<PlacedNode> stack;
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) {
        at(file.data.nodes, *root, file, "node");
        stack.push_back({*root, dmat4(1.0)});
    }
    std::vector<bool> visited(file.data.nodes.size(), false);
    std::vector<PlacedNode> placed;
    while (!stack.empty()) {
        PlacedNode node = stack.back();
        stack.pop_back();
        if (visited[static_cast<std::size_t>(node.index)]) {
            fail("{}: node {} is reached twice; nodes must form trees", file.shown, node.index);
        }
        visited[static_cast<std::size_t>(node.index)] = true;
        const tinygltf::Node& data = file.data.nodes[static_cast<std::size_t>(node.index)];
        node.ws_from_node = node.ws_from_node * local_matrix(data);
        node.visible = node.visible && !hides(data);
        const int place = static_cast<int>(placed.size());
        placed.push_back(node);
        for (auto child = data.children.rbegin(); child != data.children.rend(); ++child) {
            stack.push_back({*child, node.ws_from_node, node.visible, place});
        }
    }
    return placed;
}

}  // namespace gn::gltf
