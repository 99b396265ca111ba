// SPDX-License-Identifier: MIT
// COLOR_0 of glTF: its alpha decides what of a masked surface is there, for the eye, for every map and for the truth.
#include "base/paths.h"
#include "tests/little_gltf.h"

namespace gn::vertex_color_test {
namespace {

using test::level;
using test::LittleGltf;
using test::on_ground;
using test::quad;

constexpr test::ComparisonOptions small{.width = 96, .height = 96, .samples = 1};
constexpr const char* masked =
    R"("name":"board","alphaMode":"MASK","alphaCutoff":0.4,"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.8]})";

LittleGltf with_floor(const std::string& lamp) {
    LittleGltf world;
    world.add(level({0, 0, 0}, 5), 0);
    world.light(lamp, {-0.5F, 4, 0.5F});
    world.camera({0, 3, 6}, -0.182008F, 0.983297F);
    return world;
}

/// A level board above a floor, two units wide. Its corners' alpha runs from `left` to `right`.
Scene board(const std::string& lamp, float left, float right, const std::string& material = masked) {
    LittleGltf world = with_floor(lamp);
    const vec4 l(1, 1, 1, left);
    const vec4 r(1, 1, 1, right);
    world.add(level({0, 1, 0}, 1), world.material(material), "", "", {l, r, r, l, r, l});
    return world.load();
}

/// What is left of it where alpha times 0.8 reaches 0.4: the right half.
Scene half_board(const std::string& lamp) {
    LittleGltf world = with_floor(lamp);
    world.add(quad({0, 1, 1}, {1, 1, 1}, {1, 1, -1}, {0, 1, -1}), world.material(R"("name":"half")"));
    return world.load();
}

std::size_t seen_at(const FrameResult& frame, float y) {
    return static_cast<std::size_t>(std::count_if(frame.samples.position_ws.begin(), frame.samples.position_ws.end(),
                                                  [y](vec4 p) { return p.w > 0 && std::abs(p.y - y) < 1e-4F; }));
}

TEST(VertexColor, HalfOfABoardCastsWhereItsAlphaRunsFromNoneToAll) {
    struct Case {
        const char *lamp, *technique;
    };
    for (const Case& tested : {Case{"directional", "hard"},
                               {"directional", "silhouette"},
                               {"directional", "planar"},
                               {"directional", "cascades"},
                               {"directional", "evsm4"},
                               {"directional", "hard,casters=ids"},
                               {"point", "hard"},
                               {"point", "paraboloid"},
                               {"point", "planar"}}) {
        SCOPED_TRACE(std::string(tested.technique) + " under a " + tested.lamp);
        const auto whole = test::compare(board(tested.lamp, 0, 1), tested.technique, small);
        const auto half = test::compare(half_board(tested.lamp), tested.technique, small);

        // The eye: a column of pixels may fall on the edge.
        EXPECT_NEAR(static_cast<double>(seen_at(whole.frame, 1)), static_cast<double>(seen_at(half.frame, 1)), 24);
        EXPECT_GT(seen_at(half.frame, 1), 150U);

        // The truth, and the technique, as over half a board: but for a line along the edge, 24 of some 6000 samples.
        const auto truth = on_ground(half, half.truth.visibility);
        const auto drawn = on_ground(half, half.visibility().values);
        EXPECT_LT(truth.mean, 0.98);
        EXPECT_NEAR(on_ground(whole, whole.truth.visibility).mean, truth.mean, 0.004);
        EXPECT_NEAR(on_ground(whole, whole.visibility().values).mean, drawn.mean, 0.004);
        EXPECT_LT(*whole.errors.mismatch, 0.02);
    }
}

TEST(VertexColor, OneAlphaForAllCornersIsAFactorLikeTheMaterials) {
    // Too little of it, and nothing is there; enough, and it is solid; blended, it is glass. All of it is said.
    const Scene none = board("directional", 0.3F, 0.3F);
    EXPECT_TRUE(testing_scene::has_note(none, "'board' is wholly transparent"));
    const Scene all = board("directional", 0.6F, 0.6F);
    EXPECT_TRUE(all.notes.empty()) << all.notes[0];
    const Scene glass = board("directional", 0.6F, 0.6F, R"("name":"board","alphaMode":"BLEND")");
    EXPECT_TRUE(testing_scene::has_note(glass, "'board' lets light through"));
    const Scene solid = board("directional", 0.3F, 0.3F, R"("name":"board")");
    for (const char* technique : {"hard", "planar"}) {
        for (const Scene* lit : {&none, &glass}) {
            const auto c = test::compare(*lit, technique, small);
            EXPECT_EQ(on_ground(c, c.truth.visibility).mean, 1);
            EXPECT_EQ(on_ground(c, c.visibility().values).mean, 1);
        }
        for (const Scene* shadowed : {&all, &solid}) {
            const auto c = test::compare(*shadowed, technique, small);
            EXPECT_LT(on_ground(c, c.truth.visibility).mean, 0.97);
            EXPECT_LT(on_ground(c, c.visibility().values).mean, 0.97);
        }
    }
}

TEST(VertexColor, ColoursTintTheSurface) {
    const auto picture = [](const std::string& material, vec4 color) {
        const test::ValidationGuard guard;
        LittleGltf world = with_floor("directional");
        world.add(level({0, 1, 0}, 1), world.material(material), "", "", std::vector<vec4>(6, color));
        const Scene scene = world.load();
        SceneGpu gpu = upload_scene(test::device(), scene);
        return render_frame(test::device(), gpu, scene.cameras[0], load_recipe("none"),
                            {.width = 64, .height = 64, .repeat = 0})
            .picture.values;
    };
    const std::string plain = R"("name":"board")";
    const auto red = picture(R"("name":"board","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,0,1]})", vec4(1));
    EXPECT_EQ(picture(plain, {0.5F, 0.25F, 0, 1}), red);
    EXPECT_NE(picture(plain, vec4(1)), red);
}

TEST(VertexColorFiles, HalfTheCardCasts) {
    const auto folder = data_root() / "../shared/cases/vertex_alpha_mask";
    if (!std::filesystem::exists(folder)) {
        GTEST_SKIP() << "the cases are not beside the source tree";
    }
    for (const char* technique : {"hard", "planar"}) {
        const auto got = test::compare((folder / "scene.glb").string(), technique, small);
        const auto expected = test::compare((folder / "expected.glb").string(), technique, small);
        std::size_t differing = 0;
        for (std::size_t i = 0; i < got.frame.samples.position_ws.size(); ++i) {
            const bool place =
                glm::distance(got.frame.samples.position_ws[i], expected.frame.samples.position_ws[i]) > 1e-3F;
            const bool light = std::abs(got.visibility().values[i] - expected.visibility().values[i]) > 0.5F ||
                               got.truth.visibility[i] != expected.truth.visibility[i];
            differing += place || light ? 1U : 0U;
        }
        // The edge where alpha crosses the cutoff, and its shadow: as long as half the picture, one pixel wide.
        EXPECT_LT(differing, 30U) << technique;
    }
}

}  // namespace
}  // namespace gn::vertex_color_test
