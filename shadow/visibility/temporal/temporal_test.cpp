// SPDX-License-Identifier: MIT
// A still view converges to the traced shadow, and nothing that is seen is older than what happened to it.
#include "shadow/visibility/temporal/temporal.glsl"

#include "shadow/frame/history.h"
#include "shadow/receiver/reprojection.glsl"
#include "shadow/scene/move.h"
#include "tests/direct_scenes.h"
#include "tests/rig.h"
#include "tests/thorough.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace gn::temporal_test {
namespace {

constexpr uint width = 96, height = 64;

TEST(Temporal, TheMeanIsThatOfAllFramesByTheirWeight) {
    const GnTemporalParams params{.exponent = 2, .memory = 1.5F};
    float mean = 0;
    float sum = 0;
    float weights = 0;
    float weighted = 0;
    const std::array<std::pair<float, float>, 4> frames{{{1, 0.5F}, {0, 0.3F}, {1, 0.9F}, {0.25F, 0.1F}}};
    for (const auto& [v, confidence] : frames) {
        const float weight = glsl::gn_temporal_weight(confidence, params);
        EXPECT_FLOAT_EQ(weight, confidence * confidence);
        mean = glm::mix(mean, v, glsl::gn_temporal_share(sum, weight));
        sum = glsl::gn_temporal_sum(sum, weight, params);
        weights += weight;
        weighted += weight * v;
        EXPECT_NEAR(mean, weighted / weights, 1e-6F);
    }
    EXPECT_EQ(glsl::gn_temporal_share(0, 0), 1) << "what no frame has seen is what this one says";
    EXPECT_FLOAT_EQ(glsl::gn_temporal_sum(1.4F, 0.9F, params), 1.5F);
}

TEST(Temporal, ABoxTouchesWhatLiesBehindItFromAnyPartOfTheLight) {
    GnLight sun;
    sun.direction_ws = vec4(0, -1, 0, 0);
    const vec3 low(-1, 4, -1);
    const vec3 high(1, 5, 1);
    const auto touches = [&](const GnLight& light, vec3 p, float reach) {
        return glsl::gn_temporal_touches(light, p, low, high, reach);
    };
    EXPECT_TRUE(touches(sun, vec3(0.9F, 0, 0), 0));
    EXPECT_FALSE(touches(sun, vec3(1.1F, 0, 0), 0));
    EXPECT_TRUE(touches(sun, vec3(1.1F, 0, 0), 0.2F)) << "a kernel reaches it";
    EXPECT_FALSE(touches(sun, vec3(0, 6, 0), 0)) << "above the box";
    EXPECT_TRUE(touches(sun, vec3(0, 4.5F, 0), 0)) << "in it";
    // Half a metre and more beside it at five metres' height, a sun of a tenth of a radian sees past it.
    sun.angular_radius = 0.1F;
    EXPECT_TRUE(touches(sun, vec3(1.45F, 0, 0), 0));
    GnLight lamp;
    lamp.kind = GN_LIGHT_POINT;
    lamp.position_ws = vec4(0, 10, 0, 1);
    EXPECT_TRUE(touches(lamp, vec3(1.6F, 0, 0), 0));
    EXPECT_FALSE(touches(lamp, vec3(2.1F, 0, 0), 0));
    lamp.position_ws.y = 3;
    EXPECT_FALSE(touches(lamp, vec3(0), 0)) << "the box is beyond the lamp";
}

/// Frames of a recipe with a history of their own.
class Sequence {
  public:
    Sequence(SceneGpu& gpu, const std::string& recipe) : gpu_(gpu), recipe_(test::device(), load_recipe(recipe)) {}
    FrameResult draw(const Camera& camera) {
        return render_frame(gpu_, camera, recipe_,
                            {.width = width, .height = height, .picture = false, .history = &history_});
    }
    FrameResult draw() { return draw(gpu_.scene->cameras.front()); }

