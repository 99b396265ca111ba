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

/// A pass lives when it writes something that is needed.
bool lives(Needed& needed, const GraphDeclaration& declaration, const DeclaredPass& pass) {
    bool found = pass.keep;
    for (const Use& use : pass.uses) {
        if (may_write(declaration, use)) {
            for_touched(needed, declaration, use, [&](auto&& need) { found = found || need; });
        }
    }
    return found;
}

/// What a living pass clears needs no earlier writer; what it otherwise touches does.
void take(Needed& needed, const GraphDeclaration& declaration, const DeclaredPass& pass) {
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

/// Walks passes `first` to `end` backwards, marks those that live, and leaves what was needed before them.
void walk(Needed& needed, const GraphDeclaration& declaration, std::size_t first, std::size_t end,
          std::vector<bool>& living) {
    for (std::size_t i = end; i-- > first;) {
        const DeclaredPass& pass = declaration.passes[i];
        if (lives(needed, declaration, pass)) {
            living[i] = true;
            take(needed, declaration, pass);
        }
    }
}

void add(std::vector<bool>& to, const std::vector<bool>& more) {
    for (std::size_t i = 0; i < to.size(); ++i) {
        to[i] = to[i] || more[i];
    }
}

/// A round's end is needed by what comes after the loop or by the round after it. Whoever lives in one round does in all.
void walk_loop(Needed& needed, const GraphDeclaration& declaration, const DeclaredLoop& loop,
               std::vector<bool>& living) {
    Needed after = needed;
    std::size_t known = 0;
    const auto count = [&] { return static_cast<std::size_t>(std::count(living.begin(), living.end(), true)); };
    do {
        known = count();
        needed = after;
        walk(needed, declaration, loop.first, loop.first + loop.count, living);
        for (std::size_t i = 0; i < after.texels.size(); ++i) {
            add(after.texels[i], needed.texels[i]);
        }
        add(after.buffers, needed.buffers);
    } while (count() != known);
}

}  // namespace

std::vector<std::uint32_t> living_passes(const GraphDeclaration& declaration) {
    Needed needed = needed_after(declaration);
    std::vector<bool> living(declaration.passes.size(), false);
    std::size_t end = living.size();
    for (auto loop = declaration.loops.rbegin(); loop != declaration.loops.rend(); ++loop) {
        walk(needed, declaration, loop->first + loop->count, end, living);
        walk_loop(needed, declaration, *loop, living);
        end = loop->first;
    }
    walk(needed, declaration, 0, end, living);

    std::vector<std::uint32_t> passes;
    for (std::uint32_t i = 0; i < living.size(); ++i) {
        if (living[i]) {
            passes.push_back(i);
        }
    }
    return passes;
}

}  // namespace gn
