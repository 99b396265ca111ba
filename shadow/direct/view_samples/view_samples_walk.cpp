// SPDX-License-Identifier: MIT
// Based on: Sintorn, Eisemann, Assarsson. Sample Based Visibility for Soft Shadows using Alias-free Shadow Maps. EGSR 2008. [SEA08]
#include "shadow/direct/view_samples/view_samples_walk.h"

#include "gpu/upload.h"
#include "gpu/zeros_pass.h"
#include "shadow/casters/solids.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/occluders.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"
#include "shadow/scene/casting.h"

#include <cstring>

namespace gn {
namespace {

/// Triangles that follow each other; outward as SolidRun says it.
struct HidingRun {
    std::uint32_t first = 0, count = 0;
    int outward = 0;
};

/// A solid's face that all of the light sees hides nothing that its other faces do not: what goes in comes out.
std::vector<HidingRun> hiding_runs(const MappedSamples& m, bool masked) {
    const Scene& scene = m.input.scene;
    const std::vector<CasterKind> kinds = caster_kinds(m.input);
    const auto solids = m.params.closed != 0 && !masked ? solids_of(m.input) : nullptr;
    std::vector<HidingRun> runs;
    const auto append = [&](const HidingRun& run) {
        if (!runs.empty() && runs.back().first + runs.back().count == run.first && runs.back().outward == run.outward) {
            runs.back().count += run.count;
        } else if (run.count > 0) {
            runs.push_back(run);
        }
    };
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        const Object& object = scene.objects[i];
        if (kinds[i] != (masked ? CasterKind::masked : CasterKind::opaque)) {
            continue;
        }
        if (solids == nullptr || is_single_sided(scene, object)) {
            append({object.first_triangle, object.triangle_count, 0});
            continue;
        }
        for (const SolidRun& run : (*solids)[i]) {
            append({run.first, run.count, run.outward});
        }
    }
    return runs;
}

/// The left-sample map of the light's points, kept with the recipe.
void add_left_map(const MappedSamples& m, ShaderInputs& inputs) {
    const GnLight& light = m.input.light().shape;
    LeftMapShape shape{.light = sampled_light(light),
                       .angles = m.params.angles,
                       .offsets = m.params.offsets,
                       .words = static_cast<int>(m.words),
                       .count = m.params.samples,
                       .bracket = m.params.test == GN_VIEW_SAMPLES_EXACT};
    const std::size_t patterns =
        static_cast<std::size_t>(m.params.patterns) * static_cast<std::size_t>(m.params.patterns);
    const std::size_t bytes = left_map_texels(shape) * m.words * patterns * (shape.bracket ? 2 : 1) * 4;
    if (bytes > m.input.device.properties().limits.maxStorageBufferRange) {
        refuse(
            "direct 'view-samples' would look {} points up in a map of {} bytes, and a storage block of device '{}' "
            "holds "
            "{}; fewer view-samples.angles, view-samples.offsets or view-samples.samples fit",
            m.params.samples * static_cast<int>(patterns), bytes, m.input.device.info().name,
            m.input.device.properties().limits.maxStorageBufferRange);
    }
    Hasher key;
    key.value(light.kind).value(light.kind == GN_LIGHT_DIRECTIONAL ? light.angular_radius : 0.0F);
    const auto map = made_once(m.input.prepared, "view-samples left", key.finish().low, [&] {
        return upload(m.input.device, "view-samples left",
                      left_sample_map(shape, point_coordinates(light, m.params.samples * static_cast<int>(patterns))));
    });
    m.input.graph.hold(map);
    inputs
        .buffer("readonly buffer", "LeftMap", shape.bracket ? "uvec2 left_map[];" : "uint left_map[];",
                m.input.graph.import(*map))
        .constant("GnSampledLight", "sampled", shape.light)
        .constant("int", "angles", shape.angles)
        .constant("int", "offsets", shape.offsets)
        .constant("uint", "texels", static_cast<std::uint32_t>(left_map_texels(shape)));
}

}  // namespace

const char* const pattern_text = R"(
uint pattern_of(uint pixel) {
    return (pixel / u.width % u.side) * u.side + pixel % u.width % u.side;
}
)";

std::string mapped_defines(const MappedSamples& m, bool masked) {
    return fmt::format(
               "#define GN_WORDS {}u\n#define GN_LEVELS {}u\n#define GN_MASKED {:d}\n#define GN_SPHERE {:d}\n{}{}",
               m.words, SortedSamples::tree_levels, masked, m.input.light().shape.kind == GN_LIGHT_POINT,
               m.params.test == GN_VIEW_SAMPLES_EXACT ? "#define GN_BRACKET\n" : "",
               m.asked.valid() ? "#define GN_COUNT_ASKED\n" : "") +
           include_line("shadow/scene/light_samples.h") + include_line("shadow/direct/view_samples/view_samples.glsl") +
           SortedSamples::node_type;
}

/// The light's points, and which a pixel takes.
void add_mapped_points(const MappedSamples& m, ShaderInputs& inputs) {
    inputs.block("readonly buffer", "LightPoints", "vec4 light_points[];", std::as_bytes(std::span(m.points)))
        .constant("GnLight", "whole", m.input.light().shape)
        .constant("uint", "count", m.count())
        .constant("uint", "side", static_cast<std::uint32_t>(m.samples.side))
        .constant("uint", "width", m.input.samples.width);
}

