// SPDX-License-Identifier: MIT
// The shape of V with three channels, proven by a part that stands here only: a lookup that says of a translucent caster's
// map which share of red, green and blue goes through.
#include "shadow/scene/casting.h"
#include "tests/direct_scenes.h"
#include "tests/rig.h"

namespace gn::colour_test {
namespace {

constexpr uint side = 128;
const vec3 glass_colour(0.75F, 0.25F, 0.5F);

/// A pane of coloured glass and, beside it and partly under it, a solid box above a ground.
Scene glazed(const GnLight& light) {
    by_hand::SceneBuilder builder;
    Material glass;
    glass.name = "glass";
    glass.base_color = vec4(glass_colour, 1);
    glass.transmission = 1;
    glass.casts = false;  // as finish_scene leaves it
    const int pane = builder.material(glass);
    return builder.ground(5)
        .quad({-1, 1.6F, 1}, {1.2F, 1.6F, 1}, {1.2F, 1.6F, -1}, {-1, 1.6F, -1}, pane)
        .box({0.2F, 0.5F, -0.4F}, {2, 0.9F, 0.6F})
        .light(light)
        .camera({0.5F, 5, 6}, {0.3F, 0, 0})
        .scene();
}

/// What the made-up lookup's glass lets through, and the hard comparison of its map.
Part coloured_lookup() {
    Part part;
    part.id = "coloured";
    part.stage = Stage::lookup;
    part.needs = {"depth"};
    part.channels = 3;
    part.prologue = [](const Recipe&) {
        return fmt::format(R"(
#include "shadow/receiver/map_access.glsl"
vec3 gn_coloured_visibility(GnLookup at, sampler2DArray depth) {{
    ivec2 texel = ivec2(floor(at.projected.uv_ts / at.projected.texel_ts));
    vec2 middle_ts = (vec2(texel) + 0.5) * at.projected.texel_ts;
    bool lit = gn_depth_at(at.projected, middle_ts, at.bias) <= texelFetch(depth, ivec3(texel, at.projected.layer), 0).r;
    return lit ? vec3(1.0) : vec3({}, {}, {});
}}
)",
                           glass_colour.r, glass_colour.g, glass_colour.b);
    };
    return part;
}

Recipe coloured_recipe(const std::string& name, const Part& lookup) {
    Recipe recipe = load_recipe(name);
    recipe.translucent_map = &find_part(Stage::map, "depth");
    recipe.translucent_lookup = &lookup;
    return recipe;
}

FrameResult render(const Scene& scene, const Recipe& recipe) {
    const test::ValidationGuard guard;
    SceneGpu gpu = upload_scene(test::device(), scene);
    FrameResult frame = render_frame(test::device(), gpu, scene.camera(""), recipe,
                                     {.width = side, .height = side, .repeat = 0, .only_light = 0});
    EXPECT_EQ(frame.refused.front(), "");
    return frame;
}

/// How many channels of samples away from edges differ from the traced V by more than `most`, and how many were judged.
struct Judged {
    std::size_t wrong = 0, samples = 0, tinted = 0;
};
Judged judge(const Scene& scene, const FrameResult& frame, const TruthOptions& options, float most) {
    const TruthResult truth =
        Truth(scene).trace(frame.samples.position_ws, frame.samples.normal_ws, scene.lights.front(), options);
    Judged judged;
    // Every edge is one of red, green or blue; a tint of a quarter is found as an edge when it is stretched to the whole.
    std::vector<std::uint8_t> edges(truth.counted.size(), 0);
    for (int c = 0; c < 3; ++c) {
        std::vector<float> channel = channel_of(truth.visibility, 3, c);
        for (float& v : channel) {
            v = v > 0.99F ? 1.0F : v > 0.01F ? 0.5F : 0.0F;
        }
        const std::vector<std::uint8_t> found = edge_pixels(channel, truth.counted, side, side);
        std::transform(edges.begin(), edges.end(), found.begin(), edges.begin(), std::bit_or<>());
    }
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (truth.counted[i] == 0 || edges[i] != 0) {
            continue;
        }
        ++judged.samples;
        judged.tinted += std::abs(truth.visibility[3 * i + 1] - glass_colour.g) < 1e-6F ? 1 : 0;
        for (std::size_t c = 0; c < 3; ++c) {
            judged.wrong += std::abs(frame.visibility.front().values[3 * i + c] - truth.visibility[3 * i + c]) > most;
        }
    }
    return judged;
}

TEST(Colour, OpaqueAndTranslucentMapsGiveTheTracedProduct) {
    const Part lookup = coloured_lookup();
    for (const GnLight& light : {by_hand::sun({0.3F, -1, -0.2F}), by_hand::point({-1, 4, 1})}) {
        const Scene scene = glazed(light);
        const FrameResult frame = render(scene, coloured_recipe("hard,resolution=2048", lookup));
        ASSERT_EQ(frame.visibility.front().channels, 3);
        const Judged judged = judge(scene, frame, {.samples = 1, .channels = 3}, 1e-6F);
        EXPECT_EQ(judged.wrong, 0U) << "of " << judged.samples;
        EXPECT_GT(judged.samples, side * side / 3);
        EXPECT_GT(judged.tinted, 300U);
    }
}

