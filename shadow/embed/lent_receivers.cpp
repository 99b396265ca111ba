// SPDX-License-Identifier: MIT
#include "shadow/embed/lent_receivers.h"

#include "gpu/shader_inputs.h"
#include "shadow/embed/lent_camera.h"
#include "shadow/frame/frame.h"
#include "shadow/receiver/channels.h"
#include "shadow/recipe/prepared.h"

namespace gn::embed {
namespace {

constexpr const char* main_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;

float depth_of(ivec2 pixel) { return texelFetch(lent_depth, pixel, 0).r; }
bool is_seen(float depth) { return GN_REVERSED ? depth > 0.0 : depth < 1.0; }

// Metres along the camera's axis.
float distance_of(float depth) {
    return GN_PERSPECTIVE ? float(u.z_offset / (depth - u.z_scale)) : u.z_offset + u.z_scale * depth;
}

vec3 position_of(ivec2 pixel, float z) {
    vec2 at = vec2(pixel) + 0.5;
    vec3 across_ws = u.first_ws.xyz + at.x * u.right_ws.xyz + at.y * u.down_ws.xyz;
    return u.eye_ws.xyz + (GN_PERSPECTIVE ? z * (u.forward_ws.xyz + across_ws) : z * u.forward_ws.xyz + across_ws);
}

vec3 to_eye(vec3 p_ws) { return GN_PERSPECTIVE ? u.eye_ws.xyz - p_ws : -u.forward_ws.xyz; }

// The nearer of both neighbours on an axis lies on the same surface, if any does.
vec3 step_of(ivec2 pixel, ivec2 axis, vec3 p_ws, float z) {
    vec3 best = vec3(0.0);
    float least = 3.0e38;
    for (int side = -1; side <= 1; side += 2) {
        ivec2 neighbour = pixel + side * axis;
        if (any(lessThan(neighbour, ivec2(0))) || any(greaterThanEqual(neighbour, textureSize(lent_depth, 0)))) {
            continue;
        }
        float depth = depth_of(neighbour);
        float beside = distance_of(depth);
        if (is_seen(depth) && abs(beside - z) < least) {
            least = abs(beside - z);
            best = float(side) * (position_of(neighbour, beside) - p_ws);
        }
    }
    return best;
}

vec3 normal_of(ivec2 pixel, vec3 p_ws, float z) {
#if GN_NORMALS == 0
    vec3 n = cross(step_of(pixel, ivec2(0, 1), p_ws, z), step_of(pixel, ivec2(1, 0), p_ws, z));
    return dot(n, n) > 0.0 ? normalize(n) : normalize(to_eye(p_ws));
#else
    vec3 n = texelFetch(lent_normals, pixel, 0).xyz;
#if GN_NORMALS == 2 || GN_NORMALS == 4
    n = 2.0 * n - 1.0;
#endif
#if GN_NORMALS >= 3
    return gn_from_octahedral(n.xy);
#else
    return normalize(n);
#endif
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, textureSize(lent_depth, 0)))) {
        return;
    }
    float depth = depth_of(pixel);
    vec4 position = vec4(0.0);
    vec4 normal = vec4(0.0);
    if (is_seen(depth)) {
        float z = distance_of(depth);
        position = vec4(position_of(pixel, z), 1.0);
        vec3 n_ws = normal_of(pixel, position.xyz, z);
        normal = vec4(dot(n_ws, to_eye(position.xyz)) < 0.0 ? -n_ws : n_ws, z);
    }
    imageStore(position_ws, pixel, position);
    imageStore(normal_ws, pixel, normal);
}
)";

constexpr const char* give_text = R"(
layout(location = 0) out vec4 v;
void main() { v = vec4(vec3(GN_V_OF(texelFetch(visibility, ivec2(gl_FragCoord.xy), 0))), 1.0); }
)";

