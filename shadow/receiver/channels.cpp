// SPDX-License-Identifier: MIT
#include "shadow/receiver/channels.h"

namespace gn {

VkFormat visibility_format(uint channels) {
    GN_CHECK(channels == 1 || channels == 3);
    return channels == 1 ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
}

uint channels_of(const FrameGraph& graph, TextureHandle visibility) {
    return graph.desc(visibility).format == visibility_format(1) ? 1 : 3;
}

std::string channels_text(uint channels) {
    return channels == 1 ? "#define GN_V float\n#define GN_V_OF(texel) (texel).r\n"
                           "#define GN_V_TEXEL(v) vec4(v, 0.0, 0.0, 1.0)\n#define GN_V_FORMAT r32f\n"
                         : "#define GN_V vec3\n#define GN_V_OF(texel) (texel).rgb\n"
                           "#define GN_V_TEXEL(v) vec4(v, 1.0)\n#define GN_V_FORMAT rgba32f\n";
}

}  // namespace gn
