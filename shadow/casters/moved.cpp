// SPDX-License-Identifier: MIT
#include "shadow/casters/moved.h"

#include <cstring>

namespace gn {

GnLight shadow_shape(const Light& light) {
    GnLight shape = light.shape;
    shape.color = vec4(0);
    shape.intensity = 0;
    return shape;
}

bool same_shape(const GnLight& a, const GnLight& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

std::optional<std::vector<Box>> moved_since(const SceneHandles& handles, std::uint64_t version, std::size_t most) {
    std::optional<std::vector<Box>> boxes = handles.touched_since(version);
    if (boxes && boxes->size() > most) {
        Box all;
        for (const Box& box : *boxes) {
            all.grow(box);
        }
        boxes = {all};
    }
    return boxes;
}

}  // namespace gn
