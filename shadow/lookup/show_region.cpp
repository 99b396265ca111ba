// SPDX-License-Identifier: MIT
// The regions that a recipe's kernels draw V from: the stages before the map, then one pass.
#include "shadow/lookup/sample_pass.h"
#include "shadow/lookup/show.h"
#include "shadow/view/read_back.h"

namespace gn {
namespace {

// Where two views are mixed, the larger of the two regions.
constexpr const char* main_text = R"(
layout(binding = 4, rgba32f) uniform writeonly image2D region_a;
layout(binding = 5, rgba32f) uniform writeonly image2D region_b;

void region_in(GnReceiver receiver, int index, inout vec3 a_ws, inout vec3 b_ws) {
    GnProjected projected = gn_project(receiver, views[index], u.bias);
    vec3 a_here_ws;
    vec3 b_here_ws;
    gn_kernel_region(receiver, views[index], projected, u.bias, u.pixels, a_here_ws, b_here_ws);
    bool larger = length(cross(a_here_ws, b_here_ws)) > length(cross(a_ws, b_ws));
    if (projected.inside && larger) {
        a_ws = a_here_ws;
        b_ws = b_here_ws;
    }
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    vec3 a_ws = vec3(0.0);
    vec3 b_ws = vec3(0.0);
    GnReceiver receiver;
    if (read_sample(pixel, receiver)) {
        GnChoice choice = GN_CHOOSE(receiver, placement);
        region_in(receiver, choice.first, a_ws, b_ws);
        if (choice.second >= 0 && choice.weight > 0.0) {
            region_in(receiver, choice.second, a_ws, b_ws);
        }
    }
    imageStore(region_a, pixel, vec4(a_ws, 0.0));
    imageStore(region_b, pixel, vec4(b_ws, 0.0));
}
)";

ComputeDesc region_shader(const Recipe& recipe, const LightViews& views) {
    const Part& placement = *views.part;
    const std::string text = receiver_defines(recipe, views) + "#include \"shadow/view/view.glsl\"\n" +
                             include_line(placement.glsl) + include_line("shadow/lookup/show.glsl") +
                             sample_bindings("float pixels;") + sample_functions(placement) + main_text;
    return {{ShaderKind::compute, fmt::format("kernel regions {}", placement.id), text}, {}};
}

TextureHandle create_axis(const FrameInput& input, std::string name) {
    return input.graph.create({.name = std::move(name),
                               .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                               .width = input.samples.width,
                               .height = input.samples.height});
}

struct Axes {
    TextureHandle a, b;
};

Axes add_regions(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    const Axes axes{create_axis(input, "kernel region a"), create_axis(input, "kernel region b")};

    // A filtered fetch takes a mip level whose texels are up to twice as wide as the pixel's footprint.
    const float pixels = recipe.lookup->needs == "filterable" ? 2.0F : 0.0F;
    std::vector<std::byte> bytes = sample_constants(input, recipe);
    const auto more = std::as_bytes(std::span(&pixels, 1));
    bytes.insert(bytes.end(), more.begin(), more.end());

    const ViewSamples& samples = input.samples;
    input.graph.add_pass(
        "kernel regions",
        [&](PassBuilder& pass) {
            declare_samples(pass, samples, views);
            pass.storage_write(axes.a);
            pass.storage_write(axes.b);
        },
        [shader = region_shader(recipe, views), bytes, samples, views, axes](Recorder& r) {
            r.bind(shader);
            set_samples(r, samples, views);
            r.set_storage("region_a", axes.a);
            r.set_storage("region_b", axes.b);
            r.set_bytes("u", bytes);
            r.dispatch_pixels(samples.width, samples.height);
        });
    return axes;
}

vec3 texel(const Image& image, std::size_t i) {
    return {image.values[4 * i], image.values[4 * i + 1], image.values[4 * i + 2]};
}

}  // namespace

std::vector<KernelRegion> kernel_regions(Device& device, SceneGpu& scene, const Camera& camera, const Recipe& recipe,
                                         const HiddenOptions& options) {
    // A filter of V on the screen draws on other pixels.
    if (recipe.map == nullptr || recipe.lookup == nullptr || recipe.visibility != nullptr) {
        return {};
    }
    FrameGraph graph(device);
    graph.group("scene");
    const SceneHandles handles = import_scene(graph, scene);
    const ViewSamples samples = add_view_samples(graph, scene, handles, camera, options.width, options.height);
    graph.group("shadow");
    const FrameInput input{device, graph, *scene.scene, handles, samples, nullptr, options.light, options.history};
    check_recipe(recipe, input.scene, input.light(), input.device);
    const Part& placement = recipe.placement_for(input.light().shape);
    LightViews views = placement.place(input, recipe);
    views.part = &placement;
    const Axes axes = add_regions(input, recipe, views);
    graph.keep(axes.a);
    graph.keep(axes.b);
    graph.execute(false);

    const Image a = read_image(graph, axes.a);
    const Image b = read_image(graph, axes.b);
    std::vector<KernelRegion> regions(a.values.size() / 4);
    for (std::size_t i = 0; i < regions.size(); ++i) {
        regions[i] = {texel(a, i), texel(b, i)};
    }
    return regions;
}

}  // namespace gn
