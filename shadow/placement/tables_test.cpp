// SPDX-License-Identifier: MIT
// What a placement lends to its GLSL beside its sixteen vectors: a placement of the tests shuffles the views of another,
// and finds them again through a table in a buffer and a texture.
#include "gpu/shader_inputs.h"
#include "tests/rig.h"

#include <numeric>

namespace gn::tables_test {
namespace {

const Part* shuffled_part = nullptr;
bool on_gpu = false;

std::uint32_t place_of(std::size_t view, std::size_t count) {
    return static_cast<std::uint32_t>((view + 1) % count);
}

/// R32F, one texel a view: where it stands.
TextureHandle draw_order(FrameGraph& graph, std::uint32_t count) {
    const TextureHandle order =
        graph.create({.name = "order again", .format = VK_FORMAT_R32_SFLOAT, .width = count, .height = 1});
    graph.add_pass(
        "order", [&](PassBuilder& pass) { pass.color(order, Load::discard); },
        [count](Recorder& r) {
            r.bind(fullscreen({ShaderKind::fragment, "order",
                               "layout(push_constant) uniform Push { int count; };\nlayout(location = 0) out vec4 c;\n"
                               "void main() { c = vec4(float((int(gl_FragCoord.x) + 1) % count)); }\n"}));
            r.push_value(static_cast<std::int32_t>(count));
            r.draw(3);
        });
    return order;
}

BufferHandle write_order(FrameGraph& graph, std::uint32_t count) {
    const BufferHandle order = graph.create({.name = "order", .bytes = count * sizeof(std::uint32_t)});
    ShaderInputs inputs;
    inputs.buffer("writeonly buffer", "Order", "uint order[];", order).constant("uint", "count", count);
    const std::string text = inputs.text() +
                             "layout(local_size_x = 1) in;\nvoid main() {\n"
                             "    for (uint i = 0u; i < u.count; ++i) {\n"
                             "        order[i] = (i + 1u) % u.count;\n    }\n}\n";
    graph.add_pass(
        "order", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, text](Recorder& r) {
            r.bind(ComputeDesc{{ShaderKind::compute, "order", text}, {}});
            inputs.set(r);
            r.dispatch(1, 1);
        });
    return order;
}

LightViews place_shuffled(const FrameInput& input, const Recipe& recipe) {
    const LightViews seeds = shuffled_part->place(input, recipe);
    const std::size_t count = seeds.views.size();
    LightViews views = seeds;
    std::vector<std::uint32_t> order(count);
    for (std::size_t i = 0; i < count; ++i) {
        order[i] = place_of(i, count);
        views.views[order[i]] = seeds.views[i];
        if (!seeds.casters.empty()) {
            views.casters[order[i]] = seeds.casters[i];
        }
    }
    const auto bytes = std::as_bytes(std::span(order));
    const auto number = static_cast<std::uint32_t>(count);
    views.offers = {{"order-again", draw_order(input.graph, number), nearest()}};
    PlacementTable table{.name = "order", .type = "uint", .buffer = {}, .bytes = {}};
    if (on_gpu) {
        table.buffer = write_order(input.graph, number);
    } else {
        table.bytes.assign(bytes.begin(), bytes.end());
    }
    views.tables = {table};
    return views;
}

std::vector<float> visibility(const Scene& scene, const Recipe& recipe) {
    const test::ValidationGuard guard;
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameResult frame =
        render_frame(test::device(), gpu, scene.camera(""), recipe,
                     {.width = 128, .height = 96, .repeat = 0, .only_light = 0, .picture = false});
    EXPECT_EQ(frame.refused.front(), "");
    return frame.visibility.front().values;
}

TEST(PlacementTables, AViewIsFoundThroughATableAndATexture) {
    const Scene scene = load_scene("fence");
    // Kernels that cross views ask again, and transitions ask for a second view.
    for (const char* text : {"pcf,placement=cascades,cascades.count=3,resolution=128",
                             "hard,placement=cascades,cascades.transition=blend,resolution=128",
                             "forward,placement=cascades,resolution=128"}) {
        Recipe recipe = load_recipe(text);
        const std::vector<float> expected = visibility(scene, recipe);
        EXPECT_GT(std::count(expected.begin(), expected.end(), 0.0F), 200);
        shuffled_part = recipe.placement;
        Part part = *recipe.placement;
        part.id = "by-table";
        part.glsl = "tests/placement_by_table.glsl";
        part.place = place_shuffled;
        recipe.placement = &part;
        for (const bool gpu : {false, true}) {
            on_gpu = gpu;
            EXPECT_EQ(visibility(scene, recipe), expected) << text << (gpu ? ", on the GPU" : "");
        }
    }
}

}  // namespace
}  // namespace gn::tables_test
