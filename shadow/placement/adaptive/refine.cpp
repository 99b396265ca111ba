// SPDX-License-Identifier: MIT
// Based on: Giegl, Wimmer. Queried Virtual Shadow Maps. I3D 2007. [GW07b]
// Fernando, Fernandez, Bala, Greenberg. Adaptive Shadow Maps. SIGGRAPH 2001. [FFBG01]
// Departs from them: rounds follow each other on the GPU, counted by atomics, and nothing is read back.
#include "shadow/placement/adaptive/refine.h"

#include "gpu/zeros_pass.h"
#include "shadow/casters/raster.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <algorithm>

namespace gn::adaptive {
namespace {

constexpr const char* look_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;

// Whether the texel beside the receiver's own leaves it lit.
bool lit_beside(GnProjected at, GnBias bias, ivec2 beside) {
    vec4 border = round(at.bounds_ts / at.texel_ts);
    vec2 texel = clamp(floor(at.uv_ts / at.texel_ts) + vec2(beside), border.xy, border.zw - 1.0);
    return gn_depth_at(at, (texel + 0.5) * at.texel_ts, bias) <= texelFetch(drawn_depth, ivec3(texel, at.layer), 0).r;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), u.view.size.xy))) {
        return;
    }
    GnReceiver receiver;
    if (!read_sample(pixel, receiver)) {
        return;
    }
    GnAdaptiveFound found = gn_adaptive_find(receiver, placement);
    GnBias bias = known_bias();
    GnProjected at = gn_project(receiver, known_view(found.view), bias);
    bool lit = lit_beside(at, bias, ivec2(0));
#ifdef GN_REFINE_EDGES
    // An edge passes between the texels around the receiver.
    bool refine = false;
    for (int i = 0; i < 9; ++i) {
        refine = refine || lit_beside(at, bias, ivec2(i % 3, i / 3) - 1) != lit;
    }
#else
    // The finer tile changed the sample; nothing is finer than the first round.
    bool refine = u.round == 0 || imageLoad(lit_before, pixel).r != float(lit);
    imageStore(lit_before, pixel, vec4(float(lit)));
#endif
    if (refine && found.level == u.level) {
        atomicAdd(changed[found.node], u.round == 0 ? u.at_first : 1u);
    }
}
)";

/// What of a round's map the samples see.
void add_look(const FrameInput& input, const Recipe& recipe, const LightViews& views, TextureHandle depth,
              TextureHandle lit, BufferHandle changed, const GnTreeConstants& t, int round, bool edges) {
    ShaderInputs inputs = sample_inputs(input, recipe, views);
    inputs.texture("sampler2DArray", "drawn_depth", depth).buffer("buffer", "Changed", "uint changed[];", changed);
    if (!edges) {
        inputs.image("r32f", "", "image2D", "lit_before", lit);
    }
    inputs.constant("int", "round", round).constant("int", "level", t.limit);
    inputs.constant("uint", "at_first", edges ? 1U : static_cast<std::uint32_t>(std::max(t.threshold + 1, 1)));
    const std::string defines = receiver_defines(recipe, views);
    // What is known of the light differs from light to light.
    const std::string functions = sample_functions(input, recipe, views);
    const auto shader =
        compute_once(input.prepared, "adaptive look", hashed(inputs).text(defines).text(functions), [&] {
            return (edges ? "#define GN_REFINE_EDGES\n" : "") + defines + include_line("shadow/view/view.glsl") +
                   placement_text(*views.part, recipe) + inputs.text() + functions + look_text;
        });
    add_pixel_pass(input.graph, "adaptive look", inputs, shader, input.samples.width, input.samples.height);
}

}  // namespace

BufferHandle add_refinement(const FrameInput& input, const Recipe& recipe, const GnTreeConstants& constants, int rounds,
                            bool edges, const TilesOf& tiles_of) {
    FrameGraph& graph = input.graph;
    const BufferHandle changed =
        graph.create({.name = "adaptive changes", .bytes = static_cast<VkDeviceSize>(constants.nodes) * 4});
    const TextureHandle lit = graph.create({.name = "adaptive lit",
                                            .format = VK_FORMAT_R32_SFLOAT,
                                            .width = input.samples.width,
                                            .height = input.samples.height});
    add_zeros(graph, "adaptive unchanged", {changed});
    for (int round = 0; round < rounds; ++round) {
        GnTreeConstants t = constants;
        t.limit = constants.start + round;
        const LightViews views = tiles_of(t, changed, round);
        const TextureHandle depth = graph.create({.name = "adaptive round",
                                                  .format = VK_FORMAT_D32_SFLOAT,
                                                  .width = views.resolution,
                                                  .height = views.resolution,
                                                  .layers = views.layers});
        add_caster_passes(input, recipe, views, {.name = "adaptive round", .depth = depth});
        add_look(input, recipe, views, depth, lit, changed, t, round, edges);
    }
    return changed;
}

}  // namespace gn::adaptive
