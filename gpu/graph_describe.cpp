// SPDX-License-Identifier: MIT
// A plan as text.
#include "gpu/graph_plan.h"
#include "gpu/vk_names.h"

namespace gn {
namespace {

std::string range_text(const Range& range, const TextureDesc& desc) {
    if (range.mips == desc.mips && range.layers == desc.layers) {
        return "";
    }
    std::string text = fmt::format("[mip {}", range.mip);
    text += range.mips > 1 ? fmt::format("..{}", range.mip + range.mips - 1) : "";
    text += fmt::format(", layer {}", range.layer);
    text += range.layers > 1 ? fmt::format("..{}", range.layer + range.layers - 1) : "";
    return text + "]";
}

std::string load_text(const Use& use) {
    if (use.kind != UseKind::color && use.kind != UseKind::depth) {
        return "";
    }
    return use.load == Load::clear ? " clear" : use.load == Load::keep ? " keep" : " discard";
}

std::string dependency_text(VkPipelineStageFlags2 src, VkAccessFlags2 src_access, VkPipelineStageFlags2 dst,
                            VkAccessFlags2 dst_access) {
    return fmt::format("{}({}) -> {}({})", stages_name(src), access_name(src_access), stages_name(dst),
                       access_name(dst_access));
}

void describe_pass(std::string& text, const GraphDeclaration& declaration, const PlannedPass& planned) {
    const DeclaredPass& pass = declaration.passes[planned.declared];
    text += fmt::format("pass {}{}{}\n", pass.group, pass.group.empty() ? "" : "/", pass.name);
    for (const ImageBarrier& barrier : planned.images) {
        const TextureDesc& desc = declaration.textures[barrier.texture].desc;
        text += fmt::format(
            "    barrier {}{}: {}", desc.name, range_text(barrier.range, desc),
            dependency_text(barrier.src_stages, barrier.src_access, barrier.dst_stages, barrier.dst_access));
        text += fmt::format(", {} -> {}\n", layout_name(barrier.old_layout), layout_name(barrier.new_layout));
    }
    for (const BufferBarrier& barrier : planned.buffers) {
        text += fmt::format(
            "    barrier {}: {}\n", declaration.buffers[barrier.buffer].desc.name,
            dependency_text(barrier.src_stages, barrier.src_access, barrier.dst_stages, barrier.dst_access));
    }
    for (const Use& use : pass.uses) {
        if (use.texture) {
            const TextureDesc& desc = declaration.textures[use.resource].desc;
            text += fmt::format("    {} {}{}{}\n", use_name(use.kind), desc.name, range_text(use.range, desc),
                                load_text(use));
        } else {
            text += fmt::format("    {} {}\n", use_name(use.kind), declaration.buffers[use.resource].desc.name);
        }
    }
}

}  // namespace

std::string describe(const GraphDeclaration& declaration, const GraphPlan& plan) {
    std::string text;
    for (const Turn& turn : turns_of(declaration, plan)) {
        describe_pass(text, declaration, *turn.pass);
    }
    const auto memory = [&](const auto& declared, const std::vector<Placement>& placements) {
        for (std::size_t i = 0; i < placements.size(); ++i) {
            const Placement& p = placements[i];
            if (p.used && p.transient) {
                text += fmt::format("memory {}: heap {}, {} + {}, passes {}..{}\n", declared[i].desc.name, p.heap,
                                    p.offset, p.bytes, p.first, p.last);
            }
        }
    };
    memory(declaration.textures, plan.textures);
    memory(declaration.buffers, plan.buffers);
    return text + fmt::format("transient bytes {}\n", plan.transient_bytes());
}

}  // namespace gn
