// SPDX-License-Identifier: MIT
// Drawing into views whose layers, rectangles and number only the GPU knows (LightViews::tiles): a pass a layer, of which
// every draw is indirect and takes each view that exists as an instance.
#pragma once

#include "gpu/frame_graph.h"
#include "shadow/stages.h"

namespace gn {

/// VkDrawIndexedIndirectCommand[Scene::objects]: each object's triangles, once for every view.
BufferHandle add_tile_draws(const FrameInput& input, const LightViews& views);

/// Which views an object's box may cast into, and draws of these alone.
struct TileLists {
    BufferHandle
        draws;  ///< VkDrawIndexedIndirectCommand[layers][Scene::objects]: once for every such view of the layer
    BufferHandle views;  ///< uint[]: [layer * objects + object] is where this draw's views begin, instance by instance
};
TileLists add_tile_lists(const FrameInput& input, const LightViews& views);
/// One VkDrawIndirectCommand: so many vertices, once for every view.
BufferHandle add_tile_draw(const FrameInput& input, const LightViews& views, std::uint32_t vertices);

/// Vertices of add_tile_draw.
inline constexpr std::uint32_t tile_quad_vertices = 6;
/// A pipeline whose fragments are the texels of the views' rectangles in one layer. The fragment's inputs begin with view_list,
/// its push constants with the layer; it gets `layout(location = 7) flat in int tile_view`.
RasterDesc tile_quads(ShaderSource fragment);

}  // namespace gn
