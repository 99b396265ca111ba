// SPDX-License-Identifier: MIT
#include "shadow/receiver/sent_points.h"

#include "gpu/hash.h"
#include "shadow/receiver/channels.h"
#include "shadow/scene/point_emission.h"

namespace gn {

SentPoints sent_by_points(const FrameInput& input, int count, int side) {
    const GnLight& light = input.light().shape;
    const Image8* const picture = input.parent == nullptr ? shown_picture(input.scene, light) : nullptr;
    if (picture == nullptr) {
        return nullptr;
    }
    // Points lie at the same places of all pictures but for those that are seen from the other side.
    const bool mirrored = gn_emission_place(light, vec2(1)).x < 0.5F;
    const std::uint64_t key =
        Hasher().value(gn_emission_texture(light)).value(count).value(side).value(mirrored).finish().low;
    return input.derive("sent by points", key, [&] { return emission_of_points(*picture, light, count, side); });
}

void add_sent_points(ShaderInputs& inputs, const SentPoints& sent) {
    if (sent != nullptr) {
        inputs.block("readonly buffer", "SentPoints", "vec4 sent_points[];", std::as_bytes(std::span(*sent)));
    }
}

std::string sent_text(const SentPoints& sent) {
    return channels_text(channels_of(sent)) +
           (sent != nullptr ? "#define GN_SENT(i) sent_points[i].rgb\n" : "#define GN_SENT(i) 1.0\n");
}

std::string remark_pictures(const Scene& scene, std::string_view part) {
    for (const Light& light : scene.lights) {
        if (shown_picture(scene, light.shape) != nullptr) {
            return fmt::format(
                "{} knows how much of the picture of light '{}' is hidden, not which part of it: its V has no colour "
                "(view-samples, depth-complexity, and backprojection with its bitmask know)",
                part, light.name);
        }
    }
    return "";
}

}  // namespace gn
