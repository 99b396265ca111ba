// SPDX-License-Identifier: MIT
// The plain shadow map: the linear depth of the nearest caster, D32_SFLOAT.
//
// Based on: Williams. Casting Curved Shadows on Curved Surfaces. SIGGRAPH 1978. [Wil78]
// Departs from it: depth is linear in distance under every projection, so one bias means the same everywhere.
#include "shadow/casters/caster_depth.h"
#include "shadow/recipe/part.h"

namespace gn::parts {

const Part& map_depth() {
    static const Part part = [] {
        Part p;
        p.id = "depth";
        p.stage = Stage::map;
        p.title = "Linear depth of the nearest caster";
        p.citation = "Wil78";
        p.gives = {"depth", "ids"};
        p.separates_casters = true;
        p.add_map = add_caster_depth;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
