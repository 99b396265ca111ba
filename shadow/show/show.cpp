// SPDX-License-Identifier: MIT
// Pictures of the hidden: the stages before the lookup once, then one pass per kind of picture.
#include "shadow/show/show.h"

#include "shadow/frame/history.h"
#include "shadow/frame/map_memory.h"
#include "shadow/map/derived.h"
#include "shadow/placement/place.h"
#include "shadow/show/show_passes.h"
#include "shadow/view/read_back.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gn {
namespace {

constexpr const char* output_text = R"(
// Texels per pixel, bias in metres, pixels per texel, whether the view holds the receiver.
vec4 sizes_in(GnReceiver receiver, int index) {
    GnProjected moved = gn_project(receiver, views[index], u.bias);
    GnProjected still = gn_project(receiver, views[index], u.no_bias);
    float metres = gn_bias_metres(receiver, views[index], moved, still);
    return vec4(gn_texels_per_pixel(receiver, moved), metres, gn_undersampling_in(receiver, moved),
                moved.inside ? 1.0 : 0.0);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    vec4 shown = vec4(0.0, -1.0, 0.0, -1.0);
    vec4 sizes = vec4(0.0, 0.0, 0.0, -1.0);
    GnReceiver receiver;
    if (read_sample(pixel, receiver)) {
        GnChoice choice = GN_CHOOSE(receiver, placement);
        sizes = sizes_in(receiver, choice.first);
        if (choice.second >= 0 && choice.weight > 0.0) {
            sizes = mix(sizes, sizes_in(receiver, choice.second), choice.weight);
        }
        shown = vec4(choice.first, choice.second, choice.second >= 0 ? choice.weight : 0.0, sizes.w);
#ifdef GN_PAGE_LEVEL
        // Pages say how fine they are: where in the pool they lie says nothing.
        shown.x = float(GN_PAGE_LEVEL(views[choice.first]));
#endif
    }
    imageStore(first, pixel, shown);
    imageStore(second, pixel, sizes);
}
)";

/// How much of the view sees the surface's front: 1 face to face, less where it is slanted.
std::vector<float> shade_of(const CpuSamples& samples) {
    std::vector<float> shade(samples.position_ws.size(), 0.0F);
    for (std::size_t i = 0; i < shade.size(); ++i) {
        if (samples.position_ws[i].w > 0.5F) {
            const vec3 to_eye_ws = to_eye(samples.camera, vec3(samples.position_ws[i]));
            shade[i] = 0.55F + 0.45F * std::abs(glm::dot(to_eye_ws, vec3(samples.normal_ws[i])));
        }
    }
    return shade;
}

struct Built {
    ViewSamples samples;
    LightViews views;
    ShadowMap map;
    SampleFigures figures;
    std::vector<Offer> sides;
    LayerTiles map_tiles, light_tiles;
};

bool asked(std::span<const std::string> names, Hidden kind) {
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& name) { return find_hidden(name).kind == kind; });
}

/// Those of the names that the lookup tells beside V.
std::vector<std::string_view> asked_sides(const Recipe& recipe, std::span<const std::string> names) {
    std::vector<std::string_view> sides;
    for (const HiddenPicture& picture : side_pictures()) {
        if (std::find(names.begin(), names.end(), picture.name) == names.end()) {
            continue;
        }
        if (!tells(*recipe.lookup, picture.name)) {
            refuse("lookup '{}' does not tell '{}'; lookups that tell it: {}", recipe.lookup->id, picture.name,
                   lookups_that_tell(picture.name));
        }
        sides.push_back(picture.name);
    }
    return sides;
}

/// The stages up to the lookup, for what it tells beside V.
std::vector<Offer> add_sides(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    ShadowMap map = recipe.map->add_map(input, recipe, views);
    map.part = recipe.map;
    add_derived(input, recipe, views, map);
    check_map_memory(input, recipe, map.texture());
    const Visibility visibility = recipe.lookup->add_lookup != nullptr
                                      ? recipe.lookup->add_lookup(input, recipe, views, map)
                                      : add_resolve(input, recipe, views, map);
    for (const Offer& side : visibility.sides) {
        input.graph.keep(side.texture);
    }
    return visibility.sides;
}

