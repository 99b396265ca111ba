// SPDX-License-Identifier: MIT
// Sample distribution shadow maps: one reduction finds where the samples are, the next what each slice's samples span in
// light space; views are written by a shader and read by shaders. Nothing is read back, nothing lags a frame.
//
// Based on: Lauritzen, Salvi, Lefohn. Sample Distribution Shadow Maps. I3D 2011. [LSL10]
// Departs from it: the histogram's splits minimize the mean size of a texel, where the paper's partitions are heuristics; only samples that face the light count, and an invocation reduces a column of pixels in registers
// before one atomic, where the paper uses shared memory.
#include "shadow/placement/cascades/sdsm.h"

#include "shadow/placement/cascades/cascade_views.h"

namespace gn::cascades {
namespace {

constexpr const char* head_text = R"(
#include "shadow/placement/cascades/cascades.glsl"
#include "shadow/placement/cascades/sdsm.h"
layout(binding = 0, scalar) uniform Constants { GnSdsmConstants u; };
layout(binding = 1, scalar) buffer Reduction { GnSdsmReduction r; };

// Bits that order as floats do; 0 is below every number.
uint ordered(float x) {
    uint bits = floatBitsToUint(x);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
float unordered(uint bits) {
    return uintBitsToFloat((bits & 0x80000000u) != 0u ? bits & 0x7FFFFFFFu : ~bits);
}
)";

constexpr const char* pixels_text = R"(
layout(local_size_x = 64) in;
layout(binding = 2) uniform sampler2D gbuffer_position;
layout(binding = 3) uniform sampler2D gbuffer_normal;

// The sample of a pixel, and whether it counts for the light.
bool fetch(ivec2 pixel, out vec3 p_ws, out float distance) {
    vec4 position = texelFetch(gbuffer_position, pixel, 0);
    vec4 normal = texelFetch(gbuffer_normal, pixel, 0);
    p_ws = position.xyz;
    distance = normal.w;
    return position.w > 0.5 && distance > 0.0 && gn_counted(u.light, p_ws, normal.xyz);
}
)";

// Nearest and farthest sample, and how many lie in each ratio of distances.
constexpr const char* distances_text = R"(
void main() {
    uint x = gl_GlobalInvocationID.x;
    uint y = gl_GlobalInvocationID.y * GN_SDSM_ROWS;
    if (x >= u.size.x) {
        return;
    }
    uint nearest = 0u;
    uint farthest = 0u;
    int bin = -1;
    uint run = 0u;
    for (uint end = min(y + GN_SDSM_ROWS, u.size.y); y < end; ++y) {
        vec3 p_ws;
        float distance;
        if (!fetch(ivec2(x, y), p_ws, distance)) {
            continue;
        }
        nearest = max(nearest, ~ordered(distance));
        farthest = max(farthest, ordered(distance));
        float t = log(distance / u.near) / log(u.far / u.near);
        int at = clamp(int(t * GN_SDSM_BINS), 0, GN_SDSM_BINS - 1);
        if (at != bin && run > 0u) {
            atomicAdd(r.bins[bin], run);
            run = 0u;
        }
        bin = at;
        run += 1u;
    }
    if (run > 0u) {
        atomicAdd(r.bins[bin], run);
        atomicMax(r.nearest, nearest);
        atomicMax(r.farthest, farthest);
    }
}
)";

// Slices of equal ratio between nearest and farthest ([LSL10] 3.1); or, where the histogram counts, those that minimize the
// mean over all samples of the size of their texels: a slice that ends at z has texels proportional to z, and a sample errs
// where an edge lies within a texel of it. Gaps between the samples take no slice by themselves.
constexpr const char* splits_text = R"(
layout(local_size_x = 1) in;
const int COARSE = 64;  // bins that a slice can end at
const float NEVER = 1.0e30;

float edge(int bin) { return gn_cascades_log(u.near, u.far, float(bin) / float(COARSE)); }

