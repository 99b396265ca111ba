// SPDX-License-Identifier: MIT
// Shading: a little light from everywhere, then each light times its visibility, one pass a light.
#include "shadow/frame/frame.h"
#include "shadow/scene/clusters.h"

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

constexpr const char* ambient_text = R"(
layout(binding = 7, scalar) uniform Constants { GnViewConstants view; float ambient; } u;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    vec3 radiance;
    if (texelFetch(gbuffer_position, pixel, 0).w > 0.5) {
        // A pale sky above, half of it from below.
        float up = 0.5 + 0.5 * texelFetch(gbuffer_shading_normal, pixel, 0).y;
        vec3 sky = mix(vec3(0.5, 0.48, 0.45), vec3(0.85, 0.95, 1.1), up);
        radiance = texelFetch(gbuffer_albedo, pixel, 0).rgb * sky * (u.ambient / gn_pi);
        radiance += texelFetch(gbuffer_emission, pixel, 0).rgb;
    } else {
        float height = float(pixel.y) / float(u.view.size.y);
        radiance = mix(vec3(0.55, 0.75, 1.1), vec3(1.0, 0.98, 0.94), height) * (1.5 * u.ambient / gn_pi);
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
    float v = 1.0;
#ifdef GN_VISIBILITY
    v = texelFetch(visibility, pixel, 0).r;
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

struct AmbientConstants {
    GnViewConstants view;
    float ambient;
};
struct LightConstants {
    GnViewConstants view;
    GnLight light;
};

/// Ambient illuminance, lux: a share of what the lights give on the scene, so that shadows are dark but not black.
float ambient_of(const Scene& scene) {
    const Box around_ws = largest_cluster(scene);
    const float reach = around_ws.empty() ? 1.0F : 0.2F * around_ws.diagonal();
    float sum = 0;
    for (const Light& light : scene.lights) {
        const GnLight& shape = light.shape;
        const float area = 4 * shape.half_size.x * shape.half_size.y;
        sum += shape.kind == GN_LIGHT_DIRECTIONAL ? shape.intensity
               : shape.kind == GN_LIGHT_RECTANGLE ? shape.intensity * area / (reach * reach)
                                                  : 0.5F * shape.intensity / (reach * reach);
    }
    return 0.08F * sum;
}

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
        [samples, visibility, picture, constants = LightConstants{samples.constants, light.shape}](Recorder& r) {
            r.bind(shader("shade", visibility.valid() ? "#define GN_VISIBILITY\n" : "", light_text));
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
    const TextureHandle picture = input.graph.create(
        {.name = "picture", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = samples.width, .height = samples.height});
    input.graph.add_pass(
        "ambient",
        [&](PassBuilder& pass) {
            declare_gbuffer(pass, samples);
            pass.storage_write(picture);
        },
        [samples, picture, constants = AmbientConstants{samples.constants, ambient_of(input.scene)}](Recorder& r) {
            r.bind(shader("ambient", "", ambient_text));
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
