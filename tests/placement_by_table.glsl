// SPDX-License-Identifier: MIT
// A placement of the tests: cascades, found through a table and a texture.
#ifndef GN_TESTS_PLACEMENT_BY_TABLE_GLSL
#define GN_TESTS_PLACEMENT_BY_TABLE_GLSL

#include "shadow/placement/cascades/cascades.glsl"

uint gn_by_table_order(int i);

GnChoice gn_by_table_choose(GnReceiver receiver, GnCascadesData data, sampler2DArray order_again) {
    GnChoice choice = gn_cascades_choose(receiver, data);
    choice.first = int(gn_by_table_order(choice.first));
    choice.second = choice.second < 0 ? choice.second : int(texelFetch(order_again, ivec3(choice.second, 0, 0), 0).r + 0.5);
    return choice;
}

#endif