Built build(FrameGraph& graph, SceneGpu& scene, const Camera& camera, const Recipe& recipe,
            std::span<const std::string> names, const HiddenOptions& options) {
    Built built;
    graph.group("scene");
    const SceneHandles handles = import_scene(graph, scene);
    built.samples = add_view_samples(graph, scene, handles, camera, options.width, options.height);
    graph.group("shadow");
    FrameInput input{graph.device(), graph,          *scene.scene,
                     handles,        built.samples,  &scene.scene->lights.at(options.light),
                     options.light,  options.history};

    // The stages before the lookup, as in a frame.
    check_recipe(recipe, input.scene, input.light(), input.device);
    built.views = place_views(input, recipe);
    if (asked(names, Hidden::map)) {
        built.map = recipe.map->add_map(input, recipe, built.views);
        check_map_memory(input, recipe, built.map.texture());
        built.map_tiles = add_layer_tiles(input, built.map.texture());
        graph.keep(built.map_tiles.image);
    }
    if (asked(names, Hidden::light_view)) {
        built.light_tiles = add_layer_tiles(input, add_light_picture(input, recipe, built.views));
        graph.keep(built.light_tiles.image);
    }
    input.sides = asked_sides(recipe, names);
    if (!input.sides.empty()) {
        built.sides = add_sides(input, recipe, built.views);
    }
    built.figures = add_sample_figures(input, recipe, built.views);
    graph.keep(built.figures.choice);
    graph.keep(built.figures.sizes);
    graph.keep(built.samples.position);
    graph.keep(built.samples.normal);
    return built;
}

Shown color_hidden(FrameGraph& graph, const Recipe& recipe, const Built& built, const HiddenPicture& picture) {
    switch (picture.kind) {
        case Hidden::view:
            return color_choice(read_image(graph, built.figures.choice), shade_of(read_samples(graph, built.samples)),
                                built.views);
        case Hidden::texels: return color_texels(read_image(graph, built.figures.sizes));
        case Hidden::undersampling: return color_undersampling(read_image(graph, built.figures.sizes));
        case Hidden::bias: return color_bias(read_image(graph, built.figures.sizes));
        case Hidden::map:
            return color_map(read_image(graph, built.map_tiles.image), built.map_tiles, graph.desc(built.map.texture()),
                             holds(recipe.map->gives, "depth"));
        case Hidden::light_view: return color_light(read_image(graph, built.light_tiles.image), built.light_tiles);
        case Hidden::side: break;
    }
    const auto side = std::find_if(built.sides.begin(), built.sides.end(),
                                   [&](const Offer& offer) { return offer.name == picture.name; });
    GN_CHECK(side != built.sides.end());
    return color_side(read_image(graph, side->texture), read_image(graph, built.figures.sizes), picture.sentence,
                      "magenta: in no light view, grey: no light arrives");
}

bool tells_all(const Part* direct, std::span<const std::string> names) {
    return direct != nullptr && !names.empty() &&
           std::all_of(names.begin(), names.end(), [&](const std::string& name) { return tells(*direct, name); });
}

/// What a part without a map tells beside V.
std::vector<Shown> show_told(Device& device, SceneGpu& scene, const Camera& camera, const Recipe& recipe,
                             std::span<const std::string> names, const HiddenOptions& options) {
    FrameGraph graph(device);
    graph.group("scene");
    const SceneHandles handles = import_scene(graph, scene);
    const ViewSamples samples = add_view_samples(graph, scene, handles, camera, options.width, options.height);
    graph.group("shadow");
    FrameInput input{device,        graph,          *scene.scene,
                     handles,       samples,        &scene.scene->lights.at(options.light),
                     options.light, options.history};
    check_recipe(recipe, input.scene, input.light(), input.device);
    for (const std::string& name : names) {
        input.sides.emplace_back(name);
    }
    const Visibility told = recipe.direct->add_direct(input, recipe);
    for (const Offer& side : told.sides) {
        graph.keep(side.texture);
    }
    graph.keep(samples.position);
    graph.keep(samples.normal);
    graph.execute(false);

    // There is no light view that could miss a sample: all that see a surface are told of.
    const CpuSamples seen = read_samples(graph, samples);
    Image states(static_cast<int>(options.width), static_cast<int>(options.height), 4);
    for (std::size_t i = 0; i < seen.position_ws.size(); ++i) {
        states.values[4 * i + 3] = seen.position_ws[i].w > 0.0F ? 1.0F : -1.0F;
    }
    std::vector<Shown> shown;
    for (const std::string& name : names) {
        const Offer* side = told.find(name);
        GN_CHECK(side != nullptr);
        shown.push_back(color_side(read_image(graph, side->texture), states, find_hidden(name).sentence,
                                   "grey: no surface is seen"));
        shown.back().name = name;
    }
    return shown;
}

}  // namespace