  private:
    SceneGpu& gpu_;
    History history_{test::device()};
    PreparedRecipe recipe_;
};

TruthResult truth_of(const Scene& scene, const CpuSamples& samples) {
    return Truth(scene).trace(samples.position_ws, samples.normal_ws, scene.lights.front(), {.samples = 1});
}

/// Of the recipe alone the least over all frames, and of what was gathered over them.
struct Figures {
    double least = 1e9, gathered = 0;
    std::vector<double> of_one, of_all;  ///< of each frame
};
Figures after_frames(Scene& scene, const std::string& recipe, int frames, std::optional<double> Errors::*figure) {
    SceneGpu gpu = upload_scene(test::device(), scene);
    Sequence gathered(gpu, recipe + ",visibility=temporal");
    Sequence alone(gpu, recipe);
    Figures figures;
    std::optional<TruthResult> truth;
    for (int k = 0; k < frames; ++k) {
        const FrameResult one = alone.draw();
        const FrameResult all = gathered.draw();
        if (!truth) {
            truth = truth_of(scene, one.samples);
        }
        const auto of = [&](const FrameResult& frame) {
            return *(visibility_errors(frame.visibility[0].values, truth->visibility, truth->counted, width, height).*
                     figure);
        };
        figures.of_one.push_back(of(one));
        figures.of_all.push_back(of(all));
        figures.least = std::min(figures.least, figures.of_one.back());
        figures.gathered = figures.of_all.back();
    }
    return figures;
}

/// Triangles over a ground, seen from above.
Scene loose_triangles() {
    by_hand::SceneBuilder b;
    b.ground(8).soup(Box{vec3(-3, 1, -3), vec3(3, 3, 3)}, 1.5F, 24, 7).light(by_hand::sun({0.3F, -1, 0.2F}));
    Scene scene = b.scene();
    scene.cameras = {{.position_ws = vec3(0, 9, 9), .forward_ws = glm::normalize(vec3(0, -1, -1))}};
    return scene;
}

/// Wrong samples lie within half a texel of an edge; of 64 places one lies within an eighth of it.
TEST(TemporalRendered, AStillViewConvergesToTheTracedShadow) {
    const test::ValidationGuard guard;
    Scene scene = loose_triangles();
    const Figures hard = after_frames(scene, "hard,placement=jittered,resolution=64", 64, &Errors::mismatch);
    EXPECT_GT(hard.least, 0.005);
    EXPECT_LE(5 * hard.gathered, hard.least) << "mismatch " << hard.gathered << " of " << hard.least;
    if (test::thorough()) {
        for (std::size_t k = 0; k < hard.of_all.size(); ++k) {
            fmt::print("frame {} mismatch alone {:.5f} gathered {:.5f}\n", k, hard.of_one[k], hard.of_all[k]);
        }
    }
    for (const char* lookup : {"pcf", "pcss"}) {
        const Figures soft =
            after_frames(scene, fmt::format("{},placement=jittered,resolution=64", lookup), 24, &Errors::rmse);
        EXPECT_LT(soft.gathered, soft.least) << lookup;
    }
}

/// Tiles and pages that move from frame to frame are gathered as one map is.
TEST(TemporalRendered, AStillViewConvergesOverTilesAndPages) {
    const test::ValidationGuard guard;
    Scene scene = loose_triangles();
    for (const char* placement : {"adaptive,adaptive.maps=1,adaptive.levels=5,resolution=128,adaptive.jitter=1",
                                  "virtual,resolution=128,virtual.jitter=1"}) {
        const Figures hard = after_frames(scene, fmt::format("hard,placement={}", placement), 24, &Errors::mismatch);
        EXPECT_GT(hard.least, 0.005) << placement;
        EXPECT_LE(2 * hard.gathered, hard.least) << placement;
    }
}

/// What the frame before saw of all four pixels around where a sample was, or something far from it.
bool surely_revealed(const CpuSamples& before, const Camera& camera, vec3 p_ws) {
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    const vec3 place = glsl::gn_reproject(cs_from_vs(camera, aspect) * vs_from_ws(camera), mat4(1), p_ws);
    const ivec2 first(glm::floor(vec2(place) * vec2(width, height) - 0.5F));
    for (int i = 0; i < 4; ++i) {
        const ivec2 pixel = first + ivec2(i & 1, i >> 1);
        if (place.z == 0 || pixel.x < 0 || pixel.y < 0 || pixel.x >= static_cast<int>(width) ||
            pixel.y >= static_cast<int>(height)) {
            continue;
        }
        const vec4& q =
            before.position_ws[static_cast<std::size_t>(pixel.y) * width + static_cast<std::size_t>(pixel.x)];
        if (q.w > 0 && glm::distance(vec3(q), p_ws) < 1) {
            return false;
        }
    }
    return true;
}

/// A sample that comes into view is what a frame alone says of it, to the bit; others know more than that frame.
TEST(TemporalRendered, ADisoccludedSampleIsHardToTheBit) {
    const test::ValidationGuard guard;
    // The shadow falls behind the box, which hides it with its lit faces: what is revealed is dark.
    Scene scene = by_hand::box_on_ground();
    scene.lights.front().shape.direction_ws = vec4(glm::normalize(vec3(0.2F, -1, -1.2F)), 0);
    SceneGpu gpu = upload_scene(test::device(), scene);
    Sequence gathered(gpu, "temporal,resolution=64");
    Sequence alone(gpu, "hard,placement=jittered,resolution=64");
    Camera camera = scene.cameras.front();
    int dark = 0;
    CpuSamples before;
    Camera camera_before;
    int revealed = 0;
    int known = 0;
    for (int k = 0; k < 12; ++k) {
        camera.position_ws.x = k < 8 ? 0.0F : 0.9F * static_cast<float>(k - 7);
        const FrameResult one = alone.draw(camera);
        const FrameResult all = gathered.draw(camera);
        for (std::size_t i = 0; k > 0 && i < one.samples.position_ws.size(); ++i) {
            const vec4& p_ws = one.samples.position_ws[i];
            const float v = one.visibility[0].values[i];
            if (p_ws.w > 0 && surely_revealed(before, camera_before, vec3(p_ws))) {
                ASSERT_EQ(all.visibility[0].values[i], v) << "frame " << k << " sample " << i;
                ++revealed;
                dark += v < 0.5F ? 1 : 0;
            }
            known += all.visibility[0].values[i] != v ? 1 : 0;
        }
        before = one.samples;
        camera_before = camera;
    }
    EXPECT_GT(revealed, 100);
    EXPECT_GT(dark, 10);
    EXPECT_GT(known, 100);
}

/// Least and greatest V that frames alone gave a sample since something happened to it.
struct Since {
    std::vector<float> least, greatest;
    void add(const std::vector<float>& v) {
        least.resize(v.size(), 2);
        greatest.resize(v.size(), -1);
        for (std::size_t i = 0; i < v.size(); ++i) {
            least[i] = std::min(least[i], v[i]);
            greatest[i] = std::max(greatest[i], v[i]);
        }
    }
};

/// Whether V of the samples that `changed` lies within what frames since the change have said.
void expect_nothing_older(const FrameResult& frame, const Since& since, const std::vector<std::uint8_t>& changed,
                          const std::string& when) {
    for (std::size_t i = 0; i < changed.size(); ++i) {
        if (changed[i] != 0) {
            const float v = frame.visibility[0].values[i];
            // A mean of floats rounds.
            ASSERT_GE(v, since.least[i] - 1e-6F) << when << " sample " << i;
            ASSERT_LE(v, since.greatest[i] + 1e-6F) << when << " sample " << i;
        }
    }
}

class NoStaleValue : public testing::TestWithParam<const char*> {};

/// A caster jumps: where the truth changes no frame from then on shows anything of before.
TEST_P(NoStaleValue, WhereACasterJumps) {
    const test::ValidationGuard guard;
    Scene scene = by_hand::box_on_ground();
    SceneGpu gpu = upload_scene(test::device(), scene);
    const std::string recipe = std::string(GetParam());
    Sequence gathered(gpu, recipe + ",visibility=temporal");
    Sequence alone(gpu, recipe);
    for (int k = 0; k < 6; ++k) {
        static_cast<void>(gathered.draw());
        static_cast<void>(alone.draw());
    }
    Scene still = scene;
    move_object(scene, 1, glm::translate(mat4(1), vec3(2.5F, 0.25F, -1)));
    refresh_scene(test::device(), gpu);
    Since since;
    std::vector<std::uint8_t> changed;
    std::size_t wrong = 0;
    for (int k = 0; k < 4; ++k) {
        const FrameResult one = alone.draw();
        const FrameResult all = gathered.draw();
        if (k == 0) {
            // What the box hid and what it hides, from the same samples.
            const TruthResult was = truth_of(still, one.samples);
            const TruthResult is = truth_of(scene, one.samples);
            for (std::size_t i = 0; i < is.visibility.size(); ++i) {
                changed.push_back(is.counted[i] != 0 && was.visibility[i] != is.visibility[i] ? 1 : 0);
                wrong += changed[i] != 0 && std::abs(one.visibility[0].values[i] - is.visibility[i]) > 0.5F ? 1 : 0;
            }
        }
        since.add(one.visibility[0].values);
        expect_nothing_older(all, since, changed, fmt::format("frame {} after the jump", k));
    }
    const auto all = static_cast<std::size_t>(std::count(changed.begin(), changed.end(), 1));
    EXPECT_GT(all, 100U);
    EXPECT_LT(wrong, all / 4) << "of " << all << ": the frame's own map is as new";
}

INSTANTIATE_TEST_SUITE_P(
    TemporalRendered, NoStaleValue,
    testing::Values("hard,placement=jittered,resolution=64", "pcf,placement=jittered,resolution=64",
                    "pcss,placement=jittered,resolution=64", "hard,placement=virtual,resolution=256",
                    "hard,placement=virtual,resolution=256,virtual.jitter=1",
                    "hard,placement=adaptive,adaptive.maps=1,adaptive.levels=5,resolution=256,adaptive.kept=tiles",
                    "hard,placement=adaptive,adaptive.maps=1,adaptive.levels=5,resolution=256,adaptive.jitter=1"));

/// What did not move keeps what frames knew of it: only samples in reach of the mover begin anew.
TEST(TemporalRendered, ShadowsOfWhatRestsAreKept) {
    by_hand::SceneBuilder b;
    b.ground(8)
        .box({-3, 0.5F, -1}, {-1.5F, 2.5F, 1})
        .box({3, 0.5F, 2}, {3.5F, 1, 2.5F})
        .light(by_hand::sun({0.3F, -1, 0.2F}));
    Scene scene = b.scene();
    scene.cameras = {{.position_ws = vec3(0, 9, 9), .forward_ws = glm::normalize(vec3(0, -1, -1))}};
    SceneGpu gpu = upload_scene(test::device(), scene);
    Sequence gathered(gpu, "temporal,resolution=64");
    Sequence alone(gpu, "hard,placement=jittered,resolution=64");
    for (int k = 0; k < 8; ++k) {
        static_cast<void>(gathered.draw());
        static_cast<void>(alone.draw());
    }
    // The small box moves a little; then the light moves, and nobody knows anything.
    for (const bool light : {false, true}) {
        if (light) {
            scene.lights[0].shape.direction_ws = vec4(glm::normalize(vec3(0.31F, -1, 0.2F)), 0);
        } else {
            move_object(scene, 2, glm::translate(mat4(1), vec3(0.1F, 0, 0)));
            refresh_scene(test::device(), gpu);
        }
        const FrameResult one = alone.draw();
        const FrameResult all = gathered.draw();
        int known = 0;
        for (std::size_t i = 0; i < one.visibility[0].values.size(); ++i) {
            known += one.visibility[0].values[i] != all.visibility[0].values[i] ? 1 : 0;
        }
        if (light) {
            EXPECT_EQ(known, 0);
        } else {
            EXPECT_GT(known, 10);
        }
    }
}

}  // namespace
}  // namespace gn::temporal_test
