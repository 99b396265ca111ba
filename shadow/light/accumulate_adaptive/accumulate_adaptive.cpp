// SPDX-License-Identifier: MIT
// An area light as many points, no more than the picture needs: parts of the light whose points disagree about few view samples
// stay whole.
//
// Based on: Schwaerzler, Mattausch, Scherzer, Wimmer. Fast Accurate Soft Shadows with Adaptive Light Source Sampling. VMV 2012.
// [SMSW12]
// Departs from it: points lie within cells and not at their corners, so that a light in cells of one size is that of
// `accumulate`; what was counted divides the light of the next frame, and no query is waited for.
// Also here: light_tree.h, light_tree.cpp.
#include "shadow/light/accumulate_adaptive/accumulate_adaptive.h"

#include "gpu/zeros_pass.h"
#include "shadow/frame/history.h"
#include "shadow/light/accumulate_adaptive/light_tree.h"
#include "shadow/light/weighted.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"
#include "shadow/scene/light_samples.h"

#include <array>
#include <cstring>

namespace gn::parts::accumulate_adaptive {
namespace {

// The least and the greatest V of the four parts of a cell, one layer a level; after the fourth whoever sees them differ counts.
constexpr const char* watch_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
shared uint disagree_here;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    bool there = all(lessThan(pixel, ivec2(u.view.size.xy)));
    vec4 position = there ? gbuffer_position_texel(pixel) : vec4(0.0);
    vec3 n_ws = there ? gbuffer_normal_texel(pixel).xyz : vec3(0.0);
    bool counted = position.w > 0.5 && gn_counted(u.light, position.xyz, n_ws);
    bool weighs = counted && gn_point_weight(u.light, u.one, position.xyz) > 0.0;
    bool above = dot(n_ws, gn_to_light(u.one, position.xyz)) > 0.0;
    float v = weighs && above ? GN_LEAST(texelFetch(visibility, pixel, 0)) : 0.0;
    for (int level = 0; level < u.levels; ++level) {
        uint bit = 1u << level;
        if ((u.speaks & bit) == 0u) {
            continue;
        }
        barrier();
        disagree_here = 0u;
        barrier();
        if (counted) {
            vec2 range = (u.firsts & bit) != 0u ? vec2(2.0, -2.0) : imageLoad(ranges, ivec3(pixel, level)).rg;
            range = weighs ? vec2(min(range.x, v), max(range.y, v)) : range;
            imageStore(ranges, ivec3(pixel, level), vec4(range, 0.0, 0.0));
            if ((u.lasts & bit) != 0u && range.y - range.x > 1.0 / 256.0) {
                atomicAdd(disagree_here, 1u);
            }
        }
        barrier();
        if (gl_LocalInvocationIndex == 0u && disagree_here > 0u) {
            atomicAdd(disagree[u.parents[level]], disagree_here);
        }
    }
}
)";

/// What the frames of a sequence know of a light: the last tree that was answered for.
using LatestTree = std::shared_ptr<std::optional<SeenTree>>;

/// One frame's tree and where its counts go.
struct Watched {
    LightTree tree;
    std::vector<TreeLeaf> leaves;
    TextureHandle ranges;
    BufferHandle disagree;
};

GnAccumulateAdaptiveParams params_of(const Recipe& recipe) {
    return recipe.of<GnAccumulateAdaptiveParams>("accumulate-adaptive");
}

/// The tree of this frame: a single one has nobody to learn from.
LightTree tree_of(const FrameInput& input, const Recipe& recipe, LatestTree& latest) {
    const GnAccumulateAdaptiveParams params = params_of(recipe);
    if (input.history == nullptr) {
        return divided_to(params.levels, params.levels);
    }
    const std::string name = fmt::format("light tree of light {}", input.light_id);
    const auto* before = input.history->before<LatestTree>(name);
    latest = before != nullptr ? *before : std::make_shared<std::optional<SeenTree>>();
    input.history->leave(name, latest);
    if (!latest->has_value() || (*latest)->tree.levels != params.levels) {
        return divided_to(params.start, params.levels);
    }
    const double pixels = static_cast<double>(input.samples.width) * input.samples.height;
    return refined(**latest, static_cast<double>(params.threshold) * pixels);
}

std::vector<Light> lights_of(const Light& light, const std::vector<TreeLeaf>& leaves, int levels) {
    const std::vector<GnLight> points = light_samples(light.shape, 1 << (2 * levels)).points;
    std::vector<Light> lights;
    for (const TreeLeaf& leaf : leaves) {
        lights.push_back({.name = light.name, .shape = points.at(leaf.point), .spared = light.spared});
        lights.back().shape.intensity = leaf.share;
    }
    return lights;
}

