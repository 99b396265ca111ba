// SPDX-License-Identifier: MIT
// The peer: a plain forward renderer that looks its shadow up in its own fragment shader, as most do. The same mesh, camera,
// light, map and taps, written as briefly as such renderers write it: one matrix, one constant bias, no mask. What its
// shadow adds is its pass shadowed minus its pass unshadowed; beside it stands the floor, a pass that reads the view's
// depth and writes V and nothing else.
#include "shadow/placement/cascades/cascades.h"
#include "shadow/placement/place.h"
#include "tests/performance/bench.h"

#include <cstring>

namespace gn::performance {
namespace {

enum class Kernel { none, hard, grid3 };
enum class Views { one, cascades, cube };

constexpr const char* vertex_text = R"(
layout(location = 0) in vec3 in_position_ws;
layout(push_constant) uniform Push { mat4 cs_from_ws; } push;
layout(location = 0) out vec3 out_position_ws;
void main() {
    out_position_ws = in_position_ws;
    gl_Position = push.cs_from_ws * vec4(in_position_ws, 1.0);
}
)";

// Light from one direction or point on a surface whose normal comes from the pixel's neighbours.
constexpr const char* fragment_text = R"(
#include "shadow/light_view.h"
layout(location = 0) in vec3 position_ws;
layout(location = 0) out vec4 color;
layout(binding = 0, scalar) uniform Light { vec4 light_ws; vec4 forward_ws; vec4 ends; GnLightView views[GN_VIEWS]; } u;
#ifdef GN_SHADOWED
layout(binding = 1) uniform sampler2DArrayShadow map;
float shadow() {
#if defined(GN_CUBE)
    vec3 d = position_ws - u.light_ws.xyz;
    vec3 a = abs(d);
    int view = a.x >= a.y && a.x >= a.z ? (d.x >= 0.0 ? 0 : 1) : a.y >= a.z ? (d.y >= 0.0 ? 2 : 3) : (d.z >= 0.0 ? 4 : 5);
#elif defined(GN_CASCADES)
    float z = dot(u.forward_ws.xyz, position_ws) + u.forward_ws.w;
    int view = int(z > u.ends.x) + int(z > u.ends.y) + int(z > u.ends.z);
#else
    const int view = 0;
#endif
    vec4 p_cs = u.views[view].cs_from_ws * vec4(position_ws, 1.0);
    vec3 p = vec3(p_cs.xy / p_cs.w * 0.5 + 0.5, dot(u.views[view].depth_from_ws, vec4(position_ws, 1.0)) - 0.001);
#ifdef GN_GRID3
    float sum = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            sum += texture(map, vec4(p.xy + vec2(x, y) * GN_TEXEL, view, p.z));
        }
    }
    return sum / 9.0;
#else
    return texture(map, vec4(p.xy, view, p.z));
#endif
}
#endif
void main() {
    vec3 n = normalize(cross(dFdy(position_ws), dFdx(position_ws)));
    vec3 l = u.light_ws.w > 0.5 ? normalize(u.light_ws.xyz - position_ws) : u.light_ws.xyz;
    float lit = max(dot(n, l), 0.0);
#ifdef GN_SHADOWED
    lit *= shadow();
#endif
    color = vec4(vec3(0.1 + 0.8 * lit), 1.0);
}
)";

struct Peer {
    std::string scene, recipe;
    int light = 0;
    Kernel kernel = Kernel::hard;
    Views views = Views::one;
};

struct Constants {
    vec4 light_ws, forward_ws, ends;
};

RasterDesc pipeline(const Peer& peer, Kernel kernel, std::size_t views, std::uint32_t resolution) {
    std::string text = fmt::format("#define GN_VIEWS {}\n#define GN_TEXEL {}\n", views, 1.0 / resolution);
    text += kernel != Kernel::none ? "#define GN_SHADOWED\n" : "";
    text += kernel == Kernel::grid3 ? "#define GN_GRID3\n" : "";
    text += peer.views == Views::cube       ? "#define GN_CUBE\n"
            : peer.views == Views::cascades ? "#define GN_CASCADES\n"
                                            : "";
    RasterDesc desc;
    desc.vertex = {ShaderKind::vertex, "inline.vert", vertex_text};
    desc.fragment = ShaderSource{ShaderKind::fragment, "inline.frag", text + fragment_text};
    desc.depth_test = desc.depth_write = true;
    desc.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT}};
    desc.vertex_stride = sizeof(vec3);
    return desc;
}