std::span<const HiddenPicture> hidden_pictures() {
    static constexpr std::array<HiddenPicture, 6> pictures{{
        {Hidden::view, "view", "Which light view serves a pixel: the cascade or the face, by its index.", true},
        {Hidden::texels, "texels",
         "Map texels along a pixel's side, in the direction that has fewest; below 1 they show as steps.", true},
        {Hidden::undersampling, "undersampling",
         "Pixels under a map texel, in the direction where it covers most; above 1 texels show as steps.", true},
        {Hidden::bias, "bias", "Distance in metres that the bias moves a receiver before it is compared with the map.",
         true},
        {Hidden::map, "map", "The map's contents: its layers side by side, its channels below each other.", false},
        {Hidden::light_view, "light-view", "What the light sees through each of its views, lit from the light.", false},
    }};
    return pictures;
}

std::span<const HiddenPicture> side_pictures() {
    static const std::vector<HiddenPicture> pictures = [] {
        std::vector<HiddenPicture> found;
        for (const Part* part : all_parts()) {
            for (const Side& side : part->sides) {
                if (std::none_of(found.begin(), found.end(), [&](const auto& p) { return p.name == side.name; })) {
                    found.push_back({Hidden::side, side.name, side.sentence, true});
                }
            }
        }
        return found;
    }();
    return pictures;
}

const HiddenPicture& find_hidden(std::string_view name) {
    std::vector<std::string_view> known;
    for (const std::span<const HiddenPicture> pictures : {hidden_pictures(), side_pictures()}) {
        for (const HiddenPicture& picture : pictures) {
            if (picture.name == name) {
                return picture;
            }
            known.push_back(picture.name);
        }
    }
    fail("no picture is called '{}'; {}", name, suggest(name, known));
}

SampleFigures add_sample_figures(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    // A bias of nothing follows the recipe's own.
    const std::array<std::byte, sizeof(GnBias)> no_bias{};
    const SampleImages images = add_sample_pass(
        input, recipe, views, {"show", "shown views", "shown sizes", "GnBias", "no_bias", output_text}, no_bias);
    return {images.first, images.second};
}

std::vector<Shown> show_hidden(Device& device, SceneGpu& scene, const Camera& camera, const Recipe& recipe,
                               std::span<const std::string> names, const HiddenOptions& options) {
    for (const std::string& name : names) {
        find_hidden(name);
    }
    if (recipe.map == nullptr && tells_all(recipe.direct, names)) {
        return show_told(device, scene, camera, recipe, names, options);
    }
    if (recipe.map == nullptr) {
        refuse(
            "recipe '{}' has no shadow map whose inside could be shown; recipes with a map name one in 'gnomon show'",
            recipe.name);
    }
    FrameGraph graph(device);
    const Built built = build(graph, scene, camera, recipe, names, options);
    graph.execute(false);
    if (options.history != nullptr) {
        options.history->advance();
    }

    std::vector<Shown> shown;
    for (const std::string& name : names) {
        shown.push_back(color_hidden(graph, recipe, built, find_hidden(name)));
        shown.back().name = name;
    }
    return shown;
}

std::vector<float> undersampling(Device& device, SceneGpu& scene, const Camera& camera, const Recipe& recipe,
                                 const HiddenOptions& options) {
    if (recipe.map == nullptr) {
        return {};
    }
    FrameGraph graph(device);
    const Built built = build(graph, scene, camera, recipe, {}, options);
    graph.execute(false);
    if (options.history != nullptr) {
        options.history->advance();
    }
    const Image sizes = read_image(graph, built.figures.sizes);
    std::vector<float> m(sizes.pixels(), -1.0F);
    for (std::size_t i = 0; i < m.size(); ++i) {
        m[i] = sizes.values[4 * i + 3] >= 0.5F ? sizes.values[4 * i + 2] : -1.0F;
    }
    return m;
}

}  // namespace gn
