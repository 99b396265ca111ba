// SPDX-License-Identifier: MIT
// Based on: Reinhard, Stark, Shirley, Ferwerda. Photographic Tone Reproduction for Digital Images. SIGGRAPH 2002. [RSSF02]
#include "apps/view/display.h"

#include "gpu/shader_inputs.h"
#include "shadow/receiver/channels.h"
#include "shadow/recipe/prepared.h"

namespace gn {
namespace {

constexpr const char* exposure_text = R"(
layout(local_size_x = 64) in;
shared float sums[64];
shared int counts[64];

void main() {
    // Every invocation takes a row of the lattice.
    int row = int(gl_LocalInvocationIndex);
    ivec2 size = picture_size();
    float sum = 0.0;
    int count = 0;
    for (int i = 0; i < 64; ++i) {
        ivec2 pixel = ivec2((vec2(i, row) + 0.5) / 64.0 * vec2(size));
        float y = dot(picture_texel(pixel).rgb, vec3(0.2126, 0.7152, 0.0722));
        if (y > 0.0 && y < 1e30) {
            sum += log(y);
            ++count;
        }
    }
    sums[row] = sum;
    counts[row] = count;
    barrier();
    if (row == 0) {
        for (int i = 1; i < 64; ++i) {
            sum += sums[i];
            count += counts[i];
        }
        exposure = count == 0 ? 1.0 : 0.18 / exp(sum / float(count));
    }
}
)";

constexpr const char* display_text = R"(
layout(location = 0) out vec4 shown;

// Linear up to 0.6, then a shoulder that reaches 1 only at infinity.
vec3 shoulder(vec3 x) {
    const float knee = 0.6;
    return mix(knee + (1.0 - knee) * (1.0 - exp(-(x - knee) / (1.0 - knee))), x, lessThanEqual(x, vec3(knee)));
}
vec3 srgb(vec3 x) {
    return mix(1.055 * pow(max(x, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}
// Too dark is blue, too light is orange, as in reports; the square root gives small errors their room.
vec3 error_over(vec3 color, float signed_error) {
    float size = sqrt(min(abs(signed_error), 1.0));
    float grey = 0.22 + 0.5 * dot(color, vec3(0.299, 0.587, 0.114));
    return mix(vec3(grey), signed_error < 0.0 ? vec3(0.24, 0.53, 0.93) : vec3(0.95, 0.50, 0.16), size);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float x = (float(pixel.x) + 0.5) / float(picture_size().x);
    vec3 radiance = picture_texel(pixel).rgb;
#ifdef GN_BESIDE
    radiance = x < u.split ? radiance : beside_texel(pixel).rgb;
#endif
    vec3 color = srgb(shoulder(max(radiance * exposure * u.gain, vec3(0.0))));
#ifdef GN_ERROR
    if (x < u.split) {
        vec3 difference = visibility_texel(pixel).GN_A - visibility_b_texel(pixel).GN_B;
        vec3 size = abs(difference);
        color = error_over(color, size.r >= max(size.g, size.b) ? difference.r : size.g >= size.b ? difference.g : difference.b);
    }
#endif
#ifdef GN_BESIDE
    // A thin line at the split.
    color = abs(float(pixel.x) + 0.5 - u.split * float(picture_size().x)) < 1.0 ? vec3(1.0, 0.82, 0.45) : color;
#endif
    shown = vec4(color, 1.0);
}
)";

std::string swizzle_of(const FrameGraph& graph, TextureHandle visibility) {
    return channels_of(graph, visibility) == 1 ? "rrr" : "rgb";
}

}  // namespace

BufferDesc exposure_buffer() {
    return {.name = "exposure", .bytes = sizeof(float), .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
}

void add_exposure(FrameGraph& graph, const PreparedRecipe& recipe, TextureHandle picture, BufferHandle exposure) {
    ShaderInputs inputs;
    inputs.texels(graph.device(), VK_FORMAT_R32G32B32A32_SFLOAT, "2D", "picture", picture);
    inputs.buffer("writeonly buffer", "Exposure", "float exposure;", exposure);
    const auto shader =
        compute_once(&recipe, "exposure", hashed(inputs), [&] { return inputs.text() + exposure_text; });
    graph.add_pass(
        "exposure",
        [&](PassBuilder& pass) {
            inputs.declare(pass);
            pass.keep();
        },
        [inputs, shader](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch(1, 1);
        });
}

void add_display(FrameGraph& graph, const PreparedRecipe& recipe, const DisplayInputs& shown) {
    const bool error = shown.visibility.valid() && shown.visibility_b.valid();
    ShaderInputs inputs;
    const auto texels = [&](std::string_view name, TextureHandle texture) {
        inputs.texels(graph.device(), graph.desc(texture).format, "2D", name, texture);
    };
    std::string defines;
    texels("picture", shown.picture);
    if (shown.beside.valid()) {
        defines += "#define GN_BESIDE\n";
        texels("beside", shown.beside);
    }
    if (error) {
        defines += fmt::format("#define GN_ERROR\n#define GN_A {}\n#define GN_B {}\n",
                               swizzle_of(graph, shown.visibility), swizzle_of(graph, shown.visibility_b));
        texels("visibility", shown.visibility);
        texels("visibility_b", shown.visibility_b);
    }
    inputs.buffer("readonly buffer", "Exposure", "float exposure;", shown.exposure);
    inputs.constant("float", "gain", std::exp2(shown.stops)).constant("float", "split", shown.split);
    const auto shader = made_once(&recipe, "display", hashed(inputs).text(defines).finish().low, [&] {
        return sealed(fullscreen({ShaderKind::fragment, "display", defines + inputs.text() + display_text}));
    });
    graph.add_pass(
        "display",
        [&](PassBuilder& pass) {
            pass.color(shown.target, Load::discard);
            inputs.declare(pass);
            pass.keep();
        },
        [inputs, shader](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.draw(3);
        });
}

void add_answer(FrameGraph& graph, TextureHandle texture, std::function<void(std::span<const std::byte>)> receive) {
    const TextureDesc& desc = graph.desc(texture);
    const BufferHandle buffer = graph.create({.name = desc.name + " read back",
                                              .bytes = format_bytes(desc.format) * desc.width * desc.height,
                                              .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
    graph.add_pass(
        "read back " + desc.name,
        [&](PassBuilder& pass) {
            pass.copy_from(texture);
            pass.copy_to(buffer);
        },
        [=](Recorder& r) {
            r.copy(texture, buffer, {0, 1, 0, 1});
        });
    graph.answer(buffer, std::move(receive));
}

}  // namespace gn
