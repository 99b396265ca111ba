// SPDX-License-Identifier: MIT
// Views that the GPU makes: a placement of the tests hands over another's views in a buffer that a shader writes, and V is
// what the same views give from the CPU.
#include "gpu/shader_inputs.h"
#include "shadow/casters/tiles.glsl"
#include "shadow/frame/history.h"
#include "tests/rig.h"

namespace gn::gpu_views_test {
namespace {

constexpr std::uint32_t most_views = 9;  // more than any placement here has

const char* const make_text = R"(
layout(local_size_x = 1) in;
void main() {
    int layers = 0;
    for (int i = 0; i < u.most; ++i) {
        GnLightView view = seeds[min(i, u.there - 1)];
        // Where a rectangle lies is told in texels; what does not exist has none.
        vec4 rect = i < u.there ? vec4(texels[i]) / view.resolution : vec4(0.0);
        view.rect_ts = rect;
        view.layer = i < u.there ? layer[i] : 0;
        views[i] = view;
        layers = max(layers, view.layer + 1);
    }
    placement = values;
    count = uint(u.there);
    needed = uint(layers);
}
)";

struct Made {
    const Part* of = nullptr;
    bool tiles = false;
    std::vector<std::uint32_t>* layers = nullptr;  ///< of each frame, to be looked at
} made;

/// The views of made.of, of which the CPU keeps what it must know and no more.
LightViews place_on_gpu(const FrameInput& input, const Recipe& recipe) {
    const LightViews seeds = made.of->place(input, recipe);
    std::vector<ivec4> texels;
    std::vector<int> layers;
    std::vector<GnLightView> stripped = seeds.views;
    for (GnLightView& view : stripped) {
        texels.emplace_back(view.rect_ts * view.resolution);
        layers.push_back(view.layer);
        view.rect_ts = vec4(0, 0, 1, 1);
        view.layer = 0;
    }
    const std::uint32_t most = made.tiles ? most_views : static_cast<std::uint32_t>(seeds.views.size());

    FrameGraph& graph = input.graph;
    LightViews views;
    views.kind = seeds.kind;
    views.resolution = seeds.resolution;
    views.layers = seeds.layers;
    views.tiles = made.tiles;
    views.buffer = graph.create({.name = "made views", .bytes = most * sizeof(GnLightView)});
    views.data_buffer = graph.create({.name = "made data", .bytes = sizeof views.data});
    const BufferHandle count = graph.create({.name = "made count", .bytes = sizeof(std::uint32_t)});
    const BufferHandle needed = graph.create({.name = "needed layers", .bytes = sizeof(std::uint32_t)});
    for (std::uint32_t i = 0; i < most; ++i) {
        GnLightView unknown;
        unknown.resolution = static_cast<float>(seeds.resolution);
        if (!made.tiles) {
            unknown.resolution = seeds.views[i].resolution;
            unknown.layer = seeds.views[i].layer;
            unknown.rect_ts = seeds.views[i].rect_ts;
        }
        views.views.push_back(unknown);
    }
    if (made.tiles) {
        views.count = count;
    }

    // How many layers the tiles need is answered to the next frame; the first takes one a view.
    if (made.tiles && input.history != nullptr) {
        const std::shared_ptr<std::uint32_t> known = input.history->answered("needed layers");
        views.layers = *known != 0 ? *known : static_cast<std::uint32_t>(seeds.views.size());
        made.layers->push_back(views.layers);
        graph.answer(needed, [known](std::span<const std::byte> bytes) { std::memcpy(known.get(), bytes.data(), 4); });
    }

    ShaderInputs inputs;
    inputs.block("readonly buffer", "Seeds", "GnLightView seeds[];", std::as_bytes(std::span(stripped)));
    inputs.block("readonly buffer", "Texels", "ivec4 texels[];", std::as_bytes(std::span(texels)));
    inputs.block("readonly buffer", "Layers", "int layer[];", std::as_bytes(std::span(layers)));
    inputs.block("readonly buffer", "Values", "vec4 values[16];", seeds.data);
    inputs.buffer("writeonly buffer", "Views", "GnLightView views[];", views.buffer);
    inputs.buffer("writeonly buffer", "Placement", "vec4 placement[16];", views.data_buffer);
    inputs.buffer("writeonly buffer", "Count", "uint count;", count);
    inputs.buffer("writeonly buffer", "Needed", "uint needed;", needed);
    inputs.constant("int", "most", static_cast<int>(most));
    inputs.constant("int", "there", static_cast<int>(seeds.views.size()));
    const std::string text = "#include \"shadow/receiver/receiver.glsl\"\n" + inputs.text() + make_text;
    graph.add_pass(
        "make views", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, text](Recorder& r) {
            r.bind(ComputeDesc{{ShaderKind::compute, "make views", text}, {}});
            inputs.set(r);
            r.dispatch(1, 1);
        });
    return views;
}

