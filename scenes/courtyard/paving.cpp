// SPDX-License-Identifier: MIT
// The pavement: stones with slight relief in rows of varying width, and the ground and trees beyond the fence.
#include "scenes/courtyard/courtyard.h"

#include "scenes/noise.h"

namespace gn::scenes::yard {

void add_paving(MeshBuilder& builder, const Materials& m) {
    // Rows along x; stones of a row end where the dice say, joints are 1 cm.
    builder.begin("paving", m.paving, 0.45F);
    Dice dice(41);
    const float joint = 0.01F, row_depth = 0.78F;
    for (float z = north + 0.42F; z < south + 0.2F; z += row_depth) {
        float x = west + 0.42F;
        while (x < east - 0.15F) {
            float width = dice.between(0.62F, 1.15F);
            if (x + width > east - 0.6F) {
                width = east - 0.05F - x;
            }
            const float top = dice.between(-0.006F, 0.0F);
            builder.chamfered_slab({x, -0.12F, z}, {x + width - joint, top, z + row_depth - joint}, 0.008F);
            x += width;
        }
    }
}

void add_surroundings(MeshBuilder& builder, const Materials& m) {
    builder.begin("ground (sheet)", m.grass, 0.25F);
    builder.sheet({-60, -0.03F, 60}, {120, 0, 0}, {0, 0, -120});
    // Cypresses and a hedge close the view to the east without shading the court.
    builder.begin("cypresses", m.grass, 0.3F);
    Dice dice(43);
    for (int i = 0; i < 7; ++i) {
        const float h = dice.between(5.5F, 8.5F), r = dice.between(0.55F, 0.8F);
        builder.place(vec3(dice.between(10.5F, 13.5F) + 0.6F * static_cast<float>(i), -0.1F,
                           -8.0F - 2.1F * static_cast<float>(i)));
        const std::array profile{vec2(0.12F, 0),
                                 vec2(0.12F, 0.35F),
                                 vec2(r, 0.8F),
                                 vec2(r * 1.05F, h * 0.35F),
                                 vec2(r * 0.75F, h * 0.65F),
                                 vec2(r * 0.3F, h * 0.9F),
                                 vec2(0, h)};
        builder.lathe(profile, 11);
    }
    builder.begin("hedge", m.grass, 0.3F);
    builder.chamfered_slab({19, -0.2F, -22}, {20.5F, 1.6F, 24}, 0.2F);
}

}  // namespace gn::scenes::yard