namespace {

/// Walks that are handed over, and whether a loop was cut.
struct RestOfWalks {
    static constexpr std::uint32_t most = 1U << 18U;
    BufferHandle entries, used, cut;
};

constexpr const char* arguments_text = R"(
layout(local_size_x = 1) in;
void main() {
    uint count = min(rest_used, u.rest_most);
    groups[0] = min(count, 32768u);
    groups[1] = (count + 32767u) / 32768u;
    groups[2] = 4u;
}
)";

RestOfWalks add_rest(const MappedSamples& m, const std::string& name, ShaderInputs& inputs) {
    const auto create = [&](const char* what, VkDeviceSize words) {
        return m.input.graph.create(BufferDesc{.name = name + what, .bytes = words * sizeof(std::uint32_t)});
    };
    const RestOfWalks rest{create(" rest", VkDeviceSize{2} * RestOfWalks::most), create(" rests", 1),
                           create(" cut", 1)};
    add_zeros(m.input.graph, name + ": begin", {rest.used, rest.cut});
    inputs.buffer("buffer", "Rest", "uvec2 rest[];", rest.entries)
        .buffer("buffer", "RestUsed", "uint rest_used;", rest.used)
        .buffer("buffer", "WasCut", "uint was_cut;", rest.cut)
        .constant("uint", "rest_most", RestOfWalks::most);
    return rest;
}

/// As many workgroups as there are walks to go on with.
BufferHandle add_rest_groups(const MappedSamples& m, const std::string& name, const RestOfWalks& rest) {
    const BufferHandle groups =
        m.input.graph.create(BufferDesc{.name = name + " groups", .bytes = 3 * sizeof(std::uint32_t)});
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "RestUsed", "uint rest_used;", rest.used)
        .buffer("writeonly buffer", "Groups", "uint groups[];", groups)
        .constant("uint", "rest_most", RestOfWalks::most);
    const auto shader = compute_once(m.input.prepared, "view-samples: groups", hashed(inputs),
                                     [&] { return inputs.text() + arguments_text; });
    m.input.graph.add_pass(
        name + ": groups", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch(1, 1);
        });
    return groups;
}

/// What is left out is said.
void tell_missing(const FrameInput& input, const std::string& name, BufferHandle cut) {
    input.graph.answer(cut, [name, remarks = input.late_remarks](std::span<const std::byte> bytes) {
        std::uint32_t was_cut = 0;
        std::memcpy(&was_cut, bytes.data(), sizeof was_cut);
        if (was_cut != 0 && remarks != nullptr) {
            remarks->insert(fmt::format(
                "the driver ended a loop of pass '{}' early, or too many triangles reach many samples, so that shadows "
                "are "
                "missing in this frame; fewer view-samples.samples make loops shorter, a smaller picture lists shorter",
                name));
        }
    });
}

/// What walks read and write.
ShaderInputs walk_inputs(const MappedSamples& m) {
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Points", "uvec4 points[];", m.sorted.points)
        .buffer("readonly buffer", "Nodes", "SampleNode nodes[];", m.sorted.nodes)
        .buffer("readonly buffer", "Used", "uint used;", m.sorted.used)
        .buffer("buffer", "Hidden", "uint hidden[];", m.hidden);
    if (m.asked.valid()) {
        inputs.buffer("buffer", "Asked", "uint asked[];", m.asked);
    }
    add_mapped_points(m, inputs);
    add_left_map(m, inputs);
    const glsl::GnLightAxes axes = light_axes(m.input.light().shape);
    inputs.constant("GnLightAxes", "axes", axes)
        .constant("GnSampledLight", "sampled_ls", ls_from_ws(axes, sampled_light(m.input.light().shape)));
    add_occluders(inputs, m.input);
    return inputs;
}

}  // namespace

void add_walk(const MappedSamples& m, bool masked) {
    const std::string name = masked ? "view-samples: masks" : "view-samples: triangles";
    const std::vector<HidingRun> runs = hiding_runs(m, masked);
    ShaderInputs inputs = walk_inputs(m);
    const RestOfWalks rest = add_rest(m, name, inputs);
    const std::string before = mapped_defines(m, masked) + occluder_includes();
    const auto shader = [&](const std::string& called, const char* define) {
        return compute_once(m.input.prepared, called, hashed(inputs).text(before), [&] {
            return define + before + inputs.text() + pattern_text + occluder_functions() +
                   "#include \"shadow/direct/view_samples/view_samples_walk.glsl\"\n";
        });
    };

    // Every triangle walks every tree of samples.
    m.input.graph.add_pass(
        name, [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader = shader(name, ""), runs, trees = m.sorted.trees](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            for (const HidingRun& run : runs) {
                r.push_value(run);
                const std::uint32_t groups = (run.count + 63) / 64;
                const std::uint32_t across = std::min(groups, 32768U);
                r.dispatch(across, (groups + across - 1) / across, trees);
            }
        });

    // Long walks go on, shared out.
    const BufferHandle groups = add_rest_groups(m, name, rest);
    m.input.graph.add_pass(
        name + ": rest",
        [&](PassBuilder& pass) {
            inputs.declare(pass);
            pass.indirect(groups);
        },
        [inputs, groups, shader = shader(name + ": rest", "#define GN_REST\n")](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch_indirect(groups);
        });
    tell_missing(m.input, name, rest.cut);
}

}  // namespace gn
