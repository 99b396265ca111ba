// SPDX-License-Identifier: MIT
// For each texel of a map from the light's centre, the share of the light that is seen along its ray as a function of depth: a
// soft shadow in one look, wherever the receiver is.
//
// Based on: St-Amour, Paquette, Poulin. Soft Shadows from Extended Light Sources with Penumbra Deep Shadow Maps. Graphics
// Interface 2005. [SPP05]
// Departs from it: rays are followed by their depth, so that events need no order while they are gathered; a function that has
// no room errs by more, and says so.
// Also here: penumbra_march.glsl, penumbra_fit.glsl.
#include "shadow/map/penumbra_deep/penumbra_deep.h"

#include "gpu/zeros_pass.h"
#include "shadow/casters/point_maps.h"
#include "shadow/casters/texel_lists.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <cstring>

namespace gn::parts::penumbra_deep {
namespace {

// Every texel of every view of the centre.
constexpr const char* march_text = R"(
bool serves(int index, vec3 p_ws) {
#if GN_SEVERAL
    GnReceiver receiver = point_receiver(p_ws, vec3(0.0));
    return GN_CHOOSE(receiver, placement).first == index;
#else
    return true;
#endif
}
#include "shadow/map/penumbra_deep/penumbra_march.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    GnLightView view = centre_views[gl_GlobalInvocationID.z];
    ivec2 first = ivec2(round(view.rect_ts.xy * view.resolution));
    ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(place, ivec2(round(view.rect_ts.zw * view.resolution))))) {
        return;
    }
    ivec3 texel = ivec3(first + place, view.layer);
    vec2 uv_ts = (vec2(texel.xy) + 0.5) / view.resolution;
    vec3 near_ws = gn_point_at(view, uv_ts, 0.0);
    vec3 far_ws = gn_point_at(view, uv_ts, 1.0);
    for (int i = 0; i < u.count; ++i) {
        march(texel, known_view(i), i, near_ws, far_ws);
    }
}
)";

void add_march(const PointMap& point, const Recipe& recipe, const LightViews& views, const TexelLists& lists) {
    ShaderInputs inputs = point_inputs(point, recipe, views);
    add_lists(inputs, lists, ListAccess::add);
    inputs.constant("int", "count", static_cast<int>(point.views.views.size()));
    const std::string includes =
        point_includes(point, recipe, views) + fmt::format("#define GN_SEVERAL {:d}\n", point.views.views.size() > 1);
    const std::string functions = point_functions(point, recipe);
    const auto shader = compute_once(
        point.input.prepared, "penumbra: march", hashed(inputs).text(includes).text(functions),
        [&] { return includes + inputs.text() + functions + list_functions(ListAccess::add) + march_text; });
    point.input.graph.add_pass(
        "penumbra: march", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, groups = (views.resolution + 7) / 8,
         count = static_cast<std::uint32_t>(views.views.size())](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch(groups, groups, count);
        });
}

