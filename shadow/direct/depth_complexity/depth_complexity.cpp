// SPDX-License-Identifier: MIT
// A counter for each of some points of the light: silhouette edges add to those on one side of them, so that a counter becomes the
// number of surfaces before its point, and the point is seen where there is none.
//
// Based on: Laine, Aila, Assarsson, Lehtinen, Akenine-Moller. Soft Shadow Volumes for Ray Tracing. ACM TOG 2005. [LAAL05]
// Based on: Forest, Barthe, Paulin. Accurate Shadows by Depth Complexity Sampling. CGF 2008. [FBP08]
// Departs from them: counters are integers in a buffer, to which fragments add in any order, not bits of blended floats; edges are
// asked with the triangles beside them, from the sample, and the constant is that of volumes from one point or three.
//
// Also here: depth_complexity_edges.h, depth_complexity_edges.cpp, depth_complexity_edge.glsl, depth_complexity_resolve.glsl.
#include "shadow/direct/depth_complexity/depth_complexity.h"

#include "gpu/zeros_pass.h"
#include "shadow/direct/depth_complexity/depth_complexity_edges.h"
#include "shadow/frame/frame.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/edge_regions.h"
#include "shadow/geometry/masked_tree.h"
#include "shadow/geometry/seen_light.glsl"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/receiver/sent_points.h"
#include "shadow/recipe/prepared.h"
#include "shadow/scene/light_samples.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace gn::parts::depth_complexity {
namespace {

constexpr const char* part_include = "#include \"shadow/direct/depth_complexity/depth_complexity.glsl\"\n";
/// Points of the light, and what fills the last word.
constexpr std::size_t most_points = 256 + 8;
/// Places on a light, in its half widths, whose volumes are counted: off its axes and its centre, through which edges of symmetric
/// scenes pass, and around it, so that one lies well above any horizon that the centre is above. The last is that of one vote.
constexpr std::array<vec2, 4> reference_places{vec2(0.42F, 0.15F), vec2(-0.34F, 0.29F), vec2(-0.08F, -0.44F),
                                               vec2(0.031F, 0.047F)};

/// Of a view sample's counters.
struct Counters {
    std::uint32_t samples = 0;  ///< points of the light; those of the references stand behind them
    std::uint32_t bits = 8;
    std::uint32_t fields = 4;                ///< in a word
    std::uint32_t words = 0;                 ///< a view sample
    std::array<vec4, most_points> points{};  ///< x and y: on the light's plane, in the square from -1 to 1
    std::vector<GnLight> references;         ///< points of the light, without extent
    BufferHandle buffer;                     ///< words of all view samples, row by row
};

/// Where the light's points are, seen on its plane: the same from everywhere, so that the light may stand at the origin, and is seen
/// from as far below as it is wide.
vec2 on_plane(const GnLight& light, const GnLight& point) {
    GnLight here = light;
    here.position_ws = vec4(0, 0, 0, 1);
    const bool sun = light.kind == GN_LIGHT_DIRECTIONAL;
    const vec2 size = glsl::gn_light_half_size(light);
    const vec3 below_ws = vec3(light.direction_ws) * (sun ? 1.0F : std::max(size.x, size.y));
    const vec3 point_ws =
        sun ? -vec3(point.direction_ws) : vec3(point.position_ws) - vec3(light.position_ws) - below_ws;
    return glsl::gn_on_light(glsl::gn_seen_light(here, below_ws), point_ws);
}

/// A place on the light as a light of its own.
GnLight reference_of(const GnLight& light, vec2 place) {
    const vec2 at = place * glsl::gn_light_half_size(light);
    vec3 x_ws(light.right_ws);
    vec3 y_ws(light.up_ws);
    if (light.kind != GN_LIGHT_RECTANGLE) {
        glsl::gn_across(vec3(light.direction_ws), x_ws, y_ws);
    }
    GnLight one = light;
    one.radius = one.angular_radius = one.range = 0;
    one.half_size = vec2(0);
    if (light.kind == GN_LIGHT_DIRECTIONAL) {
        one.direction_ws = vec4(glm::normalize(vec3(light.direction_ws) + at.x * x_ws + at.y * y_ws), 0);
        return one;
    }
    one.kind = GN_LIGHT_POINT;
    one.position_ws = vec4(vec3(light.position_ws) + at.x * x_ws + at.y * y_ws, 1);
    return one;
}

Counters counters_of(const GnLight& given, const GnDepthComplexityParams& params) {
    // A sphere is the disc that the sample sees, and faces it.
    GnLight light = given;
    if (light.kind == GN_LIGHT_POINT) {
        light.kind = GN_LIGHT_SPOT;
        light.direction_ws = vec4(0, -1, 0, 0);
    }
    Counters counters{.samples = static_cast<std::uint32_t>(params.samples)};
    const bool three = params.votes == GN_DEPTH_COMPLEXITY_THREE;
    for (std::size_t i = three ? 0 : 3; i < (three ? 3U : 4U); ++i) {
        counters.references.push_back(reference_of(light, reference_places.at(i)));
    }
    counters.bits = params.bits == GN_DEPTH_COMPLEXITY_BITS_8 ? 8 : 16;
    counters.fields = 32 / counters.bits;
    const auto all = counters.samples + static_cast<std::uint32_t>(counters.references.size());
    counters.words = (all + counters.fields - 1) / counters.fields;
    const std::vector<GnLight> points = light_samples(light, params.samples).points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        counters.points.at(i) = vec4(on_plane(light, points[i]), 0, 0);
    }
    return counters;
}

