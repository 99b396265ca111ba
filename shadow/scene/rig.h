// SPDX-License-Identifier: MIT
// What moves in a file: a forest of nodes, curves that move them, and the vertices, lights and cameras that follow.
//
//     AnimatedScene loaded = load_animated_scene("model.glb");
//     pose_scene(loaded.scene, loaded.rig, find_animation(loaded.rig, "walk"), 0.5);   // seconds
//     refresh_scene(device, gpu);                                    // where it lies on the GPU already
//
// The mathematics is that of glTF 2.0 (sections 3.7.3, 3.11 and appendix C). All of it runs on the CPU in double precision.
#pragma once

#include "shadow/scene/scene.h"
#include "shadow/scene/smoothing.h"

#include <glm/gtc/quaternion.hpp>

#include <span>

namespace gn {

/// How values between two keys are found.
enum class Interpolation { step, linear, cubic_spline };

/// Values over time. A rotation is a quaternion x, y, z, w; the others use x, y, z.
struct Curve {
    Interpolation between = Interpolation::linear;
    std::vector<float> times;  ///< seconds, ascending strictly, never empty
    /// One a key; with cubic_spline three: the tangent that arrives, the value, the tangent that leaves.
    std::vector<vec4> values;
};
/// The value at a time; before the first key and behind the last one it is theirs.
dvec3 vector_at(const Curve& curve, double seconds);
/// Likewise, of unit length; the shorter way round between linear keys.
glm::dquat rotation_at(const Curve& curve, double seconds);

/// translation * rotation * scale; a quaternion without length turns nothing.
dmat4 matrix_of(dvec3 translation, glm::dquat rotation, dvec3 scale);

/// Where a node stands in its parent's space.
struct RigNode {
    int parent = -1;  ///< a node before this one; -1: none
    dvec3 translation{0};
    glm::dquat rotation{1, 0, 0, 0};
    dvec3 scale{1};
    std::optional<dmat4> matrix;  ///< instead of the three, which then nothing moves
    std::vector<double> weights;  ///< of its mesh's morph targets
};

dmat4 local_matrix(const RigNode& node);

/// One property of one node follows a curve; a weight its x.
struct Channel {
    enum Path { translation, rotation, scale, weight };
    std::size_t node = 0;
    Path path = translation;
    std::size_t curve = 0;
    std::size_t target = 0;  ///< whose weight it is
};

struct Animation {
    std::string name;
    std::vector<Channel> channels;
    double seconds = 0;  ///< the time of its last key
};

struct Skin {
    std::vector<int> joints;             ///< nodes; -1 stands at the origin
    std::vector<dmat4> joint_from_mesh;  ///< inverse bind matrices, one a joint
};

/// ws_from_joint * joint_from_mesh of every joint, with the world matrices of all nodes.
std::vector<dmat4> joint_matrices(const Skin& skin, std::span<const dmat4> nodes);

struct Influence {
    std::uint32_t joint = 0;  ///< of the skin
    float weight = 0;         ///< above 0; those of a vertex need not sum to one
};

/// How far the vertices of a shape go at a weight of 1. Those that stand still are not listed.
struct MorphTarget {
    std::vector<std::uint32_t> vertices;         ///< of the shape, ascending
    std::vector<vec3> positions_os, normals_os;  ///< displacements, one a vertex in the list
};

/// A mesh as it is before it is morphed, placed or posed.
struct RigShape {
    std::vector<dvec3> positions_os;
    std::vector<vec3> normals_os;  ///< with targets: the file's own, unit; 0 where it gives none
    std::vector<MorphTarget> targets;
    /// With a skin: the influences of vertex v are [first[v], first[v + 1]).
    std::vector<std::uint32_t> first;
    std::vector<Influence> influences;
};

/// The mean of the joints' matrices by the weights of a vertex; nothing where it hangs on none.
std::optional<dmat4> blend_joints(const RigShape& shape, std::size_t vertex, std::span<const dmat4> joints);

/// Vertices of the scene that follow a node, or the joints of a skin.
struct Follower {
    std::size_t shape = 0;
    int node = -1;                   ///< that all of it follows; with a skin, what hangs on no joint. -1: the origin
    int skin = -1;                   ///< -1: none
    dmat4 node_from_os{1};           ///< without a skin
    int weights = -1;                ///< the node whose weights the shape's targets take; -1: none
    std::uint32_t first_vertex = 0;  ///< of the scene, as many as the shape has
    struct Copy {
        std::uint32_t vertex = 0, of = 0;  ///< a vertex of the scene, and the shape's
    };
    std::vector<Copy> copies;      ///< vertices that stand where another one does, with another normal
    std::vector<vec3> normals_os;  ///< of the shape's vertices, then of the copies
    double facing = 1;             ///< -1: mirrored at rest, so that normals_os are the file's turned round
    std::vector<double> shares;    ///< of every joint in the mean of the vertices' matrices, then of what hangs on none
    std::vector<SmoothCorner> smooth;  ///< with weights: of the vertices that no file gave a normal
};

/// A light or a camera that a node carries, as it is at rest.
struct CarriedLight {
    std::size_t light = 0, node = 0;
    Light rest;
};
struct CarriedCamera {
    std::size_t camera = 0, node = 0;
    Camera rest;
};

/// Empty where nothing moves.
struct Rig {
    std::vector<RigNode> nodes;
    std::vector<Curve> curves;
    std::vector<Animation> animations;
    std::vector<Skin> skins;
    std::vector<RigShape> shapes;
    std::vector<Follower> followers;  ///< by ascending first_vertex
    std::vector<CarriedLight> lights;
    std::vector<CarriedCamera> cameras;

