// SPDX-License-Identifier: MIT
// Layers of surfaces under each texel of a map from the light's centre, each with the share of the light's points that see it: a
// soft shadow in one look.
//
// Based on: Agrawala, Ramamoorthi, Heirich, Moll. Efficient Image-Based Methods for Rendering Soft Shadows. SIGGRAPH 2000.
// [ARHM00]
// Departs from it: layers are peeled under the centre and ask every point's map, where the points' texels were warped into them
// and counted as they came: no texel is hit twice or missed, and counts are what a receiver there would count.
#include "shadow/map/layered_attenuation/layered_attenuation.h"

#include "gpu/zeros_pass.h"
#include "shadow/casters/point_maps.h"
#include "shadow/casters/raster.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <cstring>

namespace gn::parts::layered_attenuation {
namespace {

constexpr const char* part_include = "#include \"shadow/map/layered_attenuation/layered_attenuation.glsl\"\n";

TextureHandle create(const FrameInput& input, const LightViews& views, const char* name, VkFormat format,
                     std::uint32_t layers) {
    return input.graph.create(
        {.name = name, .format = format, .width = views.resolution, .height = views.resolution, .layers = layers});
}

/// One surface under every texel: RGBA32F (depth, normal), and the depths by which it was found.
struct Surfaces {
    TextureHandle surface, depth;
};

/// The nearest surfaces, or the nearest ones behind others.
Surfaces add_surfaces(const FrameInput& input, const Recipe& recipe, const LightViews& views, TextureHandle before) {
    // What a light shines on is turned to it: of closed bodies one layer, not two.
    Recipe turned = recipe;
    turned.casters = Casters::automatic;
    LightViews drawn = views;
    drawn.layered = false;
    drawn.kept.reset();
    CasterPass pass;
    pass.name = "layers: peel";
    pass.color = create(input, views, "surfaces", VK_FORMAT_R32G32B32A32_SFLOAT, views.layers);
    pass.depth = create(input, views, "surface depths", VK_FORMAT_D32_SFLOAT, views.layers);
    pass.clear_color = {.color = vec4(1, 0, 0, 0)};
    pass.fragment.includes = part_include;
    pass.fragment.includes += "layout(location = 0) out vec4 out_surface;\n";
    pass.fragment.reads_slope = true;
    if (before.valid()) {
        pass.fragment.inputs.texture("sampler2DArray", "surfaces_before", before);
        pass.fragment.body = R"(
    if (depth <= texelFetch(surfaces_before, ivec3(gl_FragCoord.xy, views[caster_view].layer), 0).r + gn_depth_epsilon) {
        discard;
    }
)";
    }
    pass.fragment.body += R"(
    GnLightView view = views[caster_view];
    out_surface = vec4(depth, gn_layer_normal(view, gl_FragCoord.xy / view.resolution, depth, slope));
)";
    add_caster_passes(input, turned, drawn, pass);
    return {pass.color, pass.depth};
}

/// A compute pass over the texels of every view; `text` is the body for one of them.
void add_texel_pass(const FrameInput& input, const char* name, const LightViews& views, const ShaderInputs& inputs,
                    const std::shared_ptr<const ComputeDesc>& shader) {
    input.graph.add_pass(
        name, [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, groups = (views.resolution + 7) / 8,
         count = static_cast<std::uint32_t>(views.views.size())](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch(groups, groups, count);
        });
}

// The texel of a view, and the surface under it.
constexpr const char* begin_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    GnLightView view = centre_views[gl_GlobalInvocationID.z];
    ivec2 first = ivec2(round(view.rect_ts.xy * view.resolution));
    ivec2 size = ivec2(round(view.rect_ts.zw * view.resolution));
    ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(place, size))) {
        return;
    }
    ivec3 texel = ivec3(first + place, view.layer);
    vec4 surface = texelFetch(surfaces, texel, 0);
    if (surface.x >= 1.0) {
        return;
    }
)";

