// SPDX-License-Identifier: MIT
// Maps of several sizes: how large each is, where it lies, and that it is the map of that size.
#include "tests/cascade_frame.h"
#include "tests/warp_scene.h"

namespace gn::falloff_test {
namespace {

using namespace cascades;
using namespace test;
using glsl::GnChoice;
using glsl::GnReceiver;

TEST(CascadeFalloff, SidesAreHalvedStepByStep) {
    const auto sides = [](int count, float falloff) {
        std::vector<int> all;
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            all.push_back(side_of({.count = count, .falloff = falloff}, 1024, i));
        }
        return all;
    };
    EXPECT_EQ(sides(4, 0), (std::vector<int>{1024, 1024, 1024, 1024}));
    EXPECT_EQ(sides(4, 1), (std::vector<int>{1024, 512, 256, 128}));
    EXPECT_EQ(sides(4, 0.5F), (std::vector<int>{1024, 1024, 512, 512}));
    EXPECT_EQ(sides(4, -1), (std::vector<int>{128, 256, 512, 1024}));
    EXPECT_EQ(sides(7, 1.0F / 3), (std::vector<int>{1024, 1024, 1024, 512, 512, 512, 256}));
    EXPECT_EQ(sides(1, 2), (std::vector<int>{1024}));
}

/// Maps lie apart in as few layers as their areas sum to, each the view that a map of its size has by itself, to the bit.
/// A window that g texels widen on both sides has texels of E / (n - 2 g) metres for n a side.
TEST(CascadeFalloff, EveryMapIsTheOneOfItsSizeInAsFewLayersAsHoldThem) {
    const Scene& scene = test::built_in("corridor");
    const float g = guard_of(load_recipe("hard"), scene.lights[0], scene.bounds_ws).texels;
    for (const char* fit : {"plain", "fitted", "warped", "stable"}) {
        for (const float falloff : {1.0F, 0.5F, -1.0F}) {
            const auto text = [&](int resolution, float steps) {
                return fmt::format("hard,resolution={},placement=cascades,cascades.fit={},cascades.falloff={}",
                                   resolution, fit, steps);
            };
            const LightViews packed = test::place(scene, text(1024, falloff));
            const LightViews whole = test::place(scene, text(1024, 0));
            EXPECT_EQ(whole.layers, 4U);
            double area = 0;
            for (std::size_t i = 0; i < 4; ++i) {
                const GnLightView& view = packed.views[i];
                const int side = side_of({.falloff = falloff}, 1024, i);
                const LightViews alone = test::place(scene, text(side, 0));
                EXPECT_EQ(view.cs_from_ws, alone.views[i].cs_from_ws) << fit << " " << falloff << " " << i;
                EXPECT_EQ(view.grid, alone.views[i].grid);
                EXPECT_EQ(packed.casters[i], alone.casters[i]);
                EXPECT_EQ(view.rect_ts.z * view.resolution, static_cast<float>(side));
                EXPECT_EQ(view.rect_ts.w * view.resolution, static_cast<float>(side));
                area += static_cast<double>(view.rect_ts.z * view.rect_ts.w);
                for (std::size_t k = 0; k < i; ++k) {
                    const vec4 a = view.rect_ts;
                    const vec4 b = packed.views[k].rect_ts;
                    const bool apart = a.x >= b.x + b.z || b.x >= a.x + a.z || a.y >= b.y + b.w || b.y >= a.y + a.w;
                    EXPECT_TRUE(apart || view.layer != packed.views[k].layer) << fit << " " << i << " " << k;
                }
                if (std::string_view(fit) == "fitted") {
                    const float along = glm::length(glsl::gn_row(view.cs_from_ws, 0));
                    const float before = glm::length(glsl::gn_row(whole.views[i].cs_from_ws, 0));
                    const auto n = static_cast<float>(side);
                    const float texels = (1024 - 2 * g) / (n - 2 * g);
                    EXPECT_NEAR((before * 1024) / (along * n), texels, 1e-4F * texels) << falloff << " " << i;
                }
            }
            EXPECT_EQ(packed.layers, static_cast<std::uint32_t>(std::ceil(area))) << falloff;
        }
    }
}

/// What a receiver and its kernel may reach in a smaller map: the share that the smaller map's own choice would be told.
TEST(CascadeFalloff, SmallerMapsKeepALargerShareForKernels) {
    const Scene& scene = test::built_in("corridor");
    const std::string base = "pcf,pcf.size=7,placement=cascades,cascades.fit=fitted,cascades.select=projection";
    const auto data = test::place(scene, base + ",resolution=1024,cascades.falloff=1").data_as<GnCascadesData>();
    for (int i = 0; i < 4; ++i) {
        const auto alone =
            test::place(scene, fmt::format("{},resolution={}", base, 1024 >> i)).data_as<GnCascadesData>();
        EXPECT_NEAR(glsl::gn_cascades_limit(data, i), alone.limit, 1e-6F) << i;
    }
}

/// V of a frame with maps of several sizes, and V where each sample has the map of that size among others of its size.
struct Sized {
    Rendered packed;
    std::vector<Rendered> alone;  ///< by the number of halvings
};

Sized sized(SceneGpu& gpu, const Camera& camera, const std::string& recipe) {
    const auto text = [&](int resolution, int falloff) {
        return fmt::format("{},resolution={},placement=cascades,cascades.transition=none,cascades.falloff={}", recipe,
                           resolution, falloff);
    };
    Sized result{render(gpu, camera, camera, text(512, 1)), {}};
    for (int i = 0; i < 4; ++i) {
        result.alone.push_back(render(gpu, camera, camera, text(512 >> i, 0)));
    }
    return result;
}

/// The largest change of V, and how many samples change by more than a thousandth.
struct Change {
    double most = 0;
    std::size_t many = 0, samples = 0;
};

Change change_of(const Sized& maps) {
    Change change;
    std::vector<int> seen(4, 0);
    for (std::size_t p = 0; p < maps.packed.visibility.size(); ++p) {
        GnReceiver receiver = receiver_at(maps.packed.samples.normal_ws[p].w);
        receiver.p_ws = vec3(maps.packed.samples.position_ws[p]);
        const auto i = static_cast<std::size_t>(glsl::gn_cascades_choose(receiver, maps.packed.data).first);
        seen[i] += maps.packed.samples.position_ws[p].w > 0 ? 1 : 0;
        const double by = std::abs(static_cast<double>(maps.packed.visibility[p] - maps.alone[i].visibility[p]));
        change.most = std::max(change.most, by);
        change.many += by > 1e-3 ? 1 : 0;
        ++change.samples;
    }
    EXPECT_GT(*std::min_element(seen.begin(), seen.end()), 20);
    return change;
}

/// What each sample sees is what it sees with maps that are all as large as its own: nothing is read, blurred or biased beyond
/// the map's own rectangle. Stable windows, whose places are whole fractions of a texel, give every bit; others are rounded
/// where their square stands in the layer. Memory is that of the layers.
TEST(CascadesRendered, FalloffIsTheSmallerMapSampleBySample) {
    SceneGpu gpu = upload_scene(test::device(), test::built_in("corridor"));
    const Camera& camera = gpu.scene->camera("");
    for (const char* recipe : {"hard", "pcf,pcf.size=7"}) {
        const Sized maps = sized(gpu, camera, recipe);
        EXPECT_EQ(change_of(maps).most, 0) << recipe;
        EXPECT_EQ(2 * maps.packed.map.size(), maps.alone[0].map.size()) << recipe;
    }
    // Bilinear weights of 49 texels, each rounded.
    EXPECT_LE(change_of(sized(gpu, camera, "pcf,pcf.size=7,cascades.split=sdsm-minmax")).most, 1e-5);
    // Depths are interpolated from the layer's corner and differ in their last bits; where the mean of a far map is a receiver's
    // depth to these bits, a whole step of V hangs on them: at one sample here. Blur and mips make no more of them.
    const Change moments = change_of(sized(gpu, camera, "vsm"));
    EXPECT_LE(moments.many, moments.samples / 1000);
}

TEST(CascadesRendered, RefusesFalloffThatNoMapCanHold) {
    const Scene scene = load_scene("contact");
    Light light = scene.lights[0];
    light.shape.kind = GN_LIGHT_DIRECTIONAL;
    for (const char* text :
         {"cascades,cascades.falloff=2,resolution=256", "cascades,cascades.falloff=1,resolution=1020",
          "cascades,cascades.falloff=1,cascades.scroll=1", "cascades,cascades.falloff=1,cascades.passes=layered"}) {
        EXPECT_THROW(check_recipe(load_recipe(text), scene, light, test::device()), Refusal) << text;
    }
    EXPECT_NO_THROW(
        check_recipe(load_recipe("cascades,cascades.falloff=1,resolution=1024"), scene, light, test::device()));
}

}  // namespace
}  // namespace gn::falloff_test