void main() {
    bool none = r.farthest == 0u;
    float near = none ? 1.0 : unordered(~r.nearest) * (1.0 - 1.0e-5);
    float far = none ? 2.0 : unordered(r.farthest) * (1.0 + 1.0e-5);
    int count = u.params.count;
    for (int i = 0; i <= count; ++i) {
        r.ends[i] = i == 0 ? near : i == count ? far : gn_cascades_log(near, far, float(i) / float(count));
    }
    if (none || u.params.split != GN_SPLIT_SDSM_HISTOGRAM) {
        return;
    }
    // Samples before every edge.
    float sums[COARSE + 1];
    sums[0] = 0.0;
    for (int b = 0; b < COARSE; ++b) {
        sums[b + 1] = sums[b];
        for (int fine = 0; fine < GN_SDSM_BINS / COARSE; ++fine) {
            sums[b + 1] += float(r.bins[b * (GN_SDSM_BINS / COARSE) + fine]);
        }
    }
    // best[b]: least cost of all samples before edge b in i slices, the last beginning at edge starts[i][b].
    float best[COARSE + 1];
    int starts[GN_CASCADES_MOST * (COARSE + 1)];
    for (int b = 0; b <= COARSE; ++b) {
        best[b] = min(edge(b), far) * sums[b];
        starts[b] = 0;
    }
    for (int i = 1; i < count; ++i) {
        for (int b = COARSE; b >= 1; --b) {
            float least = NEVER;
            int start = 0;
            for (int a = 0; a <= b; ++a) {
                float cost = best[a] + min(edge(b), far) * (sums[b] - sums[a]);
                if (cost < least) {
                    least = cost;
                    start = a;
                }
            }
            best[b] = least;
            starts[i * (COARSE + 1) + b] = start;
        }
    }
    // Walk back from the last slice.
    int b = COARSE;
    for (int i = count - 1; i >= 1; --i) {
        b = starts[i * (COARSE + 1) + b];
        r.ends[i] = clamp(edge(b), near, r.ends[i + 1]);
    }
}
)";

// Light space bounds of every slice's samples ([LSL10] 3.3).
constexpr const char* bounds_text = R"(
void flush(int cascade, vec3 low, vec3 high) {
    for (int axis = 0; axis < 3; ++axis) {
        atomicMax(r.lowest[3 * cascade + axis], ~ordered(low[axis]));
        atomicMax(r.highest[3 * cascade + axis], ordered(high[axis]));
    }
}

void main() {
    uint x = gl_GlobalInvocationID.x;
    uint y = gl_GlobalInvocationID.y * GN_SDSM_ROWS;
    if (x >= u.size.x) {
        return;
    }
    float width = u.params.transition == GN_TRANSITION_NONE ? 0.0 : u.params.width;
    int cascade = 0;
    bool any = false;
    vec3 low = vec3(0.0);
    vec3 high = vec3(0.0);
    for (uint end = min(y + GN_SDSM_ROWS, u.size.y); y < end; ++y) {
        vec3 p_ws;
        float distance;
        if (!fetch(ivec2(x, y), p_ws, distance)) {
            continue;
        }
        int at = 0;
        while (at + 1 < u.params.count && distance > r.ends[at + 1]) {
            at += 1;
        }
        vec3 d_ws = p_ws - u.eye_ws.xyz;
        vec3 p_ls = vec3(dot(u.x_ws.xyz, d_ws), dot(u.y_ws.xyz, d_ws), dot(u.z_ws.xyz, d_ws));
        if (any && at != cascade) {
            flush(cascade, low, high);
            any = false;
        }
        low = any ? min(low, p_ls) : p_ls;
        high = any ? max(high, p_ls) : p_ls;
        cascade = at;
        any = true;
        // A sample in the transition's band belongs to the next slice too.
        float position = (distance - r.ends[at]) / max(r.ends[at + 1] - r.ends[at], 1.0e-6);
        if (at + 1 < u.params.count && gn_cascades_band(position, 1.01 * width) > 0.0) {
            flush(at + 1, p_ls, p_ls);
        }
    }
    if (any) {
        flush(cascade, low, high);
    }
}
)";

// One orthographic view around each slice's bounds, wide enough for the kernels; and what the choice reads.
constexpr const char* views_text = R"(
#include "shadow/light_view.h"
layout(local_size_x = 1) in;
layout(binding = 4, scalar) buffer Views { GnLightView views[]; };
layout(binding = 5, scalar) buffer Placement { GnPlacementData placement; };

