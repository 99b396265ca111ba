// SPDX-License-Identifier: MIT
// Based on: Everitt, Kilgard. Practical and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering. 2002.
// [EK02] The raster pass of a light that counts, and what it can show.
// Based on: Hornus, Hoberock, Lefebvre, Hart. ZP+: Correct Z-pass Stencil Shadows. I3D 2005. [HHLH05]
// Departs from them: the count is a sum of blended floats, exact to 16 million, where eight bits of stencil wrap at 256; which
// side of the samples is counted each component of the mesh decides for itself.
#include "shadow/geometry/volume_steps.h"
#include "shadow/geometry/volumes.glsl"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {

namespace {

constexpr const char* mark_text = R"(
void main() {
    if (!volume_marked(ivec2(gl_FragCoord.xy))) {
        discard;
    }
}
)";

RasterDesc mark_pipeline(const VolumeMarks& marks, const ShaderInputs& inputs) {
    RasterDesc desc =
        fullscreen({ShaderKind::fragment, "volume-mark.frag", marks.types + inputs.text() + marks.text + mark_text});
    desc.color_mask = 0;
    desc.stencil = volume_stencil(VK_COMPARE_OP_ALWAYS, VK_STENCIL_OP_REPLACE);
    return sealed(std::move(desc));
}

ShaderInputs count_inputs(const FrameInput& input, const VolumeBuffers& buffers) {
    ShaderInputs inputs = volume_side_inputs(buffers);
    add_gbuffer(inputs, input.device, input.samples);
    inputs.buffer("readonly buffer", "Indices", "uint indices[];", buffers.triangles)
        .buffer("readonly buffer", "Caps", "uint caps[];", buffers.caps)
        .buffer("readonly buffer", "Owners", "uint owners[];", buffers.owners);
    if (buffers.runs.valid()) {
        inputs.buffer("readonly buffer", "First", "uint first[];", buffers.first)
            .buffer("readonly buffer", "Around", "uint around[];", buffers.around)
            .buffer("readonly buffer", "Runs", "uvec4 runs[];", buffers.runs)
            .constant("uvec2", "picture", uvec2(input.samples.width, input.samples.height));
    }
    return inputs;
}

/// What a pass needs that draws steps.
struct StepPass {
    const char* name;
    ShaderInputs inputs;
    std::shared_ptr<const std::vector<Step>> steps;
    const VolumeMarks* marks = nullptr;
};

TextureHandle add_steps(const FrameInput& input, const VolumeBuffers& buffers, TextureHandle receivers,
                        const StepPass& drawn) {
    const TextureHandle counts = input.graph.create(TextureDesc{.name = drawn.name,
                                                                .format = VK_FORMAT_R32_SFLOAT,
                                                                .width = input.samples.width,
                                                                .height = input.samples.height});
    const VolumeMarks* marks = drawn.marks;
    std::shared_ptr<const RasterDesc> mark;
    if (marks != nullptr) {
        mark = made_once(input.prepared, "volume marks", hashed(marks->inputs).text(marks->text).finish().low,
                         [&] { return mark_pipeline(*marks, marks->inputs); });
    }
    input.graph.add_pass(
        drawn.name,
        [&](PassBuilder& pass) {
            pass.color(counts, Load::clear);
            pass.depth_read_only(receivers, {0, 1, 0, 1},
                                 marks != nullptr ? std::optional<std::uint32_t>(0) : std::nullopt);
            drawn.inputs.declare(pass);
            if (marks != nullptr) {
                marks->inputs.declare(pass);
            }
            pass.vertices(buffers.positions);
            pass.indices(buffers.indices);
            pass.indirect(buffers.draws);
        },
        [inputs = drawn.inputs, steps = drawn.steps, mark, marking = marks != nullptr ? marks->inputs : ShaderInputs(),
         draws = buffers.draws, indices = buffers.indices, positions = buffers.positions](Recorder& r) {
            if (mark != nullptr) {
                r.bind(*mark);
                r.stencil_reference(1);
                marking.set(r);
                r.draw(3);
            }
            r.bind(steps->front().pipeline);
            inputs.set(r);
            r.vertex_buffer(positions);
            r.index_buffer(indices);
            draw_steps(r, *steps, draws);
        });
    return counts;
}

StepPass counting_pass(const FrameInput& input, const VolumeBuffers& buffers, const char* name,
                       const VolumeMarks* marks, bool all_fragments) {
    ShaderInputs inputs = count_inputs(input, buffers);
    const StepOptions options{buffers.mode, gn_volumes_has_far_cap(buffers.frame), marks != nullptr && marks->alone,
                              all_fragments, buffers.runs.valid()};
    const std::uint64_t key = hashed(inputs)
                                  .value(options.mode)
                                  .value(options.far_caps)
                                  .value(options.alone)
                                  .value(all_fragments)
                                  .finish()
                                  .low;
    auto steps = made_once(input.prepared, name, key, [&] { return count_steps(inputs, options); });
    return {name, std::move(inputs), std::move(steps), marks};
}

StepPass silhouette_pass(const FrameInput& input, const VolumeBuffers& buffers) {
    ShaderInputs inputs = volume_side_inputs(buffers);
    auto steps = made_once(input.prepared, "volume silhouettes", hashed(inputs).finish().low,
                           [&] { return silhouette_steps(inputs); });
    return {"volumes: shown silhouettes", std::move(inputs), std::move(steps)};
}

}  // namespace

TextureHandle add_counts(const FrameInput& input, const VolumeBuffers& buffers, TextureHandle receivers,
                         const VolumeMarks* marks) {
    return add_steps(input, buffers, receivers, counting_pass(input, buffers, "volumes: counts", marks, false));
}

std::vector<Side> volume_sides() {
    return {{"volume-count", "", "How many volumes the counts say hold a sample."},
            {"volume-fragments", "", "Fragments of sides and caps over a pixel, whether they count or not."},
            {"volume-silhouettes", "", "Sides that begin over a pixel: silhouettes as the light sees them."}};
}

void add_volume_sides(const FrameInput& input, const VolumeBuffers& buffers, TextureHandle receivers,
                      TextureHandle counts, Visibility& told) {
    for (const std::string_view side : input.sides) {
        if (side == "volume-count") {
            told.sides.push_back({std::string(side), counts, nearest()});
        } else if (side == "volume-fragments") {
            const StepPass pass = counting_pass(input, buffers, "volumes: shown fragments", nullptr, true);
            told.sides.push_back({std::string(side), add_steps(input, buffers, receivers, pass), nearest()});
        } else if (side == "volume-silhouettes") {
            told.sides.push_back(
                {std::string(side), add_steps(input, buffers, receivers, silhouette_pass(input, buffers)), nearest()});
        }
    }
}

}  // namespace gn
