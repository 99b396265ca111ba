// SPDX-License-Identifier: MIT
// Which page of a virtual shadow map serves a receiver: of the level whose texels are as fine as its pixel, or the finest coarser one
// that is there. Level l of a face is 2^l x 2^l pages; a table of a window of each level, which wraps around, tells where they are.
// Compiles as GLSL and as C++.
// Based on: Karis, Stubbe, Wihlidal. A Deep Dive into Nanite Virtualized Geometry. SIGGRAPH Advances in Real-Time Rendering 2021.
// [KSW21]
#ifndef GN_SHADOW_PLACEMENT_VIRTUAL_GLSL
#define GN_SHADOW_PLACEMENT_VIRTUAL_GLSL

#include "shadow/placement/virtual/virtual.h"
#include "shadow/placement/faces.glsl"
#include "shadow/receiver/undersampling.glsl"

#ifdef __cplusplus
namespace gn::glsl {
#endif

// A page's name within its face and level; never 0.
GN_FN uint gn_virtual_tag(ivec2 page) { return 0x1000000u | (uint(page.y) << 12) | uint(page.x); }
GN_FN ivec2 gn_virtual_page(uint tag) { return ivec2(int(tag & 0xfffu), int((tag >> 12) & 0xfffu)); }

// Its place in the tables: coarse levels first, of each the faces, of each the window's rows.
GN_FN int gn_virtual_slot(int faces, int level, int face, ivec2 page) {
    return ((level * faces + face) * GN_VIRTUAL_SIDE + (page.y & (GN_VIRTUAL_SIDE - 1))) * GN_VIRTUAL_SIDE + (page.x & (GN_VIRTUAL_SIDE - 1));
}
GN_FN int gn_virtual_level(int faces, int slot) { return slot / (GN_VIRTUAL_SIDE * GN_VIRTUAL_SIDE) / faces; }
GN_FN int gn_virtual_face(int faces, int slot) { return slot / (GN_VIRTUAL_SIDE * GN_VIRTUAL_SIDE) % faces; }

// How much finer than those of level 0 texels must be to be no larger than a pixel of a receiver, as the power of two; its
// coordinates on level 0 change by these numbers of texels from pixel to pixel. Where light grazes a surface a texel is long: it counts
// as `stretch` times its mean side at most.
GN_FN float gn_virtual_wanted(vec2 to_right, vec2 downwards, GnVirtualData data) {
    float m = gn_undersampling_of(to_right, downwards);
    float area = abs(to_right.x * downwards.y - to_right.y * downwards.x);
    m = min(m, data.stretch / sqrt(max(area, 1.0e-30f))) * data.texels;
    return log2(max(m, 1.0e-6f));
}

// The level that is so fine, or where all are coarser by some quarters of a level: first quarters of what is wanted, then levels.
GN_FN int gn_virtual_level_of(float wanted, int coarser, int levels) {
    // A thousandth of a level is what rounding moves.
    int level = clamp(int(ceil(wanted - 0.25f * float(coarser & 3) - 0.001f)), 0, levels - 1);
    return max(level - (coarser >> 2), 0);
}

// The page of a level in which a point of the face lies, 0 to 1 across it.
GN_FN ivec2 gn_virtual_page_at(vec2 face_ts, int level) {
    int side = 1 << level;
    return clamp(ivec2(floor(face_ts * float(side))), ivec2(0), ivec2(side - 1));
}

// The view of a page: of its face's the part around the page, `border` texels of `texels` wider on each side, moved by so many.
GN_FN GnLightView gn_virtual_view(GnLightView face, int level, ivec2 page, float texels, float border, vec2 moved) {
    float across = float(1 << level);
    float scale = across * (texels - 2.0f * border) / texels;
    vec2 centre = (2.0f * vec2(page) + 1.0f) / across - 1.0f - 2.0f * moved / (texels * scale);
    GnLightView view = face;
    for (int column = 0; column < 4; ++column) {
        vec4 c = face.cs_from_ws[column];
        view.cs_from_ws[column] = vec4((c.x - centre.x * c.w) * scale, (c.y - centre.y * c.w) * scale, c.z, c.w);
    }
    view.ws_from_cs[0] = face.ws_from_cs[0] / scale;
    view.ws_from_cs[1] = face.ws_from_cs[1] / scale;
    view.ws_from_cs[3] = face.ws_from_cs[3] + face.ws_from_cs[0] * centre.x + face.ws_from_cs[1] * centre.y;
    return view;
}

// Where a receiver lies on its face, and how much finer than level 0 it asks texels to be.
struct GnVirtualPlace {
    vec2 face_ts;
    int face;
    float wanted;
};

// The rows x, y and w of the face's clip space.
GN_FN GnVirtualPlace gn_virtual_place(GnReceiver receiver, int face, vec4 x, vec4 y, vec4 w, GnVirtualData data) {
    vec4 p_ws = vec4(receiver.p_ws, 1.0f);
    float divisor = dot(w, p_ws);
    vec2 p_ndc = vec2(dot(x, p_ws), dot(y, p_ws)) / divisor;
    vec3 du_ws = (vec3(x) - p_ndc.x * vec3(w)) * (0.5f * data.page / divisor);
    vec3 dv_ws = (vec3(y) - p_ndc.y * vec3(w)) * (0.5f * data.page / divisor);
    GnVirtualPlace place;
    place.face = face;
    place.face_ts = 0.5f * p_ndc + 0.5f;
    place.wanted = gn_virtual_wanted(vec2(dot(du_ws, receiver.ddx_ws), dot(dv_ws, receiver.ddx_ws)),
                                     vec2(dot(du_ws, receiver.ddy_ws), dot(dv_ws, receiver.ddy_ws)), data);
    return place;
}

#ifdef __cplusplus
}  // namespace gn::glsl
#else

