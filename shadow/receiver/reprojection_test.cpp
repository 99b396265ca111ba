// SPDX-License-Identifier: MIT
// What a frame sees is found again in the frame before, under a camera and on objects that moved.
#include "shadow/receiver/reprojection.h"

#include "base/shared.h"
#include "shadow/frame/history.h"
#include "shadow/receiver/reprojection.glsl"
#include "shadow/scene/move.h"
#include "shadow/view/read_back.h"
#include "tests/direct_scenes.h"
#include "tests/rig.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gn::reprojection_test {
namespace {

constexpr uint width = 160, height = 120;

Scene box_on_ground() {
    by_hand::SceneBuilder b;
    b.ground(8).box({-1, 0.5F, -1}, {1, 2.5F, 1}).light(by_hand::sun({0.3F, -1, 0.2F}));
    Scene scene = b.scene();
    scene.cameras = {{.position_ws = vec3(0, 6, 9), .forward_ws = glm::normalize(vec3(0, -0.7F, -1))}};
    return scene;
}

/// Shares of the samples that are found in the frame before: of all that it shows, those whose point is that of the pixel.
struct Found {
    std::size_t shown = 0, same = 0;
};

Found find(const CpuSamples& now, const CpuSamples& before, const Reprojection& way, bool with_objects) {
    Found found;
    for (const vec4& p : now.position_ws) {
        if (p.w == 0) {
            continue;
        }
        // The box is all that lies above the ground.
        const mat4 moved = with_objects && p.y > 1e-3F ? way.before_from_now[1] : mat4(1);
        const vec3 place = glsl::gn_reproject(way.before_cs_from_ws, moved, vec3(p));
        const ivec2 pixel(glm::floor(vec2(place) * vec2(width, height)));
        if (place.z == 0 || pixel.x < 0 || pixel.y < 0 || pixel.x >= static_cast<int>(width) ||
            pixel.y >= static_cast<int>(height)) {
            continue;
        }
        ++found.shown;
        const vec4& seen =
            before.position_ws[static_cast<std::size_t>(pixel.y) * width + static_cast<std::size_t>(pixel.x)];
        // A pixel is two centimetres wide at one metre's height, four on the slanting ground.
        found.same += seen.w > 0 && glm::distance(vec3(seen), vec3(moved * vec4(vec3(p), 1))) < 0.25F ? 1 : 0;
    }
    return found;
}

TEST(Reprojection, FindsWhatMovedUnderACameraThatMoved) {
    const test::ValidationGuard guard;
    Scene scene = box_on_ground();
    SceneGpu gpu = upload_scene(test::device(), scene);
    History history(test::device());
    const Recipe recipe = load_recipe("hard,resolution=64");
    const auto draw = [&] {
        return render_frame(test::device(), gpu, scene.cameras.front(), recipe,
                            {.width = width, .height = height, .picture = false, .history = &history})
            .samples;
    };
    const auto way_back = [&] {
        FrameGraph graph(test::device());
        const SceneHandles handles = import_scene(graph, gpu);
        const ViewSamples samples = add_view_samples(graph, gpu, handles, scene.cameras.front(), width, height);
        return reprojection({test::device(), graph, scene, handles, samples, scene.lights.data(), 0, &history});
    };
    EXPECT_FALSE(way_back().has_value()) << "nothing came before";
    const CpuSamples before = draw();

    // The camera goes aside and turns, the box goes up, turns, and is moved twice.
    scene.cameras.front().position_ws = vec3(1, 6.5F, 8.5F);
    move_object(scene, 1, glm::rotate(mat4(1), 0.4F, vec3(0, 1, 0)));
    move_object(scene, 1, glm::translate(mat4(1), vec3(0.8F, 0.3F, 0.2F)));
    refresh_scene(test::device(), gpu);
    const std::optional<Reprojection> way = way_back();
    ASSERT_TRUE(way.has_value());
    ASSERT_EQ(way->before_from_now.size(), scene.objects.size());
    EXPECT_EQ(way->before_from_now[0], mat4(1));
    const CpuSamples now = draw();
    const Found found = find(now, before, *way, true), still = find(now, before, *way, false);
    EXPECT_GT(found.shown, width * height / 2);
    // What the frame before did not see lies behind the box, or at its new bottom.
    EXPECT_GT(found.same, found.shown * 9 / 10) << found.shown;
    EXPECT_LT(still.same, found.same - found.shown / 50) << "the box is not where it was";

    // Then all stands still, and a point is where it is.
    const std::optional<Reprojection> rest = way_back();
    EXPECT_EQ(rest->before_from_now[1], mat4(1));
    EXPECT_EQ(find(now, now, *rest, true).same, find(now, now, *rest, true).shown);
    history.clear();
    EXPECT_FALSE(way_back().has_value()) << "after a cut";
}

/// Frames that ask twice each, as two lights do, for what the frame before saw.
class SamplesKept {
  public:
    explicit SamplesKept(const Scene& scene) : scene_(scene), gpu_(upload_scene(test::device(), scene)) {}

