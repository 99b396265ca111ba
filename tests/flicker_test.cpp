// SPDX-License-Identifier: MIT
// Flicker as rendered: cascades that keep their texels fixed to the world against those that follow the camera.
#include "shadow/metrics/flicker.h"
#include "shadow/frame/history.h"
#include "tests/cascade_frame.h"
#include "tests/thorough.h"
#include "tests/warp_scene.h"

#include <cmath>

namespace gn::flicker_test {
namespace {

constexpr uint width = 640, height = 360;
/// Samples closer than this share of a texel are one point to the map.
constexpr float part_of_texel = 1.0F / 16;

struct Walked {
    double flicker = 0, rmse = 0;  ///< of all steps; mean over the frames
};

/// Which pairs of samples are compared.
enum class Pairs { all, one_texel };

/// Drops the pairs that are two points to the map: farther apart than a small part of the texels that serve them. In a
/// grazing view a pixel's width is many texels, and a map that never changes then differs from one sample to the next.
void keep_one_texel(std::vector<int>& same, const CpuSamples& from, const CpuSamples& to, const LightViews& views) {
    const auto data = views.data_as<GnCascadesData>();
    for (std::size_t i = 0; i < same.size(); ++i) {
        if (same[i] < 0) {
            continue;
        }
        const auto other = static_cast<std::size_t>(same[i]);
        const int index = glsl::gn_cascades_choose(test::receiver_at(from.normal_ws[i].w), data).first;
        const GnLightView& view = views.views[static_cast<std::size_t>(index)];
        const float rows =
            std::max(glm::length(glsl::gn_row(view.cs_from_ws, 0)), glm::length(glsl::gn_row(view.cs_from_ws, 1)));
        const float texel_ws = 2 / (rows * view.resolution);
        if (glm::distance(vec3(from.position_ws[i]), vec3(to.position_ws[other])) > part_of_texel * texel_ws) {
            same[i] = -1;
        }
    }
}

PathView view_of(const CpuSamples& samples, int w, int h) {
    const Camera& camera = samples.camera;
    const mat4 cs_from_ws = cs_from_vs(camera, static_cast<float>(w) / static_cast<float>(h)) * vs_from_ws(camera);
    return {w,
            h,
            cs_from_ws,
            static_cast<float>(2 * half_height_at(camera, 1) / static_cast<double>(h)),
            samples.normal_ws,
            samples.position_ws};
}

/// Follows the cameras with one history, against the closed answer of the tracer for a sun without size.
Walked walk(const Scene& scene, const std::vector<Camera>& cameras, const std::string& text, Pairs pairs = Pairs::all) {
    const test::ValidationGuard guard;
    const Recipe recipe = load_recipe(text);
    const Truth tracer(scene);
    SceneGpu gpu = upload_scene(test::device(), scene);
    History history(test::device());
    Flicker flicker;
    CpuSamples before;
    SignedError error_before;
    Walked walked;
    for (const Camera& camera : cameras) {
        FrameResult frame = render_frame(
            test::device(), gpu, camera, recipe,
            {.width = width, .height = height, .repeat = 0, .only_light = 0, .picture = false, .history = &history});
        EXPECT_EQ(frame.refused.front(), "");
        const TruthResult truth =
            tracer.trace(frame.samples.position_ws, frame.samples.normal_ws, scene.lights[0], {.samples = 1});
        const std::vector<float>& found = frame.visibility.front().values;
        SignedError error = signed_error(found, truth.visibility, truth.counted, width, height);
        walked.rmse += visibility_errors(found, truth.visibility, truth.counted, width, height).rmse.value() /
                       static_cast<double>(cameras.size());
        if (!before.position_ws.empty()) {
            std::vector<int> same = same_points(view_of(before, width, height), view_of(frame.samples, width, height));
            if (pairs == Pairs::one_texel) {
                keep_one_texel(same, before, frame.samples, test::place(scene, text, width, height, &before.camera));
            }
            flicker += flicker_between(error_before, error, same);
        }
        before = std::move(frame.samples);
        error_before = std::move(error);
    }
    EXPECT_GT(flicker.samples, 1000U) << text;
    walked.flicker = flicker.root_mean_square().value_or(NAN);
    return walked;
}

TEST(FlickerRendered, AStillCameraHasNone) {
    const Scene& scene = test::built_in("corridor");
    const std::vector<Camera> still(3, scene.camera(""));
    for (const char* recipe : {"pcf,placement=cascades,resolution=256", "pcf,placement=fit,resolution=256"}) {
        EXPECT_EQ(walk(scene, still, recipe).flicker, 0.0) << recipe;
    }
}

/// Like for like: the same windows, that move by whole texels or follow the camera to the last bit.
TEST(FlickerRendered, SnappedCascadesFlickerATenthOfThoseThatAreNot) {
    const std::vector<const char*> scenes{"corridor", "courtyard"};
    for (const char* name : std::span(scenes).first(test::thorough() ? 2 : 1)) {
        const Scene scene = test::with_hard_sun(name);
        // Without GNOMON_THOROUGH the first third, in which the camera moves as it does in all of it.
        const std::vector<Camera>& all = scene.paths.at(0).frames;
        const auto frames = static_cast<std::ptrdiff_t>(all.size() / (test::thorough() ? 1 : 3));
        const std::vector<Camera> path(all.begin(), all.begin() + frames);
        const Walked snapped = walk(scene, path, "pcf,placement=cascades", Pairs::one_texel);
        const Walked loose = walk(scene, path, "pcf,placement=cascades,cascades.snap=0", Pairs::one_texel);
        EXPECT_NEAR(snapped.rmse, loose.rmse, 0.1 * loose.rmse) << name;
        EXPECT_LE(snapped.flicker, 0.1 * loose.flicker) << name << " " << snapped.flicker << " of " << loose.flicker;
        EXPECT_GT(loose.flicker, 0.01) << name;
    }
}

/// What is left between all pairs is the scene's, not the map's: far down the corridor a pixel is many texels wide. One map
/// that never changes, coarser though it is, has more than half as much, and a technique without texels has none.
TEST(FlickerRendered, MostOfWhatRemainsIsThatOfAMapThatNeverChanges) {
    const Scene& scene = test::built_in("corridor");
    const std::vector<Camera>& path = scene.paths.at(0).frames;
    const double snapped = walk(scene, path, "pcf,placement=cascades", Pairs::all).flicker;
    EXPECT_GT(walk(scene, path, "pcf,placement=single", Pairs::all).flicker, 0.5 * snapped);
    EXPECT_LT(walk(scene, path, "volumes", Pairs::all).flicker, 0.01 * snapped);
}

/// How much V of points that both see differs from the first camera to the second, where the map is one and the same.
double change_of(SceneGpu& gpu, const std::array<Camera, 2>& cameras, const std::string& recipe) {
    constexpr uint w = 640, h = 480;
    std::array<FrameResult, 2> frames;
    for (std::size_t i = 0; i < 2; ++i) {
        frames[i] = render_frame(test::device(), gpu, cameras[i], load_recipe(recipe),
                                 {.width = w, .height = h, .only_light = 0, .picture = false});
        EXPECT_EQ(frames[i].refused.front(), "");
    }
    const std::vector<int> same = same_points(view_of(frames[0].samples, w, h), view_of(frames[1].samples, w, h));
    const std::vector<float>& after = frames[1].visibility[0].values;
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < same.size(); ++i) {
        const float v = frames[0].visibility[0].values[i];
        if (same[i] >= 0 && v > 0 && v < 1) {
            const double change =
                static_cast<double>(after[static_cast<std::size_t>(same[i])]) - static_cast<double>(v);
            sum += change * change;
            ++count;
        }
    }
    EXPECT_GT(count, 50) << recipe;
    return std::sqrt(sum / count);
}

/// What turns the taps of a penumbra stays on the surface: as the camera moves by a fraction of its pixels, most points keep the
/// cell that they lie in, whose taps change with the pixel otherwise.
TEST(FlickerRendered, ThePenumbrasNoiseStaysOnTheSurface) {
    const test::ValidationGuard guard;
    const Scene& scene = test::built_in("half-plane:light=directional");
    SceneGpu gpu = upload_scene(test::device(), scene);
    std::array<Camera, 2> cameras{scene.camera(""), scene.camera("")};
    cameras[1].position_ws += 0.01F * scene.bounds_ws.diagonal() * cameras[1].forward_ws;
    const std::string few = "pcss,placement=single,pcss.taps=8";
    const double swims = change_of(gpu, cameras, few + ",pcss.noise=pixel");
    EXPECT_LT(change_of(gpu, cameras, few), 0.7 * swims);
}

/// How much V of the points that frames share changes from each to the next, on the root mean square. A point's own V stays as
/// it is, so that all of that is flicker, and nothing need be traced.
double flicker_of(const Scene& scene, const std::vector<Camera>& cameras, const std::string& text, uint w, uint h) {
    SceneGpu gpu = upload_scene(test::device(), scene);
    History history(test::device());
    const Recipe recipe = load_recipe(text);
    Flicker flicker;
    CpuSamples before;
    SignedError error_before;
    for (const Camera& camera : cameras) {
        FrameResult frame = render_frame(
            test::device(), gpu, camera, recipe,
            {.width = w, .height = h, .repeat = 0, .only_light = 0, .picture = false, .history = &history});
        EXPECT_EQ(frame.refused.front(), "");
        const std::vector<float>& found = frame.visibility.front().values;
        std::vector<std::uint8_t> counted(found.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            const vec4 p_ws = frame.samples.position_ws[i];
            counted[i] =
                p_ws.w > 0.5F && gn_counted(scene.lights[0].shape, vec3(p_ws), vec3(frame.samples.normal_ws[i]));
        }
        SignedError error =
            signed_error(found, std::vector<float>(found.size()), counted, static_cast<int>(w), static_cast<int>(h));
        if (!before.position_ws.empty()) {
            const auto view = [&](const CpuSamples& samples) {
                return view_of(samples, static_cast<int>(w), static_cast<int>(h));
            };
            flicker += flicker_between(error_before, error, same_points(view(before), view(frame.samples)));
        }
        before = std::move(frame.samples);
        error_before = std::move(error);
    }
    EXPECT_GT(flicker.samples, 500U) << text;
    return flicker.root_mean_square().value_or(NAN);
}

/// Penumbrae of a sun of a degree swim no more than twice as much as the edges of pcf's fixed kernel over the same maps.
TEST(FlickerRendered, PenumbraeFlickerNoMoreThanTwiceAsMuchAsPcf) {
    const test::ValidationGuard guard;
    Scene scene = test::built_in("corridor");
    scene.lights[0].shape.angular_radius = glm::radians(0.5F);
    // Without GNOMON_THOROUGH a few steps of the walk and one of the recipes, in a smaller picture over smaller maps.
    const std::vector<Camera>& all = scene.paths.at(0).frames;
    const std::vector<Camera> path(all.begin(), test::thorough() ? all.end() : all.begin() + 4);
    const std::string maps = test::thorough() ? ",resolution=2048" : ",resolution=1024";
    const uint w = test::thorough() ? width : 480, h = test::thorough() ? height : 270;
    const std::vector<std::pair<const char*, const char*>> recipes{{"pcss", "pcf,placement=auto"},
                                                                   {"soft", "pcf,placement=cascades"}};
    for (const auto& [recipe, pcf] : std::span(recipes).first(test::thorough() ? 2 : 1)) {
        const double least = flicker_of(scene, path, pcf + maps, w, h);
        EXPECT_LE(flicker_of(scene, path, recipe + maps, w, h), 2 * least) << recipe;
        EXPECT_GT(least, 0.01) << recipe;
    }
}

}  // namespace
}  // namespace gn::flicker_test
