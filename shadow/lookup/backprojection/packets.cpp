// SPDX-License-Identifier: MIT
// Based on: Yang, Feng, Guennebaud, Liu. Packet-based Hierarchal Soft Shadow Mapping. EGSR 2009. [YFGL09]
#include "shadow/lookup/backprojection/packets.h"

#include "shadow/frame/frame.h"
#include "shadow/lookup/backprojection/backprojection.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/expect.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"

namespace gn {
namespace {

/// How a search that leaves its view finds the next one.
std::string crossing_text(const LightViews& views) {
    return views.crosses ? "#define GN_CROSSING\n#define GN_CHOICE(receiver) " + choose_call(views) +
                               "\n#define GN_LIGHT_VIEW(i) known_view(i)\n"
                         : "";
}

}  // namespace

Visibility add_packets(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map,
                       std::span<const std::string_view> needs, const std::string& prologue) {
    const auto params = recipe.of<GnBackprojectionParams>("backprojection");
    const auto side = static_cast<std::uint32_t>(params.packet);
    const Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs = sample_inputs(input, recipe, views);
    std::string maps;
    for (std::size_t i = 0; i < needs.size(); ++i) {
        // What a recipe does not ask for is the map again, and is not read.
        const Offer* const found = map.find(needs[i]);
        const Offer& offer = found != nullptr ? *found : map.offers.front();
        inputs.texture("sampler2DArray", fmt::format("map{}", i), offer.texture, offer.sampler);
        maps += fmt::format("{}map{}", i == 0 ? "" : ", ", i);
    }
    inputs.image(image_format(visibility_format(1)), "writeonly", "image2D", "visibility", result.image);
    inputs.constant("GnBackprojectionParams", "lookup_params", params);
    const std::string before =
        receiver_defines(recipe, views) + prologue +
        fmt::format("#define GN_BACK_SIDE {}\n#define GN_BACK_PACKET {}\n#define MAPS {}\n", side, side * side, maps);
    const std::string functions = sample_functions(input, recipe, views) + crossing_text(views);
    const auto shader =
        compute_once(input.prepared, "packets", hashed(inputs).text(before).text(functions).text(views.part->id), [&] {
            return expect_text(input.device) + channels_text(1) + before + include_line("shadow/view/view.glsl") +
                   include_line("shadow/view/surface.glsl") + placement_text(*views.part, recipe) +
                   include_line("shadow/lookup/backprojection/backprojection.h") + inputs.text() + functions +
                   include_line("shadow/lookup/backprojection/packets.glsl") +
                   include_line("shadow/lookup/backprojection/packet_pass.glsl");
        });
    add_pixel_pass(input.graph, "lookup", inputs, shader, (input.samples.width + side - 1) / side,
                   (input.samples.height + side - 1) / side);
    return result;
}

}  // namespace gn
