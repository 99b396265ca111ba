// SPDX-License-Identifier: MIT
// The resolve pass: every view sample through the placement's choice, the bias and the lookup's function. Its shader is
// composed of includes; no combination of parts is ever written down.
#include "shadow/frame/frame.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/expect.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <bit>
#include <cstdint>

namespace gn {
namespace {

constexpr const char* lookup_text = R"(
layout(location = 0) out vec4 out_visibility;
GnLookup lookup_of(GnReceiver receiver, int index) {
    GnLightView view = known_view(index);
    GnBias bias = known_bias();
    return GnLookup(receiver, gn_project(receiver, view, bias), bias, u.light, view);
}
)";

constexpr const char* main_text = R"(
GN_V visibility_in(GnReceiver receiver, int index) {
    GnLookup at = lookup_of(receiver, index);
    return at.projected.inside ? gn_unit(GN_V(GN_LOOKUP(at))) : GN_V(1.0);
}

GN_V visibility_by(GnReceiver receiver, GnChoice choice) {
#if GN_TWO_VIEWS
    // Few neighbours need a second view, and a loop, unlike a choice, ends for all where none goes on.
    bool blends = choice.second >= 0 && choice.weight > 0.0;
    GN_V v;
    int turn = 0;
    while (true) {
        GN_V seen = visibility_in(receiver, turn == 0 ? choice.first : choice.second);
        v = turn == 0 ? seen : mix(v, seen, choice.weight);
        if (++turn > int(blends)) {
            break;
        }
    }
    return v;
#else
    return visibility_in(receiver, 0);
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    GN_V v = GN_V(0.0);
    GnReceiver receiver;
    bool counted = read_sample(pixel, receiver);
    GnChoice choice = GnChoice(0, -1, 0.0);
    if (counted) {
#ifdef GN_CASTER_IDS
        receiver.object = int(gn_surface_object(gbuffer_surface_texel(pixel).xy));
#endif
        choice = GN_CHOOSE(receiver, placement);
        v = visibility_by(receiver, choice);
    }
    out_visibility = GN_V_TEXEL(v);
    GN_WRITE_SIDES(counted, receiver, choice.first);
}
)";

