// SPDX-License-Identifier: MIT
// Primitives: triangles, strips and fans, with only the vertices that they use.
#include "shadow/scene/files/gltf_packed.h"

#include <algorithm>
#include <numeric>

namespace gn::gltf {

namespace {

// A primitive of the file, with what was unpacked of it.
struct Source {
    const File& file;
    const tinygltf::Primitive& primitive;
    std::optional<UnpackedPrimitive> unpacked;

    [[nodiscard]] std::optional<Elements> attribute(const std::string& name) const {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end()) {
            return std::nullopt;
        }
        const auto bytes = unpacked ? unpacked->attributes.find(name) : decltype(unpacked->attributes.end()){};
        return unpacked && bytes != unpacked->attributes.end()
                   ? std::optional<Elements>(std::in_place, file, found->second, bytes->second)
                   : std::optional<Elements>(std::in_place, file, found->second);
    }
};

int mode_of(const tinygltf::Primitive& primitive) {
    return primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
}

// How many triangles a list of `count` indices makes.
std::size_t count_triangles(int mode, std::size_t count) {
    return mode == TINYGLTF_MODE_TRIANGLES ? count / 3 : count < 3 ? 0 : count - 2;
}

// The places in the index list of triangle `i`; strips turn every other one, fans share the first.
std::array<std::size_t, 3> triangle_slots(int mode, std::size_t i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        return i % 2 == 0 ? std::array{i, i + 1, i + 2} : std::array{i + 1, i, i + 2};
    }
    return mode == TINYGLTF_MODE_TRIANGLE_FAN ? std::array<std::size_t, 3>{0, i + 1, i + 2}
                                              : std::array{3 * i, 3 * i + 1, 3 * i + 2};
}

std::vector<uvec3> read_triangles(File& file, const Source& source, std::size_t vertices) {
    // Unpacked strips have become triangles.
    const int mode = source.unpacked ? TINYGLTF_MODE_TRIANGLES : mode_of(source.primitive);
    std::optional<Elements> indices;
    if (source.primitive.indices >= 0 && !source.unpacked) {
        indices.emplace(file, source.primitive.indices);
    }
    const auto index_at = [&](std::size_t slot) {
        return source.unpacked ? source.unpacked->indices[slot]
               : indices       ? indices->integer(slot)
                               : static_cast<std::uint32_t>(slot);
    };
    const std::size_t count = source.unpacked ? source.unpacked->indices.size() : indices ? indices->size() : vertices;
    const std::size_t triangles = count_triangles(mode, count);
    file.triangles_decoded += triangles;
    if (file.triangles_decoded > max_triangles) {
        fail("{}: the meshes have more than {} triangles", file.shown, max_triangles);
    }

    // Drop what points nowhere; repeated indices are how strips jump.
    std::vector<uvec3> kept;
    kept.reserve(triangles);
    std::size_t dropped = 0;
    for (std::size_t i = 0; i < triangles; ++i) {
        uvec3 t;
        const auto slots = triangle_slots(mode, i);
        for (int corner = 0; corner < 3; ++corner) {
            t[corner] = index_at(slots[static_cast<std::size_t>(corner)]);
        }
        if (std::max({t.x, t.y, t.z}) >= vertices) {
            ++dropped;
        } else if (t.x != t.y && t.y != t.z && t.z != t.x) {
            kept.push_back(t);
        }
    }
    if (dropped > 0) {
        add_note(file.notes, fmt::format("Dropped {} triangles with vertices that are not there.", dropped));
    }
    if (mode == TINYGLTF_MODE_TRIANGLES && count % 3 != 0) {
        add_note(file.notes, fmt::format("A list of {} indices is no multiple of 3; the rest was dropped.", count));
    }
    return kept;
}