/// What the pixels' rays are, from the camera's constants: `first_ws` leads to the picture's corner.
void add_rays(ShaderInputs& inputs, const LentCamera& lent, const GnViewConstants& view) {
    const bool bent = !is_orthographic(lent.camera);
    const vec2 half = 0.5F * vec2(view.size.x, view.size.y);
    const vec3 first = -vec3(view.right_ws) * (half.x * (1 + lent.camera.shift_cs.x)) -
                       vec3(view.down_ws) * (half.y * (1 + lent.camera.shift_cs.y));
    inputs.constant("vec4", "eye_ws", vec4(lent.camera.position_ws, bent ? 1 : 0));
    inputs.constant("vec4", "forward_ws", vec4(lent.camera.forward_ws, 0));
    inputs.constant("vec4", "first_ws", vec4(first, 0));
    inputs.constant("vec4", "right_ws", view.right_ws);
    inputs.constant("vec4", "down_ws", view.down_ws);
    inputs.constant("float", "z_scale", static_cast<float>(lent.z_scale));
    inputs.constant("float", "z_offset", static_cast<float>(lent.z_offset));
}

}  // namespace

ViewSamples add_lent_receivers(FrameGraph& graph, const ReceiverForm& form, const Receivers& lent, TextureHandle depth,
                               TextureHandle normals, const Box& bounds_ws, const PreparedRecipe* prepared) {
    const LentCamera camera = camera_of(lent.cs_from_ws, form.reversed_depth, lent.width, lent.height, bounds_ws);
    const auto create = [&](const char* name) {
        return graph.create(
            {.name = name, .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = lent.width, .height = lent.height});
    };
    const TextureHandle position = create("position"), normal = create("normal");
    ViewSamples samples = lent_samples(graph, camera.camera, position, normal);
    samples.before_cs_from_ws = lent.before_cs_from_ws;

    ShaderInputs inputs;
    inputs.texture("sampler2D", "lent_depth", depth);
    if (form.normals != Normals::none) {
        inputs.texture("sampler2D", "lent_normals", normals);
    }
    inputs.image("rgba32f", "writeonly", "image2D", "position_ws", position);
    inputs.image("rgba32f", "writeonly", "image2D", "normal_ws", normal);
    add_rays(inputs, camera, samples.constants);
    const bool perspective = !is_orthographic(camera.camera);
    const Hasher key = hashed(inputs).value(form.reversed_depth).value(perspective).value(form.normals);
    const auto shader = compute_once(prepared, "lent receivers", key, [&] {
        return fmt::format("#define GN_REVERSED {}\n#define GN_PERSPECTIVE {}\n#define GN_NORMALS {}\n",
                           form.reversed_depth, perspective, static_cast<int>(form.normals)) +
               "#include \"shadow/embed/lent_receivers.glsl\"\n" + inputs.text() + main_text;
    });
    graph.add_pass(
        "lent receivers", [&](PassBuilder& pass) { inputs.declare(pass); },
        [=, width = lent.width, height = lent.height](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch_pixels(width, height);
        });
    return samples;
}

void add_copy(FrameGraph& graph, TextureHandle visibility, TextureHandle target, const PreparedRecipe* prepared) {
    if (!visibility.valid()) {
        graph.add_pass(
            "lit",
            [&](PassBuilder& pass) {
                pass.color(target, Load::clear, {.color = {1, 1, 1, 1}});
            },
            [](Recorder&) {});
        return;
    }
    const uint channels = channels_of(graph, visibility);
    ShaderInputs inputs;
    inputs.texture("sampler2D", "visibility", visibility);
    const auto shader = made_once(prepared, "give back V", channels, [&] {
        return sealed(
            fullscreen({ShaderKind::fragment, "give back V", channels_text(channels) + inputs.text() + give_text}));
    });
    graph.add_pass(
        "give back V",
        [&](PassBuilder& pass) {
            inputs.declare(pass);
            pass.color(target, Load::discard);
        },
        [=](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.draw(3);
        });
}

}  // namespace gn::embed
