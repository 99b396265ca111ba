// SPDX-License-Identifier: MIT
#include "shadow/frame/history.h"

namespace gn {
namespace {

/// Frames that a host may have in flight (gpu/frames.h).
constexpr std::uint64_t most_in_flight = 8;

}  // namespace

bool serves(const TextureDesc& held, const TextureDesc& wanted) {
    return held.format == wanted.format && held.width == wanted.width && held.height == wanted.height &&
           held.layers == wanted.layers && held.mips == wanted.mips && held.samples == wanted.samples &&
           (wanted.usage & ~held.usage) == 0;
}

std::string chosen_texels(std::uint64_t light_id) {
    return fmt::format("chosen texels of light {}", light_id);
}

void History::advance() {
    for (auto& [name, kept] : textures_) {
        kept.written = kept.written || kept.asked;
        kept.asked = false;
    }
    for (auto& [name, pair] : pairs_) {
        pair.now = pair.asked ? 1 - pair.now : pair.now;
        pair.written = pair.written || pair.asked;
        pair.asked = false;
    }
    for (auto& [name, value] : values_) {
        if (value.now.has_value()) {
            value.before = std::move(value.now);
            value.now.reset();
        }
    }
    ++frame_;
    std::erase_if(dropped_, [&](const Dropped& d) { return d.frame + most_in_flight < frame_; });
}

void History::clear() {
    for (auto& [name, kept] : textures_) {
        drop(std::move(kept.texture));
    }
    for (auto& [name, pair] : pairs_) {
        for (Texture2D& texture : pair.textures) {
            drop(std::move(texture));
        }
    }
    textures_.clear();
    pairs_.clear();
    values_.clear();
    answers_.clear();
}

Texture2D& History::texture(const TextureDesc& desc, bool& fresh) {
    KeptTexture& kept = textures_[desc.name];
    if (kept.texture.vk() == VK_NULL_HANDLE || !serves(kept.texture.desc(), desc)) {
        drop(std::move(kept.texture));
        kept = {Texture2D(device_, desc)};
    }
    kept.asked = true;
    fresh = !kept.written;
    return kept.texture;
}

History::Pair History::pair(const TextureDesc& desc) {
    KeptPair& held = pairs_[desc.name];
    if (held.textures[0].vk() == VK_NULL_HANDLE || !serves(held.textures[0].desc(), desc)) {
        for (Texture2D& texture : held.textures) {
            drop(std::move(texture));
        }
        held = {{Texture2D(device_, desc), Texture2D(device_, desc)}};
    }
    held.asked = true;
    return {held.written ? &held.textures[1 - held.now] : nullptr, &held.textures[held.now]};
}

}  // namespace gn