/// Sorts the events of every texel, adds them up and keeps few nodes of the function that they are.
TextureHandle add_fit(const FrameInput& input, const LightViews& views, const TexelLists& lists, int points,
                      const GnPenumbraDeepParams& params) {
    FrameGraph& graph = input.graph;
    const TextureHandle functions = graph.create({.name = "penumbra functions",
                                                  .format = VK_FORMAT_R32G32_SFLOAT,
                                                  .width = views.resolution,
                                                  .height = views.resolution,
                                                  .layers = views.layers * static_cast<std::uint32_t>(params.nodes)});
    const BufferHandle wide = graph.create({.name = "penumbra wide", .bytes = 2 * sizeof(std::uint32_t)});
    add_zeros(graph, "penumbra: none is wide", {wide});

    ShaderInputs inputs;
    add_lists(inputs, lists, ListAccess::add);
    inputs.image("rg32f", "writeonly", "image2DArray", "functions", functions);
    inputs.buffer("buffer", "Wide", "uint wide_count; uint widest;", wide);
    inputs.constant("GnPenumbraDeepParams", "params", params).constant("int", "points", points);
    const auto shader = compute_once(input.prepared, "penumbra: fit", hashed(inputs), [&] {
        return "#include \"shadow/map/penumbra_deep/penumbra_deep.glsl\"\n" + inputs.text() +
               list_functions(ListAccess::add) + "#include \"shadow/map/penumbra_deep/penumbra_fit.glsl\"\n";
    });
    graph.add_pass(
        "penumbra: fit", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, groups = (views.resolution + 7) / 8, layers = views.layers](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch(groups, groups, layers);
        });
    graph.answer(wide, [params, remarks = input.late_remarks](std::span<const std::byte> bytes) {
        std::array<std::uint32_t, 2> told{};
        std::memcpy(told.data(), bytes.data(), sizeof told);
        if (told[0] > 0 && remarks != nullptr) {
            float widest = 0;
            std::memcpy(&widest, &told[1], sizeof widest);
            remarks->insert(fmt::format(
                "map 'penumbra-deep': the functions of {} texels have no room for an epsilon of {:.3g} in {} nodes and "
                "err by up to {:.3g}; penumbra-deep.nodes keeps more",
                told[0], params.epsilon, params.nodes, widest));
        }
    });
    return functions;
}

ShadowMap add_functions(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    const auto params = recipe.of<GnPenumbraDeepParams>("penumbra-deep");
    if (views.tiles || views.part->bends) {
        refuse(
            "map 'penumbra-deep' follows straight rays through views that are known when it is declared, and "
            "placement '{}' has none such; fit, single, cube and cascades have",
            views.part->id);
    }
    // Most rays end behind one surface, which every point sees once.
    const uvec3 size(views.resolution, views.resolution, views.layers);
    const auto points = static_cast<std::uint32_t>(params.lights);
    const TexelLists lists = add_texel_lists(input, "penumbra events", size,
                                             std::uint64_t{size.x} * size.y * size.z * (points + points / 2 + 2));
    int count = 1;
    add_point_maps(input, recipe, params.lights, [&](const PointMap& point) {
        add_march(point, recipe, views, lists);
        count = point.count;
    });
    return {.offers = {{"penumbra-functions", add_fit(input, views, lists, count, params), nearest()}}};
}

std::string refuses(const Scene&, const Light& light, const Recipe& recipe) {
    if (light.shape.kind == GN_LIGHT_POINT && light.shape.radius > 0) {
        return fmt::format(
            "map 'penumbra-deep' counts the points of a light alike, and those of the sphere '{}' weigh otherwise for "
            "every receiver; map layered-attenuation and light accumulate weigh them",
            light.name);
    }
    return refuses_points("penumbra-deep", light, recipe);
}

}  // namespace
}  // namespace gn::parts::penumbra_deep

namespace gn::parts {

const Part& map_penumbra_deep() {
    using namespace penumbra_deep;
    static const Part part = [] {
        Part p;
        p.id = "penumbra-deep";
        p.stage = Stage::map;
        p.title = "The share of the light that is seen, along the ray of each texel";
        p.citation = "SPP05";
        p.gives = {"penumbra-functions"};
        p.filterable = true;
        p.textures = {"penumbra-functions"};
        p.solid_only = true;
        p.params = param_table<GnPenumbraDeepParams>({
            GN_PARAM(GnPenumbraDeepParams, lights, integer, 1, 1024, "",
                     "Points of the light: finer steps in penumbrae, a map and a march through it each."),
            GN_PARAM(GnPenumbraDeepParams, nodes, integer, 2, 32, "",
                     "Nodes of a texel's function, eight bytes each: fewer err by more than epsilon where casters lie "
                     "one behind the other."),
            GN_PARAM(GnPenumbraDeepParams, epsilon, real, 0, 0.5, "",
                     "What a function may err by: more needs fewer nodes, and smooths the steps of the points."),
        });
        p.params_type = "GnPenumbraDeepParams";
        p.glsl = "shadow/map/penumbra_deep/penumbra_deep.glsl";
        p.add_map = add_functions;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
