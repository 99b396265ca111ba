// SPDX-License-Identifier: MIT
// Shading: the environment, of which everything sees all, then light times visibility, summed in the scene's order: one pass
// reads the view samples once for several lights.
#include "shadow/frame/frame.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <algorithm>

namespace gn {
namespace {

/// Lights of one pass: as many textures as every device binds, besides those of the view samples.
constexpr std::size_t most_lights = 8;

constexpr const char* environment_text = R"(
vec3 environment(ivec2 pixel, vec4 position) {
    if (position.w < 0.5) {
        float height = float(pixel.y) / float(u.view.size.y);
        return mix(u.sky.zenith.rgb, u.sky.horizon.rgb, height) * (u.sky.seen * u.environment.intensity / gn_pi);
    }
    float up = 0.5 + 0.5 * gbuffer_shading_normal_texel(pixel).y;
    vec3 sky = mix(u.sky.below.rgb, u.sky.above.rgb, up);
    vec3 radiance = texelFetch(gbuffer_albedo, pixel, 0).rgb * sky * (u.environment.intensity / gn_pi);
#ifdef GN_EMISSION
    radiance += gbuffer_emission_texel(pixel).rgb;
#endif
    return radiance;
}
)";

constexpr const char* reflect_text = R"(
vec3 reflected(GnLight light, ivec2 pixel, vec4 position) {
    vec3 to_eye = normalize(gn_ray_to_eye(u.view, position.xyz));
    vec3 to_light = gn_to_light(light, position.xyz);
    vec2 surface = gbuffer_material_texel(pixel).xy;
    return gn_reflect(gbuffer_shading_normal_texel(pixel).xyz, to_eye, to_light,
                      texelFetch(gbuffer_albedo, pixel, 0).rgb, surface.x, surface.y);
}
)";

/// Adds light `i`, whose kind is known; without a visibility it is seen from everywhere.
std::string light_text(std::size_t i, uint kind, std::string_view visibility) {
    return fmt::format(R"(
    light = u.light{0};
    light.kind = {1}u;
    if (surface && gn_counted(light, position.xyz, normal)) {{
        vec3 v = {2};
        radiance += light.color.rgb * gn_illuminance(light, position.xyz) * v * reflected(light, pixel, position);
    }}
)",
                       i, kind, visibility);
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

/// What V of light `i` is called in the text; "vec3(1.0)" where there is none.
std::string add_visibility(ShaderInputs& inputs, const FrameInput& input, std::size_t i, TextureHandle image) {
    if (!image.valid()) {
        return "vec3(1.0)";
    }
    const uint channels = channels_of(input.graph, image);
    const std::string name = fmt::format("visibility{}", i);
    inputs.texels(input.device, visibility_format(channels), "2D", name, image);
    return fmt::format("vec3({}_texel(pixel).{})", name, channels == 1 ? "r" : "rgb");
}

struct Composed {
    ShaderInputs inputs;
    std::string text;
};

Composed compose(const FrameInput& input, const ShadingPass& pass) {
    const ViewSamples& samples = input.samples;
    const bool emission = !pass.before.valid() && emits(input.scene);
    Composed composed;
    ShaderInputs& inputs = composed.inputs;
    add_gbuffer(inputs, input.device, samples);
    inputs.texels(input.device, VK_FORMAT_R16G16B16A16_SFLOAT, "2D", "gbuffer_shading_normal", samples.shading_normal);
    inputs.texels(input.device, VK_FORMAT_R8G8B8A8_UNORM, "2D", "gbuffer_material", samples.material);
    inputs.texture("sampler2D", "gbuffer_albedo", samples.albedo);
    if (emission) {
        inputs.texels(input.device, VK_FORMAT_R16G16B16A16_SFLOAT, "2D", "gbuffer_emission", samples.emission);
    }
    if (pass.before.valid()) {
        inputs.texels(input.device, VK_FORMAT_R32G32B32A32_SFLOAT, "2D", "before", pass.before);
    }
    inputs.constant("GnViewConstants", "view", samples.constants);
    if (!pass.before.valid()) {
        const Light sky = environment_of(input.scene);
        inputs.constant("GnLight", "environment", sky.shape).constant("GnSky", "sky", sky.sky);
    }
    std::string lights;
    for (std::size_t i = 0; i < pass.lights.size(); ++i) {
        const GnLight& shape = pass.lights[i].shape;
        inputs.constant("GnLight", fmt::format("light{}", i), shape);
        lights += light_text(i, shape.kind, add_visibility(inputs, input, i, pass.visibility[i]));
    }
    composed.text = std::string(emission ? "#define GN_EMISSION\n" : "") +
                    "#include \"shadow/view/view.glsl\"\n#include \"shadow/shading/shading.glsl\"\n" + inputs.text() +
                    "layout(location = 0) out vec4 picture;\n" + (pass.before.valid() ? "" : environment_text) +
                    reflect_text + R"(
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 position = gbuffer_position_texel(pixel);
    vec3 normal = gbuffer_normal_texel(pixel).xyz;
    bool surface = position.w > 0.5;
    GnLight light;
    vec3 radiance = )" +
                    (pass.before.valid() ? "before_texel(pixel).rgb" : "environment(pixel, position)") + ";\n" +
                    lights + "    picture = vec4(radiance, 1.0);\n}\n";
    return composed;
}

TextureHandle add_pass(const FrameInput& input, const ShadingPass& pass) {
    const ViewSamples& samples = input.samples;
    const TextureHandle picture = input.graph.create(
        {.name = "picture", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = samples.width, .height = samples.height});
    const Composed composed = compose(input, pass);
    const std::uint64_t key = Hasher().text(composed.text).finish().low;
    const auto shader = made_once(input.prepared, "shade", key, [&] {
        return sealed(fullscreen({ShaderKind::fragment, "shade", composed.text}));
    });
    input.graph.add_pass(
        "shade",
        [&](PassBuilder& builder) {
            builder.color(picture, Load::discard);
            composed.inputs.declare(builder);
        },
        [shader, inputs = composed.inputs](Recorder& r) {
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
        pass.lights = lights.subspan(first, std::min(most_lights, lights.size() - first));
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
