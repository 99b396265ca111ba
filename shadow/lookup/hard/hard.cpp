// SPDX-License-Identifier: MIT
// Hard shadows: one comparison.
//
// Based on: Williams. Casting Curved Shadows on Curved Surfaces. SIGGRAPH 1978. [Wil78]
#include "shadow/recipe/part.h"

namespace gn::parts {

const Part& lookup_hard() {
    static const Part part = [] {
        Part p;
        p.id = "hard";
        p.stage = Stage::lookup;
        p.title = "One comparison";
        p.citation = "Wil78";
        p.needs = {"depth"};
        p.optional = {"ids"};
        p.sides = {
            {"blocker-distance", "m", "How far along the light's depth what hides a sample lies before it."},
            {"confidence", "", "How near the centre of its texel a sample lies: 1 at it, 0 at the texel's border."},
            {"kernel-reach", "m", "How far around a sample, across the rays, casters change its V."}};
        p.glsl = "shadow/lookup/hard/hard.glsl";
        return p;
    }();
    return part;
}

}  // namespace gn::parts
