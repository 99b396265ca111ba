// SPDX-License-Identifier: MIT
// The pieces of the glTF loader. Everything in the parsed file is hostile until one of these has checked it.
#pragma once

#include "base/error.h"
#include "shadow/scene/files/files.h"
#include "shadow/scene/model.h"

#include <tiny_gltf.h>

#include <map>
#include <span>

namespace gn::gltf {

/// A parsed file and what is needed to read from it.
struct File {
    std::string shown;  ///< the path, fit for messages
    tinygltf::Model data;
    std::map<int, std::vector<std::byte>> external_images;  ///< bytes of images that are not in a buffer view
    std::map<std::string, std::string> refusals;  ///< names of files that were not found or not allowed, and why
    std::map<int, std::vector<unsigned char>> unpacked_views;  ///< what compressed buffer views hold
    std::vector<std::string> notes;
    std::size_t triangles_decoded = 0;  ///< of all primitives so far, before instancing
    std::size_t coarse_triangles = 0;   ///< of these, as large as few steps of the floats that hold their positions
    double coarse_step = 0;             ///< the largest of these steps
    std::size_t influences = 0;         ///< of joints on vertices, read so far
    std::size_t displacements = 0;      ///< of morph targets on vertices, read so far
};

/// Throws Error for what is no JSON, for nesting or a number of values that only an attack has, and for indices,
/// counts and lists of another type: the parser would quietly read them as absent.
void check_json(std::string_view json, const std::string& shown);
/// Reads a .gltf or .glb; external files only from its folder and `assets`. Throws Error.
File parse_file(const std::filesystem::path& path, const Assets& assets);

/// One note for each kind of extension that the file uses and that is not understood.
void note_extensions(File& file);

/// Of an accessor's type; 0 for one that is not read.
int count_components(int type);

/// Reads elements of an accessor as floats, whatever they are stored as; sparse ones included.
class Elements {
  public:
    /// Throws Error when any element would lie outside its buffer.
    Elements(const File& file, int accessor);
    /// The same of an accessor whose bytes lie elsewhere, without gaps and alive for as long as this.
    Elements(const File& file, int accessor, std::span<const unsigned char> bytes);
    [[nodiscard]] std::size_t size() const { return count_; }
    /// Components beyond those stored are 0. `index` < size().
    [[nodiscard]] dvec4 vector(std::size_t index) const;
    [[nodiscard]] dmat4 matrix(std::size_t index) const;
    [[nodiscard]] std::uint32_t integer(std::size_t index) const;
    [[nodiscard]] int components() const { return components_; }

  private:
    void take_form(const File& file, int accessor);
    struct Run {
        const unsigned char* bytes = nullptr;  ///< null: all zeros
        std::size_t stride = 0;
    };
    Run locate(const File& file, int view, std::size_t offset, std::size_t count, std::size_t element_size,
               bool packed) const;
    void read_sparse(const File& file, const tinygltf::Accessor& accessor);
    [[nodiscard]] const unsigned char* element(std::size_t index) const;
    [[nodiscard]] double component(const unsigned char* bytes, int component) const;

