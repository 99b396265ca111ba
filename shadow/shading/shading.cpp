// SPDX-License-Identifier: MIT
// Shading: the environment, of which everything sees all, then light times visibility, summed in the scene's order: one pass
// reads the view samples once for several lights.
#include "shadow/frame/frame.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"
#include "shadow/scene/emission.h"

#include <algorithm>

namespace gn {
namespace {

/// Lights of one pass: as many textures as every device binds, besides those of the view samples; where a light has a cookie each
/// counts twice.
constexpr std::size_t most_lights = 8;
std::size_t lights_at_once(std::span<const Light> lights) {
    const bool cookies =
        std::any_of(lights.begin(), lights.end(), [](const Light& light) { return light.cookie >= 0; });
    return cookies ? most_lights / 2 : most_lights;
}

constexpr const char* environment_text = R"(
vec3 environment(ivec2 pixel, vec4 position, Seen seen) {
    if (position.w < 0.5) {
        float height = float(pixel.y) / float(u.view.size.y);
        return mix(u.sky.zenith.rgb, u.sky.horizon.rgb, height) * (u.sky.seen * u.environment.intensity / gn_pi);
    }
    vec3 sky = mix(u.sky.below.rgb, u.sky.above.rgb, 0.5 + 0.5 * seen.n_ws.y);
    return seen.base_color * sky * (u.environment.intensity / gn_pi) + seen.emission;
}
)";

/// What all lights shade.
constexpr const char* seen_text = R"(
struct Seen {
    vec3 n_ws, to_eye_ws, base_color, emission;
    float roughness, metallic;
};
Seen seen_at(ivec2 pixel, vec3 p_ws) {
    uvec2 texel = gbuffer_surface_texel(pixel).xy;
    Seen seen;
    vec4 albedo = texelFetch(gbuffer_albedo, pixel, 0);
    seen.n_ws = gn_surface_normal(texel);
    seen.to_eye_ws = normalize(gn_ray_to_eye(u.view, p_ws));
    seen.base_color = albedo.rgb;
    seen.metallic = albedo.a;
    seen.roughness = gn_surface_roughness(texel);
    seen.emission = vec3(0.0);
#ifdef GN_EMISSION
    seen.emission = emission[gn_surface_object(texel)];
#endif
    return seen;
}
)";

/// Adds light `i`, whose kind is known; without a visibility it is seen from everywhere. A cookie colours it.
std::string light_text(std::size_t i, const Light& given, std::string_view visibility) {
    const std::string cookie =
        given.cookie < 0 ? ""
                         : fmt::format(" * textureLod(cookie{}, gn_cookie_place(light, position.xyz), 0.0).rgb", i);
    return fmt::format(R"(
    light = u.light{0};
    light.kind = {1}u;
    if (surface && gn_counted(light, position.xyz, normal)) {{
        vec3 v = {2};
        radiance += light.color.rgb * gn_illuminance(light, position.xyz){3} * v *
                    gn_reflect(seen.n_ws, seen.to_eye_ws, gn_to_light(light, position.xyz), seen.base_color,
                               seen.roughness, seen.metallic);
    }}
)",
                       i, given.shape.kind, visibility, cookie);
}

/// One pass: what came before, and the lights that it adds.
struct ShadingPass {
    TextureHandle before;  ///< the picture so far; invalid: the environment begins it
    std::span<const Light> lights;
    std::vector<TextureHandle> visibility;  ///< as many
};

bool emits(const Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& material) { return material.emissive != vec3(0); });
}

void add_visibility(ShaderInputs& inputs, const FrameInput& input, std::size_t i, TextureHandle image) {
    if (image.valid()) {
        inputs.texels(input.device, visibility_format(channels_of(input.graph, image)), "2D",
                      fmt::format("visibility{}", i), image);
    }
}

/// V of light `i` in the text; 1 where there is none.
std::string visibility_text(const FrameInput& input, std::size_t i, TextureHandle image) {
    return image.valid() ? fmt::format("vec3(visibility{}_texel(pixel).{})", i,
                                       channels_of(input.graph, image) == 1 ? "r" : "rgb")
                         : "vec3(1.0)";
}

bool adds_emission(const FrameInput& input, const ShadingPass& pass) {
    return !pass.before.valid() && emits(input.scene);
}