TEST(Colour, PassesThroughTheStagesBehindChannelByChannel) {
    // Weighted lights and a filter of V: the green channel is what one channel with that tint would be.
    const Part lookup = coloured_lookup();
    GnLight panel = by_hand::rectangle({-1, 4, 1}, {0, 0, 0});
    panel.half_size = vec2(0.3F);
    const Scene scene = glazed(panel);
    const FrameResult coloured =
        render(scene, coloured_recipe("hard,light=accumulate,accumulate.lights=4,visibility=bilateral", lookup));
    Part grey = lookup;
    grey.id = "coloured";
    grey.channels = 1;
    grey.prologue = [](const Recipe&) {
        return coloured_lookup().prologue(Recipe{}) +
               "#define gn_coloured_visibility(at, depth) gn_coloured_visibility(at, depth).g\n";
    };
    const FrameResult green =
        render(scene, coloured_recipe("hard,light=accumulate,accumulate.lights=4,visibility=bilateral", grey));
    ASSERT_EQ(green.visibility.front().channels, 1);
    EXPECT_EQ(channel_of(coloured.visibility.front().values, 3, 1), green.visibility.front().values);
    EXPECT_NE(channel_of(coloured.visibility.front().values, 3, 0), green.visibility.front().values);
}

TEST(Colour, ShadesEachColourByItsOwnChannel) {
    const Part lookup = coloured_lookup();
    const Scene scene = glazed(by_hand::sun({0.3F, -1, -0.2F}));
    const FrameResult coloured = render(scene, coloured_recipe("hard", lookup));
    const FrameResult dark = render(scene, load_recipe("hard"));
    // The given V shades as the drawn one does.
    SceneGpu gpu = upload_scene(test::device(), scene);
    const Image again = shade(test::device(), gpu, scene.camera(""), side, side, coloured.visibility);
    EXPECT_EQ(again.values, coloured.picture.values);
    // Where V differs in red, the picture differs in red by the same share of the light.
    std::vector<Image> none(1, Image(side, side, 1, 0.0F));
    const Image ambient = shade(test::device(), gpu, scene.camera(""), side, side, none);
    std::size_t tinted = 0;
    for (std::size_t i = 0; i < ambient.pixels(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const float v = coloured.visibility.front().values[3 * i + c];
            if (dark.visibility.front().values[i] == 1 && v < 1) {
                ++tinted;
                const float full = dark.picture.values[3 * i + c] - ambient.values[3 * i + c];
                EXPECT_NEAR(coloured.picture.values[3 * i + c] - ambient.values[3 * i + c], v * full, 1e-5F * full);
            }
        }
    }
    EXPECT_GT(tinted, 300U);
}

TEST(Colour, ASceneWithoutTranslucentCastersKeepsOneChannel) {
    const Part lookup = coloured_lookup();
    const Scene scene = load_scene("contact");
    const FrameResult with = render(scene, coloured_recipe("hard", lookup));
    EXPECT_EQ(with.visibility.front().channels, 1);
    EXPECT_EQ(with.visibility.front().values, render(scene, load_recipe("hard")).visibility.front().values);
}

TEST(Colour, CastersAreOpaqueMaskedOrTranslucent) {
    Scene scene = glazed(by_hand::point({0, 4, 0}));
    EXPECT_EQ(caster_class(scene, 0, nullptr), CasterClass::opaque);
    EXPECT_EQ(caster_class(scene, 1, nullptr), CasterClass::translucent);
    EXPECT_EQ(translucent_casters(scene, scene.lights[0]), std::vector<std::uint32_t>{1});
    EXPECT_FALSE(casts(scene, 1, nullptr));
    EXPECT_EQ(transmittance(scene.materials.back()), glass_colour);
    scene.objects[1].casts = true;
    EXPECT_EQ(caster_class(scene, 1, nullptr), CasterClass::opaque);
    scene.objects[1].casts = false;
    EXPECT_EQ(caster_class(scene, 1, nullptr), CasterClass::none);
    scene.materials[0].alpha_mode = AlphaMode::mask;
    EXPECT_EQ(caster_class(scene, 0, nullptr), CasterClass::masked);
    scene.lights[0].spared = {0};
    EXPECT_EQ(caster_class(scene, 0, scene.lights.data()), CasterClass::none);
}

TEST(Colour, TheTruthWithOneChannelLetsGlassBlockNothing) {
    const Scene scene = glazed(by_hand::sun({0.3F, -1, -0.2F}));
    const FrameResult frame = render(scene, load_recipe("hard"));
    const Truth truth(scene);
    const auto trace = [&](int channels) {
        return truth.trace(frame.samples.position_ws, frame.samples.normal_ws, scene.lights.front(),
                           {.samples = 1, .channels = channels});
    };
    const TruthResult grey = trace(1), coloured = trace(3);
    std::size_t tinted = 0;
    for (std::size_t i = 0; i < grey.counted.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const float v = coloured.visibility[3 * i + c];
            const bool through = std::abs(v - grey.visibility[i] * glass_colour[static_cast<int>(c)]) < 1e-6F;
            EXPECT_TRUE(v == grey.visibility[i] || through) << i;
            tinted += through && grey.visibility[i] > 0 ? 1 : 0;
        }
    }
    EXPECT_GT(tinted, 900U);
    EXPECT_THROW(static_cast<void>(trace(2)), Error);
}

}  // namespace
}  // namespace gn::colour_test
