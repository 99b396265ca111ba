// SPDX-License-Identifier: MIT
// Morph targets: displacements of positions, normals and colours, summed by the weights of the node or else of the mesh.
#include "shadow/scene/files/gltf_data.h"
#include "shadow/scene/morph.h"

#include <algorithm>

namespace gn::gltf {

namespace {

// Most displacements of all vertices by all targets of one file.
constexpr std::size_t most_displacements = std::size_t{1} << 25;

// What one target does to the vertices in use.
struct Displaced {
    MorphTarget target;
    std::vector<std::pair<std::size_t, vec4>> colors;  ///< of the mesh's vertices
};

// Reads one target's attribute for the vertices in use.
class Displacements {
  public:
    Displacements(File& file, const std::map<std::string, int>& target, const char* attribute, std::size_t used)
        : name_(attribute) {
        const auto named = target.find(attribute);
        if (named == target.end()) {
            return;
        }
        values_.emplace(file, named->second);
        if (values_->components() < 3) {
            fail("accessor {} holds {} numbers a vertex; {} has 3", named->second, values_->components(), attribute);
        }
        file.displacements += used;
        if (file.displacements > most_displacements) {
            fail("the file's morph targets move vertices more than {} times", most_displacements);
        }
    }

    [[nodiscard]] bool any() const { return values_.has_value(); }
    [[nodiscard]] std::size_t size() const { return values_->size(); }
    // 0 of a vertex that is not listed.
    [[nodiscard]] vec4 of(std::uint32_t vertex) const {
        const vec4 value(values_ && vertex < values_->size() ? values_->vector(vertex) : dvec4(0));
        if (!finite(vec3(value)) || !std::isfinite(value.w)) {
            fail("the {} of vertex {} is not finite", name_, vertex);
        }
        return value;
    }

  private:
    const char* name_;
    std::optional<Elements> values_;
};

void note_short(File& file, const Displacements& displacements, const std::vector<std::uint32_t>& used) {
    if (displacements.any() && !used.empty() && used.back() >= displacements.size()) {
        add_note(file.notes, fmt::format("A morph target holds {} displacements, fewer than its mesh has vertices; the "
                                         "others stand still.",
                                         displacements.size()));
    }
}

// Throws Error for what cannot be read.
Displaced read_target(File& file, const std::map<std::string, int>& target, const std::vector<std::uint32_t>& used,
                      bool colored) {
    const Displacements positions(file, target, "POSITION", used.size());
    const Displacements normals(file, target, "NORMAL", used.size());
    const std::map<std::string, int> none;
    const Displacements colors(file, colored ? target : none, "COLOR_0", used.size());
    Displaced read;
    for (std::size_t i = 0; i < used.size(); ++i) {
        const vec3 position(positions.of(used[i])), normal(normals.of(used[i]));
        if (position != vec3(0) || normal != vec3(0)) {
            read.target.vertices.push_back(static_cast<std::uint32_t>(i));
            read.target.positions_os.push_back(position);
            read.target.normals_os.push_back(normal);
        }
        if (const vec4 color = colors.of(used[i]); color != vec4(0)) {
            read.colors.emplace_back(i, color);
        }
    }
    note_short(file, positions, used);
    note_short(file, normals, used);
    note_short(file, colors, used);
    return read;
}

// The mesh as the targets find it. A normal that is none is found from the faces, at rest as later.
void keep_shape(const Mesh& mesh, RigShape& shape) {
    shape.positions_os = mesh.positions_os;
    for (const vec3& normal : mesh.normals_os) {
        const float length = glm::length(normal);
        shape.normals_os.push_back(std::isfinite(length) && length > 1e-6F ? normal / length : vec3(0));
    }
}

}  // namespace

std::size_t count_targets(const tinygltf::Mesh& mesh) {
    std::size_t count = 0;
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
        count = std::max(count, primitive.targets.size());
    }
    return count;
}

void morph(File& file, const tinygltf::Primitive& primitive, std::span<const double> weights,
           const std::vector<std::uint32_t>& used, Mesh& mesh, RigShape* shape) {
    if (shape != nullptr) {
        keep_shape(mesh, *shape);
    }

    // Read the targets: all of them where weights change, else those that have one.
    const std::size_t count = primitive.targets.size();
    const auto weight_of = [&](std::size_t t) {
        return t < weights.size() && std::isfinite(weights[t]) ? weights[t] : 0.0;
    };
    std::vector<MorphTarget> targets(count);
    bool colors_rest = false;
    for (std::size_t t = 0; t < count; ++t) {
        if (weight_of(t) == 0.0 && shape == nullptr) {
            continue;
        }
        try {
            Displaced read = read_target(file, primitive.targets[t], used, !mesh.colors.empty());
            for (const auto& [vertex, color] : read.colors) {
                mesh.colors[vertex] += vec4(weight_of(t) * dvec4(color));
            }
            colors_rest = colors_rest || (shape != nullptr && !read.colors.empty());
            targets[t] = std::move(read.target);
        } catch (const Error& problem) {
            if (file.displacements > most_displacements) {
                throw;
            }
            add_note(file.notes,
                     fmt::format("Morph target {} of mesh '{}' is left out: {}.", t + 1, mesh.name, problem.what()));
        }
    }
    if (colors_rest) {
        add_note(file.notes, fmt::format("Colours of the morph targets of mesh '{}' stay as at rest while an animation "
                                         "changes their weights.",
                                         mesh.name));
    }

    // Move the mesh by them.
    Morphed morphed{mesh.positions_os, {mesh.normals_os.begin(), mesh.normals_os.end()}};
    add_targets(targets, weights, morphed);
    mesh.positions_os = std::move(morphed.positions_os);
    std::transform(morphed.normals_os.begin(), morphed.normals_os.end(), mesh.normals_os.begin(),
                   [](const dvec3& n_os) { return vec3(n_os); });
    for (vec4& color : mesh.colors) {
        color = glm::clamp(color, 0.0F, 1.0F);
    }
    if (shape != nullptr) {
        shape->targets = std::move(targets);
    }
}

}  // namespace gn::gltf
