// SPDX-License-Identifier: MIT
// A rectangle as smaller ones, each with a soft shadow of its own, from a map of its own: maps from several places see casters
// that one map has behind others.
//
// Based on: Yang, Feng, Guennebaud, Liu. Packet-based Hierarchal Soft Shadow Mapping. EGSR 2009. [YFG+09]
#include "shadow/light/split/split.h"

#include "shadow/recipe/recipe.h"

namespace gn {
namespace {

std::vector<Light> split(const Light& light, const Recipe& recipe) {
    const int side = light.shape.kind == GN_LIGHT_RECTANGLE ? recipe.of<GnSplitParams>("split").side : 1;
    const auto count = static_cast<float>(side);
    std::vector<Light> pieces;
    for (int i = 0; i < side * side; ++i) {
        const vec2 at = (2.0F * vec2(i % side, i / side) + 1.0F) / count - 1.0F;
        Light piece{.name = light.name, .shape = light.shape, .spared = light.spared};
        const vec2 offset = at * light.shape.half_size;
        piece.shape.position_ws += vec4(offset.x * vec3(light.shape.right_ws) + offset.y * vec3(light.shape.up_ws), 0);
        piece.shape.half_size /= count;
        pieces.push_back(std::move(piece));
    }
    return pieces;
}

std::string remark(const Scene& scene, const Recipe&) {
    for (const Light& light : scene.lights) {
        if (light.shape.kind != GN_LIGHT_RECTANGLE && light.shape.kind != GN_LIGHT_ENVIRONMENT) {
            return fmt::format("light 'split' leaves '{}' whole: only rectangles have pieces of their own shape",
                               light.name);
        }
    }
    return {};
}

}  // namespace

namespace parts {

const Part& light_split() {
    static const Part part = [] {
        Part p;
        p.id = "split";
        p.stage = Stage::light;
        p.title = "A rectangle as smaller rectangles, each with a map of its own";
        p.citation = "YFG+09";
        p.params = param_table<GnSplitParams>({
            GN_PARAM(GnSplitParams, side, integer, 1, 8, "",
                     "Pieces along each side: more maps see more of what casts, cost grows with the square."),
        });
        p.params_type = "GnSplitParams";
        p.glsl = "shadow/light/split/split.glsl";
        p.split = split;
        p.remark = remark;
        return p;
    }();
    return part;
}

}  // namespace parts
}  // namespace gn
