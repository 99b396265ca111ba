// SPDX-License-Identifier: MIT
// Measuring: callers of the frame that wait for it and read it back.
#include "shadow/frame/frame.h"
#include "shadow/frame/history.h"
#include "shadow/frame/map_memory.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/expect.h"
#include "shadow/recipe/check_recipe.h"
#include "shadow/view/read_back.h"

#include <algorithm>

namespace gn {
namespace {

struct BuiltFrame {
    ViewSamples samples;
    std::vector<TextureHandle> visibility;  ///< one a light; invalid where not wanted or refused
    TextureHandle picture;
};

BuiltFrame build(FrameGraph& graph, SceneGpu& scene, const Camera& camera, const PreparedRecipe& recipe,
                 const FrameOptions& options, std::vector<std::string>& refused, std::set<std::string>& late_remarks) {
    BuiltFrame frame;
    graph.group("scene");
    const FrameCasters casters{*scene.scene, import_scene(graph, scene)};
    frame.samples = add_view_samples(graph, scene, casters.handles, camera, options.width, options.height);

    // Ask for the shadows of one light or of all; what was not asked for has neither V nor a sentence.
    const std::vector<FrameLight> lights = lights_of(*scene.scene);
    const std::size_t first =
        options.only_light < 0 ? 0 : std::min(static_cast<std::size_t>(options.only_light), lights.size());
    const std::size_t count = options.only_light < 0 ? lights.size() : std::min<std::size_t>(1, lights.size() - first);
    frame.visibility.resize(lights.size());
    refused.resize(lights.size());
    const std::vector<LightShadow> shadows = add_frame(
        graph, frame.samples, casters, std::span(lights).subspan(first, count), recipe, options.history, &late_remarks);
    for (std::size_t i = 0; i < count; ++i) {
        frame.visibility[first + i] = shadows[i].visibility.image;
        refused[first + i] = shadows[i].refused;
    }
    if (options.picture) {
        graph.group("shading");
        FrameInput input{graph.device(), graph, *scene.scene, casters.handles, frame.samples};
        input.prepared = &recipe;
        frame.picture = add_shading(input, frame.visibility);
    }
    return frame;
}

/// V as it is: of one channel, or of three.
Image read_channels(FrameGraph& graph, TextureHandle image) {
    return channels_of(graph, image) == 1 ? read_image(graph, image) : without_alpha(read_image(graph, image));
}

/// Keeps what will be read back.
void keep(FrameGraph& graph, const BuiltFrame& frame, const FrameOptions& options) {
    for (const TextureHandle image : frame.visibility) {
        if (image.valid() && options.visibility) {
            graph.keep(image);
        }
    }
    if (frame.picture.valid()) {
        graph.keep(frame.picture);
    }
    if (options.samples) {
        graph.keep(frame.samples.position);
        graph.keep(frame.samples.normal);
    }
}

/// Advances a history by a frame that completed; empties it where the frame failed halfway.
struct HistoryStep {
    History* history = nullptr;
    bool completed = false;
    explicit HistoryStep(History* kept) : history(kept) {}
    HistoryStep(const HistoryStep&) = delete;
    HistoryStep& operator=(const HistoryStep&) = delete;
    ~HistoryStep() {
        if (history != nullptr && completed) {
            history->advance();
        } else if (history != nullptr) {
            history->clear();
        }
    }
};

std::vector<std::string> remarks_of(const Recipe& recipe, const Scene& scene) {
    std::vector<std::string> remarks;
    if (std::string remark = placement_remark(recipe, scene); !remark.empty()) {
        remarks.push_back(std::move(remark));
    }
    // What the recipe names, and what stands in for a placement that it does not name.
    std::vector<const Part*> parts = recipe.parts();
    for (const Light& light : scene.lights) {
        const Part* const placement = recipe.map != nullptr && light.shape.kind != GN_LIGHT_ENVIRONMENT
                                          ? &recipe.placement_for(light.shape)
                                          : nullptr;
        if (placement != nullptr && std::find(parts.begin(), parts.end(), placement) == parts.end()) {
            parts.push_back(placement);
        }
    }
    for (const Part* part : parts) {
        const std::string remark = part->remark != nullptr ? part->remark(scene, recipe) : "";
        if (!remark.empty()) {
            remarks.push_back(remark);
        }
    }
    return remarks;
}

std::string recipe_text(const Recipe& recipe) {
    return recipe.name + (recipe.overrides.empty() ? "" : ",") + recipe.overrides;
}

}  // namespace

FrameResult render_frame(Device& device, SceneGpu& scene, const Camera& camera, const Recipe& recipe,
                         const FrameOptions& options) {
    return render_frame(scene, camera, PreparedRecipe(device, recipe), options);
}

FrameResult render_frame(SceneGpu& scene, const Camera& camera, const PreparedRecipe& prepared,
                         const FrameOptions& options) {
    Device& device = prepared.device();
    const Recipe& recipe = prepared.recipe();
    HistoryStep step(options.history);
    FrameGraph graph(device);
    FrameResult result;
    result.remarks = remarks_of(recipe, *scene.scene);
    std::set<std::string> late_remarks;
    const BuiltFrame frame = build(graph, scene, camera, prepared, options, result.refused, late_remarks);
    keep(graph, frame, options);

    // Run it once; where it is timed, that run warms up.
    try {
        graph.execute(false);
    } catch (const OutOfMemory& problem) {
        throw OutOfMemory(with_less_memory(problem.what(), recipe));
    }
    for (int i = 0; i < options.repeat; ++i) {
        graph.execute(true);
        record_times(graph.statistics(), result);
    }
    finish_times(graph.statistics(), result);
    result.remarks.insert(result.remarks.end(), late_remarks.begin(), late_remarks.end());

    // Read back what the metrics and the report need.
    if (options.samples) {
        result.samples = read_samples(graph, frame.samples);
    }
    for (const TextureHandle image : frame.visibility) {
        result.visibility.push_back(image.valid() && options.visibility ? read_channels(graph, image) : Image{});
        report_marked(device, result.visibility.back(), recipe_text(recipe), result.visibility.size() - 1);
    }
    if (frame.picture.valid()) {
        result.picture = without_alpha(read_image(graph, frame.picture));
    }
    step.completed = true;
    return result;
}

CpuSamples render_samples(Device& device, SceneGpu& scene, const Camera& camera, uint width, uint height) {
    FrameGraph graph(device);
    graph.group("scene");
    const SceneHandles handles = import_scene(graph, scene);
    const ViewSamples samples = add_view_samples(graph, scene, handles, camera, width, height);
    graph.keep(samples.position);
    graph.keep(samples.normal);
    graph.execute(false);
    return read_samples(graph, samples);
}

Image shade(Device& device, SceneGpu& scene, const Camera& camera, uint width, uint height,
            std::span<const Image> visibility) {
    FrameGraph graph(device);
    const SceneHandles handles = import_scene(graph, scene);
    const ViewSamples samples = add_view_samples(graph, scene, handles, camera, width, height);

    // Bring the given visibilities to the GPU; an empty one means V = 1.
    std::vector<Texture2D> textures;
    textures.reserve(visibility.size());
    std::vector<TextureHandle> given(scene.scene->lights.size());
    for (std::size_t i = 0; i < visibility.size() && i < given.size(); ++i) {
        if (visibility[i].values.empty()) {
            continue;
        }
        const Image texels = visibility[i].channels == 1 ? visibility[i] : with_alpha(visibility[i]);
        textures.push_back(upload_texture(device,
                                          {.name = "given visibility",
                                           .format = visibility_format(visibility[i].channels == 1 ? 1 : 3),
                                           .width = width,
                                           .height = height,
                                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT},
                                          std::as_bytes(std::span(texels.values))));
        given[i] = graph.import(textures.back());
    }
    const FrameInput input{device, graph, *scene.scene, handles, samples};
    const TextureHandle picture = add_shading(input, given);
    graph.keep(picture);
    graph.execute(false);
    return without_alpha(read_image(graph, picture));
}

}  // namespace gn
