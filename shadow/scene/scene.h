// SPDX-License-Identifier: MIT
// The scene: what every later stage works on. CPU only; the reference uses it without any GPU.
//
// A loaded scene is flat: every instance's triangles are stored in world space, so that the G-buffer, the maps, the
// volumes and the truth all see bit-identical positions. Ranges of triangles (objects) remain for culling.
#pragma once

#include "base/image.h"
#include "base/math.h"
#include "shadow/scene/light.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace gn {

enum class AlphaMode { opaque, mask, blend };

struct Material {
    std::string name;
    vec4 base_color{0.8F, 0.8F, 0.8F, 1.0F};  ///< linear rgb, alpha
    float metallic = 0.0F, roughness = 0.8F;
    vec3 emissive{0};                          ///< cd/m^2, linear
    AlphaMode alpha_mode = AlphaMode::opaque;  ///< blend casts and receives as mask with cutoff 0.5
    float alpha_cutoff = 0.5F;                 ///< a texel with alpha < cutoff is not there
    int base_color_texture = -1;               ///< index into Scene::textures, or -1
    bool double_sided = true;                  ///< false: the back shows nothing and casts nothing
    float transmission = 0.0F;  ///< share of the light that goes through; above 0 the material casts nothing
    bool casts = true;          ///< set by finish_scene: false for glass, see shadow/scene/casting.h
};

struct Texture {
    std::string name;
    Image8 image;
    bool repeat_u = true, repeat_v = true;
};

/// A contiguous range of triangles with one material: one primitive of one instance.
struct Object {
    std::string name;
    std::uint32_t first_triangle = 0, triangle_count = 0;
    int material = 0;
    Box bounds_ws;
    std::optional<bool> casts;  ///< told to cast, or not to; unset: as the material does
    bool receives = true;       ///< false: no shadow falls on it, and it is left out of the errors
    std::uint64_t version = 0;  ///< of its geometry: another one after every move (shadow/scene/move.h)
    /// ws: takes its points from where they were at first to where they are, by all of its moves.
    dmat4 now_from_first{1};
};

/// Names of the light kinds, by GnLight::kind.
inline constexpr std::array<std::string_view, 5> light_kind_names{"directional", "spot", "point", "rectangle",
                                                                  "environment"};

struct Light {
    std::string name;
    GnLight shape;
    std::vector<std::uint32_t> spared;  ///< objects that cast no shadow of it, ascending; set by finish_scene
    GnSky sky{};                        ///< of an environment
    int cookie = -1;  ///< index into Scene::textures, or -1: what its colour is multiplied by (shadow/scene/cookie.h)
};

/// A perspective camera, or an orthographic one, whose rays run side by side. It looks along forward_ws.
struct Camera {
    std::string name = "main";
    vec3 position_ws{0};
    vec3 forward_ws{0, 0, -1};
    vec3 up_ws{0, 1, 0};
    float yfov = 0.9F;             ///< full vertical angle, radians
    float half_height = 0;         ///< above 0 orthographic: half of what the picture shows from top to bottom, metres
    float near = 0.1F, far = 500;  ///< metres
    vec2 shift_cs{0};              ///< moves the picture right and down; sub-pixel shifts for smooth edges
};

/// Camera positions over time, for flicker: `frames` cameras in order.
struct CameraPath {
    std::string name;
    std::vector<Camera> frames;
};

struct Scene {
    std::string name;
    std::vector<vec3> positions_ws;   ///< per vertex, metres, relative to origin
    std::vector<vec3> normals_ws;     ///< per vertex, unit shading normals
    std::vector<vec2> uvs;            ///< per vertex, for the base colour texture
    std::vector<vec4> colors;         ///< per vertex, linear: times the base colour and its alpha; empty: all 1
    std::vector<uvec3> triangles;     ///< vertex indices, all < positions_ws.size()
    std::vector<Object> objects;      ///< cover all triangles in order
    std::vector<Material> materials;  ///< never empty
    std::vector<Texture> textures;
    std::vector<Light> lights;  ///< never empty after finish_scene
    /// Light from everywhere, of kind environment, beside `lights`; unset: environment_of makes one.
    std::optional<Light> environment;
    std::vector<Camera> cameras;  ///< never empty after finish_scene
    std::vector<CameraPath> paths;
    Box bounds_ws;
    dvec3 origin{0};                 ///< metres; add to a position to get the file's coordinates
    std::vector<std::string> notes;  ///< what the loader skipped or repaired, one sentence each

