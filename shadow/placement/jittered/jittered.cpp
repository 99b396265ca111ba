// SPDX-License-Identifier: MIT
// The views of another placement, moved by a part of a texel from frame to frame, so that a sequence of maps sees what lies
// between the texels of one.
//
// Based on: Scherzer, Jeschke, Wimmer. Pixel-Correct Shadow Maps with Temporal Reprojection and Shadow Test Confidence. EGSR
// 2007. [SJW07]
//
// Stands on: shadow/placement/fit, shadow/placement/lispsm, shadow/placement/tsm, shadow/placement/psm, shadow/placement/cube
// (whose views are moved)
#include "shadow/placement/jittered/jittered.h"

#include "shadow/frame/history.h"
#include "shadow/placement/jittered/jittered.glsl"
#include "shadow/recipe/recipe.h"

#include <array>

namespace gn::parts::jittered {
namespace {

const Part& moved_of(const Recipe& recipe) {
    static constexpr std::array<std::string_view, 5> ids{"fit", "lispsm", "tsm", "psm", "cube"};
    return find_part(Stage::placement, ids.at(static_cast<std::size_t>(recipe.of<GnJitteredParams>("jittered").of)));
}

/// Moves what a view sees by texels of its rectangle.
void move(GnLightView& view, dvec2 texels) {
    const dvec2 rectangle = dvec2(view.rect_ts.z, view.rect_ts.w) * static_cast<double>(view.resolution);
    const dvec2 shift_cs = 2.0 * texels / rectangle;
    dmat4 cs_from_ws = view.cs_from_ws;
    for (int column = 0; column < 4; ++column) {
        cs_from_ws[column].x += shift_cs.x * cs_from_ws[column].w;
        cs_from_ws[column].y += shift_cs.y * cs_from_ws[column].w;
    }
    view.cs_from_ws = mat4(cs_from_ws);
    view.ws_from_cs = mat4(glm::inverse(cs_from_ws));
}

LightViews place_jittered(const FrameInput& input, const Recipe& recipe) {
    LightViews views = moved_of(recipe).place(input, recipe);
    if (input.history == nullptr) {
        return views;
    }
    const double extent = static_cast<double>(recipe.of<GnJitteredParams>("jittered").extent);
    const dvec2 texels = extent * dvec2(glsl::gn_jitter(static_cast<std::uint32_t>(input.history->frame())));
    for (GnLightView& view : views.views) {
        move(view, texels);
    }
    return views;
}

std::string refuses(const Scene&, const Light& light, const Recipe& recipe) {
    const Part& moved = moved_of(recipe);
    return moved.lights.has(light.shape.kind)
               ? ""
               : fmt::format(
                     "jittered.of = {}: placement '{}' serves {} lights, and '{}' is none; jittered.of = fit "
                     "serves all",
                     moved.id, moved.id, moved.lights.names(), light.name);
}

}  // namespace
}  // namespace gn::parts::jittered

namespace gn::parts {

const Part& placement_jittered() {
    using namespace jittered;
    static const Part part = [] {
        Part p;
        p.id = "jittered";
        p.stage = Stage::placement;
        p.title = "Views that move by parts of a texel from frame to frame";
        p.citation = "SJW07";
        p.data_type = "GnFacesData";
        p.params = param_table<GnJitteredParams>({
            GN_CHOICE(GnJitteredParams, of, "The placement whose views are moved.", "fit", "lispsm", "tsm", "psm",
                      "cube"),
            GN_PARAM(GnJitteredParams, extent, real, 0, 1, "texels",
                     "How far apart the places are at most: at 1 they fill a texel, at 0 the map stands still."),
        });
        p.params_type = "GnJitteredParams";
        p.glsl = "shadow/placement/jittered/jittered.glsl";
        p.place = place_jittered;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
