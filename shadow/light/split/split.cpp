// SPDX-License-Identifier: MIT
// A light as smaller ones, each with a soft shadow of its own, from a map of its own: maps from several places see casters
// that one map has behind others.
//
// Based on: Yang, Feng, Guennebaud, Liu. Packet-based Hierarchal Soft Shadow Mapping. EGSR 2009. [YFG+09]
// Departs from it: round lights have pieces that overlap, and spread as the light does.
#include "shadow/light/split/split.h"

#include "base/disc.h"
#include "shadow/recipe/recipe.h"

#include <cmath>

namespace gn::parts::split {
namespace {

std::vector<GnLight> rectangles(const GnLight& light, int side) {
    const auto count = static_cast<float>(side);
    std::vector<GnLight> pieces;
    for (int i = 0; i < side * side; ++i) {
        const vec2 offset = ((2.0F * vec2(i % side, i / side) + 1.0F) / count - 1.0F) * light.half_size;
        GnLight piece = light;
        piece.position_ws += vec4(offset.x * vec3(light.right_ws) + offset.y * vec3(light.up_ws), 0);
        piece.half_size /= count;
        pieces.push_back(piece);
    }
    return pieces;
}

// Four pieces of half the radius r, whose points lie as far from the centre as those of the disc, on the root mean square: along
// each axis r^2 / 4 of the disc, r^2 / 16 of a piece within itself, so that 3/16 r^2 are left for where the pieces stand.

/// On a ring of radius R: R^2 / 2 along each axis.
const float ring = std::sqrt(3.0F / 8);

std::vector<GnLight> discs(const GnLight& light) {
    const bool sun = light.kind == GN_LIGHT_DIRECTIONAL;
    const float radius = sun ? std::tan(light.angular_radius) : light.radius;
    vec3 x;
    vec3 y;
    complete_frame(vec3(light.direction_ws), x, y);
    std::vector<GnLight> pieces;
    for (const vec3& way : {x + y, x - y, y - x, -x - y}) {
        const vec3 offset = ring * radius * std::sqrt(0.5F) * way;
        GnLight piece = light;
        piece.radius = sun ? light.radius : 0.5F * light.radius;
        if (sun) {
            piece.direction_ws = vec4(glm::normalize(vec3(light.direction_ws) + offset), 0);
            piece.angular_radius = std::atan(0.5F * radius);
        } else {
            piece.position_ws += vec4(offset, 0);
        }
        pieces.push_back(piece);
    }
    return pieces;
}

/// The corners of a tetrahedron, from wherever they are seen: R^2 / 3 along each axis.
std::vector<GnLight> spheres(const GnLight& light) {
    constexpr float corner = 0.75F;
    std::vector<GnLight> pieces;
    for (const vec3& way : {vec3(1, 1, 1), vec3(1, -1, -1), vec3(-1, 1, -1), vec3(-1, -1, 1)}) {
        GnLight piece = light;
        piece.position_ws += vec4(corner * light.radius * std::sqrt(1.0F / 3) * way, 0);
        piece.radius = 0.5F * light.radius;
        pieces.push_back(piece);
    }
    return pieces;
}

std::vector<GnLight> pieces_of(const GnLight& light, const GnSplitParams& params) {
    if (light.kind == GN_LIGHT_RECTANGLE) {
        return rectangles(light, light.half_size == vec2(0) ? 1 : params.side);
    }
    const float extent = light.kind == GN_LIGHT_DIRECTIONAL ? light.angular_radius : light.radius;
    if (params.round == 0 || params.side == 1 || extent == 0) {
        return {light};
    }
    return light.kind == GN_LIGHT_POINT ? spheres(light) : discs(light);
}

std::vector<Light> parts_of(const Light& light, const Recipe& recipe) {
    std::vector<Light> pieces;
    for (const GnLight& piece : pieces_of(light.shape, recipe.of<GnSplitParams>("split"))) {
        pieces.push_back({.name = light.name, .shape = piece, .spared = light.spared});
    }
    return pieces;
}

std::string refuses(const Scene&, const Light& light, const Recipe& recipe) {
    const auto params = recipe.of<GnSplitParams>("split");
    const bool moves = light.shape.kind == GN_LIGHT_SPOT && pieces_of(light.shape, params).size() > 1;
    if (moves && recipe.map != nullptr && recipe.placement != nullptr && recipe.placement->from_centre) {
        return fmt::format(
            "placement '{}' sees the cone of light '{}' from its centre, and light 'split' looks from four other "
            "points; use placement=fit or cube",
            recipe.placement->id, light.name);
    }
    if (params.fusion != GN_FUSION_SUM && recipe.translucent_map != nullptr) {
        return "coloured shadows are summed over the light's pieces; split.fusion=sum does so";
    }
    return {};
}

std::string remark(const Scene& scene, const Recipe& recipe) {
    if (recipe.of<GnSplitParams>("split").round != 0) {
        return {};
    }
    for (const Light& light : scene.lights) {
        if (light.shape.kind != GN_LIGHT_RECTANGLE && light.shape.kind != GN_LIGHT_ENVIRONMENT) {
            return fmt::format(
                "light 'split' leaves '{}' whole: only rectangles have pieces of their own shape; split.round=true "
                "cuts others into four that overlap",
                light.name);
        }
    }
    return {};
}

}  // namespace
}  // namespace gn::parts::split

namespace gn::parts {

const Part& light_split() {
    using namespace split;
    static const Part part = [] {
        Part p;
        p.id = "split";
        p.stage = Stage::light;
        p.title = "A light as smaller lights, each with a map of its own";
        p.citation = "YFG+09";
        p.params = param_table<GnSplitParams>({
            GN_PARAM(GnSplitParams, side, integer, 1, 8, "",
                     "Pieces along each side: more maps see more of what casts, cost grows with the square."),
            GN_PARAM(
                GnSplitParams, round, boolean, 0, 1, "",
                "Discs, spheres and suns, too, are cut, into four of half their radius where `side` is above 1; else "
                "they stay whole."),
            GN_CHOICE(GnSplitParams, fusion,
                      "What pieces hide together, of which each hides a share of the whole light: the sum, which is "
                      "right for "
                      "pieces that lie apart as these do; the greatest, the middle of the two, or the product of what "
                      "they leave, "
                      "which err as they do for casters.",
                      "sum", "max", "mean", "product"),
        });
        p.params_type = "GnSplitParams";
        p.glsl = "shadow/light/split/split.glsl";
        p.split = parts_of;
        p.refuses = refuses;
        p.remark = remark;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
