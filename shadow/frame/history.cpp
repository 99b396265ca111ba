// SPDX-License-Identifier: MIT
#include "shadow/frame/history.h"

namespace gn {
namespace {

bool same(const TextureDesc& a, const TextureDesc& b) {
    return a.format == b.format && a.width == b.width && a.height == b.height && a.layers == b.layers &&
           a.mips == b.mips && a.samples == b.samples && (b.usage & ~a.usage) == 0;
}

}  // namespace

Texture2D& History::texture(const TextureDesc& desc, bool& fresh) {
    const auto found = textures_.find(desc.name);
    fresh = found == textures_.end() || !same(found->second.desc(), desc);
    if (fresh) {
        textures_.insert_or_assign(desc.name, Texture2D(device_, desc));
    }
    return textures_.at(desc.name);
}

}  // namespace gn
