// SPDX-License-Identifier: MIT
// Lights that show a picture: every point weighs in its own colours.
#include "shadow/scene/emission.h"
#include "tests/direct_scenes.h"
#include "tests/panels.h"

namespace gn::view_samples_pictures_test {
namespace {

using namespace by_hand;

Scene garden_under_a_panel() {
    GnLight panel = rectangle({-1, 3.7F, 1.1F}, {0, 0, 0});
    panel.half_size = vec2(0.7F, 0.3F);
    return garden().light(panel).scene();
}

FrameResult render(const Scene& scene, const std::string& recipe) {
    const test::ValidationGuard guard;
    SceneGpu uploaded = upload_scene(device(), scene);
    FrameResult frame = render_frame(device(), uploaded, scene.cameras.front(), load_recipe(recipe),
                                     {.width = 96, .height = 72, .picture = false});
    EXPECT_EQ(frame.refused.front(), "");
    return frame;
}

TEST(ViewSamplesPictures, EveryPointWeighsWhatItSendsInEachColour) {
    Scene scene = garden_under_a_panel();
    test::show_picture(scene, test::red_and_blue());
    for (const auto& [points, side] : {std::pair{32, 1}, {40, 2}}) {
        const FrameResult frame =
            render(scene, fmt::format("view-samples,view-samples.samples={},view-samples.patterns={}", points, side));
        const Image& v = frame.visibility.front();
        ASSERT_EQ(v.channels, 3);
        const test::TracedPicture traced = test::trace_picture(scene, frame.samples, points * side * side, side);
        double wrong = 0, all = 0;
        for (std::size_t i = 0; i < v.pixels(); ++i) {
            for (std::size_t c = 0; c < 3; ++c) {
                const float expected = traced.visibility[i][static_cast<int>(c)];
                const float off = std::abs(v.values[3 * i + c] - expected);
                wrong += off > 1e-5F ? static_cast<double>(off) : 0.0;
                all += traced.counted[i];
            }
        }
        // As of white lights, 1e-5 of the points of all samples may be seen otherwise.
        EXPECT_LE(wrong, 1e-5 * all) << points << " points";
        EXPECT_GT(traced.coloured, 100);
    }
}

TEST(ViewSamplesPictures, AWhiteOneIsALightWithoutAPicture) {
    Scene scene = garden_under_a_panel();
    const std::vector<float> plain = render(scene, "view-samples").visibility.front().values;
    test::show_picture(scene, {.name = "white", .image = {1, 1, {255, 255, 255, 255}}});
    const Image coloured = render(scene, "view-samples").visibility.front();
    ASSERT_EQ(coloured.channels, 3);
    for (std::size_t i = 0; i < plain.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            ASSERT_EQ(coloured.values[3 * i + c], plain[i]) << i;
        }
    }
    // A piece of the light shows none.
    EXPECT_EQ(render(scene, "view-samples,light=split").visibility.front().channels, 1);
}

/// The points stand for what is nearer to them: coloured shadows come near the truth's as white ones do.
TEST(ViewSamplesPictures, ComeNearTheTruthOfThePicture) {
    const auto rms = [](const Scene& scene) {
        const FrameResult frame = render(scene, "view-samples,view-samples.samples=256");
        const Image& v = frame.visibility.front();
        const TruthResult truth = Truth(scene).trace(frame.samples.position_ws, frame.samples.normal_ws,
                                                     scene.lights.front(), {.samples = 256, .channels = v.channels});
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < v.values.size(); ++i) {
            const double off = static_cast<double>(v.values[i]) - static_cast<double>(truth.visibility[i]);
            sum += off * off;
            count += truth.counted[i / static_cast<std::size_t>(v.channels)];
        }
        return std::sqrt(sum / count);
    };
    Scene scene = garden_under_a_panel();
    const double white = rms(scene);
    test::show_picture(scene, test::red_and_blue());
    // A half of the picture, or one with weights that grow as x^2.2, has as many points as matter as half of a white light.
    EXPECT_LT(rms(scene), 2 * white);
}

}  // namespace
}  // namespace gn::view_samples_pictures_test