// Renumbers the triangles densely; returns which vertex of the file each new one is.
std::vector<std::uint32_t> compact(std::vector<uvec3>& triangles) {
    std::vector<std::uint32_t> used;
    used.reserve(triangles.size() * 3);
    for (const uvec3 t : triangles) {
        used.insert(used.end(), {t.x, t.y, t.z});
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (uvec3& t : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const auto found = std::lower_bound(used.begin(), used.end(), t[corner]);
            t[corner] = static_cast<std::uint32_t>(found - used.begin());
        }
    }
    return used;
}

// One set of joints and weights; glTF allows any number of sets, four influences each.
struct Influences {
    Elements joints, weights;
};

std::vector<Influences> find_influences(const Source& source) {
    std::vector<Influences> sets;
    for (int set = 0;; ++set) {
        const std::optional<Elements> joints = source.attribute(fmt::format("JOINTS_{}", set));
        const std::optional<Elements> weights = source.attribute(fmt::format("WEIGHTS_{}", set));
        if (!joints || !weights) {
            return sets;
        }
        sets.push_back({*joints, *weights});
    }
}

// The vertices before they are posed, unless that is known, and what holds each of them.
void read_shape(File& file, const Source& source, const std::vector<std::uint32_t>& used, std::size_t joints,
                const Mesh& mesh, RigShape& shape) {
    constexpr std::size_t most_influences = std::size_t{1} << 27;
    const std::vector<Influences> sets = find_influences(source);
    if (shape.positions_os.empty()) {
        shape.positions_os = mesh.positions_os;
    }
    shape.first.reserve(used.size() + 1);
    shape.first.push_back(0);
    for (const std::uint32_t vertex : used) {
        for (const Influences& set : sets) {
            if (vertex >= set.joints.size() || vertex >= set.weights.size()) {
                continue;
            }
            const dvec4 names = set.joints.vector(vertex);
            const vec4 w(set.weights.vector(vertex));
            for (int i = 0; i < 4; ++i) {
                const bool exists = names[i] >= 0.0 && names[i] < static_cast<double>(joints);
                if (exists && w[i] > 0.0F && std::isfinite(w[i])) {
                    shape.influences.push_back({static_cast<std::uint32_t>(names[i]), w[i]});
                }
            }
        }
        if (file.influences + shape.influences.size() > most_influences) {
            fail("{}: joints hold vertices more than {} times", file.shown, most_influences);
        }
        shape.first.push_back(static_cast<std::uint32_t>(shape.influences.size()));
    }
    file.influences += shape.influences.size();
}

void pose_by_joints(const RigShape& shape, const Joints& matrices, Mesh& mesh, std::vector<std::string>& notes) {
    std::size_t loose = 0;
    for (std::size_t v = 0; v < mesh.positions_os.size(); ++v) {
        const std::optional<dmat4> m = blend_joints(shape, v, matrices);
        if (!m) {
            ++loose;
            continue;
        }
        mesh.positions_os[v] = dvec3(*m * dvec4(mesh.positions_os[v], 1.0));
        const glm::dmat3 linear(*m);
        const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                   glm::cross(linear[0], linear[1]));
        const dvec3 n = cofactors * dvec3(mesh.normals_os[v]);
        const double length = glm::length(n);
        mesh.normals_os[v] = length > 0.0 && std::isfinite(length) ? vec3(n / length) : vec3(0.0F);
    }
    note_count(notes, loose,
               "1 vertex of a skinned mesh hangs on no joint that is there, and stays where the mesh has it.",
               "{} vertices of a skinned mesh hang on no joint that is there, and stay where the mesh has them.");
}

// Colours of three components are opaque; they are linear, whatever they are stored as.
vec4 read_color(const Elements& colors, std::size_t vertex) {
    const dvec4 color = colors.vector(vertex);
    return vec4(dvec4(dvec3(color), colors.components() > 3 ? color.w : 1.0));
}

// How far apart floats of a magnitude lie.
double step_at(double magnitude) {
    return std::isfinite(magnitude) && magnitude > 0.0 ? std::ldexp(1.0, std::ilogb(magnitude) - 23) : 0.0;
}

