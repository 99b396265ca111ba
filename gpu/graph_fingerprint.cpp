// SPDX-License-Identifier: MIT
// One number for a declaration, so that a steady frame finds its plan instead of making it.
#include "gpu/graph_plan.h"

namespace gn {
namespace {

void hash(Hasher& hasher, const Use& use) {
    hasher.value(use.kind).value(use.texture).value(use.resource).value(use.load);
    hasher.value(use.range.mip).value(use.range.mips).value(use.range.layer).value(use.range.layers);
    hasher.value(use.clear_stencil.has_value());
}

}  // namespace

Fingerprint fingerprint(const GraphDeclaration& declaration) {
    Hasher hasher;
    hasher.value(declaration.textures.size()).value(declaration.buffers.size()).value(declaration.passes.size());
    for (const DeclaredTexture& texture : declaration.textures) {
        const TextureDesc& desc = texture.desc;
        hasher.value(desc.format).value(desc.width).value(desc.height).value(desc.layers).value(desc.mips);
        hasher.value(desc.samples).value(desc.usage).value(desc.cube).value(texture.imported).value(texture.kept);
    }
    for (const DeclaredBuffer& buffer : declaration.buffers) {
        // An imported buffer takes no memory here; a renderer's may end elsewhere in every frame.
        hasher.value(buffer.imported ? 0 : buffer.desc.bytes)
            .value(buffer.desc.usage)
            .value(buffer.imported)
            .value(buffer.kept);
    }
    for (const DeclaredPass& pass : declaration.passes) {
        hasher.value(pass.keep).value(pass.uses.size());
        for (const Use& use : pass.uses) {
            hash(hasher, use);
        }
    }
    for (const DeclaredLoop& loop : declaration.loops) {
        hasher.value(loop.first).value(loop.count).value(loop.rounds);
    }
    return hasher.finish();
}

}  // namespace gn
