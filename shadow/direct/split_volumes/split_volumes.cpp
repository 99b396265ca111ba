// SPDX-License-Identifier: MIT
// Shadow volumes counted before the near samples of a tile and behind the far ones.
//
// Based on: Laine. Split-plane Shadow Volumes. Graphics Hardware 2005. [Lai05]
// Departs from it: a tile of the view has one depth that splits it, of all volumes, where the original has a plane a volume; what
// shades the near rectangle is counted behind the samples.
//
// The passes stand in shadow/geometry.
#include "shadow/direct/split_volumes/split_volumes.h"

#include "shadow/geometry/volume_passes.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn::parts::split_volumes {
namespace {

constexpr const char* tile_text = R"(
layout(location = 0) out float split;
void main() {
    // Look at 8 by 8 of the tile's samples: whatever the depth is, the count is the same.
    ivec2 first = ivec2(gl_FragCoord.xy) * u.tile, size = textureSize(depth, 0);
    float nearest = 0.0, farthest = 1.0;
    for (int i = 0; i < 64; ++i) {
        float z = texelFetch(depth, min(first + ivec2(i & 7, i >> 3) * u.tile / 8, size - 1), 0).r;
        nearest = max(nearest, z);
        farthest = z > 0.0 ? min(farthest, z) : farthest;
    }
    split = gn_split_volumes_depth(nearest, farthest);
}
)";

constexpr const char* depth_mark_text = R"(
bool volume_marked(ivec2 pixel) {
    return texelFetch(depth, pixel, 0).r > texelFetch(splits, pixel / u.tile, 0).r;
}
)";

constexpr const char* random_mark_text = R"(
bool volume_marked(ivec2 pixel) { return gn_split_volumes_coin(pixel); }
)";

TextureHandle add_splits(const FrameInput& input, int tile) {
    const ViewSamples& samples = input.samples;
    const auto side = static_cast<std::uint32_t>(tile);
    const TextureHandle splits = input.graph.create(TextureDesc{.name = "splitting depths",
                                                                .format = VK_FORMAT_R32_SFLOAT,
                                                                .width = (samples.width + side - 1) / side,
                                                                .height = (samples.height + side - 1) / side});
    ShaderInputs inputs;
    inputs.texture("sampler2D", "depth", lent(samples.depth, "depth")).constant("int", "tile", tile);
    const auto pipeline = made_once(input.prepared, "splitting depths", hashed(inputs).finish().low, [&] {
        return sealed(
            fullscreen({ShaderKind::fragment, "split-volumes.frag",
                        include_line("shadow/direct/split_volumes/split_volumes.glsl") + inputs.text() + tile_text}));
    });
    input.graph.add_pass(
        "split-volumes: depths",
        [&](PassBuilder& pass) {
            pass.color(splits, Load::clear);
            inputs.declare(pass);
        },
        [inputs, pipeline](Recorder& r) {
            r.bind(*pipeline);
            inputs.set(r);
            r.draw(3);
        });
    return splits;
}

VolumeMarks near_samples(const FrameInput& input, const GnSplitVolumesParams& params) {
    VolumeMarks marks;
    marks.types = include_line("shadow/direct/split_volumes/split_volumes.glsl");
    if (params.split == GN_SPLIT_VOLUMES_RANDOM) {
        marks.text = random_mark_text;
        return marks;
    }
    marks.inputs.texture("sampler2D", "depth", lent(input.samples.depth, "depth"))
        .texture("sampler2D", "splits", add_splits(input, params.tile))
        .constant("int", "tile", params.tile);
    marks.text = depth_mark_text;
    return marks;
}

Visibility add_split_volumes(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnSplitVolumesParams>("split-volumes");
    const VolumeBuffers buffers =
        import_volume_buffers(input, {.mode = VolumeMode::split, .skip_masked = params.alpha != 0});
    add_facing(input, buffers);
    add_silhouettes(input, buffers);
    const VolumeMarks marks = near_samples(input, params);
    const TextureHandle receivers = add_receivers(input, buffers, true);
    const TextureHandle counts = add_counts(input, buffers, receivers, &marks);
    Visibility visibility = add_count_resolve(input, counts, {.masked = params.alpha != 0});
    add_volume_sides(input, buffers, receivers, counts, visibility);
    return visibility;
}

}  // namespace
}  // namespace gn::parts::split_volumes

namespace gn::parts {

const Part& direct_split_volumes() {
    using namespace split_volumes;
    static const Part part = [] {
        Part p;
        p.id = "split-volumes";
        p.stage = Stage::direct;
        p.title = "Split-plane shadow volumes";
        p.citation = "Lai05";
        p.features = {Feature::float32_blend};
        p.needs_scene = true;
        p.sides = volume_sides();
        p.params = param_table<GnSplitVolumesParams>({
            GN_CHOICE(GnSplitVolumesParams, split,
                      "By depth: samples nearer than their tile's middle count what lies before them, the others what "
                      "lies behind; random: a coin decides, which changes the cost and not the picture.",
                      "depth", "random"),
            GN_PARAM(GnSplitVolumesParams, tile, integer, 8, 1024, "pixels",
                     "Side of the tiles that share a splitting depth."),
            GN_PARAM(GnSplitVolumesParams, alpha, boolean, 0, 1, "",
                     "Asks masked polygons for their alpha; off lets them cast as a whole."),
        });
        p.params_type = "GnSplitVolumesParams";
        p.glsl = "shadow/direct/split_volumes/split_volumes.glsl";
        p.add_direct = add_split_volumes;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