void set_row(inout mat4 m, int row, vec4 values) {
    for (int column = 0; column < 4; ++column) {
        m[column][row] = values[column];
    }
}

vec3 lowest(int i) {
    return vec3(unordered(~r.lowest[3 * i]), unordered(~r.lowest[3 * i + 1]), unordered(~r.lowest[3 * i + 2]));
}
vec3 highest(int i) {
    return vec3(unordered(r.highest[3 * i]), unordered(r.highest[3 * i + 1]), unordered(r.highest[3 * i + 2]));
}
bool has_samples(int i) { return r.highest[3 * i] != 0u; }

// All cascades' depths, where a receiver may be served by a cascade of another slice.
vec2 shared_depths() {
    vec2 depths = vec2(1.0e30, -1.0e30);
    for (int i = 0; i < u.params.count; ++i) {
        if (has_samples(i)) {
            depths = vec2(min(depths.x, lowest(i).z), max(depths.y, highest(i).z));
        }
    }
    return depths;
}

void main() {
    int count = u.params.count;
    float share = min(0.4, u.guard_texels / u.resolution);
    placement.values[0] = vec4(count, u.params.transition, u.params.select, u.params.width);
    placement.values[3] = vec4(r.ends[0], 1.0 - 2.0 * share, 0.0, 0.0);
    placement.values[4] = vec4(u.x_ws.xyz, 0.0);
    placement.values[5] = vec4(u.y_ws.xyz, 0.0);
    placement.values[14] = vec4(0.0);
    placement.values[15] = vec4(0.0);
    for (int i = 0; i < count; ++i) {
        vec3 low = has_samples(i) ? lowest(i) : vec3(-1.0);
        vec3 high = has_samples(i) ? highest(i) : vec3(1.0);
        if (has_samples(i) && u.params.select == GN_SELECT_PROJECTION) {
            vec2 depths = shared_depths();
            low.z = depths.x;
            high.z = depths.y;
        }
        // No side shorter than what one pixel sees.
        vec3 half_size = max(0.5 * (high - low), vec3(1.0e-4 * r.ends[i + 1]));
        vec3 centre = 0.5 * (low + high);
        vec2 h = (half_size.xy * 1.0001 + u.guard_metres) / (1.0 - 2.0 * share);
        float slack = 1.0e-3 * half_size.z + u.guard_metres + 2.0 * max(h.x, h.y) / u.resolution;
        float near = centre.z - half_size.z - slack;
        float metres = 2.0 * (half_size.z + slack);

        GnLightView view;
        view.cs_from_ws = mat4(1.0);
        set_row(view.cs_from_ws, 0, vec4(u.x_ws.xyz, -(u.x_ws.w + centre.x)) / h.x);
        set_row(view.cs_from_ws, 1, vec4(u.y_ws.xyz, -(u.y_ws.w + centre.y)) / h.y);
        view.depth_from_ws = vec4(u.z_ws.xyz, -(u.z_ws.w + near)) / metres;
        set_row(view.cs_from_ws, 2, view.depth_from_ws);
        vec3 corner_ws = u.eye_ws.xyz + u.x_ws.xyz * centre.x + u.y_ws.xyz * centre.y + u.z_ws.xyz * near;
        view.ws_from_cs = mat4(vec4(u.x_ws.xyz * h.x, 0.0), vec4(u.y_ws.xyz * h.y, 0.0), vec4(u.z_ws.xyz * metres, 0.0),
                               vec4(corner_ws, 1.0));
        view.rect_ts = vec4(0.0, 0.0, 1.0, 1.0);
        view.eye_ws = vec4(-u.z_ws.xyz, 0.0);
        view.metres_per_depth = metres;
        view.resolution = u.resolution;
        view.layer = i;
        view.affine_depth = 1;
        view.grid = 0.0;
        view.paraboloid = 0.0;
        views[i] = view;

        placement.values[1 + i / 4][i % 4] = r.ends[i + 1];
        placement.values[6 + i] = vec4(1.0 / h.x, 1.0 / h.y, view.cs_from_ws[3][0], view.cs_from_ws[3][1]);
    }
}
)";

ComputeDesc shader(const char* name, const std::string& text) {
    return {{ShaderKind::compute, name, head_text + text}, {}};
}

