// SPDX-License-Identifier: MIT
// The types of the flow, in order. With shadow/frame/frame.cpp the file to read first.
//
//     scene -> view samples -> light -> placement -> map -> lookup -> visibility image -> shading -> picture
//                                           \______ direct (no map) ______/
#pragma once

#include "base/kept.h"
#include "gpu/frame_graph.h"
#include "shadow/light_view.h"
#include "shadow/receiver/bias.h"
#include "shadow/scene/moves.h"
#include "shadow/scene/scene.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace gn {

enum class Stage { light, placement, map, lookup, direct, visibility };
inline constexpr std::array<std::string_view, 6> stage_names{"light",  "placement", "map",
                                                             "lookup", "direct",    "visibility"};

/// The scene on the GPU. Made once by upload_scene; imported into each frame's graph.
struct SceneGpu {
    const Scene* scene = nullptr;
    Buffer positions;                 ///< vec3 per vertex (scalar layout, 12 bytes), world space
    Buffer normals;                   ///< vec3 per vertex
    Buffer uvs;                       ///< vec2 per vertex
    Buffer colors;                    ///< vec4 per vertex, or a single white one; shaders clamp the index
    Buffer indices;                   ///< uvec3 per triangle
    Buffer face_normals;              ///< vec3 per triangle: unit, on the side of its front; 0 where it has no area
    Buffer emission;                  ///< vec3 per object: emitted radiance, cd/m^2
    std::vector<Texture2D> textures;  ///< as Scene::textures, RGBA8 sRGB, mipmapped; index 0 of an empty scene is white
    Texture2D white;
    /// What is drawn: no two uploads have the same. Whoever writes into the buffers above takes a new one from next_version;
    /// what frames keep of an older version is drawn anew.
    std::uint64_t version = 0;
    /// What is derived of the geometry of this version: edges, planes, lists of what casts.
    std::shared_ptr<Kept> derived = std::make_shared<Kept>();
    /// What moved from version to version; whoever writes into the buffers and takes a new version tells it.
    std::shared_ptr<Moves> moves = std::make_shared<Moves>();
    /// What the buffers hold of each object of the scene.
    struct Uploaded {
        std::uint64_t version = 0;  ///< Object::version
        Box bounds_ws;
    };
    std::vector<Uploaded> objects;
};
/// A version that no geometry has had in this process.
std::uint64_t next_version();
SceneGpu upload_scene(Device& device, const Scene& scene);
/// Brings positions and both normals of the objects whose version is another than what was brought before (shadow/scene/move.h) to
/// the GPU, as a new version that tells where they moved; waits for the device. Where no object did, nothing is done.
void refresh_scene(Device& device, SceneGpu& scene);

struct DrawnCasters;  // shadow/casters/drawn.h
struct LightReach;    // shadow/geometry/potential_receivers.h

/// The scene's buffers in one frame's graph.
struct SceneHandles {
    BufferHandle positions, normals, uvs, colors, indices;
    BufferHandle face_normals;  ///< vec3 a triangle: unit, on the side of its front; 0 where it has no area
    BufferHandle emission;      ///< vec3 an object: emitted radiance, cd/m^2
    std::vector<TextureHandle> textures;
    TextureHandle white;
    std::uint64_t version = 0;  ///< SceneGpu::version
    std::shared_ptr<Kept> derived;
    std::shared_ptr<const Moves> moves;   ///< SceneGpu::moves; null where it is not told what moves
    std::shared_ptr<DrawnCasters> drawn;  ///< draws what casts where no buffer holds it; null: the buffers do
    /// Boxes (ws) that touch all that differs from the geometry of a version; unset where anything may.
    [[nodiscard]] std::optional<std::vector<Box>> touched_since(std::uint64_t before) const {
        return moves != nullptr    ? moves->since(before)
               : before == version ? std::vector<Box>{}
                                   : std::optional<std::vector<Box>>{};
    }
};

/// The camera's constants for shaders (shadow/view/view.glsl has the same struct).
struct GnViewConstants {
    mat4 cs_from_ws{1};  ///< reversed depth: near 1, far 0
    vec4 eye_ws{0};      ///< w = 1: the eye; w = 0: the direction towards it, the same everywhere (orthographic)
    vec4 axis_ws{0};     ///< dot(axis_ws, (p_ws, 1)): metres along the camera's axis
    vec4 right_ws{
        0};           ///< the width of a pixel, to the right: at one metre along the axis, or everywhere (orthographic)
    vec4 down_ws{0};  ///< likewise its height, downwards
    uvec4 size{0};    ///< width, height, 0, 0
};

