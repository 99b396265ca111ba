// SPDX-License-Identifier: MIT
// The resolution's law, its limit from frame to frame, and that a part of a map is as good as a map.
#include "shadow/placement/perceptual/perceptual.glsl"
#include "shadow/frame/history.h"
#include "shadow/receiver/light_plane.glsl"
#include "shadow/recipe/guard.h"
#include "shadow/shading/tonemap.h"
#include "tests/thorough.h"
#include "tests/warp_scene.h"

#include <array>
#include <cmath>

namespace gn::perceptual_test {
namespace {

constexpr float c = 3.47F;

/// K eq. 5.3 of a radius in texture space, 5.6 of one in the world, and the fitted map's: extents that shrink by s_xy take the
/// resolution with them.
TEST(Perceptual, ResolutionIsEquations53And56) {
    for (const float r_uv : {0.01F, 0.03F, 0.2F}) {
        EXPECT_FLOAT_EQ(glsl::gn_perceptual_texels(c, 1, r_uv, 0, 1e6F), c / r_uv);
    }
    const float l_ws = 40;
    const float r_ws = 0.25F;
    const float s_xy = 3;
    EXPECT_FLOAT_EQ(glsl::gn_perceptual_texels(c, l_ws, r_ws, 0, 1e6F), c * l_ws / r_ws);
    EXPECT_FLOAT_EQ(glsl::gn_perceptual_texels(c, l_ws / s_xy, r_ws, 0, 1e6F), c * l_ws / (r_ws * s_xy));
    EXPECT_FLOAT_EQ(glsl::gn_perceptual_texels(c, l_ws, r_ws, 6, 1e6F), c * l_ws / r_ws + 12) << "the guard's texels";
    // Double the filter, halve the map; without a filter all there is, and never more.
    EXPECT_FLOAT_EQ(glsl::gn_perceptual_texels(c, l_ws, 2 * r_ws, 0, 1e6F), 0.5F * c * l_ws / r_ws);
    EXPECT_EQ(glsl::gn_perceptual_texels(c, l_ws, 0, 3, 1024), 1024);
    EXPECT_EQ(glsl::gn_perceptual_texels(c, l_ws, 1e-4F, 3, 1024), 1024);
    EXPECT_EQ(glsl::gn_perceptual_blocks(64), 64);
    EXPECT_EQ(glsl::gn_perceptual_blocks(64.5F), 72);
}

TEST(Perceptual, FollowsByAtMostItsShareOfItself) {
    EXPECT_EQ(glsl::gn_perceptual_follow(800, 0, 0.25F), 800) << "nothing before";
    EXPECT_EQ(glsl::gn_perceptual_follow(800, 400, 0.25F), 496) << "500, in whole blocks";
    EXPECT_EQ(glsl::gn_perceptual_follow(80, 400, 0.25F), 320);
    EXPECT_EQ(glsl::gn_perceptual_follow(424, 400, 0.25F), 424);
    EXPECT_EQ(glsl::gn_perceptual_follow(800, 16, 0.25F), 24) << "a block where the share is less";
    EXPECT_EQ(glsl::gn_perceptual_follow(16, 24, 0), 16);
}

/// Texels that the placement draws, and their sides on the light's plane.
struct Drawn {
    ivec2 texels;
    dvec2 side;
};
Drawn drawn_of(const Scene& scene, const std::string& recipe) {
    const LightViews views = test::place(scene, recipe);
    const GnLightView& view = views.views.front();
    const dvec2 texels = glm::round(dvec2(view.rect_ts.z, view.rect_ts.w) * static_cast<double>(view.resolution));
    return {ivec2(texels), dvec2(glsl::gn_light_plane(view)) / texels};
}

/// eq. 5.4 and 5.6 of what is placed: a texel is the radius over c along both axes, but for the rounding to blocks of 8, and of
/// a light with a position where the receivers are farthest.
TEST(Perceptual, ATexelIsTheRadiusOverCAlongBothAxes) {
    Scene scene = test::long_floor(2, 60, vec3(0.3F, 1, 0.2F));
    scene.bounds_ws.min.x = -8;
    scene.bounds_ws.max.x = 8;
    for (const bool spot : {false, true}) {
        GnLight& light = scene.lights[0].shape;
        double farthest = 1;
        if (spot) {
            light.kind = GN_LIGHT_SPOT;
            light.position_ws = vec4(0, 60, -30, 1);
            light.direction_ws = vec4(0, -1, 0, 0);
            light.cos_outer = std::cos(0.6F);
            farthest = 60;
        }
        for (const double radius : {0.2, 0.4, 1.6}) {
            const std::string recipe =
                fmt::format("pcf,pcf.kernel=vogel,pcf.radius_world={},placement=perceptual,resolution=4096", radius);
            const Drawn drawn = drawn_of(scene, recipe);
            const double wanted = radius / farthest / static_cast<double>(c);
            for (int axis = 0; axis < 2; ++axis) {
                EXPECT_LE(drawn.side[axis], 1.003 * wanted) << spot << " " << radius << " axis " << axis;
                const double block = 8.0 / drawn.texels[axis];
                EXPECT_GE(drawn.side[axis], (0.997 - block) * wanted) << spot << " " << radius << " axis " << axis;
            }
            EXPECT_GT(std::abs(drawn.texels.x - drawn.texels.y), 8) << "the floor is longer than wide";
            // A smaller c draws fewer.
            const Drawn coarse = drawn_of(scene, recipe + ",perceptual.c=1.735");
            EXPECT_LT(coarse.texels.x + coarse.texels.y, 0.7 * (drawn.texels.x + drawn.texels.y));
        }
    }
    // A share of the scene's diagonal, for a kernel in texels.
    scene = test::long_floor(2, 60);
    const double diagonal = static_cast<double>(scene.bounds_ws.diagonal());
    const std::string recipe = "perceptual,perceptual.radius=0.01,resolution=4096";
    const Drawn share = drawn_of(scene, recipe);
    // A block is that share of the texels that the guard leaves.
    const double guard = static_cast<double>(guard_of(load_recipe(recipe), scene.lights[0], scene.bounds_ws).texels);
    EXPECT_NEAR(share.side.x / (0.01 * diagonal / static_cast<double>(c)), 1, 8 / (share.texels.x - 2 * guard));
}

/// Where filters differ from sample to sample and none was measured, the floor is the radius: a texel is the floor over c.
TEST(Perceptual, TheFloorIsTheRadiusOfWhatWasNotMeasured) {
    Scene scene = test::long_floor(2, 60);
    scene.lights[0].shape.angular_radius = 0.01F;
    const auto diagonal = static_cast<double>(scene.bounds_ws.diagonal());
    for (const double least : {0.002, 0.004, 0.008}) {
        const std::string recipe = fmt::format("pcss,placement=perceptual,resolution=4096,perceptual.least={}", least);
        const Drawn drawn = drawn_of(scene, recipe);
        const double wanted = least * diagonal / static_cast<double>(c);
        const Guard guard = guard_of(load_recipe(recipe), scene.lights[0], scene.bounds_ws);
        for (int axis = 0; axis < 2; ++axis) {
            // Texels are whole blocks of 8 beside the guard's.
            const double block = 8 / (drawn.texels[axis] - 2 * static_cast<double>(guard.texels));
            EXPECT_LE(drawn.side[axis], 1.003 * wanted) << least << " axis " << axis;
            EXPECT_GE(drawn.side[axis], (0.997 - block) * wanted) << least << " axis " << axis;
        }
    }
}

TEST(Perceptual, DrawsAllWhereTheFilterHasNoSize) {
    const Scene scene = test::long_floor(2, 60);
    EXPECT_EQ(drawn_of(scene, "hard,placement=perceptual,resolution=512").texels, ivec2(512));
    EXPECT_EQ(test::place(scene, "hard,placement=perceptual,resolution=512").views[0].cs_from_ws,
              test::place(scene, "hard,placement=fit,resolution=512").views[0].cs_from_ws);
    const Part& part = find_part(Stage::placement, "perceptual");
    EXPECT_NE(part.remark(scene, load_recipe("hard,placement=perceptual")), "");
    EXPECT_EQ(part.remark(scene, load_recipe("perceptual")), "");
    EXPECT_EQ(part.remark(scene, load_recipe("pcss,placement=perceptual")), "");
}

/// The same rectangle of a map of twice the side: V is the same to the bit, whatever is filtered, blurred or searched in it, and
/// whatever lies beside it.
TEST(PerceptualRendered, APartOfAMapIsAsGoodAsAMap) {
    const test::ValidationGuard guard;
    const Scene& scene = test::built_in("contact");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameOptions options{.width = 96, .height = 64, .only_light = 0, .samples = false, .picture = false};
    for (const std::string recipe :
         {"pcf,pcf.kernel=vogel,pcf.radius=3.47", "pcf,pcf.kernel=vogel,pcf.radius=3.47,pcf.tap=bilinear",
          "vsm,vsm.blur=gaussian,vsm.radius=4", "evsm4,evsm.blur=box,evsm.radius=3",
          "convolution,convolution.blur=box,convolution.radius=3", "pcss,pcss.extremes=blocks"}) {
        const auto drawn = [&](int resolution) {
            return render_frame(test::device(), gpu, scene.camera(""),
                                load_recipe(fmt::format("{},placement=perceptual,perceptual.radius=0.01,resolution={}",
                                                        recipe, resolution)),
                                options);
        };
        const FrameResult small = drawn(512);
        const FrameResult large = drawn(1024);
        EXPECT_EQ(small.visibility[0].values, large.visibility[0].values) << recipe;
        const auto dark = std::count_if(small.visibility[0].values.begin(), small.visibility[0].values.end(),
                                        [](float v) { return v < 0.5F; });
        EXPECT_GT(dark, 50) << recipe;
        ASSERT_FALSE(small.remarks.empty()) << "a single frame says what it draws";
        EXPECT_NE(small.remarks.back().find("of 512 x 512 texels"), std::string::npos) << small.remarks.back();
    }
}

/// K eq. 5.12: behind a half-plane before a rectangle all penumbrae have one width, half of it half_size (d_r - d_o) / d_o on the
/// receiver; the next frame's texels are as large as that radius asks for.
TEST(PerceptualRendered, PcssDrawsWhatItsSmallestFilterAsksFor) {
    const test::ValidationGuard guard;
    const Scene& scene = test::built_in("half-plane");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const GnLight& light = scene.lights[0].shape;
    History history(test::device());
    FrameOptions options{.width = 96, .height = 96, .only_light = 0, .samples = false, .picture = false};
    options.history = &history;
    const PreparedRecipe recipe(
        test::device(),
        load_recipe("pcss,placement=perceptual,visibility=smallest-radius,perceptual.least=0.00001,resolution=1024"));
    for (int frame = 0; frame < 2; ++frame) {
        static_cast<void>(render_frame(gpu, scene.camera(""), recipe, options));
    }
    const float found = std::bit_cast<float>(*history.answered("smallest filter of light 0"));

    // The planes of receiver and occluder, from the light.
    float receiver = 0;
    float occluder = 1e30F;
    for (const vec3& p_ws : scene.positions_ws) {
        const float distance = glm::dot(p_ws - vec3(light.position_ws), vec3(light.direction_ws));
        receiver = std::max(receiver, distance);
        occluder = std::min(occluder, distance);
    }
    const float half_size = std::min(light.half_size.x, light.half_size.y);
    const float radius = half_size * (receiver - occluder) / occluder / receiver;
    // The bias moves receivers towards the light, which makes the penumbra that is looked for narrower, never wider.
    EXPECT_LE(found, 1.005F * radius);
    EXPECT_GE(found, 0.95F * radius);

    // In time the resolution is there.
    const ivec2* texels = nullptr;
    for (int frame = 0; frame < 24; ++frame) {
        static_cast<void>(render_frame(gpu, scene.camera(""), recipe, options));
        const ivec2 before = texels != nullptr ? *texels : ivec2(0);
        texels = history.before<ivec2>("perceptual texels of light 0 pcss");
        ASSERT_NE(texels, nullptr);
        const ivec2* reported = history.before<ivec2>(chosen_texels(0));
        ASSERT_NE(reported, nullptr);
        EXPECT_EQ(*reported, *texels);
        if (before.x > 0) {
            EXPECT_GE(texels->x, std::min(before.x - 8, static_cast<int>(before.x / 1.25F))) << frame;
        }
    }
    const Guard reach = find_part(Stage::lookup, "pcss").guard(load_recipe("pcss"), scene.lights[0], scene.bounds_ws);
    FrameGraph graph(test::device());
    const LightViews fit = test::place(scene, "pcss,placement=fit,resolution=1024", 96, 96);
    const float extent = glsl::gn_light_plane(fit.views[0]).x * (1 - 2 * (reach.texels + 1) / 1024);
    EXPECT_NEAR(static_cast<float>(texels->x), c * extent / radius + 2 * (reach.texels + 1), 12);
}

/// How far a picture lies from that of the full map with the same lookup: mean FLIP, and the root mean square of V's difference.
struct Apart {
    double flip = 0, rms = 0;
};

Apart apart(const FrameResult& frame, const FrameResult& full) {
    const float exposure = automatic_exposure(full.picture);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t light = 0; light < full.visibility.size(); ++light) {
        const std::vector<float>& v = full.visibility[light].values;
        for (std::size_t i = 0; i < v.size(); ++i, ++count) {
            const auto d = static_cast<double>(frame.visibility[light].values[i] - v[i]);
            sum += d * d;
        }
    }
    return {flip(tonemap(frame.picture, exposure), tonemap(full.picture, exposure)),
            std::sqrt(sum / static_cast<double>(count))};
}

struct AgainstFull {
    Apart at_c, at_half;  ///< c = 3.47, and half of it
    Apart elsewhere;      ///< a full map again, of 8 texels less a side, so that all lie elsewhere
};

/// `asked` are keys of the placement alone, which the full maps have not.
AgainstFull against_full(const char* scene_name, const std::string& recipe, const std::string& asked = "") {
    const Scene& scene = test::built_in(scene_name);
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameOptions options{.width = 160, .height = 90, .samples = false};
    const auto drawn = [&](const std::string& placement) {
        return render_frame(test::device(), gpu, scene.camera(""),
                            load_recipe(recipe + ",resolution=2048,placement=" + placement), options);
    };
    const FrameResult full = drawn("fit+auto");
    AgainstFull result;
    result.at_c = apart(drawn("perceptual+auto,perceptual.c=3.47" + asked), full);
    result.at_half = apart(drawn("perceptual+auto,perceptual.c=1.735" + asked), full);
    if (test::thorough()) {
        result.elsewhere = apart(drawn("fit+auto,resolution=2040"), full);
        fmt::print(
            "{} {}{}: flip {:.4f}, c / 2 {:.4f}, elsewhere {:.4f}; rms of V {:.4f}, c / 2 {:.4f}, elsewhere {:.4f}\n",
            scene_name, recipe, asked, result.at_c.flip, result.at_half.flip, result.elsewhere.flip, result.at_c.rms,
            result.at_half.rms, result.elsewhere.rms);
    }
    return result;
}

/// Observers asked for c = 3.47: FLIP from the full map's picture is 0.02 at most then, or what two full maps differ by whose
/// texels lie elsewhere, and half of c errs more. Bilinear taps leave less of V's difference than single texels do, where the
/// filter's width does not hang on texels too.
TEST(PerceptualRendered, ItsPictureIsAsCloseToTheFullMapsAsTheFilterAsks) {
    struct Row {
        const char* scene;
        std::string recipe;
        std::string asked;
    };
    const std::string disc = "pcf,pcf.kernel=rotated-poisson,pcf.taps=25,pcf.radius_world=";
    std::vector<Row> rows = {{"car", disc + "0.15", ""}, {"boxes", disc + "0.15", ""}};
    if (test::thorough()) {
        rows.push_back({"warehouse-inside", disc + "1.2", ""});
        rows.push_back({"car", "pcss", ",perceptual.least=0.002"});
        rows.push_back({"warehouse-inside", "pcss", ",perceptual.least=0.002"});
    }
    for (const auto& [scene, recipe, asked] : rows) {
        const std::string tap = "," + recipe.substr(0, recipe.find(',')) + ".tap=";
        const AgainstFull texel = against_full(scene, recipe + tap + "texel", asked);
        const AgainstFull bilinear = against_full(scene, recipe + tap + "bilinear", asked);
        EXPECT_LE(bilinear.at_c.flip, std::max(0.02, bilinear.elsewhere.flip)) << scene << " " << recipe;
        EXPECT_GT(bilinear.at_c.rms, 1e-3) << scene << " " << recipe << " draws all texels";
        EXPECT_GE(bilinear.at_half.rms, 1.1 * bilinear.at_c.rms) << scene << " " << recipe;
        if (asked.empty()) {
            EXPECT_LE(bilinear.at_c.rms, 0.95 * texel.at_c.rms) << scene << " " << recipe;
        }
    }
    if (test::thorough()) {
        // Leaves smaller than texels: full maps with texels elsewhere differ nearly as much.
        const AgainstFull leaves = against_full("courtyard", disc + "0.15,pcf.tap=bilinear");
        EXPECT_LE(leaves.at_c.flip, 1.5 * leaves.elsewhere.flip);
        against_full("courtyard", disc + "0.15,pcf.tap=texel");
        // The floor where contacts are in sight: FLIP is small at the default, and grows with the floor.
        for (const char* name : {"courtyard", "car", "warehouse-inside", "boxes"}) {
            const AgainstFull at_default = against_full(name, "pcss,pcss.tap=bilinear");
            EXPECT_LE(at_default.at_c.flip, std::max(0.02, at_default.elsewhere.flip)) << name;
            against_full(name, "pcss,pcss.tap=bilinear", ",perceptual.least=0.001");
            against_full(name, "pcss,pcss.tap=bilinear", ",perceptual.least=0.002");
        }
        against_full("courtyard", "pcss,pcss.tap=texel", ",perceptual.least=0.002");
    }
}

}  // namespace
}  // namespace gn::perceptual_test
