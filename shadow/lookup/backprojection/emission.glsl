// SPDX-License-Identifier: MIT
// What is hidden of a light that shows a picture: each of the mask's 256 points weighs what the picture sends from the sixteenth
// of the light's sides in which it lies alone.
// Based on: Schwarz, Stamminger. Bitmask Soft Shadows. Computer Graphics Forum 2007. [SS07]
// The integral: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09], eq. 1.3.
#ifndef GN_SHADOW_BACKPROJECTION_EMISSION_GLSL
#define GN_SHADOW_BACKPROJECTION_EMISSION_GLSL

#include "shadow/lookup/backprojection/bitmask.glsl"
#include "shadow/scene/emission.h"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// Cells along each side of the light, each with one of the mask's points.
const int gn_back_cells = 16;

// Row of the point in a cell: a tile's four points lie in its four cells.
GN_FN int gn_back_row_in(ivec2 cell) { return 2 * cell.y + (int(gn_back_column(2 * cell.y)) >> 1 == (cell.x & 1) ? 0 : 1); }

// Whether the point in a cell is hidden.
GN_FN bool gn_back_hides_cell(GnBackMask mask, ivec2 cell) {
    int k = gn_back_row_in(cell);
    int word = k >> 2;
    uint bits = word < 4 ? mask.low[word] : mask.high[word - 4];
    return ((bits >> uint(4 * (cell.x >> 1) + int(gn_back_column(k)))) & 1u) != 0u;
}

// Where in the light sample (i, j) of n * n within a cell lies.
GN_FN vec2 gn_back_in_cell(ivec2 cell, ivec2 at, int n) {
    return (vec2(cell) + (vec2(at) + 0.5f) / float(n)) * (2.0f / float(gn_back_cells)) - 1.0f;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// Of what all cells send in each colour the share that is hidden; of a colour that none sends the share of the points.
vec3 gn_back_unsent(GnBackMask mask, sampler2DArray sent) {
    vec3 hidden = vec3(0.0);
    vec3 all_sent = vec3(0.0);
    for (int i = 0; i < gn_back_cells * gn_back_cells; ++i) {
        ivec2 cell = ivec2(i % gn_back_cells, i / gn_back_cells);
        vec3 one = texelFetch(sent, ivec3(cell, 0), 0).rgb;
        hidden += gn_back_hides_cell(mask, cell) ? one : vec3(0.0);
        all_sent += one;
    }
    return mix(hidden / max(all_sent, vec3(1.0e-30)), vec3(gn_back_share(mask, false)), equal(all_sent, vec3(0.0)));
}
#endif

#endif
