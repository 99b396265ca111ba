// SPDX-License-Identifier: MIT
// The passes of one light's shadow volumes, in order.
#pragma once

#include "shadow/direct/volumes/volumes.h"
#include "shadow/geometry/edges.h"
#include "shadow/recipe/recipe.h"

#include <memory>

namespace gn {

/// What lives as long as the frame's graph: a scene's edges on the GPU.
struct EdgeBuffers {
    EdgeList list;
    std::uint32_t opaque_triangles = 0;
    Buffer edges, first, around;  ///< as EdgeList
    Buffer
        owners;  ///< per triangle: component * 8, + 4 when masked, + 2 when its front alone casts, + 1 when either; ~0: it casts nothing
};

/// The draws of a light, in words of the buffer `draws`: VkDrawIndirectCommands of sides, of their strips, and of the masked
/// caps by sign; VkDrawIndexedIndirectCommands of the opaque caps by sign.
enum VolumeDraw : std::uint32_t {
    sides_draw = 0,
    strips_draw = 4,
    masked_draw = 8,   ///< and 12
    opaque_draw = 16,  ///< and 21
    draw_words = 26
};

struct VolumeBuffers {
    std::shared_ptr<const EdgeBuffers> scene;  ///< the graph holds it
    std::vector<std::uint32_t> forms;          ///< per component: GN_VOLUMES_*
    GnVolumesFrame frame;
    BufferHandle edges, first, around, owners;
    BufferHandle multiplicity;  ///< per triangle: -1, 0 or 1
    BufferHandle
        caps;  ///< list of masked and one-sided triangles, from both ends by sign, behind opaque_triangles slots
    BufferHandle indices;  ///< of the vertices of opaque caps: a list of triangles for either sign
    BufferHandle sides;    ///< list of edge * 2 + 1 when turned over
    BufferHandle draws;    ///< VolumeDraw
};

/// The scene's edges (built once a geometry, uploaded once a graph) and this light's lists.
VolumeBuffers import_volume_buffers(const FrameInput& input, const GnVolumesParams& params);
/// How each component casts for this light: GN_VOLUMES_* per component. `cs_from_ws` null: the view culls nothing.
std::vector<std::uint32_t> component_forms(std::span<const Component> components, const GnLight& light,
                                           const GnVolumesParams& params, const mat4* cs_from_ws);
/// Turns every triangle to the light and lists the caps.
void add_facing(const FrameInput& input, const VolumeBuffers& buffers);
/// Sums the triangles around every edge and lists the sides.
void add_silhouettes(const FrameInput& input, const VolumeBuffers& buffers);
/// A depth of its own: the view samples' depth, lifted where a sample touches the edge of a volume.
TextureHandle add_receivers(const FrameInput& input, const VolumeBuffers& buffers);
/// Counts how many volumes hold each view sample.
TextureHandle add_counts(const FrameInput& input, const VolumeBuffers& buffers, TextureHandle receivers);
/// V = 1 where the count is zero and the sample counts for the light.
Visibility add_count_resolve(const FrameInput& input, TextureHandle counts);

}  // namespace gn
