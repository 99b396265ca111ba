// SPDX-License-Identifier: MIT
// What is counted of passes: the device's own counts where work is known, and the bytes that a pass must move.
#include "gpu/pass_counters.h"

#include "gpu/test_device.h"

namespace gn::pass_counters_test {
namespace {

class Counted : public Rendered {
  protected:
    FrameGraph graph{device};
};

constexpr const char* one_text = "layout(location = 0) out float v; void main() { v = 1.0; }";

/// Corners of triangles that cover the centre of pixel (0, 0) and no other.
constexpr const char* corner_text = R"(
void main() {
    vec2 corner = vec2(gl_VertexIndex % 3 == 1, gl_VertexIndex % 3 == 2);
    gl_Position = vec4(corner * 3.0 / 16.0 - 1.0, 0.5, 1.0);
}
)";

TEST_F(Counted, VerticesTrianglesFragmentsSamplesAndItemsOfKnownWork) {
    const TextureHandle color =
        graph.create({.name = "color", .format = VK_FORMAT_R32_SFLOAT, .width = 64, .height = 32});
    const TextureHandle depth =
        graph.create({.name = "depth", .format = VK_FORMAT_D32_SFLOAT, .width = 16, .height = 16});
    const BufferHandle words = graph.create(BufferDesc{.name = "words", .bytes = 1024});
    graph.group("tests");
    graph.add_pass(
        "screen",
        [&](PassBuilder& pass) {
            pass.color(color, Load::clear);
            pass.keep();
        },
        [](Recorder& r) {
            r.bind(fullscreen(fragment_shader("one", one_text)));
            r.draw(3);
        });
    graph.add_pass(
        "triangles",
        [&](PassBuilder& pass) {
            pass.depth(depth, Load::clear);
            pass.keep();
        },
        [](Recorder& r) {
            RasterDesc desc;
            desc.vertex = vertex_shader("corner", corner_text);
            desc.depth_test = desc.depth_write = true;
            r.bind(desc);
            r.draw(300);
        });
    graph.add_pass(
        "items",
        [&](PassBuilder& pass) {
            pass.storage_write(words);
            pass.keep();
        },
        [=](Recorder& r) {
            r.bind(ComputeDesc{compute_shader("items", R"(
layout(local_size_x = 32) in;
layout(binding = 0, scalar) buffer Words { uint v[]; } words;
void main() { words.v[gl_GlobalInvocationID.x] = 1u; }
)"),
                               {}});
            r.set("words", words);
            r.dispatch(8, 1);
        });
    {
        PassCounters counters(device);
        if (!counters.missing().empty()) {
            GTEST_SKIP() << counters.missing();
        }
        graph.execute(false);
        const std::vector<CountedPass>& passes = counters.passes();
        ASSERT_EQ(passes.size(), 3U);
        const CountedPass &screen = passes[0], &triangles = passes[1], &items = passes[2];
        EXPECT_EQ(screen.name, "screen");
        EXPECT_EQ(screen.group, "tests");
        EXPECT_TRUE(screen.draws && screen.shades);
        EXPECT_EQ(screen.counts->vertices, 3U);
        EXPECT_EQ(screen.samples, 64U * 32U);
        EXPECT_GE(screen.counts->fragments, 64U * 32U) << "drivers may count whole blocks";
        EXPECT_EQ(screen.counts->items, 0U);
        EXPECT_EQ(screen.bytes, 64U * 32U * 4U);
        EXPECT_EQ(triangles.counts->vertices, 300U);
        EXPECT_EQ(triangles.counts->primitives, 100U);
        EXPECT_EQ(triangles.samples, 1U) << "all at one depth: the first passes, the others are not nearer";
        EXPECT_TRUE(triangles.draws && !triangles.shades) << "depth alone";
        EXPECT_EQ(items.counts->items, 8U * 32U);
        EXPECT_EQ(items.counts->vertices, 0U);
        EXPECT_TRUE(!items.draws && items.shades);
        // With clocks nothing is counted, and what was counted stays.
        graph.execute(true);
        EXPECT_EQ(counters.passes().size(), 3U);
    }
    EXPECT_EQ(PassCounters::of(device), nullptr);
    graph.execute(false);
}

TEST(LeastBytes, WritesAreWholeAndReadsAreAsManyAsInvocations) {
    GraphDeclaration declaration;
    declaration.textures.push_back(
        {.desc = {.name = "a", .format = VK_FORMAT_R32G32_SFLOAT, .width = 8, .height = 8, .layers = 2, .mips = 2}});
    declaration.buffers.push_back({.desc = {.name = "b", .bytes = 100}});
    DeclaredPass pass;
    const Range second{.mip = 1, .mips = 1, .layer = 0, .layers = 2};
    pass.uses.push_back({.kind = UseKind::storage_write, .range = second});
    EXPECT_EQ(least_bytes(declaration, pass, {}), 4U * 4U * 2U * 8U) << "one mip of both layers";
    // A sampled texture counts whole where nothing is counted, and a texel an invocation where those are fewer.
    pass.uses = {{.kind = UseKind::sample, .range = second}};
    EXPECT_EQ(least_bytes(declaration, pass, {}), 256U);
    EXPECT_EQ(least_bytes(declaration, pass, PassCounts{.fragments = 3}), 24U);
    EXPECT_EQ(least_bytes(declaration, pass, PassCounts{.fragments = 1000}), 256U);
    // An attachment that is kept is read and written.
    pass.uses = {{.kind = UseKind::color, .range = {0, 1, 0, 1}, .load = Load::keep}};
    EXPECT_EQ(least_bytes(declaration, pass, {}), 2U * 8U * 8U * 8U);
    pass.uses = {{.kind = UseKind::copy_from, .texture = false}};
    EXPECT_EQ(least_bytes(declaration, pass, PassCounts{}), 100U);
}

}  // namespace
}  // namespace gn::pass_counters_test
