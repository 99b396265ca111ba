// SPDX-License-Identifier: MIT
// Sample distribution shadow maps: one reduction finds where the samples are, the next what each slice's samples span in
// light space; views are written by a shader and read by shaders. Nothing is read back, nothing lags a frame.
//
// Based on: Lauritzen, Salvi, Lefohn. Sample Distribution Shadow Maps. I3D 2011. [LSL10]
// Departs from it: the histogram's splits minimize the mean size of a texel, where the paper's partitions are heuristics;
// only samples that face the light count; boxes turn to the least area; and an invocation reduces a column of pixels in
// registers before one atomic, where the paper uses shared memory.
#include "shadow/placement/cascades/sdsm.h"

#include "shadow/placement/cascades/cascade_views.h"

#include <set>

namespace gn::cascades {
namespace {

/// A pass by the file that holds it, sdsm_<file>.glsl.
ComputeDesc shader(const char* name, const char* file) {
    return {{ShaderKind::compute, name, fmt::format("#include \"shadow/placement/cascades/sdsm_{}.glsl\"\n", file)},
            {}};
}

GnSdsmConstants constants_of(const FrameInput& input, const Recipe& recipe, const GnCascadesParams& params) {
    const Camera& camera = input.samples.camera;
    const LightFrame frame = facing(camera, input.light().shape);
    const Guard guard = guard_of(input, recipe);
    const dvec3 eye(camera.position_ws);
    const auto axis = [&](dvec3 direction) { return vec4(dvec4(direction, glm::dot(direction, eye))); };
    GnSdsmConstants u;
    u.light = input.light().shape;
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
    u.guard_texels = guard.texels;
    u.guard_metres = guard.metres;
    return u;
}

/// What the passes have in common.
struct Sdsm {
    GnSdsmConstants constants;
    ViewSamples samples;
    BufferHandle reduction;

    void bind(Recorder& r, const ComputeDesc& desc) const {
        r.bind(desc);
        r.set_value("Constants", constants);
        r.set("Reduction", reduction);
    }
    /// A pass over all samples.
    void add_reduction(FrameGraph& graph, const char* name, const char* file) const {
        graph.add_pass(
            name,
            [&](PassBuilder& pass) {
                pass.sample(samples.position);
                pass.sample(samples.normal);
                pass.storage_write(reduction);
            },
            [*this, desc = shader(name, file)](Recorder& r) {
                bind(r, desc);
                r.set("gbuffer_position", samples.position);
                r.set("gbuffer_normal", samples.normal);
                r.dispatch((samples.width + 63) / 64, (samples.height + GN_SDSM_ROWS - 1) / GN_SDSM_ROWS);
            });
    }
};

/// What may cast into any view that the samples can choose: their rectangle at every turn lies within that of the
/// receivers at this turn.
std::vector<std::uint32_t> possible_casters(const FrameInput& input, const Recipe& recipe) {
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
        const GnLightView view = plain_view(body, turned(frame, angle), recipe.resolution, guard);
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
    views.layers = static_cast<std::uint32_t>(params.count);
    views.buffer = graph.create({.name = "cascade views", .bytes = count * sizeof(GnLightView)});
    views.data_buffer = graph.create({.name = "cascade choice", .bytes = sizeof views.data});
    for (std::size_t i = 0; i < count; ++i) {
        GnLightView view;
        view.resolution = static_cast<float>(recipe.resolution);
        view.layer = static_cast<int>(i);
        views.views.push_back(view);
    }
    views.casters.assign(count, possible_casters(input, recipe));
    const Sdsm sdsm{constants_of(input, recipe, params), input.samples,
                    graph.create({.name = "sample distribution", .bytes = sizeof(GnSdsmReduction)})};

    // Where the samples are along the view, the slices, and what each slice's samples span.
    graph.add_pass(
        "sdsm clear", [&](PassBuilder& pass) { pass.copy_to(sdsm.reduction); },
        [sdsm](Recorder& r) { r.fill(sdsm.reduction, 0); });
    sdsm.add_reduction(graph, "sdsm distances", "distances");
    graph.add_pass(
        "sdsm splits", [&](PassBuilder& pass) { pass.storage_write(sdsm.reduction); },
        [sdsm, desc = shader("sdsm splits", "splits")](Recorder& r) {
            sdsm.bind(r, desc);
            r.dispatch(1, 1);
        });
    sdsm.add_reduction(graph, "sdsm bounds", "bounds");

    // The views around them.
    graph.add_pass(
        "sdsm views",
        [&](PassBuilder& pass) {
            pass.storage_read(sdsm.reduction);
            pass.storage_write(views.buffer);
            pass.storage_write(views.data_buffer);
        },
        [sdsm, buffer = views.buffer, data = views.data_buffer, desc = shader("sdsm views", "views")](Recorder& r) {
            sdsm.bind(r, desc);
            r.set("Views", buffer);
            r.set("Placement", data);
            r.dispatch(1, 1);
        });
    return views;
}

}  // namespace gn::cascades
