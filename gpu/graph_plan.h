// SPDX-License-Identifier: MIT
// The frame graph without a GPU: declarations in, a plan out. Pure functions over plain structs.
//
//     declaration --cull--> living passes --lifetimes, place--> memory --barriers--> plan
#pragma once

#include "gpu/frame_graph.h"
#include "gpu/hash.h"
#include "gpu/pipeline_cache.h"

#include <optional>
#include <string>
#include <vector>

namespace gn {

enum class UseKind {
    color,
    depth,
    depth_read_only,
    sample,
    storage_read,
    storage_write,
    vertices,
    indices,
    indirect,
    copy_from,
    copy_to,
};
std::string_view use_name(UseKind kind);
/// What an image must be made for to be used so.
VkImageUsageFlags usage_of(UseKind kind);

/// One port of a pass.
struct Use {
    UseKind kind = UseKind::sample;
    bool texture = true;
    std::uint32_t resource = 0;                    ///< index into textures or buffers
    Range range{0, 1, 0, 1};                       ///< textures: counts resolved, never ~0
    Load load = Load::keep;                        ///< attachments
    ClearValue clear{};                            ///< attachments
    std::optional<std::uint32_t> clear_stencil{};  ///< depth_read_only
    bool operator==(const Use&) const = default;
};

struct DeclaredPass {
    std::string name, group;
    std::vector<Use> uses;
    bool keep = false;
    bool rests = false;                ///< part of the plan, but not run in this frame
    [[nodiscard]] bool draws() const;  ///< has attachments
    bool operator==(const DeclaredPass&) const = default;
};

struct DeclaredTexture {
    TextureDesc desc;
    std::string group;
    bool imported = false, kept = false;
    std::vector<VkImageLayout> initial;  ///< imported: layout per subresource (mip + layer * mips)
};

struct DeclaredBuffer {
    BufferDesc desc;
    std::string group;
    bool imported = false, kept = false;
};

/// Consecutive passes that run round after round, each time with constants of its own.
struct DeclaredLoop {
    std::uint32_t first = 0, count = 0;  ///< declared passes
    std::uint32_t rounds = 2;            ///< at least 2
};

struct GraphDeclaration {
    std::vector<DeclaredTexture> textures;
    std::vector<DeclaredBuffer> buffers;
    std::vector<DeclaredPass> passes;
    std::vector<DeclaredLoop> loops;  ///< in order, apart from each other
};

/// Where a declared pass's functions stand among those of all: of round i at first + i * step.
struct Calls {
    std::uint32_t first = 0, step = 0, rounds = 1;
};
Calls calls_of(const GraphDeclaration& declaration, std::uint32_t pass);

/// What a transient takes in memory.
struct Footprint {
    VkDeviceSize bytes = 0, alignment = 1;
    std::uint32_t type_bits = ~0U;  ///< resources with different bits never share memory
};
struct Footprints {
    std::vector<Footprint> textures, buffers;
};
/// By the formats' arithmetic, rounded up to 256 bytes: what a device that does not exist would say.
Footprints nominal_footprints(const GraphDeclaration& declaration);

/// What all ports of one pass together do to one subresource or buffer.
struct Access {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 access = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    bool writes = false;
    bool discards = false;  ///< nothing of the old contents is needed
};
/// Throws Error naming pass and resource when the ports cannot hold at once.
std::optional<Access> access_of(const GraphDeclaration& declaration, const DeclaredPass& pass, std::uint32_t texture,
                                std::uint32_t mip, std::uint32_t layer);
std::optional<Access> access_of(const DeclaredPass& pass, std::uint32_t buffer);
bool writes(UseKind kind);

struct ImageBarrier {
    std::uint32_t texture = 0;
    Range range;
    VkPipelineStageFlags2 src_stages = 0;
    VkAccessFlags2 src_access = 0;
    VkPipelineStageFlags2 dst_stages = 0;
    VkAccessFlags2 dst_access = 0;
    VkImageLayout old_layout = VK_IMAGE_LAYOUT_UNDEFINED, new_layout = VK_IMAGE_LAYOUT_UNDEFINED;
};
struct BufferBarrier {
    std::uint32_t buffer = 0;
    VkPipelineStageFlags2 src_stages = 0;
    VkAccessFlags2 src_access = 0;
    VkPipelineStageFlags2 dst_stages = 0;
    VkAccessFlags2 dst_access = 0;
};

struct PlannedPass {
    std::uint32_t declared = 0;  ///< index into the declaration's passes
    std::vector<ImageBarrier> images;
    std::vector<BufferBarrier> buffers;
};

/// When a resource lives, in planned passes, and where.
struct Placement {
    bool used = false, transient = false;
    std::uint32_t first = 0, last = 0;
    std::uint32_t heap = 0;  ///< index into the plan's heaps
    VkDeviceSize offset = 0, bytes = 0;
};
struct Heap {
    std::uint32_t type_bits = ~0U;
    VkDeviceSize bytes = 0;
};

/// Planned passes that run round after round.
struct PlannedLoop {
    std::uint32_t first = 0, count = 0;
    std::vector<PlannedPass> again;  ///< the same with the barriers of every round but the first
};

struct GraphPlan {
    std::vector<PlannedPass> passes;
    std::vector<PlannedLoop> loops;
    std::vector<Placement> textures, buffers;
    std::vector<Heap> heaps;
    std::vector<std::vector<VkImageLayout>> final_layouts;  ///< per texture and subresource
    [[nodiscard]] VkDeviceSize transient_bytes() const;
};

/// One run of a planned pass.
struct Turn {
    const PlannedPass* pass = nullptr;
    std::uint32_t call = 0;  ///< calls_of
};
/// All that a plan runs in this frame, in order; it points into the plan.
std::vector<Turn> turns_of(const GraphDeclaration& declaration, const GraphPlan& plan);
/// How many there are where nothing rests.
std::uint32_t most_turns(const GraphDeclaration& declaration, const GraphPlan& plan);

/// Declared passes, in order, whose results reach an imported or kept resource or a pass that must stay.
std::vector<std::uint32_t> living_passes(const GraphDeclaration& declaration);
/// What a raster pipeline must know of the pass.
AttachmentFormats attachment_formats(const GraphDeclaration& declaration, const DeclaredPass& pass);
/// Fills the loops from the passes.
void find_loops(const GraphDeclaration& declaration, GraphPlan& plan);
/// Fills placements and heaps; resources whose lives overlap never overlap in memory.
void place(const GraphDeclaration& declaration, const Footprints& footprints, GraphPlan& plan);
/// Fills every pass's barriers and the final layouts; needs placements.
void synchronize(const GraphDeclaration& declaration, GraphPlan& plan);

/// All of the above. Throws Error for a pass that reads what nobody wrote.
GraphPlan make_plan(const GraphDeclaration& declaration, const Footprints& footprints);
/// What a plan depends on: equal declarations, equal fingerprints. Names, which passes rest, and the layouts that
/// imports come in, are left out; the latter two change barriers alone (synchronize).
Fingerprint fingerprint(const GraphDeclaration& declaration);
/// Passes, ports, barriers and placements as text.
std::string describe(const GraphDeclaration& declaration, const GraphPlan& plan);

}  // namespace gn