/// How a kernel that leaves its view finds the next one.
std::string crossing_defines(const LightViews& views) {
    return views.crosses ? fmt::format(
                               "#define GN_CROSSING\n#define GN_CHOICE(receiver) {}\n"
                               "#define GN_LIGHT_VIEW(i) known_view(i)\n",
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

std::vector<std::string_view> read_by(const Recipe& recipe) {
    std::vector<std::string_view> names = needs_of(recipe);
    names.insert(names.end(), recipe.lookup->optional.begin(), recipe.lookup->optional.end());
    return names;
}

/// The calls of the lookup's function, and of the map's, by which `filtered` asks the map.
std::string calls(const Recipe& recipe, const ShadowMap& map) {
    const Part& lookup = *recipe.lookup;
    return fmt::format("#define GN_LOOKUP(at) gn_{}_visibility(at{}{})\n", identifier(lookup.id),
                       arguments(map, read_by(recipe)), lookup.params_type.empty() ? "" : ", u.lookup_params");
}

std::string side_name(std::string_view side) {
    return "side_" + identifier(side);
}

/// What is told beside V, by the view that serves the sample first.
std::string side_calls(const FrameInput& input, const Recipe& recipe, const ShadowMap& map) {
    if (input.sides.empty()) {
        return "#define GN_WRITE_SIDES(counted, receiver, index)\n";
    }
    const Part& lookup = *recipe.lookup;
    std::string text = "#define GN_WRITE_SIDES write_sides\n";
    std::string body;
    for (std::size_t i = 0; i < input.sides.size(); ++i) {
        const std::string_view side = input.sides[i];
        text += fmt::format("layout(location = {}) out vec4 {};\n", i + 1, side_name(side));
        body += fmt::format("    {} = vec4(counted ? gn_{}_{}(at{}{}) : 0.0);\n", side_name(side),
                            identifier(lookup.id), identifier(side), arguments(map, read_by(recipe)),
                            lookup.params_type.empty() ? "" : ", u.lookup_params");
    }
    return text +
           "void write_sides(bool counted, GnReceiver receiver, int index) {\n"
           "    GnLookup at;\n"
           "    if (counted) {\n"
           "        at = lookup_of(receiver, index);\n"
           "        counted = at.projected.inside;\n    }\n" +
           body + "}\n";
}

std::string map_call(const Part& part, const ShadowMap& map) {
    const std::string id = identifier(part.id);
    const std::string named = arguments(map, part.textures);
    const char* const params = part.params_type.empty() ? "" : ", u.map_params";
    return fmt::format(
        "#define GN_MAP_VISIBILITY(at, ddx_ts, ddy_ts) gn_{}_visibility(at{}, ddx_ts, ddy_ts{})\n"
        "#define GN_MAP_BLOCKERS(at, ddx_ts, ddy_ts) gn_{}_blockers(at{}, ddx_ts, ddy_ts{})\n",
        id, named, params, id, named, params);
}

/// What the shader reads: view samples, views, the map's offers, and the parts' parameters.
ShaderInputs inputs_of(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map) {
    ShaderInputs inputs = sample_inputs(input, recipe, views);
    for (const Offer& offer : map.offers) {
        inputs.texture("sampler2DArray", offer_name(offer.name), offer.texture, offer.sampler);
    }
    if (recipe.casters == Casters::ids) {
        inputs.texels(input.device, VK_FORMAT_R32G32_UINT, "2D", "gbuffer_surface",
                      lent(input.samples.surface, "object"));
    }
    for (const auto& [part, name] : {std::pair{recipe.lookup, "lookup_params"}, {recipe.map, "map_params"}}) {
        if (!part->params_type.empty()) {
            inputs.constant_bytes(part->params_type, name, recipe.block(*part).bytes());
        }
    }
    return inputs;
}

/// GLSL that a recipe's resolve shader reads samples, views and bias by.
std::string sample_text(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    return sample_functions(input, recipe, views) + crossing_defines(views) +
           fmt::format("#define GN_TWO_VIEWS {:d}\n", views.views.size() > 1);
}

RasterDesc resolve_shader(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map,
                          const ShaderInputs& inputs) {
    const Part& placement = *views.part;
    const Part& lookup = *recipe.lookup;
    std::string text = expect_text(input.device) + channels_text(lookup.channels) + receiver_defines(recipe, views) +
                       (recipe.casters == Casters::ids ? "#define GN_CASTER_IDS\n" : "");
    text += include_line("shadow/view/view.glsl") + include_line("shadow/view/surface.glsl") +
            placement_text(placement, recipe);
    text += prologue_of(*recipe.map, recipe) + include_line(recipe.map->glsl);
    // A lookup that filters calls the map's function, so that the uniform block must stand before it.
    const std::string lookup_header = lookup.params_type.empty() || lookup.glsl.empty()
                                          ? ""
                                          : std::string(lookup.glsl.substr(0, lookup.glsl.rfind('.'))) + ".h";
    text += include_line(lookup_header) + inputs.text() + sample_text(input, recipe, views);
    text += recipe.map->glsl.empty() ? "" : map_call(*recipe.map, map);
    text += prologue_of(lookup, recipe) + include_line(lookup.glsl) + calls(recipe, map) + lookup_text;
    text += side_calls(input, recipe, map) + main_text;
    RasterDesc desc = fullscreen(
        {ShaderKind::fragment, fmt::format("resolve {}+{}+{}", placement.id, recipe.map->id, lookup.id), text});
    desc.constants = lookup.constants != nullptr ? lookup.constants(recipe) : SpecConstants{};
    return desc;
}

/// All that a recipe's resolve shader depends on from light to light.
std::uint64_t shader_key(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                         const ShaderInputs& inputs) {
    Hasher hasher;
    hasher.text(views.part->id)
        .text(recipe.map->id)
        .text(recipe.lookup->id)
        .value(std::bit_cast<std::uintptr_t>(
            recipe.lookup->prologue))  // a part may run several of its functions, one after the other
        .text(receiver_defines(recipe, views))
        .text(sample_text(input, recipe, views));
    for (const std::string_view side : input.sides) {
        hasher.text(side);
    }
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
    const ViewSamples& samples = input.samples;
    Visibility result{create_visibility(input.graph, samples, recipe.lookup->channels)};
    for (const std::string_view side : input.sides) {
        result.sides.push_back({std::string(side), create_visibility(input.graph, samples), nearest()});
    }
    const ShaderInputs inputs = inputs_of(input, recipe, views, map);
    const auto shader = made_once(input.prepared, "resolve", shader_key(input, recipe, views, inputs),
                                  [&] { return sealed(resolve_shader(input, recipe, views, map, inputs)); });
    input.graph.add_pass(
        "lookup",
        [&](PassBuilder& pass) {
            pass.color(result.image, Load::clear);
            for (const Offer& side : result.sides) {
                pass.color(side.texture, Load::clear);
            }
            inputs.declare(pass);
        },
        [inputs, shader, lit = lit_pixels(input)](Recorder& r) {
            // No sample counts beyond the pixels that the light can reach.
            if (lit.z == 0 || lit.w == 0) {
                return;
            }
            r.bind(*shader);
            inputs.set(r);
            r.scissor(lit.x, lit.y, static_cast<std::uint32_t>(lit.z), static_cast<std::uint32_t>(lit.w));
            r.draw(3);
        });
    return result;
}

}  // namespace gn