    std::vector<int> followed;                 ///< by each object of the scene: its follower, or -1
    std::vector<dmat4> rest, now;              ///< ws_from_node of every node: at rest, and as the scene stands
    std::vector<std::vector<double>> weights;  ///< of every node, as the scene stands

    [[nodiscard]] bool moves() const { return !animations.empty(); }
};

/// A scene and what moves it.
struct AnimatedScene {
    Scene scene;
    Rig rig;
};
/// As load_scene, and at rest as it is there.
AnimatedScene load_animated_scene(const std::string& name_or_path, const LoadOptions& options = {});

/// The animation of this name, or "1" for the first, "2" for the second. Throws Error listing those that there are.
std::size_t find_animation(const Rig& rig, const std::string& name);

/// World matrices of all nodes at a time of an animation; unset: at rest.
std::vector<dmat4> pose_nodes(const Rig& rig, std::optional<std::size_t> animation, double seconds);
/// Likewise the weights of their morph targets.
std::vector<std::vector<double>> pose_weights(const Rig& rig, std::optional<std::size_t> animation, double seconds);

/// Moves the scene to a time of an animation; unset: to where it is at rest. Positions, normals and bounds of what moved
/// follow, with a new version of its objects (refresh_scene brings them to the GPU); lights and cameras that nodes carry
/// follow too. now_from_first is exact of what follows a node; of a skin and of what morphs it is the mean of its vertices'. What
/// would leave the numbers (beyond 1e9 m) stays where it was. What must be said of the pose, one sentence each.
std::vector<std::string> pose_scene(Scene& scene, Rig& rig, std::optional<std::size_t> animation, double seconds);

/// Ties a loaded scene to its rig, once. `first_vertex` of the followers is set; `copies`: of which vertex each of those that
/// were added behind them is a copy; `vertices`: how many there were before.
void bind_rig(const Scene& scene, Rig& rig, std::size_t vertices, std::span<const std::uint32_t> copies);

/// Appends `part` to `whole`, below a node that moves it. Animations of one name become one.
void append_rig(Rig& whole, Rig part, const dmat4& ws_from_part);

}  // namespace gn
