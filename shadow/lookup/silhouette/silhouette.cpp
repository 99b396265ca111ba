// SPDX-License-Identifier: MIT
// Hard shadows with straight edges: one comparison, with the depth on the receiver's side of the silhouette.
//
// Based on: Sen, Cammarano, Hanrahan. Shadow Silhouette Maps. SIGGRAPH 2003. [SCH03]
//
// Stands on: shadow/map/silhouette_map (what a cell stores)
#include "shadow/recipe/part.h"

namespace gn::parts::silhouette {
namespace {

Guard guard(const Recipe&, const Light&, const Box&) {
    return {.texels = 2};
}

}  // namespace
}  // namespace gn::parts::silhouette

namespace gn::parts {

const Part& lookup_silhouette() {
    using namespace silhouette;
    static const Part part = [] {
        Part p;
        p.id = "silhouette";
        p.stage = Stage::lookup;
        p.title = "One comparison on the right side of the silhouette";
        p.citation = "SCH03";
        p.needs = {"silhouettes"};
        p.glsl = "shadow/lookup/silhouette/silhouette.glsl";
        p.guard = guard;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
