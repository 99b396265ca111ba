// SPDX-License-Identifier: MIT
// Lists per texel of a map: any shader adds values, any reads them. What does not fit is counted, said, and fits in the next
// frame of the sequence.
//
// Based on: Yang, Hensley, Gruen, Thibieroz. Real-Time Concurrent Linked List Construction on the GPU. EGSR 2010. [YHGT10]
#pragma once

#include "gpu/shader_inputs.h"
#include "shadow/stages.h"

#include <string>

namespace gn {

struct TexelLists {
    uvec3 size{0};               ///< width, height, layers
    std::uint32_t capacity = 0;  ///< values that all lists hold together
    BufferHandle heads;          ///< a uint a texel: the first node, counted from 1, or 0
    BufferHandle nodes;          ///< uvec2[capacity]: value, next node
    BufferHandle used;           ///< a uint: values that were added, those among them that had no room
};
/// Empty lists of one name a light. They have room for `capacity` values, or for what the last frame of the sequence would
/// have needed where that is more, but for no more than one storage block of the device holds. Where values have no room the
/// frame's remarks say so, when its answer arrives.
TexelLists add_texel_lists(const FrameInput& input, const std::string& name, uvec3 size, std::uint64_t capacity);

/// Adds the lists to what a shader reads and writes, or only reads.
enum class ListAccess { read, add };
void add_lists(ShaderInputs& inputs, const TexelLists& lists, ListAccess access);
/// GLSL, after the inputs' text. To add: void gn_list_add(ivec3 texel, uint value). To read, in no order:
///
///     for (uint node = gn_list_first(texel); node != 0u; node = gn_list_next(node)) { gn_list_value(node); }
std::string list_functions(ListAccess access);

}  // namespace gn