std::string defines_of(const Counters& counters) {
    return fmt::format("#define GN_DEPTH_BITS {}u\n#define GN_DEPTH_FIELDS {}u\n", counters.bits, counters.fields);
}

/// What the edges' and the resolve pass both read.
void add_counters(ShaderInputs& inputs, const Counters& counters, const char* access) {
    inputs.buffer(access, "Counters", "uint counters[];", counters.buffer)
        .block("uniform", "Points", fmt::format("vec4 points[{}];", most_points),
               std::as_bytes(std::span(counters.points)))
        .constant("uint", "words", counters.words)
        .constant("uint", "samples", counters.samples);
    for (std::size_t i = 0; i < 3; ++i) {
        const GnLight& reference = counters.references[std::min(i, counters.references.size() - 1)];
        inputs.constant("vec4", fmt::format("reference{}_ws", i), light_point_ws(reference));
    }
}

void add_empty(const FrameInput& input, Counters& counters) {
    const std::uint64_t bytes =
        std::uint64_t{input.samples.width} * input.samples.height * counters.words * sizeof(std::uint32_t);
    if (const std::uint64_t most = input.device.properties().limits.maxStorageBufferRange; bytes > most) {
        refuse(
            "direct 'depth-complexity' needs {} bytes for {} counters of {} bits at {} x {} view samples, and a "
            "storage "
            "block of device '{}' holds {}; a smaller depth-complexity.samples fits",
            bytes, counters.samples + counters.references.size(), counters.bits, input.samples.width,
            input.samples.height, input.device.info().name, most);
    }
    counters.buffer = input.graph.create(BufferDesc{.name = "depth-complexity counters", .bytes = bytes});
    add_zeros(input.graph, "depth-complexity: none", {counters.buffer});
}

/// Lets the edges count; gives how many surfaces begin or end before each sample's light.
TextureHandle add_edges(const FrameInput& input, const VolumeBuffers& edges, const Counters& counters) {
    const std::string includes = defines_of(counters) + part_include;
    EdgeRegionPass pass{.name = "depth-complexity: edges' counts",
                        .includes = includes,
                        .functions = "",
                        .fragment = "#include \"shadow/direct/depth_complexity/depth_complexity_edge.glsl\"\n",
                        .result = "float",
                        .extra = {},
                        // The square in which points are counted, of a disc however it is turned.
                        .growth = input.light().shape.kind == GN_LIGHT_RECTANGLE ? 1.0F : 1.4143F};
    pass.extra.buffer("readonly buffer", "Indices", "uint indices[];", input.handles.indices)
        .buffer("readonly buffer", "First", "uint first[];", edges.first)
        .buffer("readonly buffer", "Around", "uint around[];", edges.around)
        .buffer("readonly buffer", "Owners", "uint owners[];", edges.owners)
        .block("readonly buffer", "Forms", "uint forms[];", std::as_bytes(std::span(edges.forms)))
        .constant("GnLight", "light", input.light().shape)
        .constant("int", "width", static_cast<int>(input.samples.width));
    add_counters(pass.extra, counters, "buffer");
    const TextureHandle met = input.graph.create(TextureDesc{.name = "depth-complexity edges met",
                                                             .format = VK_FORMAT_R32_SFLOAT,
                                                             .width = input.samples.width,
                                                             .height = input.samples.height});
    add_edge_regions(input, edges, pass, met, {});
    return met;
}

