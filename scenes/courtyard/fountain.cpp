// SPDX-License-Identifier: MIT
// A stone fountain: an eight-sided basin on a step, a baluster and a bowl.
#include "scenes/courtyard/courtyard.h"

namespace gn::scenes::yard {

void add_fountain(MeshBuilder& builder, const Materials& m) {
    const vec3 at(-0.9F, 0, -2.3F);
    builder.begin("fountain step", m.stone, 0.7F);
    builder.place(at, pi / 8);
    const std::array step{vec2(1.55F, -0.1F), vec2(1.55F, 0.12F), vec2(1.52F, 0.14F)};
    builder.lathe(step, 8);
    builder.begin("fountain basin", m.stone, 0.7F);
    builder.place(at, pi / 8);
    const std::array basin{vec2(1.12F, 0.13F), vec2(1.12F, 0.20F), vec2(1.04F, 0.24F), vec2(1.04F, 0.56F),
                           vec2(1.14F, 0.60F), vec2(1.14F, 0.68F), vec2(1.12F, 0.70F), vec2(0.92F, 0.70F),
                           vec2(0.90F, 0.68F), vec2(0.90F, 0.30F)};
    builder.lathe(basin, 8);
    builder.begin("fountain water", m.water);
    builder.place(at, pi / 8);
    const std::array water{vec2(0.91F, 0.40F), vec2(0.91F, 0.58F)};
    builder.lathe(water, 8);
    // The baluster carries a bowl and a finial.
    builder.begin("fountain bowl", m.stone, 0.8F);
    builder.place(at);
    const std::array bowl{vec2(0.20F, 0.29F),  vec2(0.20F, 0.66F), vec2(0.15F, 0.70F),  vec2(0.09F, 0.80F),
                          vec2(0.11F, 0.95F),  vec2(0.13F, 1.02F), vec2(0.10F, 1.08F),  vec2(0.14F, 1.12F),
                          vec2(0.38F, 1.24F),  vec2(0.47F, 1.33F), vec2(0.485F, 1.36F), vec2(0.45F, 1.36F),
                          vec2(0.36F, 1.29F),  vec2(0.10F, 1.25F), vec2(0.055F, 1.28F), vec2(0.05F, 1.45F),
                          vec2(0.085F, 1.50F), vec2(0.09F, 1.56F), vec2(0.05F, 1.63F),  vec2(0, 1.68F)};
    builder.lathe(bowl, 24);
}

}  // namespace gn::scenes::yard
