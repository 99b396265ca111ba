// SPDX-License-Identifier: MIT
// Pyramids and N-buffers against a walk over the texels: exact where they promise it, never too narrow elsewhere.
#include "shadow/map/derived.h"

#include "gpu/shader_inputs.h"
#include "shadow/map/sums.h"
#include "shadow/receiver/map_range.glsl"
#include "shadow/receiver/sample_pass.h"
#include "tests/rig.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <tuple>

namespace gn::derived_test {
namespace {

/// A map of random depths, two layers.
struct Source {
    std::uint32_t width, height;
    std::vector<float> values;
    Texture2D texture;

    Source(std::uint32_t w, std::uint32_t h) : width(w), height(h), values(std::size_t{2} * w * h) {
        std::mt19937 random(w * 31 + h);
        for (float& value : values) {
            value = std::uniform_real_distribution<float>(0, 1)(random);
        }
        texture = Texture2D(test::device(), {.name = "source",
                                             .format = VK_FORMAT_R32_SFLOAT,
                                             .width = w,
                                             .height = h,
                                             .layers = 2,
                                             .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
    }
    [[nodiscard]] float at(int x, int y, std::uint32_t layer) const {
        return values[(std::size_t{layer} * height + static_cast<std::size_t>(y)) * width +
                      static_cast<std::size_t>(x)];
    }
    [[nodiscard]] vec2 range(ivec2 first, ivec2 last, std::uint32_t layer) const {
        vec2 range(3e38F, -3e38F);
        for (int y = std::max(first.y, 0); y <= std::min(last.y, static_cast<int>(height) - 1); ++y) {
            for (int x = std::max(first.x, 0); x <= std::min(last.x, static_cast<int>(width) - 1); ++x) {
                range = vec2(std::min(range.x, at(x, y, layer)), std::max(range.y, at(x, y, layer)));
            }
        }
        return range;
    }
    /// The source in a graph, filled from a buffer by a fragment pass a layer; further components are the powers of the first.
    TextureHandle draw(FrameGraph& graph, VkFormat format = VK_FORMAT_R32_SFLOAT) {
        const TextureHandle target =
            graph.create({.name = "source", .format = format, .width = width, .height = height, .layers = 2});
        for (std::uint32_t layer = 0; layer < 2; ++layer) {
            const std::size_t texels = std::size_t{width} * height;
            std::vector<float> part(values.begin() + static_cast<std::ptrdiff_t>(layer * texels),
                                    values.begin() + static_cast<std::ptrdiff_t>((layer + 1) * texels));
            ShaderInputs inputs;
            inputs.block("readonly buffer", "Values", "float values[];", std::as_bytes(std::span(part)));
            graph.add_pass(
                "fill",
                [&](PassBuilder& pass) {
                    pass.color(target, Load::discard, {}, one_layer(layer));
                    inputs.declare(pass);
                },
                [inputs, w = static_cast<std::int32_t>(width)](Recorder& r) {
                    r.bind(fullscreen({ShaderKind::fragment, "fill", inputs.text() + R"(
layout(push_constant) uniform Push { int width; } push;
layout(location = 0) out vec4 result;
void main() {
    float v = values[int(gl_FragCoord.y) * push.width + int(gl_FragCoord.x)];
    result = vec4(v, v * v, v * v * v, v * v * v * v);
}
)"}));
                    inputs.set(r);
                    r.push_value(w);
                    r.draw(3);
                });
        }
        return target;
    }
};

std::vector<vec2> pairs_of(const std::vector<std::byte>& bytes) {
    std::vector<vec2> pairs(bytes.size() / sizeof(vec2));
    std::memcpy(pairs.data(), bytes.data(), bytes.size());
    return pairs;
}

std::vector<float> floats_of(const std::vector<std::byte>& bytes) {
    std::vector<float> values(bytes.size() / sizeof(float));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

TEST(Derived, EveryLevelOfThePyramidHoldsTheRangeUnderItsTexels) {
    const test::ValidationGuard guard;
    for (const auto& [width, height, begin] :
         {std::tuple{16U, 16U, 0U}, {21U, 13U, 0U}, {7U, 1U, 0U}, {45U, 16U, 3U}, {7U, 1U, 3U}}) {
        Source source(width, height);
        FrameGraph graph(test::device());
        const TextureHandle pyramid = add_min_max_pyramid(graph, source.draw(graph), begin);
        graph.keep(pyramid);
        graph.execute(false);
        const std::uint32_t mips = graph.desc(pyramid).mips;
        const auto side = [](std::uint32_t texels) { return static_cast<int>(texels); };
        EXPECT_EQ(glsl::gn_pyramid_first(side(width), side(graph.desc(pyramid).width)),
                  std::min(side(begin), side(std::bit_width(width)) - 1));
        for (std::uint32_t layer = 0; layer < 2; ++layer) {
            for (std::uint32_t level = begin; level < begin + mips; ++level) {
                const std::vector<vec2> held = pairs_of(graph.download(pyramid, level - begin, layer));
                const int w = std::max(static_cast<int>(width >> level), 1);
                const int h = std::max(static_cast<int>(height >> level), 1);
                ASSERT_EQ(held.size(), static_cast<std::size_t>(w * h));
                for (int y = 0; y < h; ++y) {
                    for (int x = 0; x < w; ++x) {
                        // The last texel takes in what odd sides leave over.
                        const ivec2 first(x << level, y << level);
                        const ivec2 last(x == w - 1 ? static_cast<int>(width) - 1 : ((x + 1) << level) - 1,
                                         y == h - 1 ? static_cast<int>(height) - 1 : ((y + 1) << level) - 1);
                        EXPECT_EQ(held[static_cast<std::size_t>(y * w + x)], source.range(first, last, layer))
                            << width << " x " << height << " level " << level << " texel " << x << ", " << y;
                    }
                }
            }
        }
    }
}

void slant(Source& source) {
    for (std::size_t i = 0; i < source.values.size(); ++i) {
        const auto x = static_cast<double>(i % source.width), y = static_cast<double>(i / source.width % source.height);
        source.values[i] = static_cast<float>(0.3 + 0.004 * x - 0.002 * y);
    }
}

/// Under every texel of every level, of random depths and of a slanted surface, which is its own plane.
TEST(Derived, LowerPlanesLieBeforeEveryDepthUnderTheirTexels) {
    const test::ValidationGuard guard;
    for (const auto& [width, height, flat] :
         {std::tuple{64U, 64U, false}, {45U, 21U, false}, {7U, 3U, false}, {64U, 32U, true}, {45U, 21U, true}}) {
        Source source(width, height);
        if (flat) {
            slant(source);
        }
        FrameGraph graph(test::device());
        const TextureHandle planes = add_lower_planes(graph, source.draw(graph));
        graph.keep(planes);
        graph.execute(false);
        double most = 0;
        for (std::uint32_t mip = 0; mip < graph.desc(planes).mips; ++mip) {
            const std::vector<float> held = floats_of(graph.download(planes, mip, 1));
            const int shift = static_cast<int>(mip) + glsl::gn_coarse_mip;
            const int w = std::max(static_cast<int>(width) >> shift, 1),
                      h = std::max(static_cast<int>(height) >> shift, 1);
            ASSERT_EQ(held.size(), static_cast<std::size_t>(4 * w * h));
            for (int y = 0; y < static_cast<int>(height); ++y) {
                for (int x = 0; x < static_cast<int>(width); ++x) {
                    const int bx = std::min(x >> shift, w - 1), by = std::min(y >> shift, h - 1);
                    const float* plane = &held[static_cast<std::size_t>(4 * (by * w + bx))];
                    const double before = plane[0] + static_cast<double>(plane[1]) * (x - (bx << shift)) +
                                          static_cast<double>(plane[2]) * (y - (by << shift));
                    const double room = source.at(x, y, 1) - before;
                    EXPECT_GE(room, 0) << width << " x " << height << " mip " << mip << " at " << x << ", " << y;
                    most = std::max(most, room);
                }
            }
        }
        EXPECT_EQ(most < 1e-4, flat) << width << " x " << height;
    }
}

TEST(Derived, AnNBufferAnswersForEverySquare) {
    const test::ValidationGuard guard;
    Source source(19, 12);
    FrameGraph graph(test::device());
    const TextureHandle map = source.draw(graph);
    const TextureHandle ranges = add_n_buffer(graph, map, NBuffer::min_max);
    const TextureHandle means = add_n_buffer(graph, map, NBuffer::mean, 3);
    graph.keep(ranges);
    graph.keep(means);
    graph.execute(false);
    const std::uint32_t levels = n_buffer_levels(19);
    ASSERT_EQ(levels, 5U);
    ASSERT_EQ(graph.desc(ranges).layers, 2 * levels);
    ASSERT_EQ(graph.desc(means).layers, 2U * 3U);
    for (std::uint32_t layer = 0; layer < 2; ++layer) {
        for (std::uint32_t level = 0; level < levels; ++level) {
            const std::vector<vec2> read = pairs_of(graph.download(ranges, 0, layer * levels + level));
            for (int y = 0; y < 12; ++y) {
                for (int x = 0; x < 19; ++x) {
                    const ivec2 last = ivec2(x, y) + (1 << level) - 1;
                    EXPECT_EQ(read[static_cast<std::size_t>(y * 19 + x)], source.range({x, y}, last, layer))
                        << "level " << level << " texel " << x << ", " << y;
                }
            }
        }
        // Inside the map the mean at level 2 is the box of 4 x 4 texels; sums of sixteen values round four times.
        const std::vector<std::byte> bytes = graph.download(means, 0, layer * 3 + 2);
        std::vector<float> read(bytes.size() / 4);
        std::memcpy(read.data(), bytes.data(), bytes.size());
        for (int y = 0; y + 3 < 12; ++y) {
            for (int x = 0; x + 3 < 19; ++x) {
                double sum = 0;
                for (int i = 0; i < 16; ++i) {
                    sum += static_cast<double>(source.at(x + i % 4, y + i / 4, layer));
                }
                EXPECT_NEAR(read[static_cast<std::size_t>(y * 19 + x)], sum / 16, 4 * 6e-8);
            }
        }
    }
}

TEST(Derived, MipsAreTheMeansOfTheirTexels) {
    const test::ValidationGuard guard;
    Source source(32, 32);
    FrameGraph graph(test::device());
    const TextureHandle mipmapped = add_mipmapped(graph, source.draw(graph));
    graph.keep(mipmapped);
    graph.execute(false);
    ASSERT_EQ(graph.desc(mipmapped).mips, 6U);
    for (std::uint32_t layer = 0; layer < 2; ++layer) {
        for (int mip = 0; mip < 6; ++mip) {
            const std::vector<float> level =
                floats_of(graph.download(mipmapped, static_cast<std::uint32_t>(mip), layer));
            const int texels = 32 >> mip;
            for (int i = 0; i < texels * texels; ++i) {
                double sum = 0;
                for (int j = 0; j < 1 << (2 * mip); ++j) {
                    sum += static_cast<double>(
                        source.at((i % texels << mip) + j % (1 << mip), (i / texels << mip) + (j >> mip), layer));
                }
                // Each level rounds once.
                EXPECT_NEAR(level[static_cast<std::size_t>(i)], sum / (1 << (2 * mip)), (mip + 1) * 6e-8)
                    << "mip " << mip << " texel " << i;
            }
        }
    }
}

TEST(Derived, SumsAnswerWithTheMeanOfAnyRectangle) {
    const test::ValidationGuard guard;
    constexpr int rectangles = 100;
    Source source(24, 24);
    std::mt19937 random(3);
    std::vector<ivec4> asked;
    for (int i = 0; i < rectangles; ++i) {
        const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
        const ivec2 first(i == 0 ? ivec2(0) : ivec2(pick(0, 23), pick(0, 23)));
        asked.emplace_back(first, i == 0 ? ivec2(24) : ivec2(pick(first.x + 1, 24), pick(first.y + 1, 24)));
    }
    for (const VkFormat format : {VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT}) {
        FrameGraph graph(test::device());
        const TextureHandle sums = add_sat(graph, source.draw(graph, format), {.table = GN_SAT_FLOAT32});
        const BufferHandle answers = graph.create(BufferDesc{.name = "answers", .bytes = rectangles * sizeof(vec4)});
        graph.keep(answers);
        ShaderInputs inputs;
        inputs.texture("sampler2DArray", "sums", sums);
        inputs.block("readonly buffer", "Asked", "ivec4 rectangles[];", std::as_bytes(std::span(asked)));
        inputs.buffer("writeonly buffer", "Answers", "vec4 means[];", answers);
        const std::string text = "#include \"shadow/map/sums.glsl\"\n" + inputs.text() + R"(
layout(local_size_x = 64) in;
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < rectangles.length()) {
        means[i] = gn_sat_mean(sums, GN_SAT_FLOAT32, 0, 1, rectangles[i].xz, rectangles[i].yw);
    }
}
)";
        graph.add_pass(
            "ask", [&](PassBuilder& pass) { inputs.declare(pass); },
            [&](Recorder& r) {
                r.bind(ComputeDesc{{ShaderKind::compute, "ask", text}, {}});
                inputs.set(r);
                r.dispatch((rectangles + 63) / 64, 1);
            });
        graph.execute(false);
        const std::vector<float> means = floats_of(graph.download(answers));
        for (std::size_t i = 0; i < rectangles; ++i) {
            const ivec4 r = asked[i];
            std::array<double, 4> sum{};
            for (int y = r.y; y < r.w; ++y) {
                for (int x = r.x; x < r.z; ++x) {
                    const double v = source.at(x, y, 1);
                    for (int power = 0; power < 4; ++power) {
                        sum.at(static_cast<std::size_t>(power)) += std::pow(v, power + 1);
                    }
                }
            }
            const double area = static_cast<double>(r.z - r.x) * (r.w - r.y);
            const std::size_t components = format == VK_FORMAT_R32G32_SFLOAT ? 2 : 4;
            for (std::size_t c = 0; c < components; ++c) {
                // Four corners of sums up to 576 x 0.5, each rounded once a row of it.
                EXPECT_NEAR(means[4 * i + c], sum.at(c) / area, 4 * 24 * 3e-5 / area) << i << " component " << c;
            }
        }
    }
}

/// What GLSL answers for each rectangle of texels, {first, last}: `body` sets answers[i] of `rectangle`, by functions of `file`.
template <typename Answer>
std::vector<Answer> answers_of(FrameGraph& graph, ShaderInputs inputs, const std::vector<ivec4>& asked,
                               const char* file, const char* body) {
    const BufferHandle answers = graph.create(BufferDesc{.name = "answers", .bytes = asked.size() * sizeof(Answer)});
    graph.keep(answers);
    inputs.block("readonly buffer", "Asked", "ivec4 asked[];", std::as_bytes(std::span(asked)))
        .buffer("writeonly buffer", "Answers", sizeof(Answer) == sizeof(vec2) ? "vec2 answers[];" : "vec4 answers[];",
                answers);
    const std::string text = inputs.text() + include_line(file) +
                             "layout(local_size_x = 64) in;\n"
                             "void main() {\n"
                             "    uint i = gl_GlobalInvocationID.x;\n"
                             "    if (i < asked.length()) {\n"
                             "        ivec4 rectangle = asked[i];\n" +
                             body + "    }\n}\n";
    const auto groups = static_cast<std::uint32_t>((asked.size() + 63) / 64);
    graph.add_pass(
        "ask", [&](PassBuilder& pass) { inputs.declare(pass); },
        [=](Recorder& r) {
            r.bind(ComputeDesc{{ShaderKind::compute, "ask", text}, {}});
            inputs.set(r);
            r.dispatch(groups, 1);
        });
    graph.execute(false);
    const std::vector<std::byte> bytes = graph.download(answers);
    std::vector<Answer> read(asked.size());
    std::memcpy(read.data(), bytes.data(), asked.size() * sizeof(Answer));
    return read;
}

TEST(Derived, RectanglesAreCoveredByFourFetches) {
    const test::ValidationGuard guard;
    constexpr int rectangles = 200;
    Source source(33, 33);
    std::mt19937 random(7);
    std::vector<ivec4> asked;
    for (int i = 0; i < rectangles; ++i) {
        const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
        const ivec2 first(pick(0, 32), pick(0, 32));
        // The first half squares, the second any rectangles.
        const int side = pick(0, 32 - std::max(first.x, first.y));
        const ivec2 last = i < rectangles / 2 ? first + side : ivec2(pick(first.x, 32), pick(first.y, 32));
        asked.emplace_back(first, last);
    }
    FrameGraph graph(test::device());
    const TextureHandle map = source.draw(graph);
    const TextureHandle pyramid = add_min_max_pyramid(graph, map);
    const TextureHandle buffer = add_n_buffer(graph, map, NBuffer::min_max);
    ShaderInputs inputs;
    inputs.texture("sampler2DArray", "pyramid", pyramid).texture("sampler2DArray", "n_buffer", buffer);
    const std::vector<vec4> read = answers_of<vec4>(graph, inputs, asked, "shadow/receiver/map_range.glsl", R"(
        int levels = textureQueryLevels(pyramid);
        answers[i] = vec4(gn_pyramid_min_max(pyramid, rectangle.xy, rectangle.zw, 1, levels),
                          gn_n_buffer_min_max(n_buffer, rectangle.xy, rectangle.zw, 1, levels));
)");
    for (int i = 0; i < rectangles; ++i) {
        const ivec2 first(asked[static_cast<std::size_t>(i)]),
            last(asked[static_cast<std::size_t>(i)].z, asked[static_cast<std::size_t>(i)].w);
        const vec4 got = read[static_cast<std::size_t>(i)];
        const vec2 exact = source.range(first, last, 1);
        EXPECT_TRUE(got.x <= exact.x && got.y >= exact.y) << "pyramid, rectangle " << i;
        EXPECT_TRUE(got.z <= exact.x && got.w >= exact.y) << "n-buffer, rectangle " << i;
        if (last.x - first.x == last.y - first.y) {
            EXPECT_EQ(vec2(got.z, got.w), exact) << "n-buffer, square " << i;
        }
        // A pyramid answers for the aligned squares that the rectangle touches; an N-buffer is never wider than that.
        const int level = glsl::gn_n_buffer_level(first, last, 6);
        EXPECT_EQ(vec2(got.z, got.w), source.range(first, glm::max(last, first + (1 << level) - 1), 1)) << i;
    }
}

/// By four fetches too, of any rectangle, and of a slanted surface it is that surface.
TEST(Derived, ALowerPlaneLiesBeforeTheDepthsOfARectangle) {
    const test::ValidationGuard guard;
    for (const bool flat : {false, true}) {
        Source source(67, 45);
        if (flat) {
            slant(source);
        }
        std::mt19937 random(5);
        const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
        std::vector<ivec4> asked;
        for (int i = 0; i < 200; ++i) {
            const ivec2 first(pick(0, 66), pick(0, 44));
            asked.emplace_back(first, pick(first.x, 66), pick(first.y, 44));
        }
        FrameGraph graph(test::device());
        ShaderInputs inputs;
        inputs.texture("sampler2DArray", "planes", add_lower_planes(graph, source.draw(graph)));
        const std::vector<vec4> read =
            answers_of<vec4>(graph, inputs, asked, "shadow/receiver/map_range.glsl",
                             "answers[i] = vec4(gn_lower_plane(planes, rectangle.xy, rectangle.zw, 1), 0.0);\n");
        double most = 0;
        for (std::size_t i = 0; i < asked.size(); ++i) {
            for (int y = asked[i].y; y <= asked[i].w; ++y) {
                for (int x = asked[i].x; x <= asked[i].z; ++x) {
                    const double before = read[i].x + static_cast<double>(read[i].y) * (x - asked[i].x) +
                                          static_cast<double>(read[i].z) * (y - asked[i].y);
                    const double room = source.at(x, y, 1) - before;
                    EXPECT_GE(room, -1e-6) << "rectangle " << i << " at " << x << ", " << y;
                    most = std::max(most, room);
                }
            }
        }
        EXPECT_EQ(most < 1e-4, flat);
    }
}

/// Whether a rectangle holds a depth beyond a bound is told exactly, whatever squares it cuts and whether sides are odd.
TEST(Derived, ARectanglesTexelsDecideAndNoOthers) {
    const test::ValidationGuard guard;
    constexpr std::size_t rectangles = 400;
    for (const auto& [width, height] : {std::pair{64, 64}, {45, 27}}) {
        Source source(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
        // Few texels lie beyond 0.9 or before 0.1, so that many rectangles hold none.
        for (float& value : source.values) {
            value = value < 0.01F || value > 0.99F ? value : 0.5F;
        }
        std::mt19937 random(5);
        const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
        std::vector<ivec4> asked;
        for (std::size_t i = 0; i < rectangles; ++i) {
            const ivec2 first(pick(0, width - 1), pick(0, height - 1));
            asked.emplace_back(first, pick(first.x, std::min(first.x + 12, width - 1)),
                               pick(first.y, std::min(first.y + 12, height - 1)));
        }
        FrameGraph graph(test::device());
        const TextureHandle pyramid = add_min_max_pyramid(graph, source.draw(graph));
        ShaderInputs inputs;
        inputs.texture("sampler2DArray", "pyramid", pyramid);
        const std::vector<vec2> read = answers_of<vec2>(graph, inputs, asked, "shadow/receiver/map_any.glsl", R"(
        answers[i] = vec2(gn_pyramid_beyond(pyramid, rectangle.xy, rectangle.zw, 1, vec2(0.9, 0.1)));
)");
        int any = 0, both = 0;
        for (std::size_t i = 0; i < rectangles; ++i) {
            const vec2 exact = source.range(ivec2(asked[i]), ivec2(asked[i].z, asked[i].w), 1);
            EXPECT_EQ(read[i].x == 1, exact.y >= 0.9F) << width << " x " << height << ", rectangle " << i;
            EXPECT_EQ(read[i].y == 1, exact.x < 0.1F) << width << " x " << height << ", rectangle " << i;
            any += read[i].x == 1 ? 1 : 0;
            both += read[i].x == 1 && read[i].y == 1 ? 1 : 0;
        }
        EXPECT_GT(any, 40);
        EXPECT_LT(any, 360);
        EXPECT_GT(both, 20);
    }
}

}  // namespace
}  // namespace gn::derived_test
