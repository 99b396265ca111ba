// SPDX-License-Identifier: MIT
// Morph targets: displacements of positions, normals and colours, summed by the weights of the node or else of the mesh.
#include "shadow/scene/files/gltf_data.h"

namespace gn::gltf {

namespace {

// Calls add(i, displacement) for every vertex in use that the target's attribute holds.
template <class Add>
void for_each_displacement(File& file, const std::map<std::string, int>& target, const char* attribute,
                           const std::vector<std::uint32_t>& used, const Add& add) {
    const auto named = target.find(attribute);
    if (named == target.end()) {
        return;
    }
    const Elements displacements(file, named->second);
    bool complete = true;
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i] < displacements.size()) {
            add(i, displacements.vector(used[i]));
        } else {
            complete = false;
        }
    }
    if (!complete) {
        add_note(file.notes, fmt::format("A morph target holds {} displacements, fewer than its mesh has vertices; the "
                                         "others stand still.",
                                         displacements.size()));
    }
}

}  // namespace

void morph(File& file, const tinygltf::Primitive& primitive, std::span<const double> weights,
           const std::vector<std::uint32_t>& used, Mesh& mesh) {
    std::vector<dvec3> normals(mesh.normals_os.begin(), mesh.normals_os.end());
    bool turned = false;
    for (std::size_t t = 0; t < std::min(primitive.targets.size(), weights.size()); ++t) {
        const double weight = weights[t];
        if (weight == 0.0 || !std::isfinite(weight)) {
            continue;
        }
        for_each_displacement(file, primitive.targets[t], "POSITION", used,
                              [&](std::size_t i, dvec4 d) { mesh.positions_os[i] += weight * dvec3(d); });
        for_each_displacement(file, primitive.targets[t], "NORMAL", used, [&](std::size_t i, dvec4 d) {
            normals[i] += weight * dvec3(d);
            turned = true;
        });
        for_each_displacement(file, primitive.targets[t], "COLOR_0", used, [&](std::size_t i, dvec4 d) {
            if (!mesh.colors.empty()) {
                mesh.colors[i] += vec4(weight * d);
            }
        });
    }
    for (std::size_t i = 0; turned && i < normals.size(); ++i) {
        const double length = glm::length(normals[i]);
        mesh.normals_os[i] = length > 0.0 && std::isfinite(length) ? vec3(normals[i] / length) : vec3(0.0F);
    }
    for (vec4& color : mesh.colors) {
        color = glm::clamp(color, 0.0F, 1.0F);
    }
}

}  // namespace gn::gltf
