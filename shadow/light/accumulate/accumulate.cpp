// SPDX-License-Identifier: MIT
// An area light as many points, each with a hard shadow of its own: soft shadows without any assumption about what casts
// them, at the price of as many shadows.
//
// Based on: Haeberli, Akeley. The Accumulation Buffer: Hardware Support for High-Quality Rendering. SIGGRAPH 1990. [HA90]
// Departs from it: points of a sphere weigh what each receiver sees of them; pixels may share the points out.
#include "shadow/light/accumulate/accumulate.h"

#include "shadow/light/weighted.h"
#include "shadow/recipe/recipe.h"
#include "shadow/scene/light_samples.h"

#include <cmath>

namespace gn::parts::accumulate {
namespace {

/// Of more points than this a light is not summed.
constexpr int most_lights = 1024;

int points_of(const GnAccumulateParams& params) {
    return params.error > 0 ? points_within(params.error) : params.lights;
}

std::vector<Light> split(const Light& light, const Recipe& recipe) {
    const auto params = recipe.of<GnAccumulateParams>("accumulate");
    std::vector<Light> lights;
    for (const GnLight& point : light_samples(light.shape, points_of(params), params.share).points) {
        lights.push_back({.name = light.name, .shape = point, .spared = light.spared});
    }
    return lights;
}

PixelLattice pixels(int index, int count, const Recipe& recipe) {
    const int side = recipe.of<GnAccumulateParams>("accumulate").share;
    if (side * side > count) {
        return {};
    }
    const int cell = gn_point_cell(index, count, side);
    return {ivec2(cell % side, cell / side), side};
}

std::string refuses(const Scene&, const Light& light, const Recipe& recipe) {
    const auto params = recipe.of<GnAccumulateParams>("accumulate");
    const int count = points_of(params);
    if (count > most_lights) {
        return fmt::format(
            "light 'accumulate' would need {} lights to err by no more than {:.3g}; accumulate.error is at least "
            "{:.3g}, "
            "or 0 to take accumulate.lights",
            count, params.error, 63.0 / most_lights);
    }
    if (params.share * params.share > count) {
        return fmt::format(
            "light 'accumulate' cannot share {} lights among {} x {} pixels; accumulate.share is at most {}", count,
            params.share, params.share, static_cast<int>(std::sqrt(static_cast<float>(count))));
    }
    return refuses_one_centre(light, recipe);
}

}  // namespace
}  // namespace gn::parts::accumulate

namespace gn {

int points_within(float error) {
    GN_CHECK(error > 0);
    int side = 1;
    while (static_cast<float>(2 * side - 1) > error * static_cast<float>(side * side) && side < 4096) {
        side *= 2;
    }
    return side * side;
}

}  // namespace gn

namespace gn::parts {

const Part& light_accumulate() {
    using namespace accumulate;
    static const Part part = [] {
        Part p;
        p.id = "accumulate";
        p.stage = Stage::light;
        p.title = "Soft shadows summed from the hard shadows of points of the light";
        p.citation = "HA90";
        p.params = param_table<GnAccumulateParams>({
            GN_PARAM(GnAccumulateParams, lights, integer, 1, most_lights, "",
                     "Finer steps in penumbrae, cost grows in proportion; memory does not."),
            GN_PARAM(
                GnAccumulateParams, share, integer, 1, 8, "pixels",
                "Side of the square of pixels that share the points out: fewer lookups, and noise for a filter of V "
                "instead of steps."),
            GN_PARAM(GnAccumulateParams, error, real, 0, 1, "",
                     "Most that V may err by along a straight edge: takes as many points as that needs instead of "
                     "`lights`; 0 takes these."),
        });
        p.params_type = "GnAccumulateParams";
        p.glsl = "shadow/light/accumulate/accumulate.glsl";
        p.split = split;
        p.pixels = pixels;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
