// SPDX-License-Identifier: MIT
// A light that shows a picture: its shadow has the colours of what is left of it.
#include "shadow/lookup/backprojection/emission.glsl"

#include "scenes/analytic.h"
#include "tests/rig.h"

#include <cmath>

namespace gn::emission_test {
namespace {

/// Each of the 256 points lies in a cell of its own, and is asked there.
TEST(BackprojectionEmission, EveryCellHasOnePointOfTheMask) {
    const int n = glsl::gn_back_cells;
    for (int i = 0; i < n * n; ++i) {
        const ivec2 cell(i % n, i / n);
        const int k = glsl::gn_back_row_in(cell);
        const int c = 4 * (cell.x >> 1) + static_cast<int>(glsl::gn_back_column(k));
        const vec2 at = (glsl::gn_back_sample(k, c) + 1.0F) * (0.5F * static_cast<float>(n));
        EXPECT_EQ(ivec2(floor(at)), cell);
        glsl::GnBackMask mask = glsl::gn_back_no_mask();
        (k < 16 ? mask.low : mask.high)[(k >> 2) & 3] = 1U << static_cast<uint>(c);
        int hidden = 0;
        for (int j = 0; j < n * n; ++j) {
            hidden += glsl::gn_back_hides_cell(mask, ivec2(j % n, j / n)) ? 1 : 0;
        }
        EXPECT_EQ(hidden, glsl::gn_back_hides_cell(mask, cell) ? 1 : 0);
        EXPECT_EQ(hidden, 1);
    }
}

/// Who stands under a panel that shines down, looks up at it and has its up_ws upwards sees it unmirrored.
TEST(BackprojectionEmission, APictureIsReadFromWhereItShines) {
    GnLight light;
    light.kind = GN_LIGHT_RECTANGLE;
    light.half_size = vec2(1);
    light.direction_ws = vec4(0, 0, 1, 0);
    light.up_ws = vec4(0, 1, 0, 0);
    for (const float side : {1.0F, -1.0F}) {
        light.right_ws = vec4(side, 0, 0, 0);
        // The eye looks along -z: its right is +x.
        EXPECT_EQ(gn_emission_place(light, vec2(side, 1)), vec2(1, 0)) << "the upper right corner";
        EXPECT_EQ(gn_emission_place(light, vec2(-side, -1)), vec2(0, 1)) << "the lower left corner";
    }
}

/// half-plane under a panel whose left half is red and whose right half is blue; green grows from its upper edge to its lower.
Scene panel_scene(int side) {
    Scene scene = load_scene("half-plane");
    Texture panel{.name = "panel", .image = {side, side, {}}, .repeat_u = false, .repeat_v = false};
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const auto green = static_cast<std::uint8_t>(255 * y / (side - 1));
            const std::uint8_t red = x < side / 2 ? 255 : 0;
            const auto blue = static_cast<std::uint8_t>(x < side / 2 ? 0 : 188);
            panel.image.rgba.insert(panel.image.rgba.end(), {red, green, blue, 255});
        }
    }
    set_emission(scene.lights.front().shape, static_cast<int>(scene.textures.size()));
    scene.textures.push_back(std::move(panel));
    complete_emission(scene, scene.lights.front());
    return scene;
}

/// What each of the mask's points weighs: the picture's mean over its cell.
std::vector<std::pair<vec3, vec3>> points_of(const Scene& scene) {
    const Light& light = scene.lights.front();
    const Image8& picture = *shown_picture(scene, light.shape);
    const int n = glsl::gn_back_cells;
    std::vector<std::pair<vec3, vec3>> points;
    for (int i = 0; i < n * n; ++i) {
        const ivec2 cell(i % n, i / n);
        const int k = glsl::gn_back_row_in(cell);
        const vec2 x = glsl::gn_back_sample(k, 4 * (cell.x >> 1) + static_cast<int>(glsl::gn_back_column(k)));
        vec3 sent(0);
        for (int j = 0; j < 256; ++j) {
            const vec2 at = glsl::gn_back_in_cell(cell, ivec2(j % 16, j / 16), 16);
            sent += emission_at(picture, gn_emission_place(light.shape, at)) / 256.0F;
        }
        points.emplace_back(vec3(light.shape.position_ws) + x.x * light.shape.half_size.x * vec3(light.shape.right_ws) +
                                x.y * light.shape.half_size.y * vec3(light.shape.up_ws),
                            sent);
    }
    return points;
}

/// V of a scene's first light, of one channel or three, against what its points are seen of that the mask stands for: root of the
/// mean square, and how many samples are seen in another colour.
struct Judged {
    dvec3 rmse{0};
    int coloured = 0;
};
Judged judge(const Scene& scene, const std::vector<std::pair<vec3, vec3>>& points, int channels) {
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameResult frame = render_frame(test::device(), gpu, scene.cameras.front(), load_recipe("backprojection"),
                                           {.width = 48, .height = 36, .picture = false});
    const Image& v = frame.visibility.front();
    EXPECT_EQ(v.channels, channels);
    const Truth tracer(scene);
    Judged judged;
    double count = 0;
    for (std::size_t i = 0; i < v.pixels(); ++i) {
        const dvec3 p_ws(frame.samples.position_ws[i]);
        const vec3 n_ws(frame.samples.normal_ws[i]);
        if (frame.samples.position_ws[i].w != 1 || !gn_counted(scene.lights.front().shape, vec3(p_ws), n_ws) ||
            p_ws.y > 0.1) {
            continue;
        }
        dvec3 seen(0), all(0);
        for (const auto& [q_ws, sent] : points) {
            const dvec3 weight = channels == 3 ? dvec3(sent) : dvec3(1);
            seen += tracer.blocked(p_ws, dvec3(q_ws)) ? dvec3(0) : weight;
            all += weight;
        }
        const dvec3 expected = seen / all;
        const auto found = [&](std::size_t c) { return static_cast<double>(v.values[channels == 3 ? 3 * i + c : i]); };
        const dvec3 wrong = dvec3(found(0), found(1), found(2)) - expected;
        judged.rmse += wrong * wrong;
        judged.coloured += std::abs(expected.r - expected.b) > 0.5 ? 1 : 0;
        count += 1;
    }
    judged.rmse = sqrt(judged.rmse / count);
    return judged;
}

