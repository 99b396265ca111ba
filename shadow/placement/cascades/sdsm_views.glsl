// SPDX-License-Identifier: MIT
// One orthographic view around each slice's samples, of the rectangles found the one of least area, wide enough for the
// kernels; and what the choice reads.
#include "shadow/placement/cascades/sdsm_steps.glsl"
layout(local_size_x = 1) in;

void set_row(inout mat4 m, int row, vec4 values) {
    for (int column = 0; column < 4; ++column) {
        m[column][row] = values[column];
    }
}

float lowest(int i, int axis) { return unordered(~r.lowest[GN_SDSM_AXES * i + axis]); }
float highest(int i, int axis) { return unordered(r.highest[GN_SDSM_AXES * i + axis]); }
bool has_samples(int i) { return r.highest[GN_SDSM_AXES * i] != 0u; }

// Low and high along an axis, never shorter than what one pixel sees.
vec2 span(int i, int axis) {
    vec2 ends = has_samples(i) ? vec2(lowest(i, axis), highest(i, axis)) : vec2(-1.0, 1.0);
    float half_size = max(0.5 * (ends.y - ends.x), 1.0e-4 * r.ends[i + 1]);
    return vec2(0.5 * (ends.x + ends.y)) + vec2(-half_size, half_size);
}

// Where a receiver may be served by a cascade of another slice, all share one range of depths.
vec2 depths(int i) {
    const int axis = 2 * GN_SDSM_TURNS;
    vec2 ends = span(i, axis);
    for (int k = 0; k < u.params.count && has_samples(i) && u.params.select == GN_SELECT_PROJECTION; ++k) {
        ends = has_samples(k) ? vec2(min(ends.x, span(k, axis).x), max(ends.y, span(k, axis).y)) : ends;
    }
    return ends;
}

// Half the sides of the rectangle at a turn, with room for kernels.
vec2 half_sides(int i, int turn, float share) {
    vec2 a = span(i, turn);
    vec2 b = span(i, turn + GN_SDSM_TURNS);
    return (0.5 * vec2(a.y - a.x, b.y - b.x) * 1.0001 + u.guard_metres) / (1.0 - 2.0 * share);
}

void main() {
    int count = u.params.count;
    placement.count = count;
    placement.transition = u.params.transition;
    placement.select = u.params.select;
    placement.width = u.params.width;
    placement.near = r.ends[0];
    placement.limit = 1.0 - 2.0 * min(0.4, u.guard_texels / u.resolution);
    placement.halved = u.halved;
    placement.x_ws = vec4(u.x_ws.xyz, 0.0);
    placement.y_ws = vec4(u.y_ws.xyz, 0.0);
    for (int i = 0; i < count; ++i) {
        // A kernel is a larger share of a smaller map.
        float side = u.rects_ts[i].z * u.resolution;
        float share = min(0.4, u.guard_texels / side);

        // The turn of least area.
        int turn = 0;
        vec2 h = half_sides(i, 0, share);
        for (int t = 1; t < GN_SDSM_TURNS; ++t) {
            vec2 tried = half_sides(i, t, share);
            if (tried.x * tried.y < h.x * h.y) {
                turn = t;
                h = tried;
            }
        }
        vec2 c = gn_sdsm_axis(turn);
        vec4 right_ws = c.x * u.x_ws + c.y * u.y_ws;
        vec4 down_ws = c.x * u.y_ws - c.y * u.x_ws;
        vec2 a = span(i, turn);
        vec2 b = span(i, turn + GN_SDSM_TURNS);
        vec2 centre = 0.5 * vec2(a.x + a.y, b.x + b.y);
        vec2 depth = depths(i);
        float slack = 5.0e-4 * (depth.y - depth.x) + u.guard_metres + (2.0 + 2.0 * u.guard_texels) * 2.0 * max(h.x, h.y) / side;
        // Towards the light as far as a lookup asks how far away casters are.
        float near = depth.x - slack - u.guard_before;
        float metres = depth.y + slack - near;

        GnLightView view;
        view.cs_from_ws = mat4(1.0);
        set_row(view.cs_from_ws, 0, vec4(right_ws.xyz, -(right_ws.w + centre.x)) / h.x);
        set_row(view.cs_from_ws, 1, vec4(down_ws.xyz, -(down_ws.w + centre.y)) / h.y);
        view.depth_from_ws = vec4(u.z_ws.xyz, -(u.z_ws.w + near)) / metres;
        set_row(view.cs_from_ws, 2, view.depth_from_ws);
        vec3 corner_ws = u.eye_ws.xyz + right_ws.xyz * centre.x + down_ws.xyz * centre.y + u.z_ws.xyz * near;
        view.ws_from_cs = mat4(vec4(right_ws.xyz * h.x, 0.0), vec4(down_ws.xyz * h.y, 0.0),
                               vec4(u.z_ws.xyz * metres, 0.0), vec4(corner_ws, 1.0));
        view.rect_ts = u.rects_ts[i];
        view.eye_ws = vec4(-u.z_ws.xyz, 0.0);
        view.metres_per_depth = metres;
        view.resolution = u.resolution;
        view.layer = u.layers[i];
        view.grid = 0.0;
        view.paraboloid = 0.0;
        views[i] = view;

        placement.ends[i] = r.ends[i + 1];
        placement.fits[i] = vec4(1.0 / h.x, 1.0 / h.y, view.cs_from_ws[3][0], view.cs_from_ws[3][1]);
        placement.angles[i] = atan(c.y, c.x);
    }
}
