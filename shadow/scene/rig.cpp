// SPDX-License-Identifier: MIT
// A rig at a time: nodes by their curves, vertices by their node or their joints.
#include "shadow/scene/rig.h"

#include "base/error.h"
#include "base/param.h"
#include "shadow/scene/model.h"
#include "shadow/scene/morph.h"

#include <algorithm>
#include <charconv>

namespace gn {
namespace {

constexpr double farthest_coordinate = 1e9;  // as in a loaded scene

glm::dmat3 cofactors_of(const dmat4& m) {
    const glm::dmat3 linear(m);
    return {glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]), glm::cross(linear[0], linear[1])};
}

/// Of a follower, at one pose: its shape morphed, and where that goes, all by one matrix or each by the mean of its joints'.
class Placing {
  public:
    Placing(const Rig& rig, const Follower& follower, std::span<const dmat4> nodes, std::span<const double> weights)
        : shape_(rig.shapes[follower.shape]), follower_(follower) {
        whole_ = follower.node >= 0 ? nodes[static_cast<std::size_t>(follower.node)] * follower.node_from_os : dmat4(1);
        if (follower.skin >= 0) {
            joints_ = joint_matrices(rig.skins[static_cast<std::size_t>(follower.skin)], nodes);
        }
        if (follower.weights >= 0) {
            morphed_.positions_os = shape_.positions_os;
            morphed_.normals_os.assign(shape_.normals_os.begin(), shape_.normals_os.end());
            add_targets(shape_.targets, weights, morphed_);
        }
    }

    /// Of the shape's vertex: the mean of its joints' matrices by its weights.
    [[nodiscard]] dmat4 ws_from_os(std::size_t vertex) const {
        return follower_.skin < 0 ? whole_ : blend_joints(shape_, vertex, joints_).value_or(whole_);
    }
    [[nodiscard]] dvec3 position_os(std::size_t vertex) const {
        return morphed_.positions_os.empty() ? shape_.positions_os[vertex] : morphed_.positions_os[vertex];
    }
    /// Of a vertex of the shape or, behind them, a copy.
    [[nodiscard]] dvec3 normal_os(std::size_t n) const {
        const bool given = n < morphed_.normals_os.size() && morphed_.normals_os[n] != dvec3(0);
        return given ? follower_.facing * morphed_.normals_os[n] : dvec3(follower_.normals_os[n]);
    }

    /// The mean over all vertices.
    [[nodiscard]] dmat4 mean() const {
        dvec3 morph_os(0);
        for (std::size_t v = 0; v < morphed_.positions_os.size(); ++v) {
            morph_os +=
                (morphed_.positions_os[v] - shape_.positions_os[v]) / static_cast<double>(morphed_.positions_os.size());
        }
        dmat4 mean = whole_;
        if (follower_.skin >= 0) {
            mean *= follower_.shares.back();
            for (std::size_t j = 0; j < joints_.size(); ++j) {
                mean += follower_.shares[j] * joints_[j];
            }
        }
        return glm::translate(mean, morph_os);
    }

  private:
    const RigShape& shape_;
    const Follower& follower_;
    dmat4 whole_{1};
    std::vector<dmat4> joints_;
    Morphed morphed_;
};

/// Of the node that its targets follow.
std::span<const double> weights_of(const Follower& follower, std::span<const std::vector<double>> weights) {
    return follower.weights >= 0 ? std::span<const double>(weights[static_cast<std::size_t>(follower.weights)])
                                 : std::span<const double>();
}

Placing at_rest(const Rig& rig, const Follower& follower) {
    return {rig, follower, rig.rest,
            follower.weights >= 0 ? std::span(rig.nodes[static_cast<std::size_t>(follower.weights)].weights)
                                  : std::span<const double>()};
}