    std::string name_;  ///< "file.gltf: accessor 3"
    Run base_;
    std::size_t count_ = 0;
    int components_ = 0, component_type_ = 0, component_size_ = 0;
    bool normalized_ = false;
    std::map<std::uint32_t, const unsigned char*> sparse_;
};

/// Which coordinates a material's base colour wants, and how it moves them.
struct UvUse {
    int set = 0;
    glm::dmat3 uv_from_file{1.0};
};

class Pictures;  // gltf_pictures.h

/// Materials and the textures they use; the last material is the default one.
std::vector<UvUse> load_materials(File& file, Model& model, Pictures& pictures);
/// What extras.gnomon of a node, a mesh or a material says about casting and receiving.
struct Orders {
    std::optional<bool> casts, receives;
    /// These, and where they say nothing `others`.
    [[nodiscard]] Orders over(const Orders& others) const {
        return {casts.has_value() ? casts : others.casts, receives.has_value() ? receives : others.receives};
    }
};
/// `who` is for the notes: "Node 'lamp'". Nodes that carry a light may have that light's keys too.
Orders read_orders(File& file, const tinygltf::Value& extras, const std::string& who, bool carries_light = false);
/// Keys of extras.gnomon that size a light.
std::span<const char* const> light_keys();
/// Keys of extras.gnomon that order casting and receiving.
std::span<const char* const> order_keys();

/// A node's light and the picture that it shows; nothing where the node has none or it is unusable (with a note).
std::optional<PlacedLight> load_light(File& file, const tinygltf::Node& node, const dmat4& ws_from_node,
                                      Pictures& pictures);
/// What extras.gnomon of the scene that is shown says of the light from everywhere; nothing where it says nothing, or (with
/// a note) nothing usable.
std::optional<Light> load_environment(File& file);
std::optional<PlacedCamera> load_camera(File& file, const tinygltf::Node& node, const dmat4& ws_from_node);

/// World matrices of all nodes of the scene, in the order of a depth-first walk; throws Error unless it is a forest.
struct PlacedNode {
    int index = 0;
    dmat4 ws_from_node{1.0};
    bool visible = true;  ///< by KHR_node_visibility, of this node and all above it
    int parent = -1;      ///< its place in the walk; -1: none
};
std::vector<PlacedNode> walk_nodes(const File& file);

/// How a node stands in its parent's space when nothing moves it.
RigNode node_at_rest(const tinygltf::Node& node);
/// The nodes as a rig, in the order of the walk, and the animations that move any of them. What cannot be played is left out
/// with a note. No animation: the rig is empty.
Rig load_rig(File& file, std::span<const PlacedNode> nodes);
/// By each of so many nodes: whether a curve moves a weight of its mesh.
std::vector<bool> find_morphed(const Rig& rig, std::size_t nodes);
/// A skin whose joints are numbered as the walk does. Throws Error.
Skin load_skin(const File& file, int skin, std::span<const int> walked);

/// Joint matrices at rest, for meshes that hang on bones.
using Joints = std::vector<dmat4>;
/// What moves the vertices of a primitive before it is placed.
struct Pose {
    const Joints* joints = nullptr;
    std::span<const double> weights;  ///< of the morph targets, at rest
    RigShape* shape = nullptr;        ///< not null: takes the vertices as they were before the joints moved them
    bool morphs = false;              ///< as they were before the targets moved them, and the targets
};
/// The triangles of one primitive in object space (in world space with joints); empty when there are none.
Mesh load_primitive(File& file, const tinygltf::Primitive& primitive, const UvUse& uv_use, const Pose& pose,
                    const std::string& name);
/// Adds the weighted morph targets to a mesh whose vertex i is the file's used[i]. `shape`: null, or takes the mesh as it was,
/// and all targets, for weights that change. A target that cannot be read moves nothing, with a note.
void morph(File& file, const tinygltf::Primitive& primitive, std::span<const double> weights,
           const std::vector<std::uint32_t>& used, Mesh& mesh, RigShape* shape);
/// Of the primitive that has most.
std::size_t count_targets(const tinygltf::Mesh& mesh);
/// The matrices by which EXT_mesh_gpu_instancing shows a node's mesh, below the node's own; one identity without it.
std::vector<dmat4> instance_matrices(File& file, const tinygltf::Node& node);

/// file.data.<list>[index], or Error.
template <class T>
const T& at(const std::vector<T>& list, int index, const File& file, const char* what) {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size()) {
        fail("{}: {} {} does not exist; the file has {}", file.shown, what, index, list.size());
    }
    return list[static_cast<std::size_t>(index)];
}

/// A number from extras or an extension, nothing when absent or no number.
std::optional<double> number(const tinygltf::Value& object, const std::string& key);

}  // namespace gn::gltf
