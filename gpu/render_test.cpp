// SPDX-License-Identifier: MIT
// Raster passes on whatever device is there, validation on.
#include "gpu/test_device.h"

#include <bit>

namespace gn::render_test {
namespace {

constexpr std::uint32_t side = 16;

class Raster : public Rendered {
  protected:
    TextureHandle target(const char* name, VkFormat format, std::uint32_t layers = 1, std::uint32_t samples = 1) {
        const TextureHandle handle = graph.create(TextureDesc{
            .name = name, .format = format, .width = side, .height = side, .layers = layers, .samples = samples});
        return handle;
    }
    std::vector<float> floats(TextureHandle texture, std::uint32_t layer = 0, std::uint32_t mip = 0) {
        return values_of<float>(graph.download(texture, mip, layer));
    }
    FrameGraph graph{device};
};

/// A rectangle in clip space at one depth, as two triangles, counter-clockwise on the screen.
ShaderSource rectangle_vertex_shader() {
    return vertex_shader("rectangle", R"(
layout(push_constant, scalar) uniform Rectangle { vec4 bounds_cs; float depth; float value; float flip; } rectangle;
layout(location = 0) flat out float value;
void main() {
    const int corners[6] = int[](0, 2, 3, 0, 3, 1);
    int corner = corners[rectangle.flip > 0.0 ? 5 - gl_VertexIndex : gl_VertexIndex];
    vec2 p = mix(rectangle.bounds_cs.xy, rectangle.bounds_cs.zw, vec2(corner & 1, corner >> 1));
    gl_Position = vec4(p, rectangle.depth, 1.0);
    value = rectangle.value;
}
)");
}

ShaderSource value_fragment_shader() {
    return fragment_shader("value", R"(
layout(location = 0) flat in float value;
layout(location = 0) out float result;
void main() { result = value; }
)");
}

struct Rectangle {
    vec4 bounds_cs;
    float depth, value, flip = 0;
};
constexpr Rectangle whole(float depth, float value, float flip = 0) {
    return {vec4(-1, -1, 1, 1), depth, value, flip};
}

TEST_F(Raster, TheNearerSurfaceWins) {
    const TextureHandle color = target("color", VK_FORMAT_R32_SFLOAT);
    const TextureHandle depth = target("depth", VK_FORMAT_D32_SFLOAT);
    graph.keep(color);
    graph.keep(depth);
    graph.add_pass(
        "draw",
        [&](PassBuilder& pass) {
            pass.color(color, Load::clear, {.color = vec4(-1)});
            pass.depth(depth, Load::clear, {.depth = 0.0F});
        },
        [](Recorder& r) {
            r.bind(RasterDesc{.vertex = rectangle_vertex_shader(),
                              .fragment = value_fragment_shader(),
                              .depth_test = true,
                              .depth_write = true});
            // Reversed depth: the greater is nearer. The left half near, then everything far.
            r.push_value(Rectangle{vec4(-1, -1, 0, 1), 0.75F, 1.0F});
            r.draw(6);
            r.push_value(whole(0.25F, 2.0F));
            r.draw(6);
        });
    graph.execute();
    const auto colors = floats(color), depths = floats(depth);
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const bool left = i % side < side / 2;
        EXPECT_EQ(colors[i], left ? 1.0F : 2.0F) << i;
        EXPECT_EQ(depths[i], left ? 0.75F : 0.25F) << i;
    }
}

TEST_F(Raster, FrontFacesAreCounterClockwiseOnTheScreen) {
    const TextureHandle color = target("color", VK_FORMAT_R32_SFLOAT);
    graph.keep(color);
    graph.add_pass(
        "draw", [&](PassBuilder& pass) { pass.color(color, Load::clear); },
        [](Recorder& r) {
            r.bind(RasterDesc{.vertex = rectangle_vertex_shader(),
                              .fragment = value_fragment_shader(),
                              .cull = VK_CULL_MODE_BACK_BIT});
            r.push_value(whole(0.5F, 1.0F));
            r.draw(6);
            r.push_value(whole(0.5F, 2.0F, 1.0F));
            r.draw(6);
        });
    graph.execute();
    EXPECT_EQ(floats(color), std::vector<float>(side * side, 1.0F));
}

TEST_F(Raster, AReadOnlyDepthIsTestedAndSampledAtOnce) {
    const TextureHandle depth = target("depth", VK_FORMAT_D32_SFLOAT), color = target("color", VK_FORMAT_R32_SFLOAT);
    graph.keep(color);
    graph.add_pass(
        "prepass", [&](PassBuilder& pass) { pass.depth(depth, Load::clear, {.depth = 0.25F}); },
        [](Recorder& r) {
            r.bind(RasterDesc{.vertex = rectangle_vertex_shader(), .depth_test = true, .depth_write = true});
            r.push_value(Rectangle{vec4(-1, -1, 0, 1), 0.75F, 0});
            r.draw(6);
        });
    graph.add_pass(
        "shade",
        [&](PassBuilder& pass) {
            pass.depth_read_only(depth);
            pass.sample(depth);
            pass.color(color, Load::clear);
        },
        [=](Recorder& r) {
            r.bind(RasterDesc{.vertex = rectangle_vertex_shader(),
                              .fragment = fragment_shader("sampled", R"(
layout(binding = 0) uniform sampler2D depth;
layout(location = 0) out float result;
void main() { result = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r; }
)"),
                              .depth_test = true});
            r.push_value(whole(0.5F, 0));
            r.set("depth", depth);
            r.draw(6);
        });
    graph.execute();
    const auto colors = floats(color);
    for (std::uint32_t i = 0; i < side * side; ++i) {
        EXPECT_EQ(colors[i], i % side < side / 2 ? 0.0F : 0.25F) << i;
    }
}

TEST_F(Raster, TheStencilCountsBothSidesAtOnce) {
    // Depth fails: back faces count up, front faces down, as shadow volumes do; then only where it is not zero draw.
    const TextureHandle depth = target("depth", VK_FORMAT_D32_SFLOAT_S8_UINT),
                        color = target("color", VK_FORMAT_R32_SFLOAT);
    graph.keep(color);
    graph.add_pass(
        "prepass", [&](PassBuilder& pass) { pass.depth(depth, Load::clear, {.depth = 0.5F, .stencil = 7}); },
        [](Recorder&) {});
    graph.add_pass(
        "volumes",
        [&](PassBuilder& pass) {
            pass.depth_read_only(depth, {0, 1, 0, 1}, 0U);
        },
        [](Recorder& r) {
            StencilOps ops;
            ops.front = {.passOp = VK_STENCIL_OP_KEEP,
                         .depthFailOp = VK_STENCIL_OP_DECREMENT_AND_WRAP,
                         .compareOp = VK_COMPARE_OP_ALWAYS,
                         .compareMask = 0xFF,
                         .writeMask = 0xFF};
            ops.back = ops.front;
            ops.back.depthFailOp = VK_STENCIL_OP_INCREMENT_AND_WRAP;
            r.bind(RasterDesc{.vertex = rectangle_vertex_shader(), .depth_test = true, .stencil = ops});
            // The left half has a front and a back behind the surface; the lower half one more back.
            r.push_value(Rectangle{vec4(-1, -1, 0, 1), 0.3F, 0, 0});
            r.draw(6);
            r.push_value(Rectangle{vec4(-1, -1, 0, 1), 0.2F, 0, 1});
            r.draw(6);
            r.push_value(Rectangle{vec4(-1, 0, 1, 1), 0.2F, 0, 1});
            r.draw(6);
            // In front of the surface nothing counts.
            r.push_value(whole(0.9F, 0, 1));
            r.draw(6);
        });
    graph.add_pass(
        "shadow",
        [&](PassBuilder& pass) {
            pass.depth_read_only(depth);
            pass.color(color, Load::clear);
        },
        [](Recorder& r) {
            StencilOps ops;
            ops.front = {.compareOp = VK_COMPARE_OP_EQUAL, .compareMask = 0xFF, .writeMask = 0, .reference = 99};
            ops.back = ops.front;
            r.bind(
                RasterDesc{.vertex = rectangle_vertex_shader(), .fragment = value_fragment_shader(), .stencil = ops});
            r.stencil_reference(1);
            r.push_value(whole(0.5F, 3.0F));
            r.draw(6);
        });
    graph.execute();
    const auto colors = floats(color);
    for (std::uint32_t i = 0; i < side * side; ++i) {
        EXPECT_EQ(colors[i], i / side >= side / 2 ? 3.0F : 0.0F) << i;
    }
}

TEST_F(Raster, OneDrawReachesEveryLayer) {
    constexpr std::uint32_t layers = 6;
    const TextureHandle color = target("color", VK_FORMAT_R32_SFLOAT, layers),
                        depth = target("depth", VK_FORMAT_D32_SFLOAT, layers);
    graph.keep(color);
    graph.add_pass(
        "layers",
        [&](PassBuilder& pass) {
            pass.color(color, Load::clear, {.color = vec4(-1)}, one_mip(0));
            pass.depth(depth, Load::clear, {}, one_mip(0));
        },
        [](Recorder& r) {
            r.bind(RasterDesc{.vertex = vertex_shader("layered", R"(
layout(location = 0) flat out float value;
void main() {
    gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1.0);
    gl_Layer = gl_InstanceIndex;
    value = float(gl_InstanceIndex) * 10.0;
}
)"),
                              .fragment = value_fragment_shader(),
                              .depth_test = true,
                              .depth_write = true});
            r.draw(3, layers - 1);
        });
    graph.execute();
    for (std::uint32_t layer = 0; layer < layers; ++layer) {
        const float expected = layer + 1 < layers ? 10.0F * static_cast<float>(layer) : -1.0F;
        EXPECT_EQ(floats(color, layer), std::vector<float>(side * side, expected)) << "layer " << layer;
    }
}

