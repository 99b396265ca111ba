// SPDX-License-Identifier: MIT
// What the file loaders hand over: meshes in object space, instances, lights and cameras, all in double precision.
// Only flatten() rounds to float, after the scene's origin is known.
#pragma once

#include "shadow/scene/rig.h"
#include "shadow/scene/scene.h"

namespace gn {

/// Triangles of one material in object space. Indices are < positions_os.size(); a zero normal means "not given".
struct Mesh {
    std::string name;
    std::vector<dvec3> positions_os;
    std::vector<vec3> normals_os;  ///< as long as positions_os
    std::vector<vec2> uvs;         ///< as long as positions_os
    std::vector<vec4> colors;      ///< likewise, as Scene::colors; empty: all 1
    std::vector<uvec3> triangles;
    int material = 0;
};

struct Instance {
    std::size_t mesh = 0;
    dmat4 ws_from_os{1.0};
    std::string name;
    std::optional<bool> casts, receives;  ///< what the file told; unset: nothing
    std::optional<std::size_t> follower;  ///< of the rig; unset: it stands still
};

/// light.shape.position_ws is unused until flatten() writes it.
struct PlacedLight {
    Light light;
    dvec3 position_ws{0.0};
};

/// camera.position_ws is unused until flatten() writes it. near or far 0: to be chosen from the scene.
struct PlacedCamera {
    Camera camera;
    dvec3 position_ws{0.0};
};

struct PlacedPath {
    std::string name;
    std::vector<PlacedCamera> frames;
};

struct Model {
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<PlacedLight> lights;
    std::optional<Light> environment;  ///< unset: the file says nothing
    std::vector<PlacedCamera> cameras;
    std::vector<PlacedPath> paths;
    Rig rig;  ///< its lights and cameras are those of this model
    std::vector<std::string> notes;
};

/// Most instances of primitives in one scene; more is an Error.
inline constexpr std::size_t max_instances = 1'000'000;
/// Most pixels of all textures of one file; further textures are dropped with a note.
inline constexpr std::size_t max_texture_pixels = std::size_t{1} << 29;

/// Adds a note; after 200 notes one last sentence says that more were left out.
void add_note(std::vector<std::string>& notes, std::string note);
/// Adds the sentence for one thing, or that for `many` with their number in the place of {}; nothing where there is none.
void note_count(std::vector<std::string>& notes, std::size_t count, const char* one, const char* many);

/// Says that a material's holes are filled because their picture is missing.
void note_lost_mask(std::vector<std::string>& notes, const std::string& material);
/// Whether nothing of a material is there, whatever its picture.
bool is_wholly_transparent(const Material& material);
/// Notes every material in use that lets all light through: such a surface is easily taken for a missing one.
void note_transparent(Scene& scene);

/// Appends `part` to `whole`, moved by `ws_from_model`.
void append_model(Model& whole, Model part, const dmat4& ws_from_model);

/// Moves a light, whose intensity stays and whose size scales, or a camera.
void move_light(PlacedLight& placed, const dmat4& ws_from_model);
void move_camera(PlacedCamera& placed, const dmat4& ws_from_model);

/// Writes every instance in world space. Throws Error beyond max_triangles or max_instances, before it allocates.
Scene flatten(const Model& model);

/// Folders that a file may read from besides its own.
using Assets = std::vector<std::filesystem::path>;

// The loaders. Each throws Error with one sentence and reads nothing outside the file's folder and `assets`.
Model load_gltf(const std::filesystem::path& path, const Assets& assets);
Model load_obj(const std::filesystem::path& path, const Assets& assets);
Model load_assimp(const std::filesystem::path& path, const Assets& assets);
Model load_toml(const std::filesystem::path& path, const Assets& assets);
/// By extension; `.toml` only where `toml_allowed`.
Model load_model(const std::filesystem::path& path, const Assets& assets, bool toml_allowed);

// The steps of finish_scene.
void drop_bad_triangles(Scene& scene);
/// Vertices that get several normals are copied, behind all others; gives of which vertex each of those is a copy.
std::vector<std::uint32_t> complete_normals(Scene& scene);
/// As finish_scene; gives what complete_normals copied.
std::vector<std::uint32_t> finish_and_copy(Scene& scene, const LoadOptions& options);
/// Where there is no light; asks for the first camera.
void add_default_sun(Scene& scene);
void complete_lights(Scene& scene);
void complete_cameras(Scene& scene, float aspect = 1.0F);
/// Glass, and the bulbs that lamps spare.
void complete_casting(Scene& scene);
/// The box of the main mass of triangles: few far outliers left out.
Box main_bounds(const Scene& scene);

}  // namespace gn
