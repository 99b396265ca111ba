// SPDX-License-Identifier: MIT
// Measures the smallest filter radius of all samples in a penumbra, for the next frame's resolution; V stays as it is.
//
// Based on: Kreuzer. Using Perception-Based Filtering to Hide Shadow Artifacts. TU Wien 2017. [Kre17], eq. 5.12.
//
// Stands on: shadow/placement/perceptual (who reads it)
#include "shadow/placement/perceptual/smallest_filter.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <bit>
#include <limits>

namespace gn::parts::smallest_radius {
namespace {

/// Pixels that an invocation reads, one below the other, before its one atomic.
constexpr std::uint32_t rows = 16;

// The bits of positive floats are ordered as they are.
constexpr const char* reduce_text = R"(
layout(local_size_x = 64) in;
void main() {
    ivec2 size = textureSize(radii, 0);
    int x = int(gl_GlobalInvocationID.x);
    int y = int(gl_GlobalInvocationID.y) * GN_ROWS;
    if (x >= size.x) {
        return;
    }
    float least = 3.0e38;
    for (int end = min(y + GN_ROWS, size.y); y < end; ++y) {
        float radius = texelFetch(radii, ivec2(x, y), 0).r;
        least = radius > 0.0 ? min(least, radius) : least;
    }
    if (least < 3.0e38) {
        atomicMin(smallest, floatBitsToUint(least));
    }
}
)";

Visibility add_smallest_radius(const FrameInput& input, const Recipe&, const Visibility& v) {
    const std::shared_ptr<std::uint32_t> known = smallest_filter(input);
    const Offer* const radii = v.find("filter-radius");
    if (known == nullptr || radii == nullptr) {
        return {v.image};
    }
    FrameGraph& graph = input.graph;
    const BufferHandle smallest =
        graph.create(BufferDesc{.name = "smallest filter radius", .bytes = sizeof(std::uint32_t)});
    graph.add_pass(
        "smallest radius clear", [&](PassBuilder& pass) { pass.copy_to(smallest); },
        [smallest](Recorder& r) { r.fill(smallest, std::bit_cast<std::uint32_t>(std::numeric_limits<float>::max())); });
    ShaderInputs inputs;
    inputs.texture("sampler2D", "radii", radii->texture);
    inputs.buffer("buffer", "Smallest", "uint smallest;", smallest);
    const auto shader = compute_once(input.prepared, "smallest radius", hashed(inputs), [&] {
        return fmt::format("#define GN_ROWS {}\n", rows) + inputs.text() + reduce_text;
    });
    const uvec2 groups((input.samples.width + 63) / 64, (input.samples.height + rows - 1) / rows);
    graph.add_pass(
        "smallest radius", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, groups](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch(groups.x, groups.y);
        });
    graph.answer(smallest, [known](std::span<const std::byte> bytes) { std::memcpy(known.get(), bytes.data(), 4); });
    return {v.image};
}

}  // namespace
}  // namespace gn::parts::smallest_radius

namespace gn::parts {

const Part& visibility_smallest_radius() {
    using namespace smallest_radius;
    static const Part part = [] {
        Part p;
        p.id = "smallest-radius";
        p.stage = Stage::visibility;
        p.title = "The smallest filter radius on the screen";
        p.citation = "Kre17";
        p.needs = {"filter-radius"};
        p.add_visibility = add_smallest_radius;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
