// SPDX-License-Identifier: MIT
// Contact-hardening shadows: search and filter read a grid of few texels, of the mip in which it spans the kernel.
//
// Based on: Sikachev, Delmont, Doyon, Bucci. Next-Generation Rendering in Thief. GPU Pro 6, 2015. [SDDB15]
// Stands on: shadow/receiver/light_extent.glsl (the light as a receiver sees it, and where what hides it can lie)
#include "shadow/lookup/chs/chs.h"

#include "shadow/recipe/light_guard.h"
#include "shadow/recipe/recipe.h"

namespace gn::parts::chs {
namespace {

Guard guard(const Recipe& recipe, const Light& light, const Box& bounds_ws) {
    return light_guard(light, bounds_ws, recipe.of<GnChsParams>("chs").least);
}

ParamTable rows() {
    return param_table<GnChsParams>({
        GN_PARAM(GnChsParams, side, integer, 3, 16, "texels",
                 "Side of the grid: smoother and truer penumbrae, cost grows with its square."),
        GN_CHOICE(
            GnChsParams, texels,
            "A mip's texel on both sides of the receiver's plane is looked into point by point, or is as far away as "
            "its mean, which is faster and widens shadows.",
            "points", "mean"),
        GN_PARAM(GnChsParams, finer, integer, 0, 4, "mips",
                 "How much finer such a texel is read: smoother penumbrae, cost grows fourfold there with each."),
        GN_PARAM(GnChsParams, least, real, 0, 16, "texels",
                 "Half width of the narrowest kernel: below one the map's texels show at contacts."),
        GN_PARAM(
            GnChsParams, early_out, boolean, 0, 1, "",
            "Skips the search where the least and greatest depth of its region say that all of the light is seen, or "
            "none."),
    });
}

}  // namespace
}  // namespace gn::parts::chs

namespace gn::parts {

const Part& lookup_chs() {
    using namespace chs;
    static const Part part = [] {
        Part p;
        p.id = "chs";
        p.stage = Stage::lookup;
        p.title = "Contact-hardening shadows";
        p.citation = "SDDB15";
        p.needs = {"depth", "min-max", "mip-depths"};
        p.params = rows();
        p.params_type = "GnChsParams";
        p.glsl = "shadow/lookup/chs/chs.glsl";
        p.guard = guard;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
