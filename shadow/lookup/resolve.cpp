// SPDX-License-Identifier: MIT
// The resolve pass: every view sample through the placement's choice, the bias and the lookup's function. Its shader is
// composed of includes; no combination of parts is ever written down.
#include "shadow/frame/frame.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/expect.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {
namespace {

constexpr const char* main_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform Push { ivec2 first_pixel; };

GN_V visibility_in(GnReceiver receiver, int index) {
    GnLookup at = GnLookup(receiver, gn_project(receiver, views[index], u.bias), u.bias, u.light, views[index]);
    return at.projected.inside ? gn_unit(GN_V(GN_LOOKUP(at))) : GN_V(1.0);
}

void main() {
    ivec2 pixel = first_pixel + ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    GN_V v = GN_V(0.0);
    GnReceiver receiver;
    bool counted = read_sample(pixel, receiver);
    GnChoice choice = GnChoice(0, -1, 0.0);
    if (counted) {
#ifdef GN_CASTER_IDS
        vec2 id_bytes = round(texelFetch(gbuffer_material, pixel, 0).zw * 255.0);
        receiver.object = int(id_bytes.x) + 256 * int(id_bytes.y);
#endif
        choice = GN_CHOOSE(receiver, placement);
        v = visibility_in(receiver, choice.first);
        if (GN_TWO_VIEWS && choice.second >= 0 && choice.weight > 0.0) {
            v = mix(v, visibility_in(receiver, choice.second), choice.weight);
        }
    }
    imageStore(visibility, pixel, GN_V_TEXEL(v));
    GN_WRITE_SIDES(pixel, counted, receiver, choice.first);
}
)";

/// How a kernel that leaves its view finds the next one.
std::string crossing_defines(const LightViews& views) {
    return views.crosses ? fmt::format(
                               "#define GN_CROSSING\n#define GN_CHOICE(receiver) {}\n"
                               "#define GN_LIGHT_VIEW(i) views[i]\n",
                               choose_call(views))
                         : "";
}

std::string prologue_of(const Part& part, const Recipe& recipe) {
    return part.prologue != nullptr ? part.prologue(recipe) : "";
}

std::string offer_name(std::string_view name) {
    return "map_" + identifier(name);
}

/// The arguments of a part's function: the map's textures that it names, and its parameters. A texture that the map does
/// not offer in this recipe is replaced by the first, which the part does not read.
std::string arguments(const ShadowMap& map, std::span<const std::string_view> names) {
    std::string text;
    for (const std::string_view name : names) {
        const Offer* offer = map.find(name);
        text += ", " + offer_name(offer != nullptr ? offer->name : map.offers.front().name);
    }
    return text;
}

std::vector<std::string_view> read_by(const Part& lookup) {
    std::vector<std::string_view> names = lookup.needs;
    names.insert(names.end(), lookup.optional.begin(), lookup.optional.end());
    return names;
}

/// The calls of the lookup's function, and of the map's, by which `filtered` asks the map.
std::string calls(const Recipe& recipe, const ShadowMap& map) {
    const Part& lookup = *recipe.lookup;
    return fmt::format("#define GN_LOOKUP(at) gn_{}_visibility(at{}{})\n", identifier(lookup.id),
                       arguments(map, read_by(lookup)), lookup.params_type.empty() ? "" : ", u.lookup_params");
}

std::string side_name(std::string_view side) {
    return "side_" + identifier(side);
}

/// What is told beside V, by the view that serves the sample first.
std::string side_calls(const FrameInput& input, const Recipe& recipe, const ShadowMap& map) {
    if (input.sides.empty()) {
        return "#define GN_WRITE_SIDES(pixel, counted, receiver, index)\n";
    }
    const Part& lookup = *recipe.lookup;
    std::string text =
        "#define GN_WRITE_SIDES write_sides\n"
        "void write_sides(ivec2 pixel, bool counted, GnReceiver receiver, int index) {\n"
        "    GnLookup at;\n"
        "    if (counted) {\n"
        "        at = GnLookup(receiver, gn_project(receiver, views[index], u.bias), u.bias, u.light, views[index]);\n"
        "        counted = at.projected.inside;\n    }\n";
    for (const std::string_view side : input.sides) {
        text += fmt::format("    imageStore({}, pixel, vec4(counted ? gn_{}_{}(at{}{}) : 0.0));\n", side_name(side),
                            identifier(lookup.id), identifier(side), arguments(map, read_by(lookup)),
                            lookup.params_type.empty() ? "" : ", u.lookup_params");
    }
    return text + "}\n";
}

std::string map_call(const Part& part, const ShadowMap& map) {
    return fmt::format("#define GN_MAP_VISIBILITY(at, ddx_ts, ddy_ts) gn_{}_visibility(at{}, ddx_ts, ddy_ts{})\n",
                       identifier(part.id), arguments(map, part.textures),
                       part.params_type.empty() ? "" : ", u.map_params");
}

