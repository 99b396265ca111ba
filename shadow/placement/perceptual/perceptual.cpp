// SPDX-License-Identifier: MIT
// One fitted map of which only as many texels are drawn as the filter asks for: what it blurs away need not be drawn.
//
// Based on: Kreuzer. Using Perception-Based Filtering to Hide Shadow Artifacts. TU Wien 2017. [Kre17]
// Departs from it: resolutions are whole blocks of 8 texels, and what the guard adds for kernels is part of the law.
//
// Stands on: shadow/placement/fit (the same views), shadow/visibility/smallest_radius (measures what is read here)
// Also here: smallest_filter.h (the smallest filter radius on the screen)
#include "shadow/placement/perceptual/perceptual.h"

#include "shadow/frame/history.h"
#include "shadow/geometry/potential_receivers.h"
#include "shadow/placement/light_views.h"
#include "shadow/placement/perceptual/perceptual.glsl"
#include "shadow/placement/perceptual/smallest_filter.h"
#include "shadow/receiver/light_plane.glsl"
#include "shadow/recipe/guard.h"

#include <bit>

namespace gn {

std::shared_ptr<std::uint32_t> smallest_filter(const FrameInput& input) {
    return input.history != nullptr && input.parent == nullptr
               ? input.history->answered(fmt::format("smallest filter of light {}", input.light_id))
               : nullptr;
}

}  // namespace gn