// Adds w V and w of one point to the sums; a point behind the surface shows it nothing.
constexpr const char* count_text = R"(
    vec2 uv_ts = (vec2(texel.xy) + 0.5) / view.resolution;
    vec3 p_ws = gn_point_at(view, uv_ts, surface.x);
    vec3 n_ws = surface.yzw;
    float weight = gn_point_weight(u.whole, u.light, p_ws);
    bool above = dot(n_ws, gn_to_light(u.light, p_ws)) > 0.0;
    float v = above && weight > 0.0 ? gn_point_sees(p_ws, n_ws) : 0.0;
    vec2 before = u.index == 0 ? vec2(0.0) : imageLoad(sums, texel).rg;
    imageStore(sums, texel, vec4(before + weight * vec2(v, 1.0), 0.0, 0.0));
}
)";

/// Lets every layer look at one point.
void add_count(const PointMap& point, const Recipe& recipe, const LightViews& views, TextureHandle surface,
               TextureHandle sums) {
    ShaderInputs inputs = point_inputs(point, recipe, views);
    inputs.texture("sampler2DArray", "surfaces", surface);
    inputs.image("rg32f", "", "image2DArray", "sums", sums);
    inputs.constant("int", "index", point.index);
    const std::string includes = point_includes(point, recipe, views), functions = point_functions(point, recipe);
    const auto shader =
        compute_once(point.input.prepared, "layers: count", hashed(inputs).text(includes).text(functions), [&] {
            return includes + part_include + "#include \"shadow/scene/light_samples.h\"\n" + inputs.text() + functions +
                   begin_text + count_text;
        });
    add_texel_pass(point.input, "layers: count", views, inputs, shader);
}

/// One layer of every view, of the sums.
void add_mean(const FrameInput& input, TextureHandle surface, TextureHandle sums, TextureHandle layers, int layer,
              int count) {
    ShaderInputs inputs;
    inputs.texture("sampler2DArray", "surfaces", surface);
    inputs.image("rg32f", "readonly", "image2DArray", "sums", sums);
    inputs.image("rg32f", "writeonly", "image2DArray", "layers", layers);
    inputs.constant("int", "layer", layer).constant("int", "count", count);
    const auto shader = compute_once(input.prepared, "layers: mean", hashed(inputs), [&] {
        return inputs.text() + R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel.xy, imageSize(layers).xy))) {
        return;
    }
    float depth = texelFetch(surfaces, texel, 0).r;
    vec2 sum = depth < 1.0 ? imageLoad(sums, texel).rg : vec2(0.0);
    float v = sum.y > 0.0 ? sum.x / sum.y : 1.0;
    imageStore(layers, ivec3(texel.xy, texel.z * u.count + u.layer), vec4(depth, v, 0.0, 0.0));
}
)";
    });
    const TextureDesc& desc = input.graph.desc(surface);
    input.graph.add_pass(
        "layers: mean", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, size = uvec3(desc.width, desc.height, desc.layers)](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch((size.x + 7) / 8, (size.y + 7) / 8, size.z);
        });
}

/// Counts the texels that have one more surface than layers, for the frame's remarks.
void add_left_out(const FrameInput& input, const Recipe& recipe, const LightViews& views, TextureHandle last,
                  int layers) {
    if (input.late_remarks == nullptr) {
        return;
    }
    const TextureHandle behind = add_surfaces(input, recipe, views, last).surface;
    const BufferHandle left = input.graph.create({.name = "layers left out", .bytes = sizeof(std::uint32_t)});
    add_zeros(input.graph, "layers: none left out", {left});
    ShaderInputs inputs = view_list(views);
    inputs.texture("sampler2DArray", "surfaces", behind);
    inputs.buffer("buffer", "Left", "uint left_out;", left);
    const auto shader = compute_once(input.prepared, "layers: left out", hashed(inputs), [&] {
        return "#include \"shadow/light_view.h\"\n" + inputs.text() + "#define centre_views views\n" + begin_text +
               "    atomicAdd(left_out, 1u);\n}\n";
    });
    add_texel_pass(input, "layers: left out", views, inputs, shader);
    input.graph.answer(left, [layers, remarks = input.late_remarks](std::span<const std::byte> bytes) {
        std::uint32_t count = 0;
        std::memcpy(&count, bytes.data(), sizeof count);
        if (count > 0) {
            remarks->insert(fmt::format(
                "map 'layered-attenuation' left out surfaces under {} texels, which have more than {} turned to the "
                "light: what lies on them is dark; layered-attenuation.layers keeps more",
                count, layers));
        }
    });
}