    /// Draws a frame. `lent`: its images belong to a renderer.
    struct Seen {
        CpuSamples now;
        std::vector<std::byte> before, before_normals;  ///< empty where there are none
    };
    Seen draw(uint size, bool lent = false) {
        FrameGraph graph(test::device());
        const SceneHandles handles = import_scene(graph, gpu_);
        ViewSamples samples = add_view_samples(graph, gpu_, handles, scene_.cameras.front(), size, size);
        if (lent) {
            samples.position = lend(graph, samples.position, positions_);
            samples.normal = lend(graph, samples.normal, normals_);
        }
        const FrameInput input{test::device(), graph, scene_, handles, samples, nullptr, 0, &history_};
        const auto before = samples_before(input), again = samples_before(input);
        EXPECT_EQ(before.has_value(), again.has_value());
        graph.keep(samples.position);
        graph.keep(samples.normal);
        graph.execute(false);
        graph.execute(false);  // a frame that is run again finds what it found
        Seen seen{read_samples(graph, samples), {}, {}};
        if (before) {
            seen.before = graph.download(before->position);
            seen.before_normals = graph.download(before->normal);
        }
        history_.advance();
        return seen;
    }

  private:
    /// A texture of the renderer's with what the image holds.
    TextureHandle lend(FrameGraph& graph, TextureHandle image, Texture2D& own) {
        graph.place(image, [&](const TextureDesc& wanted) -> Texture2D& {
            TextureDesc desc = wanted;
            desc.name = "the renderer's";
            desc.usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
            if (own.vk() == VK_NULL_HANDLE) {
                own = Texture2D(test::device(), desc);
            }
            return own;
        });
        return image;
    }

    const Scene& scene_;
    SceneGpu gpu_;
    History history_{test::device()};
    Texture2D positions_, normals_;
};

std::vector<std::byte> bytes_of(const std::vector<vec4>& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return {bytes.begin(), bytes.end()};
}

TEST(Reprojection, KeepsWhatTheFrameBeforeSaw) {
    const test::ValidationGuard guard;
    for (const bool lent : {false, true}) {
        Scene scene = box_on_ground();
        SamplesKept frames(scene);
        const auto first = frames.draw(32, lent);
        EXPECT_TRUE(first.before.empty()) << "nothing came before";
        scene.cameras.front().position_ws.x += 1;
        const auto second = frames.draw(32, lent);
        EXPECT_EQ(second.before, bytes_of(first.now.position_ws));
        EXPECT_EQ(second.before_normals, bytes_of(first.now.normal_ws));
        EXPECT_NE(second.before, bytes_of(second.now.position_ws)) << "the camera moved";
        scene.cameras.front().position_ws.x += 1;
        EXPECT_EQ(frames.draw(32, lent).before, bytes_of(second.now.position_ws));
    }
}

TEST(Reprojection, KeepsNothingOfAnotherSize) {
    const Scene scene = box_on_ground();
    SamplesKept frames(scene);
    frames.draw(32);
    EXPECT_TRUE(frames.draw(24).before.empty());
}

TEST(Reprojection, PointsBehindTheCameraHaveNoPlace) {
    const mat4 cs_from_ws = view_constants(box_on_ground().cameras.front(), width, height).cs_from_ws;
    EXPECT_EQ(glsl::gn_reproject(cs_from_ws, mat4(1), vec3(0, 20, 30)), vec3(0));
    const vec3 ahead = glsl::gn_reproject(cs_from_ws, mat4(1), vec3(0, 6 - 7, 9 - 10));
    EXPECT_LT(glm::distance(ahead, vec3(0.5F, 0.5F, 1)), 1e-5F) << "the axis goes through the middle";
}

TEST(Reprojection, ARendererMayTellWhereItsCameraWas) {
    const Scene scene = box_on_ground();
    SceneGpu gpu = upload_scene(test::device(), scene);
    History history(test::device());
    FrameGraph graph(test::device());
    const SceneHandles handles = import_scene(graph, gpu);
    ViewSamples samples = add_view_samples(graph, gpu, handles, scene.cameras.front(), width, height);
    leave_frame(history, samples, scene, handles);
    history.advance();
    // The origin moved by a metre since.
    const mat4 told = samples.constants.cs_from_ws * glm::translate(mat4(1), vec3(1, 0, 0));
    samples.before_cs_from_ws = told;
    const auto way = reprojection({test::device(), graph, scene, handles, samples, nullptr, 0, &history});
    ASSERT_TRUE(way.has_value());
    EXPECT_EQ(way->before_cs_from_ws, told);
}

}  // namespace
}  // namespace gn::reprojection_test
