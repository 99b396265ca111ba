// SPDX-License-Identifier: MIT
// Several maps for one sun: the view is split along its axis, each slice has a map of its own.
// Also here: cascade_views.h, cascade_views.cpp (slices and the views around them), stable.cpp (windows of a fixed grid),
// keep.cpp (maps kept over frames), refusals.cpp (what it cannot do), sdsm.h, sdsm.cpp (splits and views from the samples),
// its passes sdsm_steps.glsl, sdsm_samples.glsl, sdsm_distances.glsl, sdsm_splits.glsl, sdsm_bounds.glsl, sdsm_views.glsl;
// tests: stable_test.cpp, warped_test.cpp, far_test.cpp, falloff_test.cpp, mask_test.cpp, simpler_test.cpp, sdsm_test.cpp, picture_test.cpp.
//
// Based on: Zhang, Sun, Xu, Lun. Parallel-Split Shadow Maps for Large-scale Virtual Environments. VRCIA 2006. [ZSXL06]
#include "shadow/placement/cascades/cascade_views.h"
#include "shadow/placement/receiver_mask.h"
#include "shadow/placement/warp.h"

#include <algorithm>

namespace gn::cascades {
namespace {

using namespace cascades;

/// Logarithms answer pixels that grow with the distance. An orthographic camera's do not: even lengths are even errors.
GnCascadesParams params_of(const FrameInput& input, const Recipe& recipe) {
    auto params = recipe.of<GnCascadesParams>("cascades");
    if (is_orthographic(input.samples.camera) && !by_samples(params)) {
        params.split = GN_SPLIT_UNIFORM;
    }
    return params;
}

/// Passes cost nothing on a CPU, where a layered one draws every caster into every layer; GPUs prefer one pass.
bool layered(const Device& device, const GnCascadesParams& params) {
    const bool wanted = params.passes == GN_PASSES_LAYERED || (params.passes == GN_PASSES_AUTO && !device.info().cpu);
    return wanted && packed_halvings(params) == 0 && params.simpler == 0 &&
           device.has(Feature::layer_from_vertex_shader);
}

/// One slice's receivers: their box, rectangle of least area, or warped map. `near` is the share of the slice's depth that
/// does not steer a warp.
GnLightView tight_view(const FrameInput& input, const Recipe& recipe, const ConvexBody& body, int fit, int side,
                       double near) {
    const GnLight& light = input.light().shape;
    const Guard guard = guard_of(input, recipe);
    if (fit == GN_FIT_PLAIN) {
        return plain_view(body, facing(input.samples.camera, light), side, guard);
    }
    const GnLightView fitted = fit_orthographic(body, light, side, guard);
    if (fit != GN_FIT_WARPED) {
        return fitted;
    }
    auto plane = warp::plane_of(input, body, fitted, recipe, near);
    if (!plane) {
        return fitted;
    }
    plane->share = std::min(0.4, static_cast<double>(guard.texels) / side);
    return warp::even_view(*plane, 0);
}

/// Views around the receivers of each slice.
void add_tight_views(const FrameInput& input, const Recipe& recipe, const GnCascadesParams& params,
                     std::span<const Interval> slices, LightViews& views) {
    for (const Interval& slice : slices) {
        ConvexBody body = potential_receivers(input, slice.near, slice.far);
        if (body.empty()) {
            // Nothing can receive: any view will do.
            body = body_of(Box{input.samples.camera.position_ws - 1.0F, input.samples.camera.position_ws + 1.0F});
        }
        // One pseudo-near plane for the whole view; a tenth of a slice at most.
        const double near = std::min(warp::usual_near * std::max(slices.back().far / slice.far, 1.0), 0.1);
        const int side = side_of(params, recipe.resolution, views.views.size());
        views.views.push_back(tight_view(input, recipe, body, params.fit, side, near));
    }

    // A receiver may be served by a cascade of another slice: then all share one range of depths.
    const ConvexBody all = potential_receivers(input);
    if (params.select == GN_SELECT_PROJECTION && !all.empty()) {
        const GnLight& light = input.light().shape;
        double texel = 0;
        for (const GnLightView& view : views.views) {
            const double least = std::min(glm::length(dvec3(row_of(view.cs_from_ws, 0))),
                                          glm::length(dvec3(row_of(view.cs_from_ws, 1))));
            texel = std::max(texel, 2 / least / static_cast<double>(view.resolution));
        }
        const Interval depth =
            with_slack(extent_of(all, dvec3(vec3(light.direction_ws))), guard_of(input, recipe), texel, 0);
        for (GnLightView& view : views.views) {
            set_depth_range(view, light, depth);
        }
    }
}

/// Windows of grids fixed to the world, around spheres that turn with nothing.
std::vector<Window> add_stable_views(const FrameInput& input, const Recipe& recipe, const GnCascadesParams& params,
                                     std::span<const Interval> slices, LightViews& views) {
    const Camera& camera = input.samples.camera;
    const double aspect = static_cast<double>(input.samples.width) / static_cast<double>(input.samples.height);
    const double spare = params.rate > 1 ? 0.125 : 0.0;
    const Box scene_ws = seen_bounds(input);
    std::vector<Window> windows;
    for (const Interval& slice : slices) {
        const Sphere sphere = sphere_around(slice, camera, aspect);
        const int side = side_of(params, recipe.resolution, views.views.size());
        const Grid grid = grid_of(sphere, input.light().shape, scene_ws, side, guard_of(input, recipe), spare);
        const dvec3 centre = dvec3(camera.position_ws) + sphere.centre * glm::normalize(dvec3(camera.forward_ws));
        windows.push_back({grid, centre});
        views.views.push_back(params.snap != 0 ? view_of(grid, window_around(grid, centre)) : loose_view(grid, centre));
    }
    return windows;
}

/// Of each view's casters leaves those that can fall onto what is seen of its slice.
void mask_casters(const FrameInput& input, const Recipe& recipe, const GnCascadesParams& params,
                  std::span<const Interval> slices, LightViews& views) {
    const Camera& camera = input.samples.camera;
    const Guard guard = guard_of(input, recipe);
    const bool any = params.select == GN_SELECT_PROJECTION;
    for (std::size_t i = 0; i < slices.size(); ++i) {
        // The first map also serves what lies before its slice, the last what lies beyond.
        const double near = any || i == 0 ? static_cast<double>(camera.near) : slices[i].near;
        const double far = any || i + 1 == slices.size() ? static_cast<double>(camera.far) : slices[i].far;
        const GnLightView& view = views.views[i];
        views.casters[i] =
            casters_on_receivers(input, view, with_bias(guard, recipe.bias, view), near, far, views.casters[i]);
    }
}

/// How far casters of all maps but the first may differ, by the texels of each.
std::vector<float> errors_of(const GnCascadesParams& params, int resolution, std::span<const GnLightView> views) {
    std::vector<float> errors;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const double across = glm::length(dvec3(row_of(views[i].cs_from_ws, 0)));
        const double texel = 2 / across / side_of(params, resolution, i);
        errors.push_back(i == 0 ? 0.0F : static_cast<float>(static_cast<double>(params.simpler) * texel));
    }
    return errors;
}

LightViews place_cascades(const FrameInput& input, const Recipe& recipe) {
    const GnCascadesParams params = params_of(input, recipe);
    if (by_samples(params)) {
        LightViews views = place_by_samples(input, recipe, params);
        views.layered = layered(input.device, params);
        return views;
    }
    LightViews views;
    views.resolution = static_cast<std::uint32_t>(recipe.resolution);
    views.layered = layered(input.device, params);

    // Split the view, and look at each slice.
    const Interval range = range_of(input, params);
    const std::vector<Interval> slices = slices_of(params, range);
    std::vector<Window> windows;
    if (params.fit == GN_FIT_STABLE) {
        windows = add_stable_views(input, recipe, params, slices, views);
    } else {
        add_tight_views(input, recipe, params, slices, views);
    }
    put_into_layers(params, recipe.resolution, views);
    // Where one map is warped, all get their depth from fragments.
    views.kind = kind_of(views.views);
    if (!windows.empty() && input.history != nullptr && (params.scroll != 0 || params.rate > 1)) {
        keep_windows(input, recipe, params, windows, views);
    }

    // Cull the casters of each view; tell the choice function.
    for (const GnLightView& view : views.views) {
        views.casters.push_back(casters_of(input.scene, view, params.least_caster));
    }
    if (params.mask != 0) {
        mask_casters(input, recipe, params, slices, views);
    }
    if (params.simpler > 0) {
        views.simpler = errors_of(params, recipe.resolution, views.views);
    }
    views.set_data(choice_data(params, range, facing(input.samples.camera, input.light().shape), views.views,
                               guard_of(input, recipe)));
    return views;
}

std::string known_cascades(const Recipe& recipe) {
    const auto params = recipe.of<GnCascadesParams>("cascades");
    return fmt::format(
        "#define GN_CASCADES_COUNT {}\n#define GN_CASCADES_SELECT {}\n#define GN_CASCADES_TRANSITION {}\n",
        params.count, params.select, params.transition);
}

std::vector<ParamRow> split_rows() {
    return {
        GN_PARAM(GnCascadesParams, count, integer, 1, GN_CASCADES_MOST, "",
                 "More slices, each with a map of its own: finer texels, and memory and time in proportion."),
        GN_PARAM(
            GnCascadesParams, falloff, real, -2, 2, "halvings",
            "Halves the side of the maps so many times from one to the next, away from the camera, or below 0 towards "
            "it; smaller maps share layers: less memory and time, and texels that much coarser there."),
        GN_CHOICE(GnCascadesParams, split,
                  "Where the view is split: from even lengths to even perspective error, or from the samples seen.",
                  "uniform", "log", "practical", "adapted-near", "sdsm-minmax", "sdsm-histogram"),
        GN_PARAM(GnCascadesParams, alpha, real, 0, 1, "",
                 "Moves the practical split from uniform (0) to logarithmic (1): finer texels near the camera."),
        GN_PARAM(
            GnCascadesParams, adapted_near, real, 0, 1e9, "m",
            "Where the logarithm of adapted-near starts: farther ones leave the first slice coarser and the others "
            "finer; 0 gives every slice a ratio of four."),
        GN_PARAM(
            GnCascadesParams, distance, real, 0, 1e9, "m",
            "End of the last slice, beyond which nothing is shadowed: nearer ones make all texels finer; 0 reaches "
            "as far as the scene."),
        GN_CHOICE(GnCascadesParams, far,
                  "What ends the last slice: the bounds of the scene, or the farthest object that is seen, by its own "
                  "bounds; then all texels are finer where the view is blocked, and stable windows change their size "
                  "whenever that end has moved by half an octave.",
                  "scene", "objects"),
    };
}

ParamTable rows() {
    std::vector<ParamRow> all = split_rows();
    const std::vector<ParamRow> more{
        GN_CHOICE(
            GnCascadesParams, fit,
            "What each map covers: a box, the rectangle of least area, a window of a fixed grid that does not "
            "shimmer, or that rectangle warped towards the near end of its slice; the sdsm splits always take the "
            "samples' box.",
            "plain", "fitted", "stable", "warped"),
        GN_PARAM(GnCascadesParams, snap, boolean, 0, 1, "",
                 "Moves stable windows by whole texels; without it they follow the camera exactly, and edges crawl."),
        GN_CHOICE(GnCascadesParams, transition,
                  "How one slice gives way to the next: a line, a mixture at twice the cost there, or noise.", "none",
                  "blend", "dither"),
        GN_PARAM(GnCascadesParams, width, real, 0, 0.5, "of a slice",
                 "A wider transition: less of a visible line, more samples that read two maps."),
        GN_CHOICE(GnCascadesParams, select,
                  "By distance, or the finest map that holds the receiver: finer at equal cost, with borders that are "
                  "not straight.",
                  "distance", "projection"),
        GN_CHOICE(GnCascadesParams, passes, "One pass for all maps or one each; auto prefers one on a GPU.", "auto",
                  "layered", "separate"),
        GN_PARAM(GnCascadesParams, rate, integer, 1, 64, "frames",
                 "Redraws the last map only so often, those before it more often: cheaper, and moving casters lag far "
                 "away; takes effect over a sequence of frames."),
        GN_PARAM(GnCascadesParams, scroll, boolean, 0, 1, "",
                 "Keeps the maps of still casters and draws only what the moving window reveals; takes effect over a "
                 "sequence of frames."),
        GN_PARAM(GnCascadesParams, least_caster, real, 0, 64, "texels",
                 "Leaves an object out of every map on which its bounds span fewer texels than this, to the longer "
                 "side: far "
                 "maps draw less, and shadows that thin are missing there."),
        GN_PARAM(
            GnCascadesParams, simpler, real, 0, 16, "texels",
            "Draws meshes of fewer triangles into all maps but the first, which differ from those of the scene by so "
            "many of a map's texels at most and are seen as much farther from the light: faster where meshes are fine, "
            "edges and contacts are off by that, and what bends is simplified anew in every frame; of stable windows."),
        GN_PARAM(
            GnCascadesParams, mask, boolean, 0, 1, "",
            "Leaves an object out of every map in which it falls onto nothing that the camera sees of the slice: the "
            "same V, fewer objects drawn, and some work on the CPU; for kernels that read the depth map itself."),
    };
    all.insert(all.end(), more.begin(), more.end());
    return param_table<GnCascadesParams>(std::move(all));
}

}  // namespace
}  // namespace gn::cascades

namespace gn::parts {

const Part& placement_cascades() {
    using namespace gn::cascades;
    static const Part part = [] {
        Part p;
        p.id = "cascades";
        p.stage = Stage::placement;
        p.title = "Cascades: one map per slice of the view";
        p.citation = "ZSXL06";
        p.lights = {.directional = true};
        p.params = rows();
        p.params_type = "GnCascadesParams";
        p.data_type = "GnCascadesData";
        p.glsl = "shadow/placement/cascades/cascades.glsl";
        p.place = place_cascades;
        p.prologue = known_cascades;
        p.refuses = cascades::refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