/// Whether anything of it stands otherwise by the one nodes than by the others.
bool differs(const Rig& rig, const Follower& follower, std::span<const dmat4> a, std::span<const dmat4> b) {
    const auto other = [&](int node) {
        return node >= 0 && a[static_cast<std::size_t>(node)] != b[static_cast<std::size_t>(node)];
    };
    if (follower.skin < 0) {
        return other(follower.node);
    }
    const std::vector<int>& joints = rig.skins[static_cast<std::size_t>(follower.skin)].joints;
    return std::any_of(joints.begin(), joints.end(), other);
}

bool within(dvec3 p) {
    return std::abs(p.x) <= farthest_coordinate && std::abs(p.y) <= farthest_coordinate &&
           std::abs(p.z) <= farthest_coordinate;
}

/// Writes positions and normals; false, and nothing written, where one would leave the numbers.
bool place_vertices(Scene& scene, const Rig& rig, const Follower& follower, const Placing& placing) {
    const std::size_t count = rig.shapes[follower.shape].positions_os.size();
    std::vector<vec3> positions_ws(count), normals_ws(follower.normals_os.size());
    const auto turned = [&](const dmat4& m, std::size_t n) {
        const dvec3 normal = cofactors_of(m) * placing.normal_os(n);
        const double length = glm::length(normal);
        return std::isfinite(length) && length > 0 ? vec3(normal / length) : vec3(0, 1, 0);
    };
    for (std::size_t v = 0; v < count; ++v) {
        const dmat4 m = placing.ws_from_os(v);
        const dvec3 p_ws = dvec3(m * dvec4(placing.position_os(v), 1)) - scene.origin;
        if (!within(p_ws)) {
            return false;
        }
        positions_ws[v] = vec3(p_ws);
        normals_ws[v] = turned(m, v);
    }
    std::copy(positions_ws.begin(), positions_ws.end(), scene.positions_ws.begin() + follower.first_vertex);
    std::copy_n(normals_ws.begin(), count, scene.normals_ws.begin() + follower.first_vertex);
    for (std::size_t i = 0; i < follower.copies.size(); ++i) {
        const Follower::Copy& copy = follower.copies[i];
        scene.positions_ws[copy.vertex] = positions_ws[copy.of];
        scene.normals_ws[copy.vertex] = turned(placing.ws_from_os(copy.of), count + i);
    }
    smooth_normals(scene, follower.smooth);
    return true;
}

/// The object's place by where its vertices are now. `now_from_first`: of all its points.
void place_object(Scene& scene, Object& object, const dmat4& now_from_first) {
    object.bounds_ws = {};
    for (std::uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count; ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            object.bounds_ws.grow(scene.positions_ws[scene.triangles[t][corner]]);
        }
    }
    object.now_from_first = now_from_first;
    ++object.version;
}

/// The move between two places in the scene's coordinates, which are relative to its origin; none where the first was flat.
dmat4 move_between(const dmat4& now, const dmat4& first, dvec3 origin) {
    const dmat4 moved =
        glm::translate(dmat4(1), -origin) * now * glm::inverse(first) * glm::translate(dmat4(1), origin);
    return within(dvec3(moved[0])) && within(dvec3(moved[1])) && within(dvec3(moved[2])) && within(dvec3(moved[3]))
               ? moved
               : dmat4(1);
}

/// How many would leave the numbers, and stay where they were.
std::size_t place_lights(Scene& scene, const Rig& rig) {
    std::size_t lost = 0;
    for (const CarriedLight& carried : rig.lights) {
        const dmat4 moved = move_between(rig.now[carried.node], rig.rest[carried.node], scene.origin);
        PlacedLight placed{carried.rest, dvec3(carried.rest.shape.position_ws)};
        move_light(placed, moved);
        if (!within(placed.position_ws) || !within(dvec3(rig.now[carried.node][3]) - scene.origin)) {
            ++lost;
            continue;
        }
        placed.light.shape.position_ws = vec4(vec3(placed.position_ws), carried.rest.shape.position_ws.w);
        scene.lights[carried.light].shape = moved == dmat4(1) ? carried.rest.shape : placed.light.shape;
    }
    return lost;
}