/// Lets the V of one leaf speak for the cells that its point stands for.
void add_watch(const FrameInput& one, const Watched& watched, int index, TextureHandle visibility) {
    const TreeLeaf& leaf = watched.leaves.at(static_cast<std::size_t>(index));
    std::array<std::uint32_t, most_tree_levels> parents{};
    std::copy(leaf.parents.begin(), leaf.parents.end(), parents.begin());
    ShaderInputs inputs;
    inputs.constant("GnViewConstants", "view", one.samples.constants)
        .constant("GnLight", "light", one.whole_light().shape)
        .constant("GnLight", "one", one.light().shape)
        .constant("int", "levels", watched.tree.levels)
        .constant("uint", "speaks", leaf.speaks)
        .constant("uint", "firsts", leaf.first)
        .constant("uint", "lasts", leaf.last)
        .constant("uint", fmt::format("parents[{}]", parents.size()), parents);
    add_gbuffer(inputs, one.device, one.samples);
    inputs.texture("sampler2D", "visibility", visibility);
    inputs.image("rg32f", "", "image2DArray", "ranges", watched.ranges);
    inputs.buffer("buffer", "Disagree", "uint disagree[];", watched.disagree);
    const bool coloured = channels_of(one.graph, visibility) > 1;
    const auto shader = compute_once(one.prepared, "light: watch", hashed(inputs).value(coloured), [&] {
        return fmt::format("#define GN_LEAST(texel) {}\n",
                           coloured ? "min((texel).r, min((texel).g, (texel).b))" : "(texel).r") +
               "#include \"shadow/view/view.glsl\"\n#include \"shadow/scene/light_samples.h\"\n" + inputs.text() +
               watch_text;
    });
    add_pixel_pass(one.graph, "light: watch", inputs, shader, one.samples.width, one.samples.height);
}

/// Where the parts of cells are compared: after the frame the counts are those that the next trees are made of.
void begin_watch(const FrameInput& input, Watched& watched, const LatestTree& latest) {
    FrameGraph& graph = input.graph;
    watched.ranges = graph.create({.name = "light ranges",
                                   .format = VK_FORMAT_R32G32_SFLOAT,
                                   .width = input.samples.width,
                                   .height = input.samples.height,
                                   .layers = static_cast<std::uint32_t>(watched.tree.levels)});
    watched.disagree =
        graph.create({.name = "light disagree", .bytes = watched.tree.divided.size() * sizeof(std::uint32_t)});
    add_zeros(graph, "light: nobody disagrees", {watched.disagree});
    graph.answer(watched.disagree, [latest, tree = watched.tree](std::span<const std::byte> bytes) {
        SeenTree seen{tree, std::vector<std::uint32_t>(tree.divided.size())};
        std::memcpy(seen.disagree.data(), bytes.data(), seen.disagree.size() * sizeof(std::uint32_t));
        *latest = std::move(seen);
    });
}

Visibility add_light(const FrameInput& input, const Recipe& recipe,
                     const std::function<Visibility(const FrameInput&)>& serve) {
    if (light_samples(input.light().shape, 2).points.size() == 1) {
        return add_weighted(input, recipe, lights_of(input.light(), {TreeLeaf{}}, 0), serve);
    }
    LatestTree latest;
    const auto watched = std::make_shared<Watched>();
    watched->tree = tree_of(input, recipe, latest);
    watched->leaves = leaves_of(watched->tree);
    std::vector<Light> lights = lights_of(input.light(), watched->leaves, watched->tree.levels);
    if (latest == nullptr) {
        return add_weighted(input, recipe, std::move(lights), serve);
    }
    begin_watch(input, *watched, latest);
    return add_weighted(input, recipe, std::move(lights), serve,
                        [watched](const FrameInput& one, int index, const Visibility& visibility) {
                            add_watch(one, *watched, index, visibility.image);
                        });
}

std::string refuses(const Scene&, const Light& light, const Recipe& recipe) {
    return refuses_one_centre(light, recipe);
}

}  // namespace
}  // namespace gn::parts::accumulate_adaptive

namespace gn::parts {

const Part& light_accumulate_adaptive() {
    using namespace accumulate_adaptive;
    static const Part part = [] {
        Part p;
        p.id = "accumulate-adaptive";
        p.stage = Stage::light;
        p.title = "Soft shadows summed from as many points of the light as the picture needs";
        p.citation = "SMSW12";
        p.params = param_table<GnAccumulateAdaptiveParams>({
            GN_PARAM(GnAccumulateAdaptiveParams, levels, integer, 1, most_tree_levels, "",
                     "How often parts of the light may be quartered: 4^levels points at most."),
            GN_PARAM(
                GnAccumulateAdaptiveParams, start, integer, 1, most_tree_levels, "",
                "How often all of it is quartered in a sequence's first frame; later ones go a level further each."),
            GN_PARAM(
                GnAccumulateAdaptiveParams, threshold, real, 0, 1, "of the pixels",
                "Share of the picture's pixels whose V the quarters of a part must disagree about before these are "
                "quartered: fewer maps, coarser steps; 0 quarters all."),
        });
        p.params_type = "GnAccumulateAdaptiveParams";
        p.glsl = "shadow/light/accumulate_adaptive/accumulate_adaptive.glsl";
        p.add_light = add_light;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
