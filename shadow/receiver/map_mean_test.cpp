// SPDX-License-Identifier: MIT
// What is read over a footprint lies in the view's own rectangle, on every mip.
#include "shadow/receiver/map_mean.glsl"

#include "gpu/shader_inputs.h"
#include "shadow/map/derived.h"
#include "tests/rig.h"

#include <cstring>
#include <random>

namespace gn::map_mean_test {
namespace {

constexpr int side = 64;

/// Receivers and footprints over one rectangle, texels.
struct Asked {
    std::vector<vec4> uv;         ///< ts
    std::vector<vec4> gradients;  ///< ddx_ts, ddy_ts
    vec4 bounds{0};
};

glsl::GnProjected projected(const Asked& asked, std::size_t i) {
    glsl::GnProjected p{};
    p.uv_ts = vec2(asked.uv[i]);
    p.texel_ts = 1.0F / side;
    p.bounds_ts = asked.bounds;
    return p;
}

Asked ask(ivec4 texels, std::mt19937& random) {
    Asked asked;
    asked.bounds = vec4(texels) / static_cast<float>(side);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 300; ++i) {
        const vec2 low(asked.bounds);
        const vec2 high(asked.bounds.z, asked.bounds.w);
        asked.uv.emplace_back(glm::mix(low, high, vec2(unit(random), unit(random))), 0, 0);
        // From a tenth of a texel to twice the map.
        const float reach = std::pow(10.0F, unit(random) * 3.1F - 1) / side;
        const float turn = 6.2832F * unit(random);
        asked.gradients.emplace_back(reach * std::cos(turn), reach * std::sin(turn), -reach * std::sin(turn) * 0.5F,
                                     reach * std::cos(turn));
    }
    return asked;
}

/// Rectangles at multiples of their side, and others.
const std::array<ivec4, 5> rectangles{ivec4(0, 0, 32, 32), ivec4(32, 0, 48, 16), ivec4(16, 48, 24, 56),
                                      ivec4(12, 4, 36, 44), ivec4(5, 7, 31, 40)};

TEST(MapMean, TheTexelsAroundAFootprintAreTheViews) {
    std::mt19937 random(4);
    for (const ivec4& rectangle : rectangles) {
        const Asked asked = ask(rectangle, random);
        for (std::size_t i = 0; i < asked.uv.size(); ++i) {
            const vec4 gradient = asked.gradients[i];
            const glsl::GnMapFootprint at =
                glsl::gn_within_rect(projected(asked, i), vec2(gradient), vec2(gradient.z, gradient.w));
            const float longest = side * std::max(glm::length(at.ddx_ts), glm::length(at.ddy_ts));
            const int coarser = longest > 1 ? static_cast<int>(std::ceil(std::log2(longest))) : 0;
            const int texel = 1 << coarser;
            // Bilinear filtering reads the texels whose centres lie around the place.
            for (int axis = 0; axis < 2; ++axis) {
                const float place = at.uv_ts[axis] * side / static_cast<float>(texel) - 0.5F;
                const int first = static_cast<int>(std::floor(place + 1e-4F)) * texel;
                const int last = static_cast<int>(std::ceil(place - 1e-4F)) * texel + texel;
                EXPECT_GE(first, rectangle[axis]) << i;
                EXPECT_LE(last, rectangle[axis + 2]) << i;
            }
        }
    }
}

TEST(MapMean, AWholeLayerIsReadAsItIs) {
    std::mt19937 random(5);
    const Asked asked = ask(ivec4(0, 0, side, side), random);
    for (std::size_t i = 0; i < asked.uv.size(); ++i) {
        const vec2 ddx(asked.gradients[i]);
        const vec2 ddy(asked.gradients[i].z, asked.gradients[i].w);
        const glsl::GnMapFootprint at = glsl::gn_within_rect(projected(asked, i), ddx, ddy);
        EXPECT_EQ(at.uv_ts, vec2(asked.uv[i]));
        EXPECT_EQ(at.ddx_ts, ddx);
        EXPECT_EQ(at.ddy_ts, ddy);
    }
}

/// A map that is 0 in the rectangle and 1 beside it, with all mips.
TextureHandle draw_map(FrameGraph& graph, const ivec4& rectangle) {
    const TextureHandle map =
        graph.create({.name = "map", .format = VK_FORMAT_R32G32_SFLOAT, .width = side, .height = side, .mips = 7});
    graph.add_pass(
        "fill", [&](PassBuilder& pass) { pass.color(map, Load::clear, {.color = vec4(1)}); },
        [rectangle](Recorder& r) {
            const ivec2 size(rectangle.z - rectangle.x, rectangle.w - rectangle.y);
            r.bind(fullscreen({ShaderKind::fragment, "nothing",
                               "layout(location = 0) out vec4 c;\nvoid main() { c = vec4(0.0); }\n"}));
            r.scissor(rectangle.x, rectangle.y, static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y));
            r.draw(3);
        });
    add_mips(graph, map);
    return map;
}