struct Both {
    std::vector<float> cpu, gpu;
    [[nodiscard]] std::size_t differing() const {
        std::size_t count = 0;
        for (std::size_t i = 0; i < cpu.size(); ++i) {
            count += cpu[i] != gpu[i] ? 1 : 0;
        }
        return count;
    }
    /// Samples in shadow and in light.
    void expect_contents() const {
        const auto dark = std::count(cpu.begin(), cpu.end(), 0.0F);
        EXPECT_GT(dark, static_cast<std::ptrdiff_t>(cpu.size() / 50));
        EXPECT_GT(static_cast<std::ptrdiff_t>(cpu.size()) - dark, static_cast<std::ptrdiff_t>(cpu.size() / 50));
    }
};

std::vector<float> visibility(const Scene& scene, const Recipe& recipe, History* history = nullptr) {
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameResult frame =
        render_frame(test::device(), gpu, scene.camera(""), recipe,
                     {.width = 128, .height = 128, .repeat = 1, .only_light = 0, .picture = false, .history = history});
    EXPECT_EQ(frame.refused.front(), "");
    return frame.visibility.front().values;
}

Both both(const Scene& scene, Recipe recipe, bool tiles) {
    const test::ValidationGuard guard;
    Both result;
    result.cpu = visibility(scene, recipe);
    made = {recipe.placement, tiles, nullptr};
    Part part = *recipe.placement;
    part.place = place_on_gpu;
    recipe.placement = &part;
    result.gpu = visibility(scene, recipe);
    result.expect_contents();
    return result;
}

Both both(const std::string& scene, const std::string& text, bool tiles) {
    return both(load_scene(scene), load_recipe(text), tiles);
}

struct Odd {
    const Part* of = nullptr;
    void (*change)(std::vector<GnLightView>& views) = nullptr;
} odd;

/// The views of odd.of, one of them unlike the others.
LightViews place_odd(const FrameInput& input, const Recipe& recipe) {
    LightViews views = odd.of->place(input, recipe);
    odd.change(views.views);
    return views;
}

TEST(GpuViews, TilesCoverTheirTexelsAndNoOthers) {
    GnLightView view;
    view.resolution = 64;
    view.layer = 2;
    view.rect_ts = vec4(0.25F, 0.5F, 0.125F, 0.25F);
    EXPECT_EQ(glsl::gn_tile_texels(view), ivec4(16, 32, 23, 47));
    EXPECT_TRUE(glsl::gn_tile_in(view, 2));
    EXPECT_FALSE(glsl::gn_tile_in(view, 1));
    // The view's corners become those of the rectangle, under any w.
    for (const float w : {1.0F, 3.0F}) {
        EXPECT_EQ(glsl::gn_tile_clip(view, vec4(-w, -w, 0.5F, w)), vec4(-0.5F * w, 0, 0.5F, w));
        EXPECT_EQ(glsl::gn_tile_clip(view, vec4(w, w, 0.5F, w)), vec4(-0.25F * w, 0.5F * w, 0.5F, w));
        EXPECT_EQ(glsl::gn_tile_sides(view, vec4(0.5F * w, -2 * w, 0, w), 2), vec4(1.5F * w, 0.5F * w, -w, 3 * w));
    }
    view.rect_ts = vec4(0);
    EXPECT_FALSE(glsl::gn_tile_in(view, 2));
}