ShadowMap add_layers(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    const auto params = recipe.of<GnLayeredAttenuationParams>("layered-attenuation");
    if (views.tiles) {
        refuse("map 'layered-attenuation' knows its views when it is declared, and placement '{}' makes tiles later",
               views.part->id);
    }
    if (input.handles.drawn != nullptr) {
        refuse(
            "map 'layered-attenuation' peels surfaces, which a renderer that draws its casters itself cannot; lend "
            "their buffers");
    }

    // Peel what can receive under the light's centre.
    std::vector<TextureHandle> surfaces, sums;
    for (int i = 0; i < params.layers; ++i) {
        surfaces.push_back(add_surfaces(input, recipe, views, i == 0 ? TextureHandle{} : surfaces.back()).surface);
        sums.push_back(create(input, views, "layer sums", VK_FORMAT_R32G32_SFLOAT, views.layers));
    }
    add_left_out(input, recipe, views, surfaces.back(), params.layers);

    // Let every layer look at every point of the light.
    add_point_maps(input, recipe, params.lights, [&](const PointMap& point) {
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            add_count(point, recipe, views, surfaces[i], sums[i]);
        }
    });

    const TextureHandle layers = create(input, views, "attenuation layers", VK_FORMAT_R32G32_SFLOAT,
                                        views.layers * static_cast<std::uint32_t>(params.layers));
    for (int i = 0; i < params.layers; ++i) {
        const auto at = static_cast<std::size_t>(i);
        add_mean(input, surfaces[at], sums[at], layers, i, params.layers);
    }
    return {.offers = {{"attenuation-layers", layers, nearest()}}};
}

std::string refuses(const Scene&, const Light& light, const Recipe& recipe) {
    return refuses_points("layered-attenuation", light, recipe);
}

}  // namespace
}  // namespace gn::parts::layered_attenuation

namespace gn::parts {

const Part& map_layered_attenuation() {
    using namespace layered_attenuation;
    static const Part part = [] {
        Part p;
        p.id = "layered-attenuation";
        p.stage = Stage::map;
        p.title = "Layers that know how much of the light they see";
        p.citation = "ARHM00";
        p.gives = {"attenuation-layers"};
        p.filterable = true;
        p.textures = {"attenuation-layers"};
        p.solid_only = true;
        p.params = param_table<GnLayeredAttenuationParams>({
            GN_PARAM(GnLayeredAttenuationParams, lights, integer, 1, 1024, "",
                     "Points of the light: finer steps in penumbrae, a map and a look of every layer each."),
            GN_PARAM(GnLayeredAttenuationParams, layers, integer, 1, 16, "",
                     "Surfaces under a texel that are kept: what lies behind the last one is dark."),
            GN_PARAM(GnLayeredAttenuationParams, epsilon, real, 0.01, 16, "texels",
                     "How far a receiver may lie from a layer that it takes its V of: too little leaves receivers "
                     "without a layer, too much takes one surface for another close to it."),
        });
        p.params_type = "GnLayeredAttenuationParams";
        p.glsl = "shadow/map/layered_attenuation/layered_attenuation.glsl";
        p.add_map = add_layers;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