std::size_t place_cameras(Scene& scene, const Rig& rig) {
    std::size_t lost = 0;
    for (const CarriedCamera& carried : rig.cameras) {
        const dmat4 moved = move_between(rig.now[carried.node], rig.rest[carried.node], scene.origin);
        PlacedCamera placed{carried.rest, dvec3(carried.rest.position_ws)};
        move_camera(placed, moved);
        if (!within(placed.position_ws) || !within(dvec3(rig.now[carried.node][3]) - scene.origin)) {
            ++lost;
            continue;
        }
        placed.camera.position_ws = vec3(placed.position_ws);
        scene.cameras[carried.camera] = moved == dmat4(1) ? carried.rest : placed.camera;
    }
    return lost;
}

}  // namespace

dmat4 local_matrix(const RigNode& node) {
    return node.matrix ? *node.matrix : matrix_of(node.translation, node.rotation, node.scale);
}

std::vector<dmat4> joint_matrices(const Skin& skin, std::span<const dmat4> nodes) {
    std::vector<dmat4> matrices;
    matrices.reserve(skin.joints.size());
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        const int node = skin.joints[j];
        matrices.push_back((node >= 0 ? nodes[static_cast<std::size_t>(node)] : dmat4(1)) * skin.joint_from_mesh[j]);
    }
    return matrices;
}

std::optional<dmat4> blend_joints(const RigShape& shape, std::size_t vertex, std::span<const dmat4> joints) {
    dmat4 sum(0);
    double total = 0;
    for (std::uint32_t i = shape.first[vertex]; i < shape.first[vertex + 1]; ++i) {
        const Influence& influence = shape.influences[i];
        sum += static_cast<double>(influence.weight) * joints[influence.joint];
        total += static_cast<double>(influence.weight);
    }
    return total > 0 ? std::optional(sum * (1 / total)) : std::nullopt;
}

std::size_t find_animation(const Rig& rig, const std::string& name) {
    std::vector<std::string_view> known;
    for (std::size_t i = 0; i < rig.animations.size(); ++i) {
        if (rig.animations[i].name == name) {
            return i;
        }
        known.push_back(rig.animations[i].name);
    }
    std::size_t number = 0;
    const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (code == std::errc{} && end == name.data() + name.size() && number >= 1 && number <= rig.animations.size()) {
        return number - 1;
    }
    if (known.empty()) {
        fail("--animation {}: nothing of this scene moves; a .glb or .gltf file with animations does", name);
    }
    fail("--animation: there is no animation '{}'; {}", name, suggest(name, known));
}

namespace {

std::span<const Channel> channels_of(const Rig& rig, std::optional<std::size_t> animation) {
    return animation ? std::span<const Channel>(rig.animations.at(*animation).channels) : std::span<const Channel>();
}

}  // namespace

std::vector<dmat4> pose_nodes(const Rig& rig, std::optional<std::size_t> animation, double seconds) {
    std::vector<RigNode> nodes = rig.nodes;
    for (const Channel& channel : channels_of(rig, animation)) {
        const Curve& curve = rig.curves[channel.curve];
        RigNode& node = nodes[channel.node];
        switch (channel.path) {
            case Channel::translation: node.translation = vector_at(curve, seconds); break;
            case Channel::rotation: node.rotation = rotation_at(curve, seconds); break;
            case Channel::scale: node.scale = vector_at(curve, seconds); break;
            case Channel::weight: break;
        }
    }
    std::vector<dmat4> ws_from_node;
    ws_from_node.reserve(nodes.size());
    for (const RigNode& node : nodes) {
        const dmat4 parent = node.parent >= 0 ? ws_from_node[static_cast<std::size_t>(node.parent)] : dmat4(1);
        ws_from_node.push_back(parent * local_matrix(node));
    }
    return ws_from_node;
}

