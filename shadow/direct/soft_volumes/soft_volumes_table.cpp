// SPDX-License-Identifier: MIT
// Based on: Assarsson, Akenine-Moller. A Geometry-Based Soft Shadow Volume Algorithm Using Graphics Hardware. TOG 2003. [AA03]
#include "shadow/direct/soft_volumes/soft_volumes_table.h"

#include "shadow/geometry/seen_light.glsl"

namespace gn {

const char* const soft_volumes_table_text = R"(
float gn_coverage(vec2 a, vec2 b) {
    vec4 at = (vec4(a, b) * 0.5 + 0.5) * float(u.side - 1);
    ivec4 low = ivec4(clamp(floor(at), vec4(0.0), vec4(float(u.side - 2))));
    vec4 w = at - vec4(low);
    float sum = 0.0;
    for (int i = 0; i < 16; ++i) {
        ivec4 step = ivec4(i & 1, (i >> 1) & 1, (i >> 2) & 1, i >> 3);
        ivec4 entry = low + step;
        vec4 share = mix(1.0 - w, w, vec4(step));
        sum += share.x * share.y * share.z * share.w *
               coverage[entry.x + u.side * (entry.y + u.side * (entry.z + u.side * entry.w))];
    }
    return sum;
}
)";

// [AA03] section 3.3: the ends are quantized, and what lies beyond the segment is stored.
std::vector<float> soft_volumes_table(bool square, int side) {
    std::vector<float> table;
    table.reserve(static_cast<std::size_t>(side) * side * side * side);
    const auto at = [&](int i) { return 2.0F * static_cast<float>(i) / static_cast<float>(side - 1) - 1.0F; };
    for (int w = 0; w < side; ++w) {
        for (int z = 0; z < side; ++z) {
            for (int y = 0; y < side; ++y) {
                for (int x = 0; x < side; ++x) {
                    vec2 a(at(x), at(y));
                    vec2 b(at(z), at(w));
                    table.push_back(glsl::gn_cut_to_light(square, a, b) ? glsl::gn_beyond(square, a, b) : 0.0F);
                }
            }
        }
    }
    return table;
}

}  // namespace gn