// Counts triangles with an edge of less than four steps of the floats around it: rounding has moved its ends by up to an
// eighth of it each. Only where a mesh has lost six of its 24 bits to its distance from zero, and a tenth of its triangles
// are so: slivers are everywhere, and edges of no length are said elsewhere.
void count_coarse(File& file, const Mesh& mesh) {
    std::size_t coarse = 0;
    double farthest = 0.0;
    dvec3 low(std::numeric_limits<double>::infinity());
    dvec3 high(-std::numeric_limits<double>::infinity());
    for (const uvec3 t : mesh.triangles) {
        const std::array p{mesh.positions_os[t.x], mesh.positions_os[t.y], mesh.positions_os[t.z]};
        double largest = 0.0;
        double shortest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < 3; ++i) {
            low = glm::min(low, p[i]);
            high = glm::max(high, p[i]);
            largest = std::max({largest, std::abs(p[i].x), std::abs(p[i].y), std::abs(p[i].z)});
            const double edge = glm::distance(p[i], p[(i + 1) % 3]);
            shortest = edge > 0.0 ? std::min(shortest, edge) : shortest;
        }
        coarse += shortest < 4.0 * step_at(largest) ? 1U : 0U;
        farthest = std::max(farthest, largest);
    }
    if (farthest > 64.0 * glm::distance(low, high) && 10 * coarse >= mesh.triangles.size()) {
        file.coarse_triangles += coarse;
        file.coarse_step = std::max(file.coarse_step, step_at(farthest));
    }
}

}  // namespace

Mesh load_primitive(File& file, const tinygltf::Primitive& primitive, const UvUse& uv_use, const Pose& pose,
                    const std::string& name) {
    // Only triangles cast shadows.
    Mesh mesh{.name = name};
    const int mode = mode_of(primitive);
    if (mode < TINYGLTF_MODE_TRIANGLES) {
        add_note(file.notes, "Points and lines were skipped: only triangles cast shadows.");
        return mesh;
    }
    if (mode > TINYGLTF_MODE_TRIANGLE_FAN) {
        fail("{}: primitive mode {} does not exist; modes are 0 to 6", file.shown, mode);
    }
    const auto named = primitive.attributes.find("POSITION");
    if (named == primitive.attributes.end()) {
        add_note(file.notes, "A primitive without positions was skipped.");
        return mesh;
    }

    // Find the vertices in use, then read just those.
    const Source source{file, primitive, unpack_primitive(file, primitive)};
    const Elements positions = *source.attribute("POSITION");
    const std::optional<Elements> normals = source.attribute("NORMAL");
    const std::optional<Elements> uvs = source.attribute(fmt::format("TEXCOORD_{}", uv_use.set));
    const std::optional<Elements> colors = source.attribute("COLOR_0");
    mesh.triangles = read_triangles(file, source, positions.size());
    const std::vector<std::uint32_t> used = compact(mesh.triangles);
    for (const std::uint32_t v : used) {
        mesh.positions_os.emplace_back(positions.vector(v));
        mesh.normals_os.push_back(normals && v < normals->size() ? vec3(normals->vector(v)) : vec3(0.0F));
        const dvec2 uv(uvs && v < uvs->size() ? dvec2(uvs->vector(v)) : dvec2(0.0));
        mesh.uvs.emplace_back(uv_use.uv_from_file * dvec3(uv, 1.0));
        if (colors) {
            mesh.colors.push_back(v < colors->size() ? read_color(*colors, v) : vec4(1.0F));
        }
    }
    if (file.data.accessors[static_cast<std::size_t>(named->second)].componentType == TINYGLTF_COMPONENT_TYPE_FLOAT) {
        count_coarse(file, mesh);
    }
    morph(file, primitive, pose.weights, used, mesh, pose.morphs ? pose.shape : nullptr);
    if (pose.joints != nullptr) {
        RigShape of_this;
        RigShape& shape = pose.shape != nullptr ? *pose.shape : of_this;
        read_shape(file, source, used, pose.joints->size(), mesh, shape);
        pose_by_joints(shape, *pose.joints, mesh, file.notes);
    }
    return mesh;
}

}  // namespace gn::gltf