namespace gn::perceptual {
namespace {

constexpr int least_texels = 16;

/// A radius on the light's plane or, of a length in the world, in metres; 0 where the filter has none.
struct Radius {
    double plane = 0, metres = 0;
};

/// Whether the lookup's filter differs from sample to sample, and says how wide it is.
bool varies(const Recipe& recipe) {
    return recipe.lookup != nullptr && tells(*recipe.lookup, "filter-radius");
}

Radius filter_of(const FrameInput& input, const Recipe& recipe, const GnPerceptualParams& params, const Guard& guard) {
    const auto scene = static_cast<double>(main_bounds(input).diagonal());
    if (params.radius > 0) {
        return {.metres = static_cast<double>(params.radius) * scene};
    }
    if (!varies(recipe)) {
        return {.metres = static_cast<double>(guard.metres)};
    }
    // eq. 5.12: the smallest of a frame before; without one the floor.
    Radius radius{.metres = static_cast<double>(params.least) * scene};
    if (const std::shared_ptr<std::uint32_t> found = smallest_filter(input); found != nullptr && *found != 0) {
        radius.plane = static_cast<double>(std::bit_cast<float>(*found));
    }
    return radius;
}

/// On the light's plane, whose metres are tangents at one metre: at the farthest receiver a world radius is smallest.
double on_plane(const Radius& radius, double farthest) {
    return std::max(radius.plane, radius.metres / farthest);
}

/// How far along its axis a view sees; 1 for views of a sun.
double farthest_of(const GnLightView& view) {
    if (view.eye_ws.w < 0.5F) {
        return 1;
    }
    const float eye = glm::dot(view.depth_from_ws, vec4(vec3(view.eye_ws), 1));
    return static_cast<double>((1 - eye) * view.metres_per_depth);
}

/// Texels of the rectangle that this frame draws: what the extents ask for, no faster than the limit lets it change.
ivec2 choose(const FrameInput& input, const Recipe& recipe, const GnPerceptualParams& params, dvec2 extents,
             double radius, const Guard& guard) {
    const std::string name = fmt::format("perceptual texels of light {} {}", input.light_id, recipe.name);
    const bool follows = input.history != nullptr && input.parent == nullptr;
    const ivec2* const before = follows ? input.history->before<ivec2>(name) : nullptr;
    const int most = recipe.resolution;
    ivec2 texels;
    for (int axis = 0; axis < 2; ++axis) {
        const float asked =
            glsl::gn_perceptual_texels(params.c, static_cast<float>(extents[axis]), static_cast<float>(radius),
                                       guard.texels, static_cast<float>(most));
        const int wanted = glm::clamp(glsl::gn_perceptual_blocks(asked), least_texels, most);
        const int followed = glsl::gn_perceptual_follow(wanted, before != nullptr ? (*before)[axis] : 0, params.change);
        texels[axis] = glm::clamp(followed, least_texels, most);
    }
    if (follows) {
        input.history->leave(name, texels);
        input.history->leave(chosen_texels(input.light_id), texels);
    }
    return texels;
}

/// The rectangle of the map that the views are drawn into, the same in every layer. It is never the whole to the bit, which
/// shaders would be composed for: frames that draw all texels and frames that draw some have the same.
void draw_part(LightViews& views, ivec2 texels) {
    constexpr float nearly_all = 1 - 0x1p-24F;
    const auto whole = static_cast<float>(views.resolution);
    for (GnLightView& view : views.views) {
        view.rect_ts = vec4(0, 0, glm::min(vec2(texels) / whole, vec2(nearly_all)));
        view.resolution = whole;
    }
}

/// Says of a single frame what was chosen; frames of a sequence leave it to their history.
void say(const FrameInput& input, const LightViews& views, ivec2 texels) {
    if (input.late_remarks != nullptr && input.history == nullptr) {
        input.late_remarks->insert(fmt::format("placement 'perceptual' draws {} x {} of {} x {} texels for light '{}'",
                                               texels.x, texels.y, views.resolution, views.resolution,
                                               input.light().name));
    }
}

/// Six faces where the receivers surround the light.
ivec2 place_around(LightViews& views, const FrameInput& input, const Recipe& recipe, const GnPerceptualParams& params,
                   const Radius& radius, const Guard& guard) {
    const ivec2 texels = choose(input, recipe, params, dvec2(2), on_plane(radius, reach_of(input)), guard);
    add_cube_views(views, input, guard, texels.x);
    return texels;
}

LightViews place_perceptual(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnPerceptualParams>("perceptual");
    const GnLight& light = input.light().shape;
    const Guard guard = guard_of(input, recipe);
    const Radius radius = filter_of(input, recipe, params, guard);
    LightViews views;
    views.resolution = static_cast<std::uint32_t>(recipe.resolution);
    ConvexBody body = potential_receivers(input);
    if (body.empty()) {
        body = body_of(Box{vec3(-1), vec3(1)});
    }

    // The plane as it is before texels widen it, then as many of them as the filter needs, and the view around both.
    Guard bare = guard;
    bare.texels = 0;
    const bool sun = light.kind == GN_LIGHT_DIRECTIONAL;
    const Fitted plain = sun ? Fitted{fit_orthographic(body, light, recipe.resolution, bare), true}
                             : fit_perspective(body, light, recipe.resolution, bare);
    ivec2 texels;
    if (!plain.valid) {
        texels = place_around(views, input, recipe, params, radius, guard);
    } else {
        const dvec2 extents(glsl::gn_light_plane(plain.view));
        texels = choose(input, recipe, params, extents, on_plane(radius, farthest_of(plain.view)), guard);
        const Fitted fitted = sun ? Fitted{fit_orthographic(body, light, texels, guard), true}
                                  : fit_perspective(body, light, texels, guard);
        views.views = {fitted.view};
        views.kind = sun ? ViewKind::affine : ViewKind::perspective;
    }
    draw_part(views, texels);
    say(input, views, texels);
    return views;
}

/// A filter in texels follows the resolution, and so says nothing about it.
std::string remark(const Scene&, const Recipe& recipe) {
    if (recipe.lookup == nullptr) {
        return {};
    }
    const bool radius = recipe.of<GnPerceptualParams>("perceptual").radius > 0 || varies(recipe);
    const Guard guard =
        recipe.lookup->guard != nullptr ? recipe.lookup->guard(recipe, {}, Box{vec3(0), vec3(1)}) : Guard{};
    return radius || guard.metres > 0
               ? ""
               : fmt::format(
                     "placement 'perceptual' draws all {} texels: lookup '{}' has no filter of a size in the world; "
                     "perceptual.radius gives it one, or a radius in metres of the lookup's own",
                     recipe.resolution, recipe.lookup->id);
}

ParamTable rows() {
    return param_table<GnPerceptualParams>({
        GN_PARAM(GnPerceptualParams, c, real, 0.1, 64, "texels",
                 "Radius of a filter that hides a texel's steps; 3.47 was fitted to what ten observers saw [Kre17]. "
                 "Less draws "
                 "fewer texels, and steps show."),
        GN_PARAM(
            GnPerceptualParams, radius, real, 0, 1, "of the scene",
            "The filter's radius as a share of the scene's diagonal, for kernels and blurs of 3.47 texels, which then "
            "have it; at 0 the lookup's own radius in metres counts."),
        GN_PARAM(
            GnPerceptualParams, least, real, 0.00001, 1, "of the scene",
            "The smallest radius that counts where the filter differs from sample to sample: at contacts it ends at "
            "nothing, and no resolution would do."),
        GN_PARAM(GnPerceptualParams, change, real, 0, 1000, "of itself",
                 "Most by which the resolution changes from frame to frame: less wobble, and later answers."),
    });
}

}  // namespace
}  // namespace gn::perceptual

namespace gn::parts {

const Part& placement_perceptual() {
    using namespace gn::perceptual;
    static const Part part = [] {
        Part p;
        p.id = "perceptual";
        p.stage = Stage::placement;
        p.title = "As many texels as the filter hides";
        p.citation = "Kre17";
        p.data_type = "GnFacesData";
        p.params = rows();
        p.params_type = "GnPerceptualParams";
        p.glsl = "shadow/placement/perceptual/perceptual.glsl";
        p.place = place_perceptual;
        p.remark = remark;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
