// SPDX-License-Identifier: MIT
// EXT_mesh_gpu_instancing: one node shows its mesh many times, each time moved, turned and scaled.
#include "shadow/scene/files/gltf_data.h"

#include <glm/gtc/quaternion.hpp>

namespace gn::gltf {

namespace {

constexpr const char* extension = "EXT_mesh_gpu_instancing";

std::optional<Elements> attribute(const File& file, const tinygltf::Value& attributes, const char* name) {
    const std::optional<double> index = number(attributes, name);
    if (!index) {
        return std::nullopt;
    }
    const bool known = *index >= 0.0 && *index < static_cast<double>(file.data.accessors.size());
    return Elements(file, known ? static_cast<int>(*index) : -1);
}

}  // namespace

std::vector<dmat4> instance_matrices(File& file, const tinygltf::Node& node) {
    const auto found = node.extensions.find(extension);
    if (found == node.extensions.end() || !found->second.IsObject() || !found->second.Has("attributes")) {
        return {dmat4(1.0)};
    }
    const tinygltf::Value& attributes = found->second.Get("attributes");
    const std::optional<Elements> translations = attribute(file, attributes, "TRANSLATION");
    const std::optional<Elements> rotations = attribute(file, attributes, "ROTATION");
    const std::optional<Elements> scales = attribute(file, attributes, "SCALE");

    // As many instances as every list has.
    std::optional<std::size_t> fewest;
    std::size_t most = 0;
    for (const auto* list : {&translations, &rotations, &scales}) {
        if (*list) {
            fewest = std::min(fewest.value_or((*list)->size()), (*list)->size());
            most = std::max(most, (*list)->size());
        }
    }
    if (!fewest) {
        add_note(file.notes,
                 fmt::format("Node '{}' has {} without TRANSLATION, ROTATION or SCALE; its mesh appears once.",
                             clean_text(node.name), extension));
        return {dmat4(1.0)};
    }
    if (most > *fewest) {
        add_note(file.notes, fmt::format("Node '{}' lists {} and {} values for {}; {} instances are shown.",
                                         clean_text(node.name), *fewest, most, extension, *fewest));
    }
    if (*fewest > max_instances) {
        fail("{}: {} asks for {} instances; at most {} are supported", file.shown, extension, *fewest, max_instances);
    }

    std::vector<dmat4> matrices;
    for (std::size_t i = 0; i < *fewest; ++i) {
        const dvec3 t(translations ? dvec3(translations->vector(i)) : dvec3(0.0));
        const dvec4 q(rotations ? rotations->vector(i) : dvec4(0.0, 0.0, 0.0, 1.0));
        const dvec3 s(scales ? dvec3(scales->vector(i)) : dvec3(1.0));
        const double length = glm::length(q);
        const glm::dquat r = std::isfinite(length) && length > 1e-12
                                 ? glm::dquat(q.w / length, q.x / length, q.y / length, q.z / length)
                                 : glm::dquat(1.0, 0.0, 0.0, 0.0);
        matrices.push_back(glm::translate(dmat4(1.0), t) * glm::mat4_cast(r) * glm::scale(dmat4(1.0), s));
    }
    return matrices;
}

}  // namespace gn::gltf