std::vector<std::vector<double>> pose_weights(const Rig& rig, std::optional<std::size_t> animation, double seconds) {
    std::vector<std::vector<double>> weights;
    weights.reserve(rig.nodes.size());
    for (const RigNode& node : rig.nodes) {
        weights.push_back(node.weights);
    }
    for (const Channel& channel : channels_of(rig, animation)) {
        if (channel.path == Channel::weight) {
            weights[channel.node].at(channel.target) = vector_at(rig.curves[channel.curve], seconds).x;
        }
    }
    return weights;
}

std::vector<std::string> pose_scene(Scene& scene, Rig& rig, std::optional<std::size_t> animation, double seconds) {
    std::vector<std::string> remarks;
    if (!rig.moves()) {
        return remarks;
    }
    const std::vector<dmat4> before = std::exchange(rig.now, pose_nodes(rig, animation, seconds));
    const std::vector<std::vector<double>> weights_before =
        std::exchange(rig.weights, pose_weights(rig, animation, seconds));

    // What stands otherwise than before.
    std::vector<std::optional<dmat4>> moved(rig.followers.size());
    std::size_t lost = 0;
    for (std::size_t f = 0; f < rig.followers.size(); ++f) {
        const Follower& follower = rig.followers[f];
        const std::span weights = weights_of(follower, rig.weights), held = weights_of(follower, weights_before);
        if (!differs(rig, follower, before, rig.now) && std::equal(weights.begin(), weights.end(), held.begin())) {
            continue;
        }
        const Placing placing(rig, follower, rig.now, weights);
        if (place_vertices(scene, rig, follower, placing)) {
            moved[f] = move_between(placing.mean(), at_rest(rig, follower).mean(), scene.origin);
        } else {
            ++lost;
        }
    }
    scene.bounds_ws = {};
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const int follower = i < rig.followed.size() ? rig.followed[i] : -1;
        if (follower >= 0 && moved[static_cast<std::size_t>(follower)]) {
            place_object(scene, scene.objects[i], *moved[static_cast<std::size_t>(follower)]);
        }
        scene.bounds_ws.grow(scene.objects[i].bounds_ws);
    }
    lost += place_lights(scene, rig) + place_cameras(scene, rig);
    note_count(remarks, lost, "1 mesh, lamp or camera would move beyond 1e9 m at this time; it stays where it was.",
               "{} meshes, lamps or cameras would move beyond 1e9 m at this time; they stay where they were.");
    return remarks;
}

namespace {

/// How much each joint moves the mean vertex.
std::vector<double> shares_of(const RigShape& shape, std::size_t joints) {
    std::vector<double> shares(joints + 1, 0);
    const double each = 1 / static_cast<double>(std::max<std::size_t>(shape.positions_os.size(), 1));
    for (std::size_t v = 0; v < shape.positions_os.size(); ++v) {
        const std::span held = std::span(shape.influences).subspan(shape.first[v], shape.first[v + 1] - shape.first[v]);
        double total = 0;
        for (const Influence& influence : held) {
            total += static_cast<double>(influence.weight);
        }
        for (const Influence& influence : held) {
            shares[influence.joint] += each * static_cast<double>(influence.weight) / total;
        }
        shares.back() += held.empty() ? each : 0;
    }
    return shares;
}

/// Of every follower that morphs: corners of its triangles where the file gives no normal. Copies were made for these alone.
void bind_smooth_corners(const Scene& scene, Rig& rig) {
    std::vector<std::vector<std::uint32_t>> triangles(rig.followers.size());
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const int f = rig.followed[i];
        if (f >= 0 && rig.followers[static_cast<std::size_t>(f)].weights >= 0) {
            const Object& object = scene.objects[i];
            for (std::uint32_t t = 0; t < object.triangle_count; ++t) {
                triangles[static_cast<std::size_t>(f)].push_back(object.first_triangle + t);
            }
        }
    }
    for (std::size_t f = 0; f < rig.followers.size(); ++f) {
        Follower& follower = rig.followers[f];
        const std::vector<vec3>& given = rig.shapes[follower.shape].normals_os;
        follower.smooth = find_smooth_corners(scene, triangles[f], [&](std::uint32_t vertex) {
            const std::uint32_t v = vertex - follower.first_vertex;
            return vertex < follower.first_vertex || v >= given.size() || given[v] == vec3(0);
        });
    }
}

}  // namespace

