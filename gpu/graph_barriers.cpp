// SPDX-License-Identifier: MIT
// Barriers from declared ports: each subresource remembers its last write and who has seen it.
#include "gpu/graph_plan.h"

#include <algorithm>

namespace gn {
namespace {

constexpr VkAccessFlags2 write_bits = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                      VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;

struct Seen {
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 access;
};

/// What happened to a subresource so far.
struct State {
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkPipelineStageFlags2 write_stages = 0, read_stages = 0;  ///< of the last write; of the reads since
    VkAccessFlags2 write_access = 0;
    std::vector<Seen> seen;  ///< to whom the last write is visible already
};

/// The dependency an access needs, if any.
struct Dependency {
    VkPipelineStageFlags2 src_stages = 0;
    VkAccessFlags2 src_access = 0;
    VkImageLayout old_layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

bool has_seen(const State& state, const Access& access) {
    return std::any_of(state.seen.begin(), state.seen.end(), [&](const Seen& seen) {
        return (access.stages & ~seen.stages) == 0 && (access.access & ~seen.access) == 0;
    });
}

std::optional<Dependency> advance(State& state, const Access& access, bool imported) {
    const bool transition = access.layout != state.layout;
    const bool hazard = access.writes ? (state.write_stages | state.read_stages) != 0
                                      : state.write_stages != 0 && !has_seen(state, access);
    std::optional<Dependency> dependency;
    if (transition || hazard) {
        dependency.emplace();
        dependency->old_layout = access.discards ? VK_IMAGE_LAYOUT_UNDEFINED : state.layout;

        // Readers since the write have flushed it; a later write only has to wait for them.
        const bool only_after_readers = (access.writes || transition) && state.read_stages != 0;
        dependency->src_stages = only_after_readers ? state.read_stages : state.write_stages;
        dependency->src_access = only_after_readers ? 0 : state.write_access;
        if (dependency->src_stages == 0 && imported) {
            dependency->src_stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        }
    }

    // A write, or a change of layout, starts a new epoch.
    if (access.writes) {
        state = {access.layout, access.stages, 0, access.access & write_bits, {}};
    } else if (transition) {
        state = {access.layout, access.stages, access.stages, 0, {{access.stages, access.access}}};
    } else {
        state.read_stages |= access.stages;
        if (dependency) {
            state.seen.push_back({access.stages, access.access});
        }
    }
    return dependency;
}

class Synchronizer {
  public:
    Synchronizer(const GraphDeclaration& declaration, GraphPlan& plan) : declaration_(declaration), plan_(plan) {
        for (const DeclaredTexture& texture : declaration.textures) {
            auto& states = textures_.emplace_back(std::size_t{texture.desc.mips} * texture.desc.layers);
            for (std::size_t i = 0; i < texture.initial.size() && i < states.size(); ++i) {
                states[i].layout = texture.initial[i];
            }
        }
        buffers_.resize(declaration.buffers.size());
        texture_begun_.resize(declaration.textures.size());
        buffer_begun_.resize(declaration.buffers.size());
    }

    void run() {
        std::uint32_t index = 0;
        const auto run_to = [&](std::uint32_t end) {
            for (; index < end; ++index) {
                visit(plan_.passes[index]);
            }
        };
        for (PlannedLoop& loop : plan_.loops) {
            run_to(loop.first + loop.count);
            // Once more: what a round leaves behind, and what the next one waits for, is the same from here on.
            const auto body = plan_.passes.begin() + loop.first;
            loop.again.assign(body, body + loop.count);
            std::for_each(loop.again.begin(), loop.again.end(), [&](PlannedPass& pass) { visit(pass); });
        }
        run_to(static_cast<std::uint32_t>(plan_.passes.size()));
        plan_.final_layouts.clear();
        for (const auto& states : textures_) {
            auto& layouts = plan_.final_layouts.emplace_back();
            for (const State& state : states) {
                layouts.push_back(state.layout);
            }
        }
    }

  private:
    void visit(PlannedPass& planned) {
        planned.images.clear();
        planned.buffers.clear();
        const DeclaredPass& pass = declaration_.passes[planned.declared];
        if (pass.rests) {
            return;
        }
        inherit_memory(pass);
        for (std::uint32_t texture = 0; texture < textures_.size(); ++texture) {
            if (uses(pass, true, texture)) {
                visit_texture(planned, pass, texture);
            }
        }
        for (std::uint32_t buffer = 0; buffer < buffers_.size(); ++buffer) {
            if (uses(pass, false, buffer)) {
                visit_buffer(planned, pass, buffer);
            }
        }
    }

    static bool uses(const DeclaredPass& pass, bool texture, std::uint32_t resource) {
        return std::any_of(pass.uses.begin(), pass.uses.end(),
                           [&](const Use& use) { return use.texture == texture && use.resource == resource; });
    }

    /// A transient that begins to live waits for whoever used its memory before.
    void inherit_memory(const DeclaredPass& pass) {
        for (const Use& use : pass.uses) {
            const Placement& mine = use.texture ? plan_.textures[use.resource] : plan_.buffers[use.resource];
            auto&& begun = use.texture ? texture_begun_[use.resource] : buffer_begun_[use.resource];
            if (!mine.transient || begun) {
                continue;
            }
            begun = true;
            State inherited;
            const auto take = [&](const State& ended) {
                inherited.write_stages |= ended.write_stages | ended.read_stages;
                inherited.write_access |= ended.write_access;
            };
            for (std::size_t i = 0; i < textures_.size(); ++i) {
                if (shares(mine, plan_.textures[i])) {
                    std::for_each(textures_[i].begin(), textures_[i].end(), take);
                }
            }
            for (std::size_t i = 0; i < buffers_.size(); ++i) {
                if (shares(mine, plan_.buffers[i])) {
                    take(buffers_[i]);
                }
            }
            if (use.texture) {
                std::fill(textures_[use.resource].begin(), textures_[use.resource].end(), inherited);
            } else {
                buffers_[use.resource] = inherited;
            }
        }
    }

