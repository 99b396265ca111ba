// SPDX-License-Identifier: MIT
// Every triangle takes from every view sample the points of the light that it hides from it, as bits of a mask.
//
// Based on: Sintorn, Eisemann, Assarsson. Sample Based Visibility for Soft Shadows using Alias-free Shadow Maps. EGSR 2008. [SEA08]
// Based on: Eisemann, Decoret. Visibility Sampling on GPU and Applications. Eurographics 2007. [ED07]
// Departs from it: triangles find samples through a tree of boxes over the lists, and points near an edge may be asked
// themselves, whose answer is the truth's.
//
// Stands on: shadow/placement/place, shadow/direct/irregular_z (a sample's texel, what it refuses)
// Also here: view_samples_lists.h, view_samples_lists.cpp, view_samples_table.h, view_samples_table.cpp, view_samples_walk.h,
// view_samples_walk.cpp, view_samples_walk.glsl, view_samples_pictures_test.cpp.
#include "shadow/direct/view_samples/view_samples.h"

#include "gpu/zeros_pass.h"
#include "shadow/direct/irregular_z/irregular_z_pairs.h"
#include "shadow/direct/view_samples/view_samples_walk.h"
#include "shadow/frame/frame.h"
#include "shadow/placement/place.h"
#include "shadow/receiver/line_pass.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/receiver/sent_points.h"
#include "shadow/recipe/prepared.h"

#include <algorithm>
#include <cmath>

namespace gn::parts::view_samples {
namespace {

constexpr int most_points = 1024;  ///< of all patterns

// What a sample's own surface hides is hidden, and so is what a sphere does not show it; bits behind the last point are no points.
constexpr const char* horizon_text = R"(
layout(local_size_x = 64) in;
void main() {
    uint place = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
    if (place >= used) {
        return;
    }
    uvec4 at = points[2u * place];
    vec3 p_ws = uintBitsToFloat(at.xyz);
    vec3 n_ws = uintBitsToFloat(points[2u * place + 1u].xyz);
    uint first = pattern_of(at.w) * u.count;
    for (uint word = 0u; word < GN_WORDS; ++word) {
        uint bits = 0u;
        for (uint i = 0u; i < 32u; ++i) {
            GnLight one = u.whole;
            one.position_ws = light_points[first + min(32u * word + i, u.count - 1u)];
            bool seen = dot(n_ws, gn_towards(p_ws, one.position_ws)) > 0.0 && gn_point_weight(u.whole, one, p_ws) > 0.0;
            bits |= seen && 32u * word + i < u.count ? 0u : 1u << i;
        }
        hidden[place * GN_WORDS + word] = bits;
    }
}
)";

// [EASW09] section 5.3.3: V is the share of points that are left, of a sphere by what they weigh, of a picture by what they send.
constexpr const char* resolve_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(visibility)))) {
        return;
    }
    uint index = uint(pixel.y) * u.width + uint(pixel.x);
    uint place = entries[index].x;
    GN_V sum = GN_V(0.0);
    GN_V weights = GN_V(place == 0u ? 1.0 : 0.0);
    for (uint word = 0u; word < GN_WORDS && place != 0u; ++word) {
        uint bits = hidden[(place - 1u) * GN_WORDS + word];
#if GN_WEIGHTED
        vec3 p_ws = gbuffer_position_texel(pixel).xyz;
        for (uint i = 0u; i < min(u.count - 32u * word, 32u); ++i) {
            GnLight one = u.whole;
            uint point = pattern_of(index) * u.count + 32u * word + i;
            one.position_ws = light_points[point];
            GN_V weight = gn_point_weight(u.whole, one, p_ws) * GN_SENT(point);
            weights += weight;
            sum += (bits & (1u << i)) == 0u ? weight : GN_V(0.0);
        }
#else
        sum += float(32 - bitCount(bits));
        weights = float(u.count);
#endif
    }
    imageStore(visibility, pixel, GN_V_TEXEL(weights == GN_V(0.0) ? GN_V(1.0) : min(sum / weights, GN_V(1.0))));
}
)";

// Of the points that the light shows the sample, those that are hidden.
constexpr const char* hidden_share_text = R"(
float gn_hidden_share(uint place) {
    uint left = 0u;
    for (uint word = 0u; word < GN_WORDS; ++word) {
        left += bitCount(~hidden[place * GN_WORDS + word]);
    }
    return 1.0 - float(left) / float(u.count);
}
)";

