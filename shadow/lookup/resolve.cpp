// SPDX-License-Identifier: MIT
// The resolve pass: every view sample through the placement's choice, the bias and the lookup's function. Its shader is
// composed of includes; no combination of parts is ever written down.
#include "shadow/frame/frame.h"
#include "shadow/receiver/expect.h"
#include "shadow/receiver/sample_pass.h"

namespace gn {
namespace {

constexpr const char* bindings_text = R"(
layout(binding = 4) uniform sampler2DArray shadow_map;
layout(binding = 5) uniform sampler2DArray shadow_map_extra;
layout(binding = 6, r32f) uniform writeonly image2D visibility;
#ifdef GN_CASTER_IDS
layout(binding = 8) uniform sampler2D gbuffer_material;
#endif
)";

constexpr const char* main_text = R"(
float visibility_in(GnReceiver receiver, int index) {
    GnProjected projected = gn_project(receiver, views[index], u.bias);
    return projected.inside ? gn_unit(GN_LOOKUP) : 1.0;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    float v = 0.0;
    GnReceiver receiver;
    if (read_sample(pixel, receiver)) {
#ifdef GN_CASTER_IDS
        vec2 id_bytes = round(texelFetch(gbuffer_material, pixel, 0).zw * 255.0);
        receiver.object = int(id_bytes.x) + 256 * int(id_bytes.y);
#endif
        GnChoice choice = GN_CHOOSE(receiver, placement);
        v = visibility_in(receiver, choice.first);
        if (choice.second >= 0 && choice.weight > 0.0) {
            v = mix(v, visibility_in(receiver, choice.second), choice.weight);
        }
    }
    imageStore(visibility, pixel, vec4(v));
}
)";

std::string member(const Part& part, std::string_view name) {
    return part.params_type.empty() ? "" : fmt::format("{} {};", part.params_type, name);
}

std::string prologue_of(const Part& part, const Recipe& recipe) {
    return part.prologue != nullptr ? part.prologue(recipe) : "";
}

/// What a map's function may use besides its arguments; `filtered` calls it through GN_MAP_VISIBILITY.
std::string map_call(const Part& map) {
    return fmt::format(
        "#define GN_MAP_VISIBILITY(projected, ddx_ts, ddy_ts) "
        "gn_{}_visibility(shadow_map, shadow_map_extra, projected, ddx_ts, ddy_ts{})\n",
        identifier(map.id), map.params_type.empty() ? "" : ", u.map_params");
}

ComputeDesc resolve_shader(const Device& device, const Recipe& recipe, const LightViews& views) {
    const Part& placement = *views.part;
    const Part& map = *recipe.map;
    const Part& lookup = *recipe.lookup;
    std::string text = expect_text(device) + receiver_defines(recipe, views) +
                       (recipe.casters == "ids" ? "#define GN_CASTER_IDS\n" : "");
    text += "#include \"shadow/view/view.glsl\"\n" + include_line(placement.glsl);
    text += prologue_of(map, recipe) + include_line(map.glsl);
    // A lookup that filters calls the map's function, so that the uniform block must stand before it.
    const std::string lookup_header = lookup.params_type.empty() || lookup.glsl.empty()
                                          ? ""
                                          : std::string(lookup.glsl.substr(0, lookup.glsl.rfind('.'))) + ".h";
    text += include_line(lookup_header);
    text += sample_bindings(member(lookup, "lookup_params") + " " + member(map, "map_params")) + bindings_text;
    text += map.glsl.empty() ? "" : map_call(map);
    text += prologue_of(lookup, recipe) + include_line(lookup.glsl);
    text += sample_functions(placement);
    text += fmt::format("#define GN_LOOKUP gn_{}_visibility(receiver, projected, u.bias, shadow_map{})\n",
                        identifier(lookup.id), lookup.params_type.empty() ? "" : ", u.lookup_params");
    text += main_text;
    return {{ShaderKind::compute, fmt::format("resolve {}+{}+{}", placement.id, map.id, lookup.id), text},
            lookup.constants != nullptr ? lookup.constants(recipe) : SpecConstants{}};
}

std::vector<std::byte> constants_of(const FrameInput& input, const Recipe& recipe) {
    std::vector<std::byte> bytes = sample_constants(input, recipe);
    for (const Part* part : {recipe.lookup, recipe.map}) {
        if (!part->params_type.empty()) {
            const std::span<const std::byte> more = recipe.block(*part).bytes();
            bytes.insert(bytes.end(), more.begin(), more.end());
        }
    }
    return bytes;
}

}  // namespace

TextureHandle create_visibility(FrameGraph& graph, const ViewSamples& samples) {
    return graph.create(
        {.name = "visibility", .format = VK_FORMAT_R32_SFLOAT, .width = samples.width, .height = samples.height});
}

Visibility add_resolve(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map) {
    const Visibility result{create_visibility(input.graph, input.samples)};
    const ViewSamples& samples = input.samples;
    const bool ids = recipe.casters == "ids";
    input.graph.add_pass(
        "lookup",
        [&](PassBuilder& pass) {
            declare_samples(pass, samples, views);
            if (ids) {
                pass.sample(samples.material);
            }
            pass.sample(map.texture);
            if (map.extra.valid()) {
                pass.sample(map.extra);
            }
            pass.storage_write(result.image);
        },
        [shader = resolve_shader(input.device, recipe, views), bytes = constants_of(input, recipe), samples, views, map,
         result, ids](Recorder& r) {
            r.bind(shader);
            set_samples(r, samples, views);
            if (ids) {
                r.set("gbuffer_material", samples.material);
            }
            r.set("shadow_map", map.texture, map.sampler);
            r.set("shadow_map_extra", map.extra.valid() ? map.extra : map.texture, map.sampler);
            r.set_storage("visibility", result.image);
            r.set_bytes("u", bytes);
            r.dispatch_pixels(samples.width, samples.height);
        });
    return result;
}

}  // namespace gn