/// One G-buffer: what each pixel of the view sees. Where no surface is seen, position.w = 0.
struct ViewSamples {
    uint width = 0, height = 0;
    Camera camera;
    GnViewConstants constants;
    TextureHandle position;  ///< RGBA32F: p_ws, 0 (none), 1 (surface) or 2 (surface that receives no shadow)
    TextureHandle normal;    ///< RGBA32F: geometric normal n_ws towards the camera, w = distance along the view axis
    TextureHandle albedo;    ///< RGBA8 sRGB: base colour, metallic
    TextureHandle
        surface;          ///< RG32UI: interpolated normal towards the camera, object and roughness (view/surface.glsl)
    TextureHandle depth;  ///< D32_SFLOAT_S8: reversed depth of the camera; stencil is free for direct parts
    /// Clip space of the frame before (x, y and w of it count), from this frame's world space, where whoever lends the samples
    /// says so; else it is what the history remembers (shadow/receiver/reprojection.h).
    std::optional<mat4> before_cs_from_ws{};
};

/// The same samples on the CPU, for the truth and the metrics: width * height entries, rows top to bottom.
struct CpuSamples {
    uint width = 0, height = 0;
    Camera camera;
    std::vector<vec4> position_ws;  ///< w = 1 where a surface is seen, 2 where it receives no shadow
    std::vector<vec4> normal_ws;    ///< xyz geometric, towards the camera; w = distance along the view axis
};

class History;
class PreparedRecipe;

/// What parts of all stages get to see of the frame.
struct FrameInput {
    Device& device;
    FrameGraph& graph;
    const Scene& scene;
    const SceneHandles& handles;
    const ViewSamples& samples;
    const Light* source = nullptr;  ///< what casts: a light, or a sample of one; null in passes for all lights
    std::uint64_t light_id = 0;     ///< keys what the history keeps for the light, in whatever order lights come
    History* history = nullptr;     ///< what earlier frames of the sequence kept; null for a single frame
    /// Where answers that come after the frame (FrameGraph::answer) say what it lacked; lives as long as they can come.
    std::set<std::string>* late_remarks = nullptr;
    const PreparedRecipe* prepared = nullptr;  ///< what the recipe's frames share; null where one is drawn alone
    const Light* parent = nullptr;             ///< the light that `source` is a sample of; null where it is a whole one
    std::vector<std::string_view> sides;       ///< what lookups are asked to tell beside V
    bool translucent = false;          ///< maps hold the translucent casters instead of the opaque and masked ones
    const ViewSamples* few = nullptr;  ///< lookups give V of these alone, some of `samples`; null: of all
    std::shared_ptr<LightReach>
        reach{};  ///< what whole_light() reaches, worked out once; null: whenever it is asked for
    [[nodiscard]] const Light& light() const {
        GN_CHECK(source != nullptr);
        return *source;
    }
    /// What `make` derives of the scene's geometry, kept with it under a name and a key that say all else that it depends on,
    /// and held by the graph.
    template <class Make>
    std::shared_ptr<const std::invoke_result_t<Make>> derive(std::string_view name, std::uint64_t key,
                                                             Make make) const {
        if (handles.derived == nullptr) {
            return std::make_shared<const std::invoke_result_t<Make>>(make());  // a scene that was never uploaded
        }
        auto value = handles.derived->get(handles.version, name, key, std::move(make));
        graph.hold(value);
        return value;
    }
    /// The light whose V is asked for: light(), or what it is a sample of. It says which view samples count.
    [[nodiscard]] const Light& whole_light() const { return parent != nullptr ? *parent : light(); }
};

class Part;
class ParamBlock;

/// A rectangle of a kept layer that must be drawn. Its view covers one whole tile of the layer's endless texel grid, so
/// that a grid texel is always rasterized at the same place, wherever the map's window lies.
struct KeptDraw {
    GnLightView view;
    ivec4 rect{0};  ///< x, y, width, height in texels of the kept texture
    std::vector<std::uint32_t> casters;
};
/// A layer that is kept over frames and wraps around: texel t of the map is texel (t + shift) mod resolution of it.
struct KeptLayer {
    ivec2 shift{0};
    std::vector<KeptDraw> revealed;  ///< what the window newly shows
    std::vector<KeptDraw> whole;     ///< the same for a texture without contents
};
struct KeptViews {
    History* history = nullptr;
    std::string name;
    std::vector<KeptLayer> layers;
};

