// SPDX-License-Identifier: MIT
#include "shadow/casters/point_maps.h"

#include "gpu/graph_rounds_scope.h"
#include "shadow/casters/caster_depth.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/scene/light_samples.h"

#include <algorithm>

namespace gn {
namespace {

// A receiver that no pixel of the picture is of: surfaces under the light's texels, seen or not.
constexpr const char* sees_text = R"(
GnReceiver point_receiver(vec3 p_ws, vec3 n_ws) {
    vec3 to_eye = u.view.eye_ws.w > 0.5 ? normalize(u.view.eye_ws.xyz - p_ws) : u.view.eye_ws.xyz;
    return GnReceiver(p_ws, n_ws, dot(u.view.axis_ws, vec4(p_ws, 1.0)), vec2(0.0), vec3(0.0), vec3(0.0), to_eye, 0);
}

float point_sees_in(GnReceiver receiver, int index) {
    GnBias bias = known_bias();
    GnProjected projected = gn_project(receiver, known_view(index), bias);
    if (!projected.inside) {
        return 1.0;
    }
    ivec2 texel = ivec2(floor(projected.uv_ts / projected.texel_ts));
    vec2 centre_ts = (vec2(texel) + 0.5) * projected.texel_ts;
    float occluder = texelFetch(point_depth, ivec3(texel, projected.layer), 0).r;
    return gn_depth_at(projected, centre_ts, bias) <= occluder ? 1.0 : 0.0;
}

float gn_point_sees(vec3 p_ws, vec3 n_ws) {
    GnReceiver receiver = point_receiver(p_ws, n_ws);
    GnChoice choice = GN_CHOOSE(receiver, placement);
    float first = point_sees_in(receiver, choice.first);
    return choice.second >= 0 && choice.weight > 0.0 ? mix(first, point_sees_in(receiver, choice.second), choice.weight)
                                                     : first;
}
)";

/// What a point's shadow alone would be drawn and looked up with: the same views, texels and bias as a sum of hard shadows has.
Recipe hard(const Recipe& recipe) {
    Recipe one = recipe;
    one.map = &find_part(Stage::map, "depth");
    one.lookup = &find_part(Stage::lookup, "hard");
    return one;
}

}  // namespace

void add_point_maps(const FrameInput& input, const Recipe& recipe, int count,
                    const std::function<void(const PointMap&)>& use) {
    const auto points = std::make_shared<std::vector<Light>>();
    for (const GnLight& point : light_samples(input.light().shape, count).points) {
        points->push_back({.name = input.light().name, .shape = point, .spared = input.light().spared});
    }
    const Recipe one_recipe = hard(recipe);
    const Part& placement = recipe.placement_for(input.whole_light().shape);
    input.graph.hold(points);
    const RoundsScope rounds(input.graph);
    for (std::size_t i = 0; i < points->size(); ++i) {
        rounds.next();
        FrameInput one = input;
        one.source = &points->at(i);
        one.parent = &input.whole_light();
        one.history = nullptr;
        LightViews views = placement.place(one, one_recipe);
        views.part = &placement;
        views.kept.reset();
        const TextureHandle depth = add_caster_depth(one, one_recipe, views).texture();
        use({one, views, depth, static_cast<int>(i), static_cast<int>(points->size())});
    }
}

std::string refuses_points(std::string_view id, const Light& light, const Recipe& recipe) {
    if (recipe.light != nullptr) {
        return fmt::format("map '{}' takes the points of a light by itself, and light '{}' takes them too; name one",
                           id, recipe.light->id);
    }
    if (recipe.placement != nullptr && recipe.placement->from_centre && light.shape.kind == GN_LIGHT_SPOT &&
        light.shape.radius > 0) {
        return fmt::format(
            "placement '{}' sees the cone of light '{}' from its centre, and map '{}' looks from other points too; use "
            "placement=fit or cube",
            recipe.placement->id, light.name, id);
    }
    return {};
}

ShaderInputs point_inputs(const PointMap& map, const Recipe& recipe, const LightViews& centre) {
    ShaderInputs inputs = sample_inputs(map.input, hard(recipe), map.views);
    inputs.texture("sampler2DArray", "point_depth", map.depth);
    if (centre.buffer.valid()) {
        inputs.buffer("readonly buffer", "CentreViews", "GnLightView centre_views[];", centre.buffer);
    } else {
        inputs.block("readonly buffer", "CentreViews", "GnLightView centre_views[];",
                     std::as_bytes(std::span(centre.views)));
    }
    return inputs;
}

std::string point_includes(const PointMap& map, const Recipe& recipe, const LightViews& centre) {
    // Affine views are perspective ones, too, where a shader sees both.
    LightViews either = map.views;
    either.kind = std::max(map.views.kind, centre.kind);
    return receiver_defines(recipe, either) + "#include \"shadow/view/view.glsl\"\n" +
           placement_text(*map.views.part, recipe) + "#include \"shadow/casters/caster_depth.glsl\"\n";
}

std::string point_functions(const PointMap& map, const Recipe& recipe) {
    return sample_functions(map.input, hard(recipe), map.views) + sees_text;
}

}  // namespace gn