void bind_rig(const Scene& scene, Rig& rig, std::size_t vertices, std::span<const std::uint32_t> copies) {
    rig.rest = rig.now = pose_nodes(rig, std::nullopt, 0);
    rig.weights = pose_weights(rig, std::nullopt, 0);

    // Whom a vertex of the scene belongs to; followers ascend.
    const auto follower_of = [&](std::uint32_t vertex) {
        const std::uint32_t of = vertex < vertices                   ? vertex
                                 : vertex - vertices < copies.size() ? copies[vertex - vertices]
                                                                     : vertex;
        const auto after = std::upper_bound(rig.followers.begin(), rig.followers.end(), of,
                                            [](std::uint32_t v, const Follower& f) { return v < f.first_vertex; });
        const bool any = after != rig.followers.begin() &&
                         of - (after - 1)->first_vertex < rig.shapes[(after - 1)->shape].positions_os.size();
        return std::pair(any ? static_cast<int>(after - rig.followers.begin()) - 1 : -1, of);
    };
    for (std::size_t i = 0; i < copies.size(); ++i) {
        const auto vertex = static_cast<std::uint32_t>(vertices + i);
        if (const auto [f, of] = follower_of(vertex); f >= 0) {
            Follower& follower = rig.followers[static_cast<std::size_t>(f)];
            follower.copies.push_back({vertex, of - follower.first_vertex});
        }
    }
    rig.followed.clear();
    for (const Object& object : scene.objects) {
        rig.followed.push_back(object.triangle_count > 0 ? follower_of(scene.triangles[object.first_triangle].x).first
                                                         : -1);
    }

    // Normals before they were placed, so that cofactors bring them back: C n_os = C sign(det) L^T n_ws = |det| n_ws.
    for (Follower& follower : rig.followers) {
        if (follower.skin >= 0) {
            follower.shares =
                shares_of(rig.shapes[follower.shape], rig.skins[static_cast<std::size_t>(follower.skin)].joints.size());
        }
        const Placing placing = at_rest(rig, follower);
        if (follower.skin < 0 && glm::determinant(glm::dmat3(placing.ws_from_os(0))) < 0) {
            follower.facing = -1;
        }
        const auto add = [&](std::size_t v, vec3 n_ws) {
            const glm::dmat3 linear(placing.ws_from_os(v));
            const dvec3 n = (glm::determinant(linear) < 0 ? -1.0 : 1.0) * (glm::transpose(linear) * dvec3(n_ws));
            const double length = glm::length(n);
            follower.normals_os.push_back(std::isfinite(length) && length > 0 ? vec3(n / length) : n_ws);
        };
        for (std::size_t v = 0; v < rig.shapes[follower.shape].positions_os.size(); ++v) {
            add(v, scene.normals_ws[follower.first_vertex + v]);
        }
        for (const Follower::Copy& copy : follower.copies) {
            add(copy.of, scene.normals_ws[copy.vertex]);
        }
    }
    bind_smooth_corners(scene, rig);
    for (CarriedLight& carried : rig.lights) {
        carried.rest = scene.lights.at(carried.light);
    }
    for (CarriedCamera& carried : rig.cameras) {
        carried.rest = scene.cameras.at(carried.camera);
    }
}

}  // namespace gn
