// SPDX-License-Identifier: MIT
// Rigs of several files in one scene.
#include "shadow/scene/rig.h"

#include <algorithm>
#include <iterator>

namespace gn {

void append_rig(Rig& whole, Rig part, const dmat4& ws_from_part) {
    if (!part.moves()) {
        return;
    }
    // Its nodes go below one that moves them all.
    const std::size_t root = whole.nodes.size(), first = root + 1, curves = whole.curves.size();
    const auto skins = static_cast<int>(whole.skins.size());
    const auto shift = [&](int node) { return node >= 0 ? node + static_cast<int>(first) : node; };
    whole.nodes.push_back({.matrix = ws_from_part});
    for (RigNode& node : part.nodes) {
        node.parent = node.parent >= 0 ? shift(node.parent) : static_cast<int>(root);
        whole.nodes.push_back(node);
    }
    for (Skin& skin : part.skins) {
        for (int& joint : skin.joints) {
            // A joint of no node stands at the part's origin.
            joint = joint >= 0 ? shift(joint) : static_cast<int>(root);
        }
        whole.skins.push_back(std::move(skin));
    }
    for (Follower& follower : part.followers) {
        follower.shape += whole.shapes.size();
        follower.node = follower.node >= 0 ? shift(follower.node) : static_cast<int>(root);
        follower.weights = shift(follower.weights);
        follower.skin += follower.skin >= 0 ? skins : 0;
        whole.followers.push_back(std::move(follower));
    }
    std::move(part.shapes.begin(), part.shapes.end(), std::back_inserter(whole.shapes));
    std::move(part.curves.begin(), part.curves.end(), std::back_inserter(whole.curves));
    for (CarriedLight& carried : part.lights) {
        carried.node += first;
        whole.lights.push_back(carried);
    }
    for (CarriedCamera& carried : part.cameras) {
        carried.node += first;
        whole.cameras.push_back(carried);
    }
    for (Animation& animation : part.animations) {
        auto known = std::find_if(whole.animations.begin(), whole.animations.end(),
                                  [&](const Animation& a) { return a.name == animation.name; });
        if (known == whole.animations.end()) {
            known = whole.animations.insert(whole.animations.end(), Animation{animation.name, {}, 0});
        }
        for (Channel channel : animation.channels) {
            known->channels.push_back({channel.node + first, channel.path, channel.curve + curves, channel.target});
        }
        known->seconds = std::max(known->seconds, animation.seconds);
    }
}

}  // namespace gn