/// How the views of a placement carry the world to their rectangles. Shaders are composed for it, so that it must be said
/// also where the views themselves are made on the GPU.
enum class ViewKind {
    affine,       ///< w = 1 everywhere, and clip z is the linear depth: maps of it alone need no fragments
    perspective,  ///< any matrix, affine ones among them; fragments write the linear depth
    paraboloid,   ///< shadow/receiver/paraboloid.glsl
    logarithmic,  ///< shadow/receiver/logarithm.glsl, or perspective views beside such
};
/// The narrowest kind that views made on the CPU belong to.
ViewKind kind_of(std::span<const GnLightView> views);

/// A texture that a stage lends to the shaders of the stages behind it, by the name that parts know it by.
struct Offer {
    std::string name;       ///< "depth", "moments": one of Part::gives, or of what is derived from it
    TextureHandle texture;  ///< 2D array, one layer a view (or as the part's GLSL reads it)
    SamplerDesc sampler;    ///< how it is read
};

/// A table that a placement lends to its own GLSL, which reads element i as gn_<id>_<name>(i).
struct PlacementTable {
    std::string name;              ///< "pages"
    std::string type;              ///< GLSL: of an element, "uint"
    BufferHandle buffer;           ///< the elements, in scalar layout
    std::vector<std::byte> bytes;  ///< where `buffer` is invalid: they travel with the commands
};

/// placement: where the light looks from.
struct LightViews {
    /// Where `buffer` is valid, their number is the most there can be, and of each only layer, rectangle and resolution
    /// count; with `tiles` only the resolution.
    std::vector<GnLightView> views;
    ViewKind kind = ViewKind::perspective;
    std::uint32_t resolution = 1024;  ///< texels along a side of every layer
    std::uint32_t layers = 1;
    const Part* part = nullptr;          ///< its GLSL chooses the view of a receiver
    std::array<std::byte, 256> data{};   ///< what the part's GLSL choice function is given: set_data of Part::data_type
    BufferHandle buffer;                 ///< GnLightView[] where the placement makes its views on the GPU; else invalid
    BufferHandle data_buffer;            ///< the same where it is made on the GPU
    std::vector<Offer> offers;           ///< further arguments of that function, in order
    std::vector<PlacementTable> tables;  ///< what it may ask besides
    /// Layers and rectangles, too, are known to `buffer` alone: whole texels, apart from each other. Of views that do not
    /// exist in this frame the rectangle is empty.
    bool tiles = false;
    BufferHandle count;  ///< with tiles: a uint, how many of the views exist, the first ones; invalid: all
    std::vector<std::vector<std::uint32_t>>
        casters;  ///< per view: indices into Scene::objects that may cast; empty: all
    /// Per view: by how many metres simpler casters may differ from those of the scene, 0: by none; empty: in no view. Of affine
    /// views that are drawn one by one.
    std::vector<float> simpler;
    bool crosses = false;           ///< kernels may leave a view's rectangle, and go on in the view that serves the tap
    bool layered = false;           ///< one pass draws all views, each a whole layer of its own
    std::optional<KeptViews> kept;  ///< maps that live over frames; a map part may ignore it and draw everything

    template <class Data>
    void set_data(const Data& given) {
        static_assert(sizeof(Data) <= sizeof data && std::is_trivially_copyable_v<Data>);
        std::memcpy(data.data(), &given, sizeof given);
    }
    template <class Data>
    [[nodiscard]] Data data_as() const {
        static_assert(sizeof(Data) <= sizeof data && std::is_trivially_copyable_v<Data>);
        Data given;
        std::memcpy(&given, data.data(), sizeof given);
        return given;
    }
};

/// map: what a texel stores.
struct ShadowMap {
    std::vector<Offer> offers;  ///< the first is the map itself: what `--show map` shows
    const Part* part = nullptr;
    [[nodiscard]] const Offer* find(std::string_view name) const {
        const auto found = std::find_if(offers.begin(), offers.end(), [&](const Offer& o) { return o.name == name; });
        return found != offers.end() ? &*found : nullptr;
    }
    /// The map itself.
    [[nodiscard]] TextureHandle texture() const { return offers.front().texture; }
};

/// lookup or direct or visibility: V in [0,1] for every view sample; 0 where the sample does not count. R32F, or RGBA32F
/// where V has a channel for each of red, green and blue (shadow/receiver/channels.h).
struct Visibility {
    TextureHandle image;
    std::vector<Offer>
        sides{};  ///< what the lookup was asked to tell beside V, R32F each; 0 where the sample does not count
    [[nodiscard]] const Offer* find(std::string_view side) const {
        const auto found = std::find_if(sides.begin(), sides.end(), [&](const Offer& o) { return o.name == side; });
        return found != sides.end() ? &*found : nullptr;
    }
};

}  // namespace gn