std::vector<std::byte> constants_of(const Camera& camera, const GnLight& light, const LightViews& views) {
    const bool sun = light.kind == GN_LIGHT_DIRECTIONAL;
    const auto& ends = views.data_as<GnCascadesData>().ends;  // nothing reads them where no placement has cascades
    const Constants constants{
        sun ? vec4(-vec3(light.direction_ws), 0) : vec4(vec3(light.position_ws), 1),
        vec4(camera.forward_ws, -glm::dot(camera.forward_ws, camera.position_ws)),
        vec4(ends[0], ends[1], ends[2], 0),
    };
    std::vector<std::byte> bytes(sizeof constants + views.views.size() * sizeof(GnLightView));
    std::memcpy(bytes.data(), &constants, sizeof constants);
    std::memcpy(bytes.data() + sizeof constants, views.views.data(), bytes.size() - sizeof constants);
    return bytes;
}

/// The forward pass; with a kernel its map is drawn first, by the recipe's own passes.
void build_forward(Bench& bench, const Peer& peer, Kernel kernel, FrameGraph& graph) {
    SceneGpu& gpu = bench.scene(peer.scene);
    const Camera& camera = gpu.scene->cameras[0];
    const SceneHandles handles = import_scene(graph, gpu);
    const uint width = bench.size().x, height = bench.size().y;
    const ViewSamples samples{.width = width, .height = height, .camera = camera};
    const FrameInput input{bench.device(), graph,   *gpu.scene,
                           handles,        samples, &gpu.scene->lights.at(static_cast<std::size_t>(peer.light))};
    const Recipe recipe = load_recipe(peer.recipe);
    const LightViews views = place_views(input, recipe);
    TextureHandle map;
    if (kernel != Kernel::none) {
        map = recipe.map->add_map(input, recipe, views).texture();
    }
    const TextureHandle color =
        graph.create({.name = "color", .format = VK_FORMAT_R8G8B8A8_UNORM, .width = width, .height = height});
    const TextureHandle depth =
        graph.create({.name = "depth", .format = VK_FORMAT_D32_SFLOAT, .width = width, .height = height});
    graph.keep(color);
    const mat4 cs_from_ws =
        cs_from_vs(camera, static_cast<float>(width) / static_cast<float>(height)) * vs_from_ws(camera);
    graph.add_pass(
        "inline",
        [&](PassBuilder& pass) {
            pass.color(color, Load::clear);
            pass.depth(depth, Load::clear, {.depth = 0.0F});
            pass.vertices(handles.positions);
            pass.indices(handles.indices);
            if (map.valid()) {
                pass.sample(map);
            }
        },
        [=, desc = pipeline(peer, kernel, views.views.size(), views.resolution),
         bytes = constants_of(camera, input.light().shape, views), scene = gpu.scene](Recorder& r) {
            r.bind(desc);
            r.vertex_buffer(handles.positions);
            r.index_buffer(handles.indices);
            r.set_bytes("u", bytes);
            if (map.valid()) {
                r.set("map", map, {.filter = VK_FILTER_LINEAR, .compare = VK_COMPARE_OP_LESS_OR_EQUAL});
            }
            r.push_value(cs_from_ws);
            r.draw_indexed(static_cast<std::uint32_t>(3 * scene->triangles.size()));
        });
}

/// Reads the view's depth and writes V, by fragments or by a dispatch as the lookup is: what any mask pays.
void build_floor(Bench& bench, const std::string& scene, bool dispatched, FrameGraph& graph) {
    static constexpr const char* fragment = R"(
layout(binding = 0) uniform sampler2D depth;
layout(location = 0) out float v;
void main() { v = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r > 0.0 ? 1.0 : 0.0; }
)";
    static constexpr const char* compute = R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D depth;