TEST_F(Raster, AGeometryShaderReachesEveryFaceOfACube) {
    const TextureHandle cube = graph.create(TextureDesc{
        .name = "cube", .format = VK_FORMAT_R32_SFLOAT, .width = side, .height = side, .layers = 6, .cube = true});
    const BufferHandle faces = graph.create(BufferDesc{.name = "faces", .bytes = 6 * 4});
    graph.keep(faces);
    graph.add_pass(
        "cube", [&](PassBuilder& pass) { pass.color(cube, Load::clear, {}, one_mip(0)); },
        [](Recorder& r) {
            r.bind(RasterDesc{.vertex = vertex_shader("pass", R"(
void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1.0); }
)"),
                              .geometry = ShaderSource{ShaderKind::geometry, "faces", R"(
layout(triangles, invocations = 6) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) flat out float value;
void main() {
    for (int i = 0; i < 3; ++i) {
        gl_Position = gl_in[i].gl_Position;
        gl_Layer = gl_InvocationID;
        value = float(gl_InvocationID + 1);
        EmitVertex();
    }
}
)"},
                              .fragment = value_fragment_shader()});
            r.draw(3);
        });
    graph.add_pass(
        "look",
        [&](PassBuilder& pass) {
            pass.sample(cube);
            pass.storage_write(faces);
        },
        [=](Recorder& r) {
            r.bind(ComputeDesc{compute_shader("look", R"(
layout(local_size_x = 6) in;
layout(binding = 0) uniform samplerCube cube;
layout(binding = 1, scalar) buffer Faces { float values[]; } faces;
void main() {
    uint face = gl_LocalInvocationIndex;
    vec3 axis = vec3(0);
    axis[face / 2] = (face & 1u) == 0u ? 1.0 : -1.0;
    faces.values[face] = textureLod(cube, axis, 0.0).r;
}
)"),
                               {}});
            r.set("cube", cube, linear());
            r.set("faces", faces);
            r.dispatch(1, 1);
        });
    graph.execute();
    EXPECT_EQ(values_of<float>(graph.download(faces)), (std::vector<float>{1, 2, 3, 4, 5, 6}));
}

