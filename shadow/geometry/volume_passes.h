// SPDX-License-Identifier: MIT
// The passes of one light's shadow volumes, in order.
#pragma once

#include "gpu/shader_inputs.h"
#include "shadow/geometry/caster_proxies.h"
#include "shadow/geometry/edges.h"
#include "shadow/geometry/volumes.h"
#include "shadow/recipe/part.h"
#include "shadow/recipe/recipe.h"

#include <deque>
#include <memory>

namespace gn {

/// What lives as long as the frame's graph: a scene's edges on the GPU.
struct EdgeBuffers {
    /// What casts instead of the scene's triangles.
    struct Proxies {
        ProxyMesh mesh;
        Buffer positions, indices;
    };
    std::shared_ptr<const Proxies> proxies;  ///< null: the scene's own cast
    EdgeList list;
    std::vector<std::uint8_t> casts;     ///< per triangle, as for build_edges
    std::uint32_t opaque_triangles = 0;  ///< of solids, whose caps nothing is behind; all others are compared
    Buffer edges, first, around;         ///< as EdgeList
    /// Per triangle: component * 8, + 4 when masked, + 2 when its front alone casts, + 1 when its caps are compared; ~0: it casts nothing.
    Buffer owners;
    Buffer boxes;  ///< vec4[2] a component: the corners of its bounds, ws
    /// What covered_components found for a light's place, and whatever else the key says: the latest first.
    struct Covered {
        std::uint64_t key = 0;
        std::vector<std::uint8_t> components;
    };
    mutable std::deque<Covered> covered;
    [[nodiscard]] std::span<const vec3> positions_ws(const Scene& scene) const {
        return proxies ? std::span(proxies->mesh.positions_ws) : std::span(scene.positions_ws);
    }
    [[nodiscard]] std::span<const uvec3> triangles(const Scene& scene) const {
        return proxies ? std::span(proxies->mesh.triangles) : std::span(scene.triangles);
    }
};

/// The draws of a light, in words of the buffer `draws`. Sides, their strips and the compared caps (masked and one-sided
/// ones) have a VkDrawIndirectCommand for what is listed as behind the sample and, 4 words on, for what is listed as before it;
/// opaque caps a VkDrawIndexedIndirectCommand for each, 5 words apart, and again 10 words on for those turned over.
enum VolumeDraw : std::uint32_t {
    sides_draw = 0,
    strips_draw = 8,
    compared_draw = 16,
    opaque_draw = 24,
    draw_words = 44
};

/// On which side of the samples volumes are counted.
enum class VolumeMode {
    behind,    ///< z-fail: right wherever the camera stands
    before,    ///< z-pass: right where the near rectangle lies in no volume
    capped,    ///< zp+: z-pass, and volumes that may hold part of the near rectangle are closed there
    cheapest,  ///< z-pass for each component whose volumes cannot hold part of the near rectangle, z-fail for the others
    split,     ///< of those components z-pass at marked samples and z-fail at the others; z-fail for the others at all
};

/// Samples that are told apart: GLSL of `bool volume_marked(ivec2 pixel)` and what it reads.
struct VolumeMarks {
    std::string types;  ///< GLSL before the declarations
    ShaderInputs inputs;
    std::string text;
    bool alone = false;  ///< only marked samples are counted, in any mode but split
};

/// What a part asks of its volumes.
struct VolumeOptions {
    VolumeMode mode = VolumeMode::behind;
    bool every_side = false;   ///< three sides a triangle, none cancelled
    bool skip_masked = false;  ///< masked objects have no volumes
    bool closed = true;        ///< solids cast with one half of their surface
    bool culling = true;       ///< components whose shadow cannot be seen are left out
    bool clamp = false;        ///< volumes end where no sample is beyond
    bool slices = false;       ///< volumes are drawn where, by rows and columns of the picture, a sample may be in them
    bool covered = false;      ///< components that stand wholly in another's shadow are left out
    float proxies = 0.0F;      ///< share of their triangles that solids cast with, as bodies within them; 0: all
};

struct VolumeBuffers {
    std::shared_ptr<const EdgeBuffers> scene;  ///< the graph holds it
    VolumeMode mode = VolumeMode::behind;
    std::vector<std::uint32_t> forms;  ///< per component: GN_VOLUMES_*
    GnVolumesFrame frame;
    BufferHandle positions, triangles;  ///< vec3 a vertex, three indices a triangle of what casts
    BufferHandle edges, first, around, owners;
    BufferHandle runs;          ///< with VolumeOptions::slices: uvec4 a component, see GN_VOLUMES_SLICES; else invalid
    BufferHandle multiplicity;  ///< per triangle: -1, 0 or 1, + 4 where it is not 0 and counts before the sample
    BufferHandle
        caps;  ///< triangle * 2 + 1 when turned over, of compared caps, from both ends by side, behind opaque_triangles slots
    BufferHandle indices;  ///< of the vertices of opaque caps: a list of triangles for either sign
    BufferHandle sides;    ///< edge * 2 + 1 when turned over, from both ends by side
    BufferHandle draws;    ///< VolumeDraw
};

/// GLSL of a shader that draws volumes, after the inputs' declarations; side_body draws their sides.
std::string volume_shader(const ShaderInputs& inputs, std::string_view text);
extern const std::string_view side_body;
/// What the sides' shader reads.
ShaderInputs volume_side_inputs(const VolumeBuffers& buffers);

/// What is made of the scene once a geometry.
std::shared_ptr<const EdgeBuffers> edge_buffers(const FrameInput& input, const VolumeOptions& options);
/// The scene's edges (built once a geometry, uploaded once a graph) and this light's lists.
VolumeBuffers import_volume_buffers(const FrameInput& input, const VolumeOptions& options);
/// How each component casts and counts for this light: GN_VOLUMES_* per component. `cs_from_ws` null: the view culls nothing,
/// and nothing is known to lie off its near rectangle.
std::vector<std::uint32_t> component_forms(std::span<const Component> components, const GnLight& light,
                                           const VolumeOptions& options, const mat4* cs_from_ws);
/// A box (ws) of all that the view's samples of the light and its near rectangle can be: no ray from the eye to a sample leaves it.
Box volume_region(const FrameInput& input);
/// The plane of the region, 1 to 6 as GN_VOLUMES_PLANE_SHIFT says, at which a caster's volumes may end that are counted before
/// the samples: every ray of light from the box runs towards it. 0: none.
std::uint32_t volume_end(const Box& caster, vec4 light_ws, const Box& region);
/// Adds it to the forms of the components that count before the samples.
void clamp_forms(std::span<const Component> components, vec4 light_ws, const Box& region,
                 std::span<std::uint32_t> forms);
/// Makes GN_VOLUMES_NONE of the forms of components that stand wholly in another's shadow, worked out once a place of the light.
void leave_out_covered(const FrameInput& input, const EdgeBuffers& scene, const VolumeOptions& options,
                       std::span<std::uint32_t> forms);
/// Finds for each component between which rows and columns of the picture samples may be in its volumes.
void add_volume_slices(const FrameInput& input, VolumeBuffers& buffers);
/// Pixels by which the rasterizer may move an edge, and what one pixel spans at a distance of 1 m, or everywhere (orthographic).
float snap_pixels(Device& device);
float pixel_metres(const ViewSamples& samples);
/// More metres than rounding, of the rasterizer where the scene is farthest and of coordinates, moves anything; above 0.
double rounding_metres(const FrameInput& input);
/// Turns every triangle to the light and lists the caps.
void add_facing(const FrameInput& input, const VolumeBuffers& buffers);
/// Sums the triangles around every edge and lists the sides.
void add_silhouettes(const FrameInput& input, const VolumeBuffers& buffers);
/// Silhouettes in view or not, for what edges hide beyond the hard shadow. Masked casters have no outline that geometry knows.
VolumeBuffers add_all_silhouettes(const FrameInput& input, bool closed = true);
/// A depth of its own: the view samples' depth, lifted where a sample touches the edge of a volume.
/// With a stencil where samples are to be marked.
TextureHandle add_receivers(const FrameInput& input, const VolumeBuffers& buffers, bool marks = false);
/// Counts how many volumes hold each view sample. `marks` null: all are alike.
TextureHandle add_counts(const FrameInput& input, const VolumeBuffers& buffers, TextureHandle receivers,
                         const VolumeMarks* marks = nullptr);
/// What parts that count volumes can tell of a sample, and the images of those that the input asks for.
std::vector<Side> volume_sides();
void add_volume_sides(const FrameInput& input, const VolumeBuffers& buffers, TextureHandle receivers,
                      TextureHandle counts, Visibility& told);
/// How a count becomes V.
struct CountResolve {
    bool masked = false;    ///< masked casters hide too, by their alpha: those that VolumeOptions::skip_masked left out
    TextureHandle known{};  ///< V of samples that are decided already, above 1 where they are not; invalid: none is
};
/// V = 1 where the count is zero and the sample counts for the light.
Visibility add_count_resolve(const FrameInput& input, TextureHandle counts, const CountResolve& resolve);

}  // namespace gn