constexpr const char* read_text = R"(
layout(local_size_x = 64) in;
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < uv.length()) {
        GnProjected p;
        p.uv_ts = uv[i].xy;
        p.layer = 0;
        p.texel_ts = 1.0 / 64.0;
        p.bounds_ts = u.bounds;
        vec2 ddx = gradients[i].xy;
        vec2 ddy = gradients[i].zw;
        answers[i] = vec2(gn_map_mean(map, p, 0, ddx, ddy).r, textureGrad(map, vec3(p.uv_ts, 0.0), ddx, ddy).r);
    }
}
)";

TEST(MapMeanRendered, NothingOfTheOtherViewsOfALayerIsRead) {
    const test::ValidationGuard guard;
    std::mt19937 random(6);
    for (const ivec4& rectangle : rectangles) {
        const Asked asked = ask(rectangle, random);
        FrameGraph graph(test::device());
        const TextureHandle map = draw_map(graph, rectangle);
        const BufferHandle answers =
            graph.create(BufferDesc{.name = "answers", .bytes = asked.uv.size() * sizeof(vec2)});
        graph.keep(answers);
        ShaderInputs inputs;
        inputs.texture("sampler2DArray", "map", map, trilinear());
        inputs.block("readonly buffer", "Places", "vec4 uv[];", std::as_bytes(std::span(asked.uv)));
        inputs.block("readonly buffer", "Gradients", "vec4 gradients[];", std::as_bytes(std::span(asked.gradients)));
        inputs.buffer("writeonly buffer", "Answers", "vec2 answers[];", answers);
        inputs.constant("vec4", "bounds", asked.bounds);
        const std::string text = "#include \"shadow/receiver/map_mean.glsl\"\n" + inputs.text() + read_text;
        graph.add_pass(
            "read", [&](PassBuilder& pass) { inputs.declare(pass); },
            [&](Recorder& r) {
                r.bind(ComputeDesc{{ShaderKind::compute, "read", text}, {}});
                inputs.set(r);
                r.dispatch((static_cast<std::uint32_t>(asked.uv.size()) + 63) / 64, 1);
            });
        graph.execute(false);
        const std::vector<std::byte> bytes = graph.download(answers);
        std::vector<vec2> read(asked.uv.size());
        ASSERT_EQ(bytes.size(), read.size() * sizeof(vec2));
        std::memcpy(read.data(), bytes.data(), bytes.size());
        std::size_t bled = 0;
        for (std::size_t i = 0; i < read.size(); ++i) {
            EXPECT_EQ(read[i].x, 0.0F) << i;
            bled += read[i].y > 0 ? 1 : 0;
        }
        EXPECT_GT(bled, 100U) << "without the rectangle others are read";
    }
}

}  // namespace
}  // namespace gn::map_mean_test
