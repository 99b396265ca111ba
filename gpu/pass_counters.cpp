// SPDX-License-Identifier: MIT
#include "gpu/pass_counters.h"

#include <algorithm>
#include <array>

namespace gn {
namespace {

// Values come in the order of these bits.
constexpr VkQueryPipelineStatisticFlags counted = VK_QUERY_PIPELINE_STATISTIC_VERTEX_SHADER_INVOCATIONS_BIT |
                                                  VK_QUERY_PIPELINE_STATISTIC_GEOMETRY_SHADER_PRIMITIVES_BIT |
                                                  VK_QUERY_PIPELINE_STATISTIC_CLIPPING_PRIMITIVES_BIT |
                                                  VK_QUERY_PIPELINE_STATISTIC_FRAGMENT_SHADER_INVOCATIONS_BIT |
                                                  VK_QUERY_PIPELINE_STATISTIC_COMPUTE_SHADER_INVOCATIONS_BIT;
using Counted = std::array<std::uint64_t, 5>;

thread_local PassCounters* living = nullptr;

struct Moved {
    std::uint64_t texel = 4;  ///< bytes read at once
    std::uint64_t all = 0;
};

Moved moved_by(const GraphDeclaration& declaration, const Use& use) {
    if (!use.texture) {
        return {4, declaration.buffers[use.resource].desc.bytes};
    }
    TextureDesc desc = declaration.textures[use.resource].desc;
    desc.width = std::max(1U, desc.width >> use.range.mip);
    desc.height = std::max(1U, desc.height >> use.range.mip);
    desc.mips = use.range.mips;
    desc.layers = use.range.layers;
    return {format_bytes(desc.format), texel_bytes(desc)};
}

}  // namespace

std::uint64_t least_bytes(const GraphDeclaration& declaration, const DeclaredPass& pass,
                          const std::optional<PassCounts>& counts) {
    std::uint64_t bytes = 0;
    for (const Use& use : pass.uses) {
        const Moved moved = moved_by(declaration, use);
        const bool attachment = use.kind == UseKind::color || use.kind == UseKind::depth;
        const bool read_by_shader = use.kind == UseKind::sample || use.kind == UseKind::storage_read;
        bytes += writes(use.kind) ? moved.all : 0;
        if (attachment && use.load == Load::keep) {
            bytes += moved.all;
        }
        if (read_by_shader && counts) {
            const std::uint64_t invocations = counts->vertices + counts->fragments + counts->items;
            bytes += std::min(moved.all, invocations * moved.texel);
        } else if (!writes(use.kind)) {
            bytes += moved.all;
        }
    }
    return bytes;
}

PassCounters::PassCounters(Device& device) : device_(device) {
    GN_CHECK(living == nullptr);
    VkPhysicalDeviceFeatures present{};
    vkGetPhysicalDeviceFeatures(device.physical(), &present);
    statistics_ = present.pipelineStatisticsQuery == VK_TRUE;
    samples_ = present.occlusionQueryPrecise == VK_TRUE;
    living = this;
}

PassCounters::~PassCounters() {
    living = nullptr;
    destroy_pools();
}

PassCounters* PassCounters::of(const Device& device) {
    return living != nullptr && &living->device_ == &device ? living : nullptr;
}

std::string PassCounters::missing() const {
    std::string words = statistics_ ? "" : "invocations of shaders and primitives (it has no pipelineStatisticsQuery)";
    if (!samples_) {
        words += words.empty() ? "" : " and ";
        words += "samples that pass the tests of depth and stencil (it has no occlusionQueryPrecise)";
    }
    return words.empty() ? words : "this device does not count " + words;
}

void PassCounters::make_pools(std::uint32_t passes) {
    destroy_pools();
    const auto make = [&](VkQueryType type, VkQueryPipelineStatisticFlags flags, VkQueryPool& pool) {
        const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                         .queryType = type,
                                         .queryCount = passes,
                                         .pipelineStatistics = flags};
        GN_VK(vkCreateQueryPool(device_.vk(), &info, nullptr, &pool));
        ++device_.counters().pools;
    };
    if (statistics_) {
        make(VK_QUERY_TYPE_PIPELINE_STATISTICS, counted, statistics_pool_);
    }
    if (samples_) {
        make(VK_QUERY_TYPE_OCCLUSION, 0, samples_pool_);
    }
    capacity_ = passes;
}

void PassCounters::destroy_pools() {
    vkDestroyQueryPool(device_.vk(), statistics_pool_, nullptr);
    vkDestroyQueryPool(device_.vk(), samples_pool_, nullptr);
    statistics_pool_ = samples_pool_ = VK_NULL_HANDLE;
    capacity_ = 0;
}

void PassCounters::begin(VkCommandBuffer commands, std::uint32_t passes) {
    if (capacity_ < passes) {
        make_pools(passes);
    }
    next_ = 0;
    for (const VkQueryPool pool : {statistics_pool_, samples_pool_}) {
        if (pool != VK_NULL_HANDLE && passes > 0) {
            vkCmdResetQueryPool(commands, pool, 0, passes);
        }
    }
}

void PassCounters::open(VkCommandBuffer commands) {
    if (statistics_) {
        vkCmdBeginQuery(commands, statistics_pool_, next_, 0);
    }
    if (samples_) {
        vkCmdBeginQuery(commands, samples_pool_, next_, VK_QUERY_CONTROL_PRECISE_BIT);
    }
}

void PassCounters::close(VkCommandBuffer commands) {
    if (samples_) {
        vkCmdEndQuery(commands, samples_pool_, next_);
    }
    if (statistics_) {
        vkCmdEndQuery(commands, statistics_pool_, next_);
    }
    ++next_;
}

void PassCounters::finish(const GraphDeclaration& declaration, std::span<const Turn> turns) {
    GN_CHECK(next_ == turns.size());
    const auto read = [&](VkQueryPool pool, void* values, std::size_t bytes, std::size_t stride) {
        GN_VK(vkGetQueryPoolResults(device_.vk(), pool, 0, next_, bytes, values, stride,
                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
    };
    std::vector<Counted> statistics(statistics_ ? next_ : 0);
    std::vector<std::uint64_t> samples(samples_ ? next_ : 0);
    if (!statistics.empty()) {
        read(statistics_pool_, statistics.data(), statistics.size() * sizeof(Counted), sizeof(Counted));
    }
    if (!samples.empty()) {
        read(samples_pool_, samples.data(), samples.size() * sizeof(std::uint64_t), sizeof(std::uint64_t));
    }
    passes_.clear();
    for (std::size_t i = 0; i < turns.size(); ++i) {
        const DeclaredPass& pass = declaration.passes[turns[i].pass->declared];
        CountedPass& of = passes_.emplace_back();
        of.name = pass.name;
        of.group = pass.group;
        of.draws = pass.draws();
        of.shades = std::any_of(pass.uses.begin(), pass.uses.end(), [](const Use& use) {
            return use.kind == UseKind::color || use.kind == UseKind::storage_write;
        });
        if (statistics_) {
            const Counted& c = statistics[i];
            of.counts = {c[0], c[1], c[2], c[3], c[4]};
        }
        if (samples_) {
            of.samples = samples[i];
        }
        of.bytes = least_bytes(declaration, pass, of.counts);
    }
}

}  // namespace gn