    static bool shares(const Placement& mine, const Placement& other) {
        return other.used && other.transient && other.last < mine.first && other.heap == mine.heap &&
               other.offset < mine.offset + mine.bytes && mine.offset < other.offset + other.bytes;
    }

    void visit_texture(PlannedPass& planned, const DeclaredPass& pass, std::uint32_t texture) {
        const TextureDesc& desc = declaration_.textures[texture].desc;
        const bool imported = declaration_.textures[texture].imported;
        std::vector<ImageBarrier> rows;
        for (std::uint32_t mip = 0; mip < desc.mips; ++mip) {
            std::vector<ImageBarrier> row;
            for (std::uint32_t layer = 0; layer < desc.layers; ++layer) {
                const std::optional<Access> access = access_of(declaration_, pass, texture, mip, layer);
                if (!access) {
                    continue;
                }
                State& state = textures_[texture][mip + std::size_t{layer} * desc.mips];
                if (const auto needed = advance(state, *access, imported)) {
                    append(row, {texture,
                                 {mip, 1, layer, 1},
                                 needed->src_stages,
                                 needed->src_access,
                                 access->stages,
                                 access->access,
                                 needed->old_layout,
                                 access->layout});
                }
            }
            for (const ImageBarrier& barrier : row) {
                append(rows, barrier);
            }
        }
        planned.images.insert(planned.images.end(), rows.begin(), rows.end());
    }

    void visit_buffer(PlannedPass& planned, const DeclaredPass& pass, std::uint32_t buffer) {
        const Access access = *access_of(pass, buffer);
        if (const auto needed = advance(buffers_[buffer], access, declaration_.buffers[buffer].imported)) {
            planned.buffers.push_back({buffer, needed->src_stages, needed->src_access, access.stages, access.access});
        }
    }

    /// Joins a barrier to one that it continues, by layers within a mip or by whole mips.
    static void append(std::vector<ImageBarrier>& barriers, const ImageBarrier& next) {
        for (ImageBarrier& held : barriers) {
            const bool same = held.src_stages == next.src_stages && held.src_access == next.src_access &&
                              held.dst_stages == next.dst_stages && held.dst_access == next.dst_access &&
                              held.old_layout == next.old_layout && held.new_layout == next.new_layout;
            const Range& a = held.range;
            const Range& b = next.range;
            if (same && a.mip == b.mip && a.mips == b.mips && a.layer + a.layers == b.layer) {
                held.range.layers += b.layers;
                return;
            }
            if (same && a.layer == b.layer && a.layers == b.layers && a.mip + a.mips == b.mip) {
                held.range.mips += b.mips;
                return;
            }
        }
        barriers.push_back(next);
    }

    const GraphDeclaration& declaration_;
    GraphPlan& plan_;
    std::vector<std::vector<State>> textures_;
    std::vector<State> buffers_;
    std::vector<bool> texture_begun_, buffer_begun_;
};

/// Whether a port needs contents that somebody must have written.
bool needs_contents(const Use& use) {
    switch (use.kind) {
        case UseKind::color:
        case UseKind::depth: return use.load == Load::keep;
        case UseKind::storage_write:
        case UseKind::copy_to: return false;
        default: return true;
    }
}

/// A transient's first use must be a write.
void check_contents(const GraphDeclaration& declaration, const GraphPlan& plan) {
    std::vector<bool> textures, buffers;
    for (const DeclaredTexture& texture : declaration.textures) {
        textures.push_back(texture.imported);
    }
    for (const DeclaredBuffer& buffer : declaration.buffers) {
        buffers.push_back(buffer.imported);
    }
    for (const PlannedPass& planned : plan.passes) {
        const DeclaredPass& pass = declaration.passes[planned.declared];
        const auto writes_itself = [&](const Use& read) {
            return std::any_of(pass.uses.begin(), pass.uses.end(), [&](const Use& use) {
                return use.texture == read.texture && use.resource == read.resource && writes(use.kind) &&
                       !pass.draws();
            });
        };
        for (const Use& use : pass.uses) {
            if (needs_contents(use) && !(use.texture ? textures : buffers)[use.resource] && !writes_itself(use)) {
                fail("pass '{}' reads '{}' ({}), which no earlier pass writes", pass.name,
                     use.texture ? declaration.textures[use.resource].desc.name
                                 : declaration.buffers[use.resource].desc.name,
                     use_name(use.kind));
            }
        }
        for (const Use& use : pass.uses) {
            if (writes(use.kind)) {
                (use.texture ? textures : buffers)[use.resource] = true;
            }
        }
    }
}

}  // namespace

void synchronize(const GraphDeclaration& declaration, GraphPlan& plan) {
    Synchronizer(declaration, plan).run();
}

GraphPlan make_plan(const GraphDeclaration& declaration, const Footprints& footprints) {
    GraphPlan plan;
    for (const std::uint32_t pass : living_passes(declaration)) {
        plan.passes.push_back({.declared = pass});
    }
    find_loops(declaration, plan);
    check_contents(declaration, plan);
    place(declaration, footprints, plan);
    synchronize(declaration, plan);
    return plan;
}

}  // namespace gn
