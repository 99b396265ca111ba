// SPDX-License-Identifier: MIT
// The resolve pass: every view sample through the placement's choice, the bias and the lookup's function. Its shader is
// composed of includes; no combination of parts is ever written down.
#include "shadow/frame.h"

namespace gn {
namespace {

constexpr const char* bindings_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D gbuffer_position;
layout(binding = 1) uniform sampler2D gbuffer_normal;
layout(binding = 2, scalar) readonly buffer Views { GnLightView views[]; };
layout(binding = 3, scalar) readonly buffer Placement { GnPlacementData placement; };
layout(binding = 4) uniform sampler2DArray shadow_map;
layout(binding = 5) uniform sampler2DArray shadow_map_extra;
layout(binding = 6, r32f) uniform writeonly image2D visibility;
layout(binding = 7, scalar) uniform Constants {
    GnViewConstants view;
    GnLight light;
    GnBias bias;
    GN_LOOKUP_PARAMS
    GN_MAP_PARAMS
} u;
)";

constexpr const char* main_text = R"(
float visibility_in(GnReceiver receiver, int index) {
    GnProjected projected = gn_project(receiver, views[index], u.bias);
    return projected.inside ? clamp(GN_LOOKUP, 0.0, 1.0) : 1.0;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    vec4 position = texelFetch(gbuffer_position, pixel, 0);
    vec4 normal = texelFetch(gbuffer_normal, pixel, 0);
    float v = 0.0;
    if (position.w > 0.5 && gn_counted(u.light, position.xyz, normal.xyz)) {
        GnReceiver receiver = gn_receiver(u.view, pixel, position, normal);
        GnChoice choice = GN_CHOOSE(receiver, placement);
        v = visibility_in(receiver, choice.first);
        if (choice.second >= 0 && choice.weight > 0.0) {
            v = mix(v, visibility_in(receiver, choice.second), choice.weight);
        }
    }
    imageStore(visibility, pixel, vec4(v));
}
)";

std::string include(std::string_view path) {
    return path.empty() ? "" : fmt::format("#include \"{}\"\n", path);
}

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

ComputeDesc resolve_shader(const Part& placement, const Recipe& recipe) {
    const Part& map = *recipe.map;
    const Part& lookup = *recipe.lookup;
    std::string text = "#include \"shadow/view/view.glsl\"\n" + include(placement.glsl);
    text += prologue_of(map, recipe) + include(map.glsl);
    // A lookup that filters calls the map's function, so that the uniform block must stand before it.
    const std::string lookup_header = lookup.params_type.empty() || lookup.glsl.empty()
                                          ? ""
                                          : std::string(lookup.glsl.substr(0, lookup.glsl.rfind('.'))) + ".h";
    text += include(lookup_header);
    text += fmt::format("#define GN_LOOKUP_PARAMS {}\n#define GN_MAP_PARAMS {}\n", member(lookup, "lookup_params"),
                        member(map, "map_params"));
    text += bindings_text;
    text += map.glsl.empty() ? "" : map_call(map);
    text += prologue_of(lookup, recipe) + include(lookup.glsl);
    text += fmt::format("#define GN_CHOOSE gn_{}_choose\n", identifier(placement.id));
    text += fmt::format("#define GN_LOOKUP gn_{}_visibility(receiver, projected, u.bias, shadow_map{})\n",
                        identifier(lookup.id), lookup.params_type.empty() ? "" : ", u.lookup_params");
    text += main_text;
    return {{ShaderKind::compute, fmt::format("resolve {}+{}+{}", placement.id, map.id, lookup.id), text},
            lookup.constants != nullptr ? lookup.constants(recipe) : SpecConstants{}};
}

void append(std::vector<std::byte>& bytes, std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
}

std::vector<std::byte> constants_of(const FrameInput& input, const Recipe& recipe) {
    std::vector<std::byte> bytes;
    append(bytes, std::as_bytes(std::span(&input.samples.constants, 1)));
    append(bytes, std::as_bytes(std::span(&input.light().shape, 1)));
    append(bytes, std::as_bytes(std::span(&recipe.bias, 1)));
    append(bytes,
           recipe.lookup->params_type.empty() ? std::span<const std::byte>{} : recipe.block(*recipe.lookup).bytes());
    append(bytes, recipe.map->params_type.empty() ? std::span<const std::byte>{} : recipe.block(*recipe.map).bytes());
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
    input.graph.add_pass(
        "lookup",
        [&](PassBuilder& pass) {
            pass.sample(samples.position);
            pass.sample(samples.normal);
            pass.sample(map.texture);
            if (map.extra.valid()) {
                pass.sample(map.extra);
            }
            declare_views(pass, views);
            pass.storage_write(result.image);
        },
        [shader = resolve_shader(*views.part, recipe), bytes = constants_of(input, recipe), samples, views, map,
         result](Recorder& r) {
            r.bind(shader);
            r.set("gbuffer_position", samples.position);
            r.set("gbuffer_normal", samples.normal);
            r.set("shadow_map", map.texture, map.sampler);
            r.set("shadow_map_extra", map.extra.valid() ? map.extra : map.texture, map.sampler);
            r.set_storage("visibility", result.image);
            set_views(r, views);
            r.set_bytes("u", bytes);
            r.dispatch_pixels(samples.width, samples.height);
        });
    return result;
}

void declare_views(PassBuilder& pass, const LightViews& views) {
    for (const BufferHandle buffer : {views.buffer, views.data_buffer}) {
        if (buffer.valid()) {
            pass.storage_read(buffer);
        }
    }
}

void set_views(Recorder& r, const LightViews& views) {
    if (views.buffer.valid()) {
        r.set("Views", views.buffer);
    } else {
        r.set_bytes("Views", std::as_bytes(std::span(views.views)));
    }
    if (views.data_buffer.valid()) {
        r.set("Placement", views.data_buffer);
    } else {
        r.set_value("Placement", views.data);
    }
}

}  // namespace gn