ShaderInputs inputs_of(const FrameInput& input, const ShadingPass& pass) {
    const ViewSamples& samples = input.samples;
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, samples);
    inputs.texels(input.device, VK_FORMAT_R32G32_UINT, "2D", "gbuffer_surface", samples.surface);
    inputs.texture("sampler2D", "gbuffer_albedo", samples.albedo);
    if (adds_emission(input, pass)) {
        inputs.buffer("readonly buffer", "Emission", "vec3 emission[];", input.handles.emission);
    }
    if (pass.before.valid()) {
        inputs.texels(input.device, VK_FORMAT_R32G32B32A32_SFLOAT, "2D", "before", pass.before);
    }
    inputs.constant("GnViewConstants", "view", samples.constants);
    if (!pass.before.valid()) {
        const Light sky = environment_of(input.scene);
        inputs.constant("GnLight", "environment", sky.shape).constant("GnSky", "sky", sky.sky);
    }
    for (std::size_t i = 0; i < pass.lights.size(); ++i) {
        GnLight shape = pass.lights[i].shape;
        if (const Image8* const picture = shown_picture(input.scene, shape)) {
            const auto texture = static_cast<std::uint64_t>(gn_emission_texture(shape));
            shape.color *= vec4(*input.derive("mean emission", texture, [&] { return mean_emission(*picture); }), 1.0F);
        }
        inputs.constant("GnLight", fmt::format("light{}", i), shape);
        add_visibility(inputs, input, i, pass.visibility[i]);
        if (pass.lights[i].cookie >= 0) {
            const auto cookie = static_cast<std::size_t>(pass.lights[i].cookie);
            SamplerDesc sampler = linear();
            // Longitudes go around, and a sun's picture lies beside itself; a cone has borders.
            const uint kind = pass.lights[i].shape.kind;
            sampler.address =
                kind == GN_LIGHT_SPOT ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE : VK_SAMPLER_ADDRESS_MODE_REPEAT;
            sampler.address_v =
                kind == GN_LIGHT_DIRECTIONAL ? VK_SAMPLER_ADDRESS_MODE_REPEAT : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
            inputs.texture("sampler2D", fmt::format("cookie{}", i), input.handles.textures.at(cookie), sampler);
        }
    }
    return inputs;
}

std::string compose(const FrameInput& input, const ShadingPass& pass, const ShaderInputs& inputs) {
    std::string lights;
    for (std::size_t i = 0; i < pass.lights.size(); ++i) {
        lights += light_text(i, pass.lights[i], visibility_text(input, i, pass.visibility[i]));
    }
    return std::string(adds_emission(input, pass) ? "#define GN_EMISSION\n" : "") +
           include_line("shadow/view/view.glsl") + include_line("shadow/view/surface.glsl") +
           include_line("shadow/shading/shading.glsl") + include_line("shadow/scene/cookie.h") + inputs.text() +
           "layout(location = 0) out vec4 picture;\n" + seen_text + (pass.before.valid() ? "" : environment_text) +
           R"(
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 position = gbuffer_position_texel(pixel);
    vec3 normal = gbuffer_normal_texel(pixel).xyz;
    bool surface = position.w > 0.5;
    Seen seen = seen_at(pixel, position.xyz);
    GnLight light;
    vec3 radiance = )" +
           (pass.before.valid() ? "before_texel(pixel).rgb" : "environment(pixel, position, seen)") + ";\n" + lights +
           "    picture = vec4(radiance, 1.0);\n}\n";
}

/// All that the text depends on.
std::uint64_t key_of(const FrameInput& input, const ShadingPass& pass, const ShaderInputs& inputs) {
    Hasher hasher = hashed(inputs);
    for (std::size_t i = 0; i < pass.lights.size(); ++i) {
        const TextureHandle image = pass.visibility[i];
        hasher.value(pass.lights[i].shape.kind)
            .value(pass.lights[i].cookie >= 0)
            .value(image.valid() ? channels_of(input.graph, image) : 0U);
    }
    return hasher.finish().low;
}

TextureHandle add_pass(const FrameInput& input, const ShadingPass& pass) {
    const ViewSamples& samples = input.samples;
    const TextureHandle picture = input.graph.create(
        {.name = "picture", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = samples.width, .height = samples.height});
    const ShaderInputs inputs = inputs_of(input, pass);
    const auto shader = made_once(input.prepared, "shade", key_of(input, pass, inputs), [&] {
        return sealed(fullscreen({ShaderKind::fragment, "shade", compose(input, pass, inputs)}));
    });
    input.graph.add_pass(
        "shade",
        [&](PassBuilder& builder) {
            builder.color(picture, Load::discard);
            inputs.declare(builder);
        },
        [shader, inputs](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.draw(3);
        });
    return picture;
}

}  // namespace

TextureHandle add_shading(const FrameInput& input, std::span<const TextureHandle> visibility) {
    const std::span<const Light> lights = input.scene.lights;
    ShadingPass pass;
    std::size_t first = 0;
    do {
        pass.lights = lights.subspan(first, std::min(lights_at_once(lights), lights.size() - first));
        pass.visibility.clear();
        for (std::size_t i = first; i < first + pass.lights.size(); ++i) {
            pass.visibility.push_back(i < visibility.size() ? visibility[i] : TextureHandle{});
        }
        pass.before = add_pass(input, pass);
        first += pass.lights.size();
    } while (first < lights.size());
    return pass.before;
}

}  // namespace gn