void add_horizon(const MappedSamples& m) {
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Points", "uvec4 points[];", m.sorted.points)
        .buffer("readonly buffer", "Used", "uint used;", m.sorted.used)
        .buffer("writeonly buffer", "Hidden", "uint hidden[];", m.hidden);
    add_mapped_points(m, inputs);
    const std::string before = mapped_defines(m);
    const auto shader = compute_once(m.input.prepared, "view-samples: horizon", hashed(inputs).text(before),
                                     [&] { return before + inputs.text() + pattern_text + horizon_text; });
    add_line_pass(m.input.graph, "view-samples: horizon", inputs, shader, m.sorted.pixels);
}

Visibility add_resolve_points(const MappedSamples& m) {
    const SentPoints sent = sent_by_points(m.input, static_cast<int>(m.samples.points.size()), m.samples.side);
    const uint channels = channels_of(sent);
    Visibility result{create_visibility(m.input.graph, m.input.samples, channels)};
    ShaderInputs inputs;
    add_gbuffer(inputs, m.input.device, m.input.samples);
    inputs.buffer("readonly buffer", "Entries", "uvec2 entries[];", m.sorted.entries)
        .buffer("readonly buffer", "Hidden", "uint hidden[];", m.hidden)
        .image(channels == 1 ? "r32f" : "rgba32f", "writeonly", "image2D", "visibility", result.image);
    add_mapped_points(m, inputs);
    add_sent_points(inputs, sent);
    const std::string before =
        mapped_defines(m) + sent_text(sent) + fmt::format("#define GN_WEIGHTED (GN_SPHERE || {:d})\n", sent != nullptr);
    const auto shader = compute_once(m.input.prepared, "view-samples: resolve", hashed(inputs).text(before),
                                     [&] { return before + inputs.text() + pattern_text + resolve_text; });
    add_pixel_pass(m.input.graph, "view-samples: resolve", inputs, shader, m.input.samples.width,
                   m.input.samples.height);
    return result;
}

/// Numbers beside V, where they are asked for.
constexpr const char* told_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(told)))) {
        return;
    }
    uvec2 entry = entries[uint(pixel.y) * u.width + uint(pixel.x)];
    float value = 0.0;
    if (entry.x != 0u) {
        uint place = entry.x - 1u;
        value = TOLD;
    }
    imageStore(told, pixel, vec4(value));
}
)";

void add_told(const MappedSamples& m, Visibility& result, std::string_view name, const std::string& value) {
    if (!holds(m.input.sides, name)) {
        return;
    }
    const TextureHandle image = m.input.graph.create(TextureDesc{.name = "view-samples " + std::string(name),
                                                                 .format = VK_FORMAT_R32_SFLOAT,
                                                                 .width = m.input.samples.width,
                                                                 .height = m.input.samples.height});
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Entries", "uvec2 entries[];", m.sorted.entries)
        .buffer("readonly buffer", "Hidden", "uint hidden[];", m.hidden)
        .image("r32f", "writeonly", "image2D", "told", image);
    if (m.asked.valid()) {
        inputs.buffer("readonly buffer", "Asked", "uint asked[];", m.asked);
    }
    add_mapped_points(m, inputs);
    const std::string before = mapped_defines(m);
    const auto shader =
        compute_once(m.input.prepared, "view-samples: told", hashed(inputs).text(before).text(value), [&] {
            std::string text = told_text;
            text.replace(text.find("TOLD"), 4, value);
            return before + inputs.text() + hidden_share_text + text;
        });
    add_pixel_pass(m.input.graph, "view-samples: told", inputs, shader, m.input.samples.width, m.input.samples.height);
    result.sides.push_back({std::string(name), image, {}});
}

/// Pictures whose lists, trees and bits no storage block holds are refused before any is made.
void check_size(const FrameInput& input, std::uint32_t words, int points) {
    const std::uint64_t samples = std::uint64_t{input.samples.width} * input.samples.height;
    const std::uint64_t bytes = input.device.properties().limits.maxStorageBufferRange;
    const std::uint64_t by_words = bytes / (words * sizeof(std::uint32_t));
    const std::uint64_t most = std::min(SortedSamples::most_places(bytes), by_words);
    if (samples > most) {
        refuse(
            "direct 'view-samples' lists {} x {} view samples with {} points of the light each, and storage blocks of "
            "device '{}' of {} bytes hold {} of them; a smaller picture fits{}",
            input.samples.width, input.samples.height, points, input.device.info().name, bytes, most,
            by_words < samples && words > 1 ? ", or a smaller view-samples.samples" : "");
    }
}

