// SPDX-License-Identifier: MIT
// The frame as a table of contents: one call a stage, in flow order.
#include "shadow/frame/frame.h"

#include "shadow/frame/history.h"
#include "shadow/frame/map_memory.h"
#include "shadow/map/derived.h"
#include "shadow/placement/place.h"
#include "shadow/receiver/expect.h"
#include "shadow/recipe/check_recipe.h"
#include "shadow/view/read_back.h"

namespace gn {

Visibility add_shadow(const FrameInput& input, const Recipe& recipe) {
    check_recipe(recipe, input.scene, input.light(), input.device);

    Visibility visibility;
    if (recipe.direct != nullptr) {
        visibility = recipe.direct->add_direct(input, recipe);
    } else if (recipe.lookup == nullptr) {
        visibility = add_no_shadow(input);
    } else {
        const LightViews views = place_views(input, recipe);
        ShadowMap map = recipe.map->add_map(input, recipe, views);
        map.part = recipe.map;
        add_derived(input, recipe, views, map);
        check_map_memory(input, recipe, map.texture());
        visibility = recipe.lookup->add_lookup != nullptr ? recipe.lookup->add_lookup(input, recipe, views, map)
                                                          : add_resolve(input, recipe, views, map);
    }
    if (recipe.visibility != nullptr) {
        visibility = recipe.visibility->add_visibility(input, recipe, visibility);
    }
    add_unshadowed(input, visibility);
    return visibility;
}

namespace {

/// Lights whose shadow the options ask for.
bool wanted(const FrameOptions& options, std::size_t light) {
    return options.only_light < 0 || options.only_light == static_cast<int>(light);
}

struct BuiltFrame {
    ViewSamples samples;
    std::vector<TextureHandle> visibility;  ///< one a light; invalid where not wanted or refused
    TextureHandle picture;
};

BuiltFrame build(FrameGraph& graph, SceneGpu& scene, const Camera& camera, const Recipe& recipe,
                 const FrameOptions& options, std::vector<std::string>& refused, std::set<std::string>& late_remarks) {
    BuiltFrame frame;

    // View samples.
    graph.group("scene");
    const SceneHandles handles = import_scene(graph, scene);
    frame.samples = add_view_samples(graph, scene, handles, camera, options.width, options.height);

    // Shadows, light by light.
    graph.group("shadow");
    for (std::size_t i = 0; i < scene.scene->lights.size(); ++i) {
        frame.visibility.emplace_back();
        refused.emplace_back();
        if (!wanted(options, i)) {
            continue;
        }
        const FrameInput input{graph.device(),          graph, *scene.scene,    handles,      frame.samples,
                               &scene.scene->lights[i], i,     options.history, &late_remarks};
        try {
            frame.visibility.back() = add_shadow(input, recipe).image;
            graph.keep(frame.visibility.back());
        } catch (const Refusal& refusal) {
            refused.back() = refusal.what();
        }
    }

    // Shading.
    graph.group("shading");
    const FrameInput input{graph.device(), graph, *scene.scene, handles, frame.samples};
    if (options.picture) {
        frame.picture = add_shading(input, frame.visibility);
        graph.keep(frame.picture);
    }
    graph.keep(frame.samples.position);
    graph.keep(frame.samples.normal);
    return frame;
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
    for (const Part* part : {recipe.placement, recipe.map, recipe.lookup, recipe.direct, recipe.visibility}) {
        const std::string remark = part != nullptr && part->remark != nullptr ? part->remark(scene, recipe) : "";
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
    HistoryStep step(options.history);
    FrameGraph graph(device);
    FrameResult result;
    result.remarks = remarks_of(recipe, *scene.scene);
    std::set<std::string> late_remarks;
    const BuiltFrame frame = build(graph, scene, camera, recipe, options, result.refused, late_remarks);

    // The first run pays for shader compilation; the repeats are timed.
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
    result.samples = read_samples(graph, frame.samples);
    for (const TextureHandle image : frame.visibility) {
        result.visibility.push_back(image.valid() ? read_image(graph, image) : Image{});
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
        textures.push_back(upload_texture(device,
                                          {.name = "given visibility",
                                           .format = VK_FORMAT_R32_SFLOAT,
                                           .width = width,
                                           .height = height,
                                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT},
                                          std::as_bytes(std::span(visibility[i].values))));
        given[i] = graph.import(textures.back());
    }
    const FrameInput input{device, graph, *scene.scene, handles, samples};
    const TextureHandle picture = add_shading(input, given);
    graph.keep(picture);
    graph.execute(false);
    return without_alpha(read_image(graph, picture));
}

}  // namespace gn