/// How many volumes of the references' hard shadows hold the samples.
std::vector<TextureHandle> add_references(const FrameInput& input, const Counters& counters,
                                          const GnDepthComplexityParams& params) {
    std::vector<TextureHandle> counts;
    for (const GnLight& reference : counters.references) {
        Light point = input.light();
        point.shape = reference;
        FrameInput moved = input;
        moved.parent = &input.whole_light();
        moved.source = &point;
        counts.push_back(add_hard_shadow(moved, params.closed != 0).counts);
    }
    return counts;
}

/// Of how many samples more edges met the light than counters hold, and how many edges at most.
BufferHandle add_crowded(const FrameInput& input) {
    const BufferHandle crowded =
        input.graph.create(BufferDesc{.name = "depth-complexity crowded", .bytes = 2 * sizeof(std::uint32_t)});
    add_zeros(input.graph, "depth-complexity: none is crowded", {crowded});
    return crowded;
}
void tell_crowded(const FrameInput& input, const Counters& counters, BufferHandle crowded) {
    input.graph.answer(crowded, [bits = counters.bits, remarks = input.late_remarks](std::span<const std::byte> bytes) {
        std::array<std::uint32_t, 2> told{};
        std::memcpy(told.data(), bytes.data(), sizeof told);
        if (told[0] > 0 && remarks != nullptr) {
            remarks->insert(fmt::format(
                "direct 'depth-complexity': {} view samples meet up to {} edges before the light, and counters of {} "
                "bits are sure to hold {}; {}",
                told[0], told[1], bits, (1 << (bits - 1)) - 1,
                bits == 8 ? "depth-complexity.bits=16 holds more" : "fewer casters, or a smaller light, have fewer"));
        }
    });
}

/// GLSL of the three numbers of which the constant is voted.
std::string votes_text(std::size_t references) {
    const auto vote = [](int i) {
        return fmt::format("int(volumes{0}_texel(pixel).r) - counter_of(word, u.samples + {0}u)", i);
    };
    return references < 3 ? fmt::format("ivec3({})", vote(0))
                          : fmt::format("ivec3({}, {}, {})", vote(0), vote(1), vote(2));
}

std::string resolve_defines(const Counters& counters, std::size_t votes, bool masks, bool centre, bool told) {
    const char* const hides = "masked_hides(p_ws, n_ws, at_ws)";
    return defines_of(counters) + fmt::format(
                                      "#define GN_DEPTH_VOTES {}\n#define GN_DEPTH_MASKED(at_ws) {}\n"
                                      "#define GN_DEPTH_MASKED_CENTRE(at_ws) {}\n#define GN_DEPTH_TELL {}\n",
                                      votes_text(votes), masks && !centre ? hides : "false",
                                      masks && centre ? hides : "false",
                                      told ? "imageStore(surfaces, pixel, vec4(float(most)));" : "");
}

