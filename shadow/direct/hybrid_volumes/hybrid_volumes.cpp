// SPDX-License-Identifier: MIT
// A shadow map, and shadow volumes where its texels disagree.
//
// Based on: Chan, Durand. An Efficient Hybrid Shadow Rendering Algorithm. EGSR 2004. [CD04]
// Departs from it: volumes are counted by components before or behind the samples, and masked casters by their texels.
//
// Stands on: shadow/placement/place (its map is placed as those of lookups are)
#include "shadow/direct/hybrid_volumes/hybrid_volumes.h"

#include "shadow/casters/raster.h"
#include "shadow/frame/frame.h"
#include "shadow/frame/map_memory.h"
#include "shadow/geometry/volume_passes.h"
#include "shadow/placement/place.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn::parts::hybrid_volumes {
namespace {

constexpr const char* seen_text = R"(
layout(location = 0) out float seen;
void main() {
    GnReceiver receiver;
    seen = 0.0;
    if (read_sample(ivec2(gl_FragCoord.xy), receiver)) {
        GnProjected projected = gn_project(receiver, views[GN_CHOOSE(receiver, placement).first], u.bias);
        seen = gn_hybrid_volumes_seen(projected, depth_map, u.bias, u.params.band);
    }
}
)";

constexpr const char* mark_text = R"(
bool volume_marked(ivec2 pixel) { return seen_texel(pixel).r > 1.0; }
)";

/// V by the map, or GN_HYBRID_VOLUMES_UNKNOWN.
TextureHandle add_seen(const FrameInput& input, const Recipe& recipe, const LightViews& views, TextureHandle depth,
                       const GnHybridVolumesParams& params) {
    const TextureHandle seen = create_visibility(input.graph, input.samples);
    ShaderInputs inputs = sample_inputs(input, recipe, views);
    inputs.texture("sampler2DArray", "depth_map", depth);
    inputs.constant("GnHybridVolumesParams", "params", params);
    const std::string defines = receiver_defines(recipe, views);
    const std::string functions = sample_functions(input, recipe, views);
    const std::uint64_t key = hashed(inputs).text(defines).text(functions).text(views.part->id).finish().low;
    const auto pipeline = made_once(input.prepared, "hybrid-volumes.frag", key, [&] {
        return sealed(
            fullscreen({ShaderKind::fragment, "hybrid-volumes.frag",
                        defines + include_line("shadow/view/view.glsl") + placement_text(*views.part, recipe) +
                            include_line("shadow/direct/hybrid_volumes/hybrid_volumes.glsl") + inputs.text() +
                            functions + seen_text}));
    });
    input.graph.add_pass(
        "hybrid-volumes: map",
        [&](PassBuilder& pass) {
            pass.color(seen, Load::clear);
            inputs.declare(pass);
        },
        [inputs, pipeline](Recorder& r) {
            r.bind(*pipeline);
            inputs.set(r);
            r.draw(3);
        });
    return seen;
}

Visibility add_hybrid_volumes(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnHybridVolumesParams>("hybrid-volumes");

    // Ask the map first.
    const LightViews views = place_views(input, recipe);
    const TextureHandle depth = input.graph.create(TextureDesc{.name = "map",
                                                               .format = VK_FORMAT_D32_SFLOAT,
                                                               .width = views.resolution,
                                                               .height = views.resolution,
                                                               .layers = views.layers});
    check_map_memory(input, recipe, depth);
    add_caster_passes(input, recipe, views, {.depth = depth});
    const TextureHandle seen = add_seen(input, recipe, views, depth, params);

    // Where it does not know, count volumes.
    const VolumeBuffers buffers =
        import_volume_buffers(input, {.mode = VolumeMode::cheapest, .skip_masked = params.alpha != 0});
    add_facing(input, buffers);
    add_silhouettes(input, buffers);
    VolumeMarks marks{.text = mark_text, .alone = true};
    marks.inputs.texels(input.device, VK_FORMAT_R32_SFLOAT, "2D", "seen", seen);
    const TextureHandle receivers = add_receivers(input, buffers, true);
    const TextureHandle counts = add_counts(input, buffers, receivers, &marks);
    Visibility visibility = add_count_resolve(input, counts, {.masked = params.alpha != 0, .known = seen});
    add_volume_sides(input, buffers, receivers, counts, visibility);
    return visibility;
}

}  // namespace
}  // namespace gn::parts::hybrid_volumes

namespace gn::parts {

const Part& direct_hybrid_volumes() {
    using namespace hybrid_volumes;
    static const Part part = [] {
        Part p;
        p.id = "hybrid-volumes";
        p.stage = Stage::direct;
        p.title = "Shadow volumes at a map's discontinuities";
        p.citation = "CD04";
        p.features = {Feature::float32_blend};
        p.needs_scene = true;
        p.sides = volume_sides();
        p.params = param_table<GnHybridVolumesParams>({
            GN_PARAM(GnHybridVolumesParams, band, integer, 1, 8, "texels",
                     "Texels on either side of a sample that must agree for the map to decide: wider catches thinner "
                     "casters and costs more volumes."),
            GN_PARAM(GnHybridVolumesParams, alpha, boolean, 0, 1, "",
                     "Asks masked polygons for their alpha at discontinuities; off lets them cast as a whole there."),
        });
        p.params_type = "GnHybridVolumesParams";
        p.glsl = "shadow/direct/hybrid_volumes/hybrid_volumes.glsl";
        p.reads = {"placement", "resolution", "bias"};
        p.add_direct = add_hybrid_volumes;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