// Of each slot the tag of the page that is wanted there, and where it is in the pool, plus one: 0 where it is not. Behind all
// slots by how many quarters of a level all are coarser than was asked for.
uint gn_virtual_pages(int i);
// Rows x, y and w of each face's clip space.
vec4 gn_virtual_rows(int i);

GnVirtualPlace gn_virtual_place_of(GnReceiver receiver, GnVirtualData data) {
    int face = data.eye_ws.w > 0.5 ? gn_face_of(receiver.p_ws - data.eye_ws.xyz) : 0;
    return gn_virtual_place(receiver, face, gn_virtual_rows(3 * face), gn_virtual_rows(3 * face + 1), gn_virtual_rows(3 * face + 2), data);
}

// The finest page that is there, from the level asked for on; that of level 0 always is.
GnChoice gn_virtual_choose(GnReceiver receiver, GnVirtualData data) {
    GnVirtualPlace place = gn_virtual_place_of(receiver, data);
    int coarser = int(gn_virtual_pages(2 * gn_virtual_slot(data.faces, data.levels, 0, ivec2(0))));
    for (int level = gn_virtual_level_of(place.wanted, coarser, data.levels); level >= 0; --level) {
        ivec2 page = gn_virtual_page_at(place.face_ts, level);
        int slot = gn_virtual_slot(data.faces, level, place.face, page);
        uint held = gn_virtual_pages(2 * slot + 1);
        if (held != 0u && gn_virtual_pages(2 * slot) == gn_virtual_tag(page)) {
            return gn_only(int(held) - 1);
        }
    }
    return gn_only(0);
}

// The page that shows all of a receiver's face, coarsely: that of level 0, which always is there.
int gn_virtual_whole(GnReceiver receiver, GnVirtualData data) {
    int face = data.eye_ws.w > 0.5 ? gn_face_of(receiver.p_ws - data.eye_ws.xyz) : 0;
    return max(int(gn_virtual_pages(2 * gn_virtual_slot(data.faces, 0, face, ivec2(0)) + 1)) - 1, 0);
}
// For lookups that ask what a region holds, which lies on many pages (shadow/receiver/light_extent.glsl).
#define GN_WHOLE_CHOICE(receiver) gn_virtual_whole(receiver, placement)

// The level that a page's view belongs to: by how much it is narrower than the face. What pictures show of it.
#define GN_PAGE_LEVEL(view) gn_virtual_shown_level(view)
int gn_virtual_shown_level(GnLightView view) {
    vec3 across = gn_row(view.cs_from_ws, 0);
    vec3 along = gn_row(view.cs_from_ws, 3);
    across -= along * (dot(across, along) / max(dot(along, along), 1.0e-30));
    // A border makes a view less than twice as wide.
    return int(ceil(log2(length(across) / length(gn_virtual_rows(0).xyz)) - 0.01));
}
#endif

#endif