Visibility add_resolve(const FrameInput& input, const Counters& counters, const GnDepthComplexityParams& params,
                       TextureHandle met, const std::vector<TextureHandle>& volumes) {
    const SentPoints sent = sent_by_points(input, static_cast<int>(counters.samples));
    const uint channels = channels_of(sent);
    Visibility result{create_visibility(input.graph, input.samples, channels)};
    const BufferHandle crowded = add_crowded(input);
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, input.samples);
    inputs.texels(input.device, VK_FORMAT_R32_SFLOAT, "2D", "edges", met);
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        inputs.texels(input.device, VK_FORMAT_R32_SFLOAT, "2D", fmt::format("volumes{}", i), volumes[i]);
    }
    inputs.image(channels == 1 ? "r32f" : "rgba32f", "writeonly", "image2D", "visibility", result.image)
        .buffer("buffer", "Crowded", "uint crowded_samples; uint crowded_edges;", crowded)
        .constant("GnLight", "light", input.light().shape)
        .constant("GnLight", "whole", input.whole_light().shape)
        .constant("float", "limit", static_cast<float>((1 << (counters.bits - 1)) - 1));
    add_counters(inputs, counters, "readonly buffer");
    add_sent_points(inputs, sent);
    const bool told = holds(input.sides, "depth-complexity");
    if (told) {
        const TextureHandle surfaces = create_visibility(input.graph, input.samples);
        inputs.image("r32f", "writeonly", "image2D", "surfaces", surfaces);
        result.sides.push_back({"depth-complexity", surfaces, {}});
    }
    const std::optional<MaskedTree> tree = MaskedTree::of(input);
    if (tree) {
        tree->add_to(inputs, input);
    }
    const std::string defines =
        resolve_defines(counters, volumes.size(), tree.has_value(), params.masked == GN_DEPTH_COMPLEXITY_CENTRE, told) +
        sent_text(sent);
    const auto shader = compute_once(input.prepared, "depth-complexity: resolve", hashed(inputs).text(defines), [&] {
        return (tree ? MaskedTree::types(input.device) : "") + defines + part_include + inputs.text() +
               (tree ? MaskedTree::functions() : "") +
               "#include \"shadow/direct/depth_complexity/depth_complexity_resolve.glsl\"\n";
    });
    add_pixel_pass(input.graph, "depth-complexity: resolve", inputs, shader, input.samples.width, input.samples.height);
    tell_crowded(input, counters, crowded);
    return result;
}

Visibility add_depth_complexity(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnDepthComplexityParams>("depth-complexity");
    if (!has_extent(input.light().shape)) {
        HardShadow hard = add_hard_shadow(input, params.closed != 0);
        add_edge_sides(input, hard.buffers, 1, hard.visibility);
        return hard.visibility;
    }
    Counters counters = counters_of(input.light().shape, params);
    add_empty(input, counters);
    const VolumeBuffers edges = add_light_silhouettes(input, params.closed != 0);
    const TextureHandle met = add_edges(input, edges, counters);
    const std::vector<TextureHandle> volumes = add_references(input, counters, params);
    Visibility result = add_resolve(input, counters, params, met, volumes);
    add_edge_sides(input, edges, 1, result);
    return result;
}

std::vector<Side> sides() {
    std::vector<Side> all = edge_sides();
    all.push_back({"depth-complexity", "", "How many surfaces lie before that point of the light that has most."});
    return all;
}

std::string remark(const Scene& scene, const Recipe& recipe) {
    const auto params = recipe.of<GnDepthComplexityParams>("depth-complexity");
    return params.masked == GN_DEPTH_COMPLEXITY_CENTRE ? remark_masked(scene, "depth-complexity") : "";
}

}  // namespace
}  // namespace gn::parts::depth_complexity

namespace gn::parts {

const Part& direct_depth_complexity() {
    using namespace depth_complexity;
    static const Part part = [] {
        Part p;
        p.id = "depth-complexity";
        p.stage = Stage::direct;
        p.title = "Depth complexity sampling";
        p.citation = "LAAL05";
        p.features = {Feature::float32_blend};
        p.needs_scene = true;
        p.sides = sides();
        p.params = param_table<GnDepthComplexityParams>({
            GN_PARAM(GnDepthComplexityParams, samples, integer, 1, 256, "points",
                     "More points of the light: more steps of grey, more time and bytes."),
            GN_CHOICE(GnDepthComplexityParams, bits,
                      "Of a counter: 8 are sure to hold 127 edges before a light, 16 hold 32767 in twice the bytes.",
                      "8", "16"),
            GN_CHOICE(GnDepthComplexityParams, votes,
                      "Points of the light whose volumes say how many surfaces a counter of 0 stands for: one, or "
                      "three, of which "
                      "two are right where an edge passes the third.",
                      "one", "three"),
            GN_CHOICE(GnDepthComplexityParams, masked,
                      "Masked casters hide each point of the light by a ray, or all of it by one to the centre.",
                      "points", "centre"),
            GN_PARAM(GnDepthComplexityParams, closed, boolean, 0, 1, "",
                     "Solids cast with the half of their surface that light meets first; off counts every triangle."),
        });
        p.params_type = "GnDepthComplexityParams";
        p.glsl = "shadow/direct/depth_complexity/depth_complexity.glsl";
        p.add_direct = add_depth_complexity;
        p.remark = remark;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