Visibility add_view_samples_part(const FrameInput& input, const Recipe& recipe) {
    MappedSamples m{.input = input, .params = recipe.of<GnViewSamplesParams>("view-samples")};
    m.samples =
        light_samples(input.light().shape, m.params.samples * m.params.patterns * m.params.patterns, m.params.patterns);
    m.points = points_ws(m.samples);
    m.words = (static_cast<std::uint32_t>(m.params.samples) + 31) / 32;
    check_size(input, m.words, m.params.samples);

    // Samples stand in the lists of texels, and begin with what their own surface hides.
    m.sorted = add_sorted_samples(input, recipe, place_views(input, recipe), light_axes(input.light().shape));
    const auto create = [&](const char* name, VkDeviceSize words) {
        return input.graph.create(BufferDesc{.name = name, .bytes = words * sizeof(std::uint32_t)});
    };
    m.hidden = create("view-samples hidden", VkDeviceSize{m.sorted.pixels} * m.words);
    if (holds(input.sides, "asked-triangles")) {
        m.asked = create("view-samples asked", m.sorted.pixels);
        add_zeros(input.graph, "view-samples: none asked", {m.asked});
    }
    add_horizon(m);

    // Every triangle adds what it hides.
    add_walk(m, false);
    add_walk(m, true);
    Visibility result = add_resolve_points(m);
    add_told(m, result, "hidden-samples", "gn_hidden_share(place)");
    add_told(m, result, "list-length", "float(entry.y)");
    add_told(m, result, "asked-triangles", "float(asked[place])");
    return result;
}

std::string refuses(const Scene& /*scene*/, const Light& light, const Recipe& recipe) {
    const auto params = recipe.of<GnViewSamplesParams>("view-samples");
    if (params.samples * params.patterns * params.patterns > most_points) {
        return fmt::format(
            "direct 'view-samples' knows {} points of a light, and {} patterns of {} are {}; view-samples.samples is "
            "at most "
            "{} with these patterns",
            most_points, params.patterns * params.patterns, params.samples,
            params.samples * params.patterns * params.patterns, most_points / (params.patterns * params.patterns));
    }
    return refuses_bent(
        light, recipe,
        "direct 'view-samples' lists samples in texels of a view that a matrix gives, and placement '{}' "
        "bends its views");
}

}  // namespace
}  // namespace gn::parts::view_samples

namespace gn::parts {

const Part& direct_view_samples() {
    using namespace view_samples;
    static const Part part = [] {
        Part p;
        p.id = "view-samples";
        p.stage = Stage::direct;
        p.title = "View-sample mapping";
        p.citation = "SEA08";
        p.needs_scene = true;
        p.params = param_table<GnViewSamplesParams>({
            GN_PARAM(GnViewSamplesParams, samples, integer, 1, most_points, "",
                     "Finer steps in penumbrae; each 32 take a word more a view sample, and a look at it a triangle."),
            GN_CHOICE(
                GnViewSamplesParams, test,
                "exact hides the points that rays to them find hidden; table takes them from the left-sample map, an "
                "edge up to 0.71 / offsets + 2.23 / angles of the light's side off.",
                "exact", "table"),
            GN_PARAM(
                GnViewSamplesParams, angles, integer, 8, 1024, "texels",
                "Of the left-sample map around: finer edges with test=table, fewer points asked one by one with exact; "
                "of a sphere's map times half as many."),
            GN_PARAM(GnViewSamplesParams, offsets, integer, 8, 1024, "texels", "The same across the light."),
            GN_PARAM(
                GnViewSamplesParams, patterns, integer, 1, 8, "pixels",
                "Side of the square whose pixels each take other points of the light: noise for a filter of V instead "
                "of steps."),
            GN_PARAM(GnViewSamplesParams, closed, boolean, 0, 1, "",
                     "Leaves out faces of solids that all of the light sees, which costs less; light leaks to samples "
                     "that lie "
                     "inside a solid, or in the plane of its face, as off does not let it."),
        });
        p.params_type = "GnViewSamplesParams";
        p.glsl = "shadow/direct/view_samples/view_samples.glsl";
        p.reads = {"placement", "resolution"};
        p.sides = {
            {"hidden-samples", "", "Share of the light's points that casters or the sample's own surface hide."},
            {"list-length", "", "View samples, or triangles, in the list of the texel that a sample falls into."},
            {"asked-triangles", "", "Triangles that asked which points of the light they hide from the sample."}};
        p.add_direct = add_view_samples_part;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