/// What the shader reads: view samples, views, the map's offers, and the parts' parameters.
ShaderInputs inputs_of(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map) {
    ShaderInputs inputs = sample_inputs(input, recipe, views);
    for (const Offer& offer : map.offers) {
        inputs.texture("sampler2DArray", offer_name(offer.name), offer.texture, offer.sampler);
    }
    if (recipe.casters == Casters::ids) {
        inputs.texture("sampler2D", "gbuffer_material", lent(input.samples.material, "material"));
    }
    for (const auto& [part, name] : {std::pair{recipe.lookup, "lookup_params"}, {recipe.map, "map_params"}}) {
        if (!part->params_type.empty()) {
            inputs.constant_bytes(part->params_type, name, recipe.block(*part).bytes());
        }
    }
    return inputs;
}

ComputeDesc resolve_shader(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map,
                           const ShaderInputs& inputs) {
    const Part& placement = *views.part;
    const Part& lookup = *recipe.lookup;
    std::string text = expect_text(input.device) + channels_text(lookup.channels) + receiver_defines(recipe, views) +
                       (recipe.casters == Casters::ids ? "#define GN_CASTER_IDS\n" : "") + crossing_defines(views) +
                       fmt::format("#define GN_TWO_VIEWS {}\n", views.views.size() > 1);
    text += "#include \"shadow/view/view.glsl\"\n" + include_line(placement.glsl);
    text += prologue_of(*recipe.map, recipe) + include_line(recipe.map->glsl);
    // A lookup that filters calls the map's function, so that the uniform block must stand before it.
    const std::string lookup_header = lookup.params_type.empty() || lookup.glsl.empty()
                                          ? ""
                                          : std::string(lookup.glsl.substr(0, lookup.glsl.rfind('.'))) + ".h";
    text += include_line(lookup_header) + inputs.text();
    text += recipe.map->glsl.empty() ? "" : map_call(*recipe.map, map);
    text += prologue_of(lookup, recipe) + include_line(lookup.glsl);
    text += sample_functions(views) + calls(recipe, map) + side_calls(input, recipe, map) + main_text;
    return {{ShaderKind::compute, fmt::format("resolve {}+{}+{}", placement.id, recipe.map->id, lookup.id), text},
            lookup.constants != nullptr ? lookup.constants(recipe) : SpecConstants{}};
}

/// All that a recipe's resolve shader depends on from light to light.
std::uint64_t shader_key(const Recipe& recipe, const LightViews& views, const ShaderInputs& inputs) {
    Hasher hasher;
    hasher.text(views.part->id)
        .text(recipe.map->id)
        .text(recipe.lookup->id)
        .text(receiver_defines(recipe, views))
        .value(views.crosses)
        .value(views.views.size());
    inputs.hash(hasher);
    return hasher.finish().low;
}

}  // namespace

TextureHandle create_visibility(FrameGraph& graph, const ViewSamples& samples, uint channels) {
    return graph.create({.name = "visibility",
                         .format = visibility_format(channels),
                         .width = samples.width,
                         .height = samples.height});
}

Visibility add_resolve(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map) {
    const uint channels = recipe.lookup->channels;
    const ViewSamples& samples = input.samples;
    Visibility result{create_visibility(input.graph, samples, channels)};
    // Sides are written for all of the picture.
    const ivec4 lit = input.sides.empty() ? lit_pixels(input) : ivec4(0, 0, samples.width, samples.height);

    // No sample counts beyond the pixels that the light can reach, which may be all of them in one frame and few in the next.
    if (input.light().shape.kind != GN_LIGHT_DIRECTIONAL) {
        input.graph.add_pass(
            "lookup: dark", [&](PassBuilder& pass) { pass.color(result.image, Load::clear); }, [](Recorder&) {});
    }
    ShaderInputs inputs = inputs_of(input, recipe, views, map);
    inputs.image(image_format(visibility_format(channels)), "writeonly", "image2D", "visibility", result.image);
    for (const std::string_view side : input.sides) {
        result.sides.push_back({std::string(side), create_visibility(input.graph, samples), nearest()});
        inputs.image("r32f", "writeonly", "image2D", side_name(side), result.sides.back().texture);
    }
    const auto shader = made_once(input.prepared, "resolve", shader_key(recipe, views, inputs),
                                  [&] { return sealed(resolve_shader(input, recipe, views, map, inputs)); });
    input.graph.add_pass(
        "lookup", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, lit](Recorder& r) {
            if (lit.z == 0 || lit.w == 0) {
                return;
            }
            r.bind(*shader);
            inputs.set(r);
            r.push_value(ivec2(lit));
            r.dispatch_pixels(static_cast<std::uint32_t>(lit.z), static_cast<std::uint32_t>(lit.w));
        });
    return result;
}

}  // namespace gn