layout(binding = 1, r32f) uniform writeonly image2D v;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, textureSize(depth, 0)))) {
        imageStore(v, pixel, vec4(texelFetch(depth, pixel, 0).r > 0.0 ? 1.0 : 0.0));
    }
}
)";
    SceneGpu& gpu = bench.scene(scene);
    const SceneHandles handles = import_scene(graph, gpu);
    const uvec2 size = bench.size();
    const ViewSamples samples = add_view_samples(graph, gpu, handles, gpu.scene->cameras[0], size.x, size.y);
    const TextureHandle visibility = create_visibility(graph, samples);
    graph.keep(visibility);
    graph.add_pass(
        "floor",
        [&](PassBuilder& pass) {
            pass.sample(samples.depth);
            if (dispatched) {
                pass.storage_write(visibility);
            } else {
                pass.color(visibility, Load::discard);
            }
        },
        [=](Recorder& r) {
            if (dispatched) {
                r.bind(ComputeDesc{.shader = {ShaderKind::compute, "floor", compute}});
                r.set("depth", samples.depth);
                r.set_storage("v", visibility);
                r.dispatch_pixels(size.x, size.y);
            } else {
                r.bind(fullscreen({ShaderKind::fragment, "floor", fragment}));
                r.set("depth", samples.depth);
                r.draw(3);
            }
        });
}

Timed forward(Bench& bench, const Peer& peer, Kernel kernel, std::vector<std::string> names = {"inline"}) {
    return graph_passes(
        bench, [&bench, peer, kernel](FrameGraph& graph) { build_forward(bench, peer, kernel, graph); },
        std::move(names));
}

void row(Bench& bench, const std::string& what, const Peer& peer) {
    const Timed ours = passes(bench, peer.scene, load_recipe(peer.recipe), {"lookup"}, peer.light);
    print_over_added(what, ours, forward(bench, peer, peer.kernel), forward(bench, peer, Kernel::none));
}

/// A still frame, whose map is kept, over the peer that draws its map in every frame.
void kept_row(Bench& bench, const std::string& what, const Peer& peer) {
    print_over_added(what, still_passes(bench, peer.scene, load_recipe(peer.recipe), peer.light),
                     forward(bench, peer, peer.kernel, {"map", "inline"}), forward(bench, peer, Kernel::none));
}

}  // namespace

void inlined(Bench& bench) {
    print_title("lookup pass over what a forward pass with the same taps adds");
    row(bench, "sun, one map, hard", {"courtyard", "hard,placement=fit", 0, Kernel::hard, Views::one});
    row(bench, "sun, one map, 3x3", {"courtyard", "pcf,placement=fit,pcf.kernel=3x3", 0, Kernel::grid3, Views::one});
    row(bench, "spot, one map, hard", {"courtyard", "hard,placement=fit", 2, Kernel::hard, Views::one});
    row(bench, "point, cube, hard", {"courtyard", "hard,placement=cube", 1, Kernel::hard, Views::cube});
    row(bench, "sun, 4 cascades, hard",
        {"courtyard", "hard,placement=cascades,cascades.select=distance,cascades.transition=none", 0, Kernel::hard,
         Views::cascades});
    row(bench, "sun, 4 cascades, 3x3",
        {"courtyard", "pcf,placement=cascades,cascades.select=distance,cascades.transition=none,pcf.kernel=3x3", 0,
         Kernel::grid3, Views::cascades});

    print_title("all passes of a still frame over what a forward pass and its map, drawn anew, add");
    kept_row(bench, "spot, one map, hard", {"courtyard", "hard,placement=fit", 2, Kernel::hard, Views::one});
    kept_row(bench, "point, cube, hard", {"courtyard", "hard,placement=cube", 1, Kernel::hard, Views::cube});

    print_title("over a pass that reads depth and writes V");
    const auto floor = [&bench](bool dispatched) {
        return graph_passes(
            bench, [&bench, dispatched](FrameGraph& graph) { build_floor(bench, "courtyard", dispatched, graph); },
            {"floor"});
    };
    const Timed lesser = [by_fragments = floor(false), by_dispatch = floor(true)] {
        return std::min(by_fragments(), by_dispatch());
    };
    for (const char* recipe : {"hard,placement=fit", "pcf,placement=fit,pcf.kernel=3x3", "hard,placement=cascades"}) {
        print_ratio(recipe, passes(bench, "courtyard", load_recipe(recipe), {"lookup"}), lesser);
    }
}

}  // namespace gn::performance
