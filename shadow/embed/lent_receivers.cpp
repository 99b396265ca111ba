// SPDX-License-Identifier: MIT
#include "shadow/embed/lent_receivers.h"

#include "gpu/shader_inputs.h"
#include "shadow/embed/lent_camera.h"
#include "shadow/frame/frame.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn::embed {
namespace {

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
               "#include \"shadow/receiver/octahedral.glsl\"\n" + inputs.text() +
               "#include \"shadow/embed/lent_pixels.glsl\"\n";
    });
    add_pixel_pass(graph, "lent receivers", inputs, shader, lent.width, lent.height);
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
