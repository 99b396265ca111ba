// SPDX-License-Identifier: MIT
// Which passes matter: a walk backwards from what outlives the graph.
#include "gpu/graph_plan.h"

#include <algorithm>

namespace gn {
namespace {

/// What later passes, or the world after the graph, still need.
struct Needed {
    std::vector<std::vector<bool>> texels;  ///< per texture and subresource
    std::vector<bool> buffers;
};

Needed needed_after(const GraphDeclaration& declaration) {
    Needed needed;
    for (const DeclaredTexture& texture : declaration.textures) {
        needed.texels.emplace_back(std::size_t{texture.desc.mips} * texture.desc.layers,
                                   texture.imported || texture.kept);
    }
    for (const DeclaredBuffer& buffer : declaration.buffers) {
        needed.buffers.push_back(buffer.imported || buffer.kept);
    }
    return needed;
}

/// Calls `visit` with a reference to the need of everything that a port touches.
template <class Visit>
void for_touched(Needed& needed, const GraphDeclaration& declaration, const Use& use, Visit visit) {
    if (!use.texture) {
        visit(needed.buffers[use.resource]);
        return;
    }
    const std::uint32_t mips = declaration.textures[use.resource].desc.mips;
    for (std::uint32_t layer = use.range.layer; layer < use.range.layer + use.range.layers; ++layer) {
        for (std::uint32_t mip = use.range.mip; mip < use.range.mip + use.range.mips; ++mip) {
            visit(needed.texels[use.resource][mip + std::size_t{layer} * mips]);
        }
    }
}

bool may_write(const GraphDeclaration& declaration, const Use& use) {
    const bool stencil =
        use.kind == UseKind::depth_read_only && has_stencil(declaration.textures[use.resource].desc.format);
    return writes(use.kind) || stencil;
}

}  // namespace

std::vector<std::uint32_t> living_passes(const GraphDeclaration& declaration) {
    Needed needed = needed_after(declaration);
    std::vector<std::uint32_t> living;
    for (std::size_t i = declaration.passes.size(); i-- > 0;) {
        const DeclaredPass& pass = declaration.passes[i];

        // A pass lives when it writes something that is needed.
        bool lives = pass.keep;
        for (const Use& use : pass.uses) {
            if (may_write(declaration, use)) {
                for_touched(needed, declaration, use, [&](auto&& need) { lives = lives || need; });
            }
        }
        if (!lives) {
            continue;
        }
        living.push_back(static_cast<std::uint32_t>(i));

        // What it clears needs no earlier writer; what it otherwise touches does.
        for (const Use& use : pass.uses) {
            if ((use.kind == UseKind::color || use.kind == UseKind::depth) && use.load != Load::keep) {
                for_touched(needed, declaration, use, [](auto&& need) { need = false; });
            }
        }
        for (const Use& use : pass.uses) {
            const bool attachment = use.kind == UseKind::color || use.kind == UseKind::depth;
            if (!attachment || use.load == Load::keep) {
                for_touched(needed, declaration, use, [](auto&& need) { need = true; });
            }
        }
    }
    std::reverse(living.begin(), living.end());
    return living;
}

}  // namespace gn