GnSdsmConstants constants_of(const FrameInput& input, const Recipe& recipe, const GnCascadesParams& params) {
    const Camera& camera = input.samples.camera;
    const LightFrame frame = facing(camera, input.light().shape);
    const Guard guard = guard_of(recipe);
    const dvec3 eye(camera.position_ws);
    const auto axis = [&](dvec3 direction) { return vec4(dvec4(direction, glm::dot(direction, eye))); };
    GnSdsmConstants u;
    u.light = input.light().shape;
    u.params = params;
    u.x_ws = axis(frame.x);
    u.y_ws = axis(frame.y);
    u.z_ws = axis(frame.z);
    u.eye_ws = vec4(camera.position_ws, 1);
    u.size = uvec2(input.samples.width, input.samples.height);
    u.near = camera.near;
    u.far = camera.far;
    u.resolution = static_cast<float>(recipe.resolution);
    u.guard_texels = guard.texels;
    u.guard_metres = guard.metres;
    return u;
}

/// What the passes have in common.
struct Sdsm {
    GnSdsmConstants constants;
    ViewSamples samples;
    BufferHandle reduction;

    void bind(Recorder& r, const ComputeDesc& desc) const {
        r.bind(desc);
        r.set_value("Constants", constants);
        r.set("Reduction", reduction);
    }
    /// A pass over all samples.
    void add_reduction(FrameGraph& graph, const char* name, const char* text) const {
        graph.add_pass(
            name,
            [&](PassBuilder& pass) {
                pass.sample(samples.position);
                pass.sample(samples.normal);
                pass.storage_write(reduction);
            },
            [*this, desc = shader(name, std::string(pixels_text) + text)](Recorder& r) {
                bind(r, desc);
                r.set("gbuffer_position", samples.position);
                r.set("gbuffer_normal", samples.normal);
                r.dispatch((samples.width + 63) / 64, (samples.height + GN_SDSM_ROWS - 1) / GN_SDSM_ROWS);
            });
    }
};

}  // namespace

LightViews place_by_samples(const FrameInput& input, const Recipe& recipe, const GnCascadesParams& params) {
    FrameGraph& graph = input.graph;
    const auto count = static_cast<std::size_t>(params.count);
    LightViews views;
    views.resolution = static_cast<std::uint32_t>(recipe.resolution);
    views.layers = static_cast<std::uint32_t>(params.count);
    views.buffer = graph.create({.name = "cascade views", .bytes = count * sizeof(GnLightView)});
    views.data_buffer = graph.create({.name = "cascade choice", .bytes = sizeof views.data});
    for (std::size_t i = 0; i < count; ++i) {
        GnLightView view;
        view.resolution = static_cast<float>(recipe.resolution);
        view.layer = static_cast<int>(i);
        views.views.push_back(view);
    }
    const Sdsm sdsm{constants_of(input, recipe, params), input.samples,
                    graph.create({.name = "sample distribution", .bytes = sizeof(GnSdsmReduction)})};

    // Where the samples are along the view, the slices, and what each slice's samples span.
    graph.add_pass(
        "sdsm clear", [&](PassBuilder& pass) { pass.copy_to(sdsm.reduction); },
        [sdsm](Recorder& r) { r.fill(sdsm.reduction, 0); });
    sdsm.add_reduction(graph, "sdsm distances", distances_text);
    graph.add_pass(
        "sdsm splits", [&](PassBuilder& pass) { pass.storage_write(sdsm.reduction); },
        [sdsm, desc = shader("sdsm splits", splits_text)](Recorder& r) {
            sdsm.bind(r, desc);
            r.dispatch(1, 1);
        });
    sdsm.add_reduction(graph, "sdsm bounds", bounds_text);

    // The views around them.
    graph.add_pass(
        "sdsm views",
        [&](PassBuilder& pass) {
            pass.storage_read(sdsm.reduction);
            pass.storage_write(views.buffer);
            pass.storage_write(views.data_buffer);
        },
        [sdsm, buffer = views.buffer, data = views.data_buffer, desc = shader("sdsm views", views_text)](Recorder& r) {
            sdsm.bind(r, desc);
            r.set("Views", buffer);
            r.set("Placement", data);
            r.dispatch(1, 1);
        });
    return views;
}

}  // namespace gn::cascades