TEST(BackprojectionEmissionRendered, APanelPastAnEdgeIsItsPointsTracedInTheirColours) {
    const test::ValidationGuard guard;
    const Scene scene = panel_scene(64);
    Scene white = scene;
    set_emission(white.lights.front().shape, -1);
    const auto points = points_of(scene);
    const Judged panel = judge(scene, points, 3), plain = judge(white, points, 1);
    EXPECT_GT(panel.coloured, 50) << "one half of the panel is hidden before the other";
    // Green comes from all of the panel, as white light does, more of it from one side: linear light that grows as x^2.2 has weights
    // whose mean square is 1.9. Red and blue come from a half each, of which a texel of an edge hides twice the share.
    EXPECT_LT(plain.rmse.r, 0.02);
    EXPECT_LE(panel.rmse.g, std::sqrt(1.9) * plain.rmse.g);
    EXPECT_LE(panel.rmse.r, 2 * plain.rmse.r);
    EXPECT_LE(panel.rmse.b, 2 * plain.rmse.b);
}

/// The halves of a panel are two panels: their closed forms are the shares of red and of blue.
TEST(BackprojectionEmissionRendered, TheTruthOfAPanelIsThatOfItsHalves) {
    const Scene scene = panel_scene(64);
    const GnLight& light = scene.lights.front().shape;
    std::vector<vec4> positions_ws;
    for (int i = 0; i <= 40; ++i) {
        positions_ws.emplace_back(-1 + 0.05F * static_cast<float>(i), 0, 0.2F, 1);
    }
    const std::vector<vec4> normals_ws(positions_ws.size(), vec4(0, 1, 0, 1));
    const Truth tracer(scene);
    const TruthResult coloured =
        tracer.trace(positions_ws, normals_ws, scene.lights.front(), {.samples = 1024, .channels = 3});
    const TruthResult plain = tracer.trace(positions_ws, normals_ws, scene.lights.front(), {.samples = 1024});
    const bool red_is_right = gn_emission_place(light, vec2(1, 0)).x < 0.5F;
    for (std::size_t i = 0; i < positions_ws.size(); ++i) {
        const dvec3 p_ws(positions_ws[i]);
        const auto half = [&](float side) {
            GnLight part = light;
            set_emission(part, -1);
            part.half_size.x *= 0.5F;
            part.position_ws += side * part.half_size.x * part.right_ws;
            Scene only = scene;
            only.lights.front() = {.name = "half", .shape = part, .spared = {}};
            const Truth one(only);
            const vec4 p = positions_ws[i];
            const vec4 n(0, 1, 0, 1);
            return static_cast<double>(one.trace({&p, 1}, {&n, 1}, part, {.samples = 4096}).visibility.front());
        };
        const double left = half(-1), right = half(1);
        EXPECT_LT(coloured.standard_error[i], 0.02) << "1024 points, an edge among strata of a 32nd";
        // Between the middle texels of 64 the picture goes over from one half to the other.
        const double tolerance = 1.0 / 64 + 4 * static_cast<double>(coloured.standard_error[i]) + 1e-3;
        EXPECT_NEAR(coloured.visibility[3 * i], red_is_right ? right : left, tolerance) << p_ws.x;
        EXPECT_NEAR(coloured.visibility[3 * i + 2], red_is_right ? left : right, tolerance) << p_ws.x;
        EXPECT_NEAR(plain.visibility[i], 0.5 * (left + right), tolerance) << "the share of its area";
    }
}

/// Where all of it is seen, the light is as bright as its mean, whoever shadows it.
TEST(BackprojectionEmissionRendered, APanelLightsAsItsMeanDoes) {
    Scene scene = panel_scene(64);
    scene.environment = Light{.name = "night", .shape = {.kind = GN_LIGHT_ENVIRONMENT, .intensity = 0}, .spared = {}};
    for (const char* recipe : {"backprojection,resolution=256", "hard,resolution=256"}) {
        const test::ComparisonOptions size{.width = 32, .height = 24, .samples = 1};
        Scene white = scene;
        set_emission(white.lights.front().shape, -1);
        const vec3 mean = mean_emission(*shown_picture(scene, scene.lights.front().shape));
        SceneGpu panel_gpu = upload_scene(test::device(), scene), white_gpu = upload_scene(test::device(), white);
        const auto draw = [&](SceneGpu& gpu) {
            return render_frame(test::device(), gpu, scene.cameras.front(), load_recipe(recipe),
                                {.width = size.width, .height = size.height});
        };
        const FrameResult panel = draw(panel_gpu), plain = draw(white_gpu);
        std::size_t judged = 0;
        for (std::size_t i = 0; i < plain.samples.position_ws.size(); ++i) {
            if (plain.visibility[0].values[i] < 1 || plain.samples.position_ws[i].w < 0.5F) {
                continue;
            }
            for (std::size_t c = 0; c < 3; ++c) {
                const float expected = mean[static_cast<int>(c)] * plain.picture.values[3 * i + c];
                EXPECT_NEAR(panel.picture.values[3 * i + c], expected, 1e-3F * expected) << recipe;
            }
            ++judged;
        }
        EXPECT_GT(judged, 100U);
    }
}

}  // namespace
}  // namespace gn::emission_test
