// SPDX-License-Identifier: MIT
// The regions that a recipe's kernels draw V from: the stages before the map, then one pass.
#include "shadow/placement/place.h"
#include "shadow/show/show_passes.h"
#include "shadow/view/read_back.h"

namespace gn {
namespace {

// Where two views are mixed, the larger of the two regions.
constexpr const char* main_text = R"(
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
    imageStore(first, pixel, vec4(a_ws, 0.0));
    imageStore(second, pixel, vec4(b_ws, 0.0));
}
)";

SampleImages add_regions(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    // A filtered fetch takes a mip level whose texels are up to twice as wide as the pixel's footprint.
    const float pixels = recipe.lookup->filters ? 2.0F : 0.0F;
    return add_sample_pass(input, recipe, views,
                           {"kernel regions", "kernel region a", "kernel region b", "float", "pixels", main_text},
                           std::as_bytes(std::span(&pixels, 1)));
}

vec3 texel(const Image& image, std::size_t i) {
    return {image.values[4 * i], image.values[4 * i + 1], image.values[4 * i + 2]};
}

}  // namespace

std::vector<KernelRegion> kernel_regions(Device& device, SceneGpu& scene, const Camera& camera, const Recipe& recipe,
                                         const HiddenOptions& options) {
    // A filter of V on the screen draws on other pixels, a split light on other views, a direct part on no map.
    if (recipe.map == nullptr || recipe.lookup == nullptr || recipe.direct != nullptr || recipe.light != nullptr ||
        !recipe.visibility.empty()) {
        return {};
    }
    FrameGraph graph(device);
    graph.group("scene");
    const SceneHandles handles = import_scene(graph, scene);
    const ViewSamples samples = add_view_samples(graph, scene, handles, camera, options.width, options.height);
    graph.group("shadow");
    const FrameInput input{device,        graph,          *scene.scene,
                           handles,       samples,        &scene.scene->lights.at(options.light),
                           options.light, options.history};
    check_recipe(recipe, input.scene, input.light(), input.device);
    const SampleImages axes = add_regions(input, recipe, place_views(input, recipe));
    graph.keep(axes.first);
    graph.keep(axes.second);
    graph.execute(false);

    const Image a = read_image(graph, axes.first);
    const Image b = read_image(graph, axes.second);
    std::vector<KernelRegion> regions(a.values.size() / 4);
    for (std::size_t i = 0; i < regions.size(); ++i) {
        regions[i] = {texel(a, i), texel(b, i)};
    }
    return regions;
}

}  // namespace gn