TEST(GpuViewsRendered, OfEveryKindGiveTheSameVisibilityAsThoseOfTheCpu) {
    // Kernels that follow the receiver's plane ask every tap for the view's kind.
    for (const auto& [scene, recipe] :
         {std::pair{"contact:light=point", "pcf,placement=cube,resolution=256,bias.receiver_plane=true"},
          {"contact:light=point", "pcf,placement=paraboloid,resolution=256,bias.receiver_plane=true"},
          {"contact", "pcf,placement=cascades,resolution=256,bias.receiver_plane=true"},
          {"contact", "pcf,placement=lispsm,resolution=256,bias.receiver_plane=true"}}) {
        EXPECT_EQ(both(scene, recipe, false).differing(), 0U) << recipe;
    }
}

TEST(GpuViewsRendered, WhatOneViewHasOtherwiseIsReadOfItself) {
    // What all views agree in the CPU tells the shader, or has it read of the first. Of views that the GPU makes it tells nothing: where
    // one is unlike the others, both must still see the same.
    const Scene scene = load_scene("contact");
    Recipe recipe = load_recipe("pcf,placement=cascades,resolution=256,bias.view=6");
    const std::vector<float> alike = visibility(scene, recipe);
    Part part = *recipe.placement;
    part.place = place_odd;
    odd.of = recipe.placement;
    recipe.placement = &part;
    const auto with = [&](const char* what, void (*change)(std::vector<GnLightView>&)) {
        odd.change = change;
        const Both found = both(scene, recipe, false);
        EXPECT_EQ(found.differing(), 0U) << what;
        return found.cpu;
    };
    EXPECT_NE(with("eye",
                   [](std::vector<GnLightView>& views) {
                       views.at(1).eye_ws = vec4(glm::normalize(vec3(views[1].eye_ws) + vec3(1, 0, 0.5F)), 0);
                   }),
              alike);
    EXPECT_NE(with("texels", [](std::vector<GnLightView>& views) { views.at(1).resolution *= 0.25F; }), alike);
    EXPECT_EQ(with("layer", [](std::vector<GnLightView>& views) { std::swap(views.at(0).layer, views.at(1).layer); }),
              alike);
}

TEST(GpuViewsRendered, InTilesGiveTheSameVisibilityAsThoseOfTheCpu) {
    for (const auto& [scene, recipe] :
         {std::pair{"contact:light=point", "hard,placement=cube,cube.resolution=coverage,resolution=256"},
          {"contact:light=point", "hard,placement=paraboloid,resolution=256"},
          {"contact:light=point", "vsm,placement=paraboloid,resolution=256,bias.receiver_plane=true"},
          {"contact:light=point", "hard,placement=paraboloid,resolution=256,casters=ids"},
          {"contact:light=point", "hard,placement=cube,cube.resolution=coverage,resolution=256,casters=dual"},
          {"contact:light=point", "vsm,placement=cube,cube.resolution=coverage,resolution=256"},
          {"contact:light=point", "convolution,placement=cube,cube.resolution=coverage,resolution=256"},
          {"contact:light=point", "silhouette,placement=cube,cube.resolution=coverage,resolution=256"},
          {"contact:light=point", "hard,placement=cube,cube.resolution=coverage,resolution=256,casters=ids"},
          {"contact:light=point", "forward,placement=cube,cube.resolution=coverage,resolution=256"},
          {"fence", "hard,placement=cascades,resolution=256"},
          {"contact", "pcf,placement=cascades,cascades.passes=layered,resolution=256"}}) {
        EXPECT_EQ(both(scene, recipe, true).differing(), 0U) << recipe;
    }
}

TEST(GpuViewsRendered, TellTheNextFrameHowManyLayersTheyNeed) {
    const test::ValidationGuard guard;
    const Scene scene = load_scene("contact:light=point");
    Recipe recipe = load_recipe("hard,placement=cube,cube.resolution=coverage,resolution=256");
    const std::vector<float> expected = visibility(scene, recipe);
    std::vector<std::uint32_t> layers;
    made = {recipe.placement, true, &layers};
    Part part = *recipe.placement;
    part.place = place_on_gpu;
    recipe.placement = &part;
    History history(test::device());
    for (int frame = 0; frame < 3; ++frame) {
        EXPECT_EQ(visibility(scene, recipe, &history), expected) << frame;
    }
    ASSERT_EQ(layers.size(), 3U);
    EXPECT_EQ(layers[0], 6U);
    EXPECT_LT(layers[1], 6U);
    EXPECT_EQ(layers[2], layers[1]);
}

}  // namespace
}  // namespace gn::gpu_views_test