TEST_F(Raster, SamplesAreFetchedOneByOne) {
    const TextureHandle color = target("color", VK_FORMAT_R32_SFLOAT, 1, 4);
    const TextureHandle sum = target("sum", VK_FORMAT_R32_SFLOAT);
    graph.keep(sum);
    graph.add_pass(
        "samples", [&](PassBuilder& pass) { pass.color(color, Load::clear); },
        [](Recorder& r) {
            r.bind(fullscreen(fragment_shader("sample id", R"(
layout(location = 0) out float result;
void main() { result = float(1 << gl_SampleID); }
)")));
            r.draw(3);
        });
    graph.add_pass(
        "sum",
        [&](PassBuilder& pass) {
            pass.sample(color);
            pass.color(sum, Load::discard);
        },
        [=](Recorder& r) {
            r.bind(fullscreen(fragment_shader("sum", R"(
layout(binding = 0) uniform sampler2DMS samples;
layout(location = 0) out float result;
void main() {
    result = 0.0;
    for (int i = 0; i < 4; ++i) {
        result += texelFetch(samples, ivec2(gl_FragCoord.xy), i).r;
    }
}
)")));
            r.set("samples", color);
            r.draw(3);
        });
    graph.execute();
    EXPECT_EQ(floats(sum), std::vector<float>(side * side, 15.0F));
}

TEST_F(Raster, BlendsFollowTheirNames) {
    const struct {
        Blend blend;
        float expected;
    } cases[] = {{Blend::none, 3}, {Blend::add, 8}, {Blend::min, 3}, {Blend::max, 5}};
    for (const auto& c : cases) {
        FrameGraph one(device);
        const TextureHandle color =
            one.create(TextureDesc{.name = "color", .format = VK_FORMAT_R32_SFLOAT, .width = side, .height = side});
        one.keep(color);
        one.add_pass(
            "blend", [&](PassBuilder& pass) { pass.color(color, Load::clear, {.color = vec4(5)}); },
            [=](Recorder& r) {
                r.bind(RasterDesc{
                    .vertex = rectangle_vertex_shader(), .fragment = value_fragment_shader(), .blend = c.blend});
                r.push_value(whole(0.5F, 3.0F));
                r.draw(6);
            });
        one.execute();
        EXPECT_EQ(values_of<float>(one.download(color)), std::vector<float>(side * side, c.expected));
    }
}

TEST_F(Raster, LogicOrSetsBitsOfIntegers) {
    const TextureHandle bits = target("bits", VK_FORMAT_R32G32B32A32_UINT);
    graph.keep(bits);
    graph.add_pass(
        "slices", [&](PassBuilder& pass) { pass.color(bits, Load::clear, {.bits = uvec4(0, 0, 0, 0x80000000U)}); },
        [](Recorder& r) {
            RasterDesc desc{.vertex = rectangle_vertex_shader(),
                            .fragment = fragment_shader("bits", R"(
layout(location = 0) flat in float value;
layout(location = 0) out uvec4 result;
void main() { result = uvec4(0); result[int(value) >> 5] = 1u << (int(value) & 31); }
)"),
                            .blend = Blend::logic_or};
            r.bind(desc);
            for (const float bit : {0.0F, 5.0F, 40.0F, 95.0F}) {
                r.push_value(whole(0.5F, bit));
                r.draw(6);
            }
        });
    graph.execute();
    const auto words = values_of<std::uint32_t>(graph.download(bits));
    for (std::size_t i = 0; i < words.size(); i += 4) {
        ASSERT_EQ(words[i], 33U);
        ASSERT_EQ(words[i + 1], 256U);
        ASSERT_EQ(words[i + 2], 0x80000000U);
        ASSERT_EQ(words[i + 3], 0x80000000U) << "the clear value is kept";
    }
}

TEST_F(Raster, VerticesComeThroughABindingOrAnIndexBuffer) {
    const std::vector<float> corners{-1, -1, 0.25F, -1, 3, 0.25F, 3, -1, 0.25F};
    const std::vector<std::uint32_t> order{0, 1, 2};
    Buffer vertices = upload_buffer(device, {.name = "vertices", .usage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT},
                                    std::as_bytes(std::span(corners)));
    Buffer indices = upload_buffer(device, {.name = "indices", .usage = VK_BUFFER_USAGE_INDEX_BUFFER_BIT},
                                   std::as_bytes(std::span(order)));
    const BufferHandle v = graph.import(vertices), i = graph.import(indices);
    EXPECT_EQ(graph.import(vertices), v) << "one buffer is one resource";
    const TextureHandle depth = target("depth", VK_FORMAT_D32_SFLOAT);
    graph.keep(depth);
    graph.add_pass(
        "depth",
        [&](PassBuilder& pass) {
            pass.vertices(v);
            pass.indices(i);
            pass.depth(depth, Load::clear);
        },
        [=](Recorder& r) {
            r.bind(RasterDesc{.vertex = vertex_shader("position", R"(
layout(location = 0) in vec3 p_cs;
void main() { gl_Position = vec4(p_cs, 1.0); }
)"),
                              .depth_test = true,
                              .depth_write = true,
                              .attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT}},
                              .vertex_stride = 12});
            r.vertex_buffer(v);
            r.index_buffer(i);
            r.scissor(0, 0, side, side / 2);
            r.draw_indexed(3);
        });
    graph.execute();
    const auto depths = floats(depth);
    for (std::uint32_t p = 0; p < side * side; ++p) {
        EXPECT_EQ(depths[p], p / side < side / 2 ? 0.25F : 0.0F);
    }
}

TEST_F(Raster, ManyDrawsAreAllDrawnAndNoOther) {
    // Two triangles a quarter of the picture; the list leaves the second quarter out.
    std::array<std::uint32_t, 24> numbers{};
    for (std::uint32_t i = 0; i < numbers.size(); ++i) {
        numbers[i] = i;
    }
    const Buffer indices = upload_buffer(device, {.name = "indices", .usage = VK_BUFFER_USAGE_INDEX_BUFFER_BIT},
                                         std::as_bytes(std::span(numbers)));
    const BufferHandle i = graph.import(indices);
    const TextureHandle color = target("color", VK_FORMAT_R32_SFLOAT);
    graph.keep(color);
    graph.add_pass(
        "many",
        [&](PassBuilder& pass) {
            pass.indices(i);
            pass.color(color, Load::clear);
        },
        [=](Recorder& r) {
            r.bind(RasterDesc{.vertex = vertex_shader("quarters", R"(
layout(location = 0) flat out float value;
void main() {
    int quarter = gl_VertexIndex / 6;
    int corner = int[](0, 2, 3, 0, 3, 1)[gl_VertexIndex % 6];
    vec2 low = vec2(quarter & 1, quarter >> 1) - 1.0;
    gl_Position = vec4(low + vec2(corner & 1, corner >> 1), 0.5, 1.0);
    value = float(1 + quarter);
}
)"),
                              .fragment = value_fragment_shader()});
            r.index_buffer(i);
            r.draw_indexed(std::array{VkDrawIndexedIndirectCommand{6, 1, 0, 0, 0},
                                      VkDrawIndexedIndirectCommand{6, 1, 6, 6, 0},
                                      VkDrawIndexedIndirectCommand{6, 1, 18, 0, 0}});
        });
    graph.execute();
    // The vertex offset moves the second draw on to the third quarter.
    const auto colors = floats(color);
    EXPECT_EQ(colors[0], 1.0F);
    EXPECT_EQ(colors[side - 1], 0.0F);
    EXPECT_EQ(colors[side * (side - 1)], 3.0F);
    EXPECT_EQ(colors[side * side - 1], 4.0F);
}

TEST_F(Raster, SpecializationConstantsReachEveryStage) {
    const TextureHandle color = target("color", VK_FORMAT_R32_SFLOAT);
    graph.keep(color);
    graph.add_pass(
        "constants", [&](PassBuilder& pass) { pass.color(color, Load::clear); },
        [](Recorder& r) {
            RasterDesc desc = fullscreen(fragment_shader("constant", R"(
layout(constant_id = 3) const int TAPS = 9;
layout(constant_id = 4) const float SCALE = 1.0;
layout(location = 0) out float result;
void main() { result = float(TAPS) * SCALE; }
)"));
            desc.constants = {{3, 25}, {4, std::bit_cast<std::uint32_t>(0.5F)}};
            r.bind(desc);
            r.viewport(0, 0, side / 2, side);
            r.draw(3);
        });
    graph.execute();
    const auto colors = floats(color);
    EXPECT_EQ(colors[0], 12.5F);
    EXPECT_EQ(colors[side - 1], 0.0F) << "outside the viewport";
}

TEST_F(Raster, DepthBiasMovesByItsConstant) {
    const auto draw = [&](float constant) {
        FrameGraph one(device);
        const TextureHandle depth =
            one.create(TextureDesc{.name = "depth", .format = VK_FORMAT_D16_UNORM, .width = side, .height = side});
        one.keep(depth);
        one.add_pass(
            "biased", [&](PassBuilder& pass) { pass.depth(depth, Load::clear); },
            [=](Recorder& r) {
                r.bind(RasterDesc{
                    .vertex = rectangle_vertex_shader(), .depth_test = true, .depth_write = true, .depth_bias = true});
                r.depth_bias(constant, 0.0F);
                r.push_value(whole(0.5F, 0));
                r.draw(6);
            });
        one.execute();
        return static_cast<int>(values_of<std::uint16_t>(one.download(depth))[0]);
    };
    const int unbiased = draw(0);
    EXPECT_GT(draw(64), unbiased);
    EXPECT_LT(draw(-64), unbiased);
}

}  // namespace
}  // namespace gn::render_test
