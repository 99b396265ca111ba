// SPDX-License-Identifier: MIT
// Sample distribution shadow maps: one reduction finds where the samples are, the next what each slice's samples span in
// light space; views are written by a shader and read by shaders. Nothing is read back, nothing lags a frame.
//
// Based on: Lauritzen, Salvi, Lefohn. Sample Distribution Shadow Maps. I3D 2011. [LSL10]
// Departs from it: the histogram's splits minimize the mean size of a texel, where the paper's partitions are heuristics;
// only samples that face the light count; boxes turn to the least area; and an invocation reduces a column of pixels in
// registers before one atomic, where the paper uses shared memory.
#include "shadow/placement/cascades/sdsm.h"

#include "gpu/zeros_pass.h"
#include "shadow/placement/cascades/cascade_views.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <set>

namespace gn::cascades {
namespace {

GnSdsmConstants constants_of(const FrameInput& input, const Recipe& recipe, const GnCascadesParams& params,
                             const LightViews& views) {
    const Camera& camera = input.samples.camera;
    const LightFrame frame = facing(camera, input.light().shape);
    const Guard guard = guard_of(input, recipe);
    const dvec3 eye(camera.position_ws);
    const auto axis = [&](dvec3 direction) { return vec4(dvec4(direction, glm::dot(direction, eye))); };
    GnSdsmConstants u;
    u.light = input.whole_light().shape;
    u.params = params;
    u.x_ws = axis(frame.x);
    u.y_ws = axis(frame.y);
    u.z_ws = axis(frame.z);
    u.eye_ws = vec4(camera.position_ws, 1);
    u.even = is_orthographic(camera) ? 1 : 0;
    u.size = uvec2(input.samples.width, input.samples.height);
    u.near = camera.near;
    u.far = camera.far;
    u.resolution = static_cast<float>(recipe.resolution);
    u.halved = packed_halvings(params);
    for (std::size_t i = 0; i < views.views.size(); ++i) {
        u.rects_ts[i] = views.views[i].rect_ts;
        u.layers[i] = views.views[i].layer;
    }
    u.guard_texels = guard.texels;
    u.guard_metres = guard.metres;
    u.guard_before = guard.before;
    return u;
}

/// One pass over what all passes share and what it reads and writes besides; `file` is its shader, sdsm_<file>.glsl.
struct Pass {
    const char* name;
    const char* file;
    uvec2 groups{1};
    ShaderInputs inputs;
};

void add_pass(const FrameInput& input, const GnSdsmConstants& constants, BufferHandle reduction, Pass pass) {
    pass.inputs.block("uniform", "Constants", "GnSdsmConstants u;", std::as_bytes(std::span(&constants, 1)));
    pass.inputs.buffer("buffer", "Reduction", "GnSdsmReduction r;", reduction);
    const auto shader = compute_once(input.prepared, pass.name, hashed(pass.inputs), [&] {
        return fmt::format(
            "#include \"shadow/placement/cascades/cascades.glsl\"\n#include \"shadow/placement/cascades/sdsm.h\"\n{}"
            "#include \"shadow/placement/cascades/sdsm_{}.glsl\"\n",
            pass.inputs.text(), pass.file);
    });
    input.graph.add_pass(
        pass.name, [&](PassBuilder& builder) { pass.inputs.declare(builder); },
        [pass, shader](Recorder& r) {
            r.bind(*shader);
            pass.inputs.set(r);
            r.dispatch(pass.groups.x, pass.groups.y);
        });
}

/// What may cast into any view that the samples can choose: their rectangle at every turn lies within that of the
/// receivers at this turn.
std::vector<std::uint32_t> possible_casters(const FrameInput& input, const Recipe& recipe, int least_side) {
    const ConvexBody body = potential_receivers(input);
    if (body.empty()) {
        return {};
    }
    Guard guard = guard_of(input, recipe);
    guard.metres += 2e-4F * input.samples.camera.far;  // the least side of a view
    const LightFrame frame = facing(input.samples.camera, input.light().shape);
    std::set<std::uint32_t> casters;
    for (int turn = 0; turn < GN_SDSM_TURNS; ++turn) {
        const double angle = std::numbers::pi / 2 * turn / GN_SDSM_TURNS;
        const GnLightView view = plain_view(body, turned(frame, angle), least_side, guard);
        const std::vector<std::uint32_t> some = casters_of(input.scene, view);
        casters.insert(some.begin(), some.end());
    }
    return {casters.begin(), casters.end()};
}

}  // namespace

LightViews place_by_samples(const FrameInput& input, const Recipe& recipe, const GnCascadesParams& params) {
    FrameGraph& graph = input.graph;
    const auto count = static_cast<std::size_t>(params.count);
    LightViews views;
    views.kind = ViewKind::affine;
    views.resolution = static_cast<std::uint32_t>(recipe.resolution);
    views.buffer = graph.create({.name = "cascade views", .bytes = count * sizeof(GnLightView)});
    views.data_buffer = graph.create({.name = "cascade choice", .bytes = sizeof views.data});
    views.views.resize(count);
    put_into_layers(params, recipe.resolution, views);
    const int least_side =
        std::min(side_of(params, recipe.resolution, 0), side_of(params, recipe.resolution, count - 1));
    views.casters.assign(count, possible_casters(input, recipe, least_side));
    const GnSdsmConstants constants = constants_of(input, recipe, params, views);
    const BufferHandle reduction = graph.create({.name = "sample distribution", .bytes = sizeof(GnSdsmReduction)});
    ShaderInputs samples;
    add_gbuffer(samples, input.device, input.samples);
    const uvec2 columns((input.samples.width + 63) / 64, (input.samples.height + GN_SDSM_ROWS - 1) / GN_SDSM_ROWS);

    // Where the samples are along the view, the slices, and what each slice's samples span.
    add_zeros(graph, "sdsm clear", {reduction});
    add_pass(input, constants, reduction, {"sdsm distances", "distances", columns, samples});
    add_pass(input, constants, reduction, {"sdsm splits", "splits", uvec2(1), {}});
    add_pass(input, constants, reduction, {"sdsm bounds", "bounds", columns, samples});

    // The views around them.
    ShaderInputs made;
    made.buffer("writeonly buffer", "Views", "GnLightView views[];", views.buffer);
    made.buffer("writeonly buffer", "Placement", "GnCascadesData placement;", views.data_buffer);
    add_pass(input, constants, reduction, {"sdsm views", "views", uvec2(1), made});
    return views;
}

}  // namespace gn::cascades
