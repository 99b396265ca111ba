// SPDX-License-Identifier: MIT
// Shading: the environment, of which everything sees all, then each light times its visibility, one pass a light.
#include "shadow/frame/frame.h"
#include "shadow/receiver/channels.h"

#include <algorithm>

namespace gn {
namespace {

constexpr const char* bindings_text = R"(
#include "shadow/view/view.glsl"
#include "shadow/shading/shading.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D gbuffer_position;
layout(binding = 1) uniform sampler2D gbuffer_normal;
layout(binding = 2) uniform sampler2D gbuffer_shading_normal;
layout(binding = 3) uniform sampler2D gbuffer_albedo;
layout(binding = 4) uniform sampler2D gbuffer_material;
layout(binding = 5) uniform sampler2D gbuffer_emission;
layout(binding = 6, rgba32f) uniform image2D picture;
)";

constexpr const char* environment_text = R"(
layout(binding = 7, scalar) uniform Constants { GnViewConstants view; GnLight light; GnSky sky; } u;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    vec3 radiance;
    if (texelFetch(gbuffer_position, pixel, 0).w > 0.5) {
        float up = 0.5 + 0.5 * texelFetch(gbuffer_shading_normal, pixel, 0).y;
        vec3 sky = mix(u.sky.below.rgb, u.sky.above.rgb, up);
        radiance = texelFetch(gbuffer_albedo, pixel, 0).rgb * sky * (u.light.intensity / gn_pi);
        radiance += texelFetch(gbuffer_emission, pixel, 0).rgb;
    } else {
        float height = float(pixel.y) / float(u.view.size.y);
        radiance = mix(u.sky.zenith.rgb, u.sky.horizon.rgb, height) * (u.sky.seen * u.light.intensity / gn_pi);
    }
    imageStore(picture, pixel, vec4(radiance, 1.0));
}
)";

constexpr const char* light_text = R"(
layout(binding = 7, scalar) uniform Constants { GnViewConstants view; GnLight light; } u;
#ifdef GN_VISIBILITY
layout(binding = 8) uniform sampler2D visibility;
#endif
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    vec4 position = texelFetch(gbuffer_position, pixel, 0);
    if (position.w < 0.5 || !gn_counted(u.light, position.xyz, texelFetch(gbuffer_normal, pixel, 0).xyz)) {
        return;
    }
    vec3 v = vec3(1.0);
#ifdef GN_VISIBILITY
    v = vec3(GN_V_OF(texelFetch(visibility, pixel, 0)));
#endif
    vec3 to_eye = normalize(gn_ray_to_eye(u.view, position.xyz));
    vec3 to_light = gn_to_light(u.light, position.xyz);
    vec2 surface = texelFetch(gbuffer_material, pixel, 0).xy;
    vec3 reflected = gn_reflect(texelFetch(gbuffer_shading_normal, pixel, 0).xyz, to_eye, to_light,
                                texelFetch(gbuffer_albedo, pixel, 0).rgb, surface.x, surface.y);
    vec3 radiance = u.light.color.rgb * gn_illuminance(u.light, position.xyz) * v * reflected;
    imageStore(picture, pixel, imageLoad(picture, pixel) + vec4(radiance, 0.0));
}
)";

struct EnvironmentConstants {
    GnViewConstants view;
    GnLight light;
    GnSky sky;
};
struct LightConstants {
    GnViewConstants view;
    GnLight light;
};

void declare_gbuffer(PassBuilder& pass, const ViewSamples& samples) {
    for (const TextureHandle texture : {samples.position, samples.normal, samples.shading_normal, samples.albedo,
                                        samples.material, samples.emission}) {
        pass.sample(texture);
    }
}

void set_gbuffer(Recorder& r, const ViewSamples& samples) {
    r.set("gbuffer_position", samples.position);
    r.set("gbuffer_normal", samples.normal);
    r.set("gbuffer_shading_normal", samples.shading_normal);
    r.set("gbuffer_albedo", samples.albedo);
    r.set("gbuffer_material", samples.material);
    r.set("gbuffer_emission", samples.emission);
}

ComputeDesc shader(const char* name, const std::string& defines, const char* text) {
    return {{ShaderKind::compute, name, defines + bindings_text + text}, {}};
}

void add_light(const FrameInput& input, const Light& light, TextureHandle visibility, TextureHandle picture) {
    const ViewSamples& samples = input.samples;
    input.graph.add_pass(
        "shade " + light.name,
        [&](PassBuilder& pass) {
            declare_gbuffer(pass, samples);
            if (visibility.valid()) {
                pass.sample(visibility);
            }
            pass.storage_write(picture);
        },
        [samples, visibility, picture, constants = LightConstants{samples.constants, light.shape},
         defines = visibility.valid() ? "#define GN_VISIBILITY\n" + channels_text(channels_of(input.graph, visibility))
                                      : std::string()](Recorder& r) {
            r.bind(shader("shade", defines, light_text));
            set_gbuffer(r, samples);
            if (visibility.valid()) {
                r.set("visibility", visibility);
            }
            r.set_storage("picture", picture);
            r.set_value("u", constants);
            r.dispatch_pixels(samples.width, samples.height);
        });
}

}  // namespace

TextureHandle add_shading(const FrameInput& input, std::span<const TextureHandle> visibility) {
    const ViewSamples& samples = input.samples;
    const Light sky = environment_of(input.scene);
    const TextureHandle picture = input.graph.create(
        {.name = "picture", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = samples.width, .height = samples.height});
    input.graph.add_pass(
        "environment",
        [&](PassBuilder& pass) {
            declare_gbuffer(pass, samples);
            pass.storage_write(picture);
        },
        [samples, picture, constants = EnvironmentConstants{samples.constants, sky.shape, sky.sky}](Recorder& r) {
            r.bind(shader("environment", "", environment_text));
            set_gbuffer(r, samples);
            r.set_storage("picture", picture);
            r.set_value("u", constants);
            r.dispatch_pixels(samples.width, samples.height);
        });
    for (std::size_t i = 0; i < input.scene.lights.size(); ++i) {
        add_light(input, input.scene.lights[i], i < visibility.size() ? visibility[i] : TextureHandle{}, picture);
    }
    return picture;
}

}  // namespace gn
