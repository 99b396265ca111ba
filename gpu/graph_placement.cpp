// SPDX-License-Identifier: MIT
// Transient memory: resources that never live at the same time share the same bytes.
#include "gpu/graph_plan.h"

#include <algorithm>
#include <numeric>

namespace gn {
namespace {

struct Placed {
    VkDeviceSize begin, end;
};

VkDeviceSize align_up(VkDeviceSize value, VkDeviceSize alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

/// A heap is one allocation, which devices limit: further ones are opened beyond this many bytes, so that a frame with
/// hundreds of lights is limited by the device's memory only. What is larger by itself gets a heap of its own.
constexpr VkDeviceSize most_heap_bytes = VkDeviceSize{1} << 30U;

/// The lowest offset where `footprint` fits between ranges that are taken.
VkDeviceSize lowest_gap(std::vector<Placed> taken, const Footprint& footprint) {
    std::sort(taken.begin(), taken.end(), [](const Placed& a, const Placed& b) { return a.begin < b.begin; });
    VkDeviceSize offset = 0;
    for (const Placed& range : taken) {
        if (offset + footprint.bytes <= range.begin) {
            break;
        }
        offset = std::max(offset, align_up(range.end, footprint.alignment));
    }
    return offset;
}

/// First and last planned pass that touches each resource.
void find_lifetimes(const GraphDeclaration& declaration, GraphPlan& plan) {
    plan.textures.assign(declaration.textures.size(), {});
    plan.buffers.assign(declaration.buffers.size(), {});
    for (std::uint32_t pass = 0; pass < plan.passes.size(); ++pass) {
        for (const Use& use : declaration.passes[plan.passes[pass].declared].uses) {
            Placement& placement = use.texture ? plan.textures[use.resource] : plan.buffers[use.resource];
            placement.first = placement.used ? placement.first : pass;
            placement.last = pass;
            placement.used = true;
        }
    }
    // What a loop touches lives from its beginning: a round may find what the one before left, and no two share memory.
    for (const PlannedLoop& loop : plan.loops) {
        for (std::uint32_t pass = loop.first; pass < loop.first + loop.count; ++pass) {
            for (const Use& use : declaration.passes[plan.passes[pass].declared].uses) {
                Placement& placement = use.texture ? plan.textures[use.resource] : plan.buffers[use.resource];
                placement.first = std::min(placement.first, loop.first);
            }
        }
    }
    const auto finish = [&](const auto& declared, std::vector<Placement>& placements) {
        for (std::size_t i = 0; i < declared.size(); ++i) {
            placements[i].transient = !declared[i].imported;
            if (placements[i].used && declared[i].kept) {
                placements[i].last = static_cast<std::uint32_t>(plan.passes.size());
            }
        }
    };
    finish(declaration.textures, plan.textures);
    finish(declaration.buffers, plan.buffers);
}

}  // namespace

void place(const GraphDeclaration& declaration, const Footprints& footprints, GraphPlan& plan) {
    find_lifetimes(declaration, plan);

    // Large ones first: they leave gaps that small ones fill.
    struct Item {
        Placement* placement;
        const Footprint* footprint;
    };
    std::vector<Item> items;
    const auto collect = [&](std::vector<Placement>& placements, const std::vector<Footprint>& sizes) {
        for (std::size_t i = 0; i < placements.size(); ++i) {
            if (placements[i].used && placements[i].transient) {
                items.push_back({&placements[i], &sizes[i]});
            }
        }
    };
    collect(plan.textures, footprints.textures);
    collect(plan.buffers, footprints.buffers);
    std::stable_sort(items.begin(), items.end(),
                     [](const Item& a, const Item& b) { return a.footprint->bytes > b.footprint->bytes; });

    // Put each as low as those that are alive with it allow, in the first heap with room.
    for (std::size_t i = 0; i < items.size(); ++i) {
        Placement& placement = *items[i].placement;
        const Footprint& footprint = *items[i].footprint;
        placement.bytes = footprint.bytes;
        for (placement.heap = 0;; ++placement.heap) {
            if (placement.heap == plan.heaps.size()) {
                plan.heaps.push_back({footprint.type_bits, 0});
            }
            if (plan.heaps[placement.heap].type_bits != footprint.type_bits) {
                continue;
            }
            std::vector<Placed> taken;
            for (std::size_t j = 0; j < i; ++j) {
                const Placement& other = *items[j].placement;
                if (other.heap == placement.heap && other.first <= placement.last && placement.first <= other.last) {
                    taken.push_back({other.offset, other.offset + other.bytes});
                }
            }
            placement.offset = lowest_gap(std::move(taken), footprint);
            if (placement.offset == 0 || placement.offset + placement.bytes <= most_heap_bytes) {
                break;
            }
        }
        Heap& heap = plan.heaps[placement.heap];
        heap.bytes = std::max(heap.bytes, placement.offset + placement.bytes);
    }
}

VkDeviceSize GraphPlan::transient_bytes() const {
    return std::accumulate(heaps.begin(), heaps.end(), VkDeviceSize{0},
                           [](VkDeviceSize sum, const Heap& heap) { return sum + heap.bytes; });
}

Footprints nominal_footprints(const GraphDeclaration& declaration) {
    constexpr VkDeviceSize alignment = 256;
    Footprints footprints;
    for (const DeclaredTexture& texture : declaration.textures) {
        footprints.textures.push_back({align_up(texel_bytes(texture.desc), alignment), alignment, 1});
    }
    for (const DeclaredBuffer& buffer : declaration.buffers) {
        footprints.buffers.push_back(
            {align_up(std::max<VkDeviceSize>(buffer.desc.bytes, 16), alignment), alignment, 1});
    }
    return footprints;
}

}  // namespace gn
