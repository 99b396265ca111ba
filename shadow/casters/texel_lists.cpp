// SPDX-License-Identifier: MIT
// Based on: Yang, Hensley, Gruen, Thibieroz. Real-Time Concurrent Linked List Construction on the GPU. EGSR 2010. [YHGT10]
#include "shadow/casters/texel_lists.h"

#include "gpu/zeros_pass.h"
#include "shadow/frame/history.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

namespace gn {
namespace {

/// Values that the lists of a name needed in the last frame whose answer came; null without a sequence.
std::shared_ptr<std::uint32_t> needed_values(const FrameInput& input, const std::string& name) {
    return input.history != nullptr
               ? input.history->answered(fmt::format("list values of {} of light {}", name, input.light_id))
               : nullptr;
}

/// Values that one storage block of the device holds.
std::uint64_t most_values(const Device& device) {
    const std::uint64_t held = device.properties().limits.maxStorageBufferRange / sizeof(uvec2);
    return std::min<std::uint64_t>(held, std::numeric_limits<std::uint32_t>::max());
}

}  // namespace

TexelLists add_texel_lists(const FrameInput& input, const std::string& name, uvec3 size, std::uint64_t capacity) {
    // A tenth more than the last frame needed, so that a slow change fits.
    const std::shared_ptr<std::uint32_t> needed = needed_values(input, name);
    const std::uint64_t wanted = needed != nullptr ? std::uint64_t{*needed} + *needed / 10 : 0;
    const std::uint64_t most = most_values(input.device);
    TexelLists lists{.size = size};
    lists.capacity = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(std::max(capacity, wanted), 1, most));

    FrameGraph& graph = input.graph;
    const VkDeviceSize texels = VkDeviceSize{size.x} * size.y * size.z;
    lists.heads = graph.create({.name = name + " heads", .bytes = texels * sizeof(std::uint32_t)});
    lists.nodes = graph.create({.name = name + " nodes", .bytes = VkDeviceSize{lists.capacity} * sizeof(uvec2)});
    lists.used = graph.create({.name = name + " used", .bytes = sizeof(std::uint32_t)});
    add_zeros(graph, name + ": empty", {lists.heads, lists.used});

    // What they needed comes back after the frame.
    graph.answer(
        lists.used, [needed, lists, name, most, remarks = input.late_remarks](std::span<const std::byte> bytes) {
            std::uint32_t used = 0;
            std::memcpy(&used, bytes.data(), sizeof used);
            if (needed != nullptr) {
                *needed = used;
            }
            if (used > lists.capacity && remarks != nullptr) {
                remarks->insert(fmt::format(
                    "the lists of {} have room for {} values and {} were added: {} are left out of this frame; {}",
                    name, lists.capacity, used, used - lists.capacity,
                    used > most ? "a storage block of this device holds no more; a smaller map or fewer lights fit"
                    : needed != nullptr ? "the next frame has room for them"
                                        : "render a sequence, whose next frame has room"));
            }
        });
    return lists;
}

void add_lists(ShaderInputs& inputs, const TexelLists& lists, ListAccess access) {
    const std::string_view kind = access == ListAccess::add ? "buffer" : "readonly buffer";
    inputs.buffer(kind, "ListHeads", "uint list_heads[];", lists.heads);
    inputs.buffer(kind, "ListNodes", "uvec2 list_nodes[];", lists.nodes);
    if (access == ListAccess::add) {
        inputs.buffer(kind, "ListUsed", "uint list_used;", lists.used);
    }
    inputs.constant("uvec3", "list_size", lists.size);
    inputs.constant("uint", "list_capacity", lists.capacity);
}

std::string list_functions(ListAccess access) {
    const char* const shared = R"(
uint gn_list_texel(ivec3 texel) {
    return (uint(texel.z) * u.list_size.y + uint(texel.y)) * u.list_size.x + uint(texel.x);
}
uint gn_list_first(ivec3 texel) { return list_heads[gn_list_texel(texel)]; }
uint gn_list_next(uint node) { return list_nodes[node - 1u].y; }
uint gn_list_value(uint node) { return list_nodes[node - 1u].x; }
)";
    const char* const adding = R"(
void gn_list_add(ivec3 texel, uint value) {
    uint node = atomicAdd(list_used, 1u);
    if (node < u.list_capacity) {
        uint next = atomicExchange(list_heads[gn_list_texel(texel)], node + 1u);
        list_nodes[node] = uvec2(value, next);
    }
}
)";
    return std::string(shared) + (access == ListAccess::add ? adding : "");
}

}  // namespace gn