    /// Analytic scenes: V of the light by index at a receiver point, or nothing where no closed form holds.
    std::function<std::optional<double>(std::size_t light, dvec3 p_ws)> closed_form;

    [[nodiscard]] const Camera& camera(std::string_view view_name) const;  ///< "" is the first; throws Error
};

/// Most triangles after instancing; more is an Error.
inline constexpr std::size_t max_triangles = 64'000'000;

/// A ground plane for models that bring none.
struct Ground {
    enum Kind { none, automatic, at_height } kind = none;  ///< automatic: where a file has no floor of its own
    double height = 0;                                     ///< at_height: metres, in the file's coordinates
};

/// The axis of a file that points up.
enum class UpAxis { y, z };

/// What is chosen for a scene that leaves it open.
struct LoadOptions {
    Ground ground;          ///< for files; a built-in scene has its own
    float aspect = 1.0F;    ///< width by height of the picture that default cameras frame the scene for
    UpAxis up = UpAxis::y;  ///< of a file; z turns it, with its lights and cameras, to y
    std::vector<std::filesystem::path> assets;  ///< folders that a file may read from besides its own
};

/// Loads a built-in scene by name or a file by path (.glb .gltf .obj .toml and what Assimp knows). A built-in name may
/// carry parameters: "tilted:angle=85", "contact:size=2". Throws Error with one sentence; never reads outside the
/// file's folder and options.assets; ends in bounded time and memory.
Scene load_scene(const std::string& name_or_path, const LoadOptions& options = {});

/// Completes a scene: bounds, origin (re-centres scenes far from zero), normals where missing, degenerate and
/// non-finite triangles dropped with a note, default camera and sun where none is given, the ground that is asked for.
void finish_scene(Scene& scene, const LoadOptions& options = {});

/// Completes what a host hands over: the same, but nothing is moved and no camera or light is made up.
void finish_host_scene(Scene& scene);

struct BuiltinScene {
    std::string name, sentence, parameters;  ///< parameters: "angle=60 (0 to 89 degrees)" or ""
};
/// The built-in scenes, in the order to show them.
const std::vector<BuiltinScene>& builtin_scenes();
/// Makes a built-in scene. Throws Error listing the known names.
Scene make_builtin_scene(const std::string& name_and_parameters);

/// The scene's environment; without one a pale sky that gives a share of what the lights do, so that shadows are dark but
/// not black.
Light environment_of(const Scene& scene);

inline bool is_orthographic(const Camera& camera) {
    return camera.half_height > 0.0F;
}
/// Where rays of sight end: w = 1, the eye; w = 0, the direction towards it, the same everywhere (orthographic).
vec4 eye_of(const Camera& camera);
/// Unit direction from p_ws to the eye.
vec3 to_eye(const Camera& camera, vec3 p_ws);
/// Half of what the picture shows from top to bottom, so many metres along the axis.
double half_height_at(const Camera& camera, double distance);
/// The camera as matrices: Vulkan clip space with reversed depth (near 1, far 0).
mat4 vs_from_ws(const Camera& camera);
mat4 cs_from_vs(const Camera& camera, float aspect);

}  // namespace gn

// Compiled once, in scene.cpp: nearly every source makes, copies or ends a scene.
extern template class std::vector<gn::Light>;
extern template class std::vector<gn::Camera>;
extern template class std::vector<gn::CameraPath>;
extern template class std::vector<gn::Material>;
extern template class std::vector<gn::Texture>;
extern template class std::vector<gn::Object>;
