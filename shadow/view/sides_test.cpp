// SPDX-License-Identifier: MIT
// Which side of a face shows: materials with one side, in the view and for the light; two faces back to back.
#include "base/paths.h"
#include "tests/little_gltf.h"

namespace gn::sides_test {
namespace {

using test::box;
using test::level;
using test::LittleGltf;
using test::on_ground;

constexpr test::ComparisonOptions small{.width = 96, .height = 96, .samples = 1};
constexpr const char* slanted_sun = "[-0.4340928834740518,0.4027244822399942,0.22601287402018602,0.7734950165960007]";
constexpr const char* one_side = R"("name":"thing","doubleSided":false)";

/// A floor under a slanted sun, and something above it.
LittleGltf under_the_sun(const std::vector<vec3>& thing, const std::string& material) {
    LittleGltf world;
    world.add(level({0, 0, 0}, 5), 0);
    world.add(thing, world.material(material));
    world.light("directional", {0, 5, 0}, slanted_sun);
    world.camera({0, 3, 6}, -0.182008F, 0.983297F);
    return world;
}

std::size_t seen_at(const FrameResult& frame, float y) {
    return static_cast<std::size_t>(std::count_if(frame.samples.position_ws.begin(), frame.samples.position_ws.end(),
                                                  [y](vec4 p) { return p.w > 0 && std::abs(p.y - y) < 1e-4F; }));
}

TEST(Sides, ABackShowsNothingAndCastsNothing) {
    // The same square above the floor, turned towards the sun and the camera, then away from both.
    for (const char* technique : {"hard", "silhouette", "volumes", "planar", "forward", "cascades", "sdsm", "lispsm",
                                  "psm", "tsm", "hard,casters=dual", "hard,casters=ids"}) {
        const auto towards = test::compare(under_the_sun(level({0, 1.5F, 0}, 1), one_side).load(), technique, small);
        EXPECT_GT(seen_at(towards.frame, 1.5F), 300U);
        EXPECT_LT(on_ground(towards, towards.truth.visibility).mean, 0.97);
        EXPECT_LT(*towards.errors.mismatch, 0.02) << technique;

        const auto away =
            test::compare(under_the_sun(level({0, 1.5F, 0}, 1, false), one_side).load(), technique, small);
        EXPECT_EQ(seen_at(away.frame, 1.5F), 0U) << "the floor shows through its back";
        EXPECT_EQ(on_ground(away, away.truth.visibility).mean, 1);
        // Two cascades blend to 1 but for the rounding of floats.
        EXPECT_NEAR(on_ground(away, away.visibility().values).mean, 1, 1e-6) << technique;
    }
}

TEST(Sides, OneSideLitByALampShinesThroughFromBehind) {
    // A room whose walls show inwards only, with a lamp outside: the light goes in where the eye does.
    for (const char* technique : {"hard", "silhouette", "volumes", "paraboloid"}) {
        for (const bool outwards : {false, true}) {
            LittleGltf world;
            world.add(level({0, 0, 0}, 5), 0);
            world.add(box({-1, 0.2F, -1}, {1, 2, 1}, outwards), world.material(one_side));
            world.light("point", {0.3F, 5, 0.2F});
            world.camera({0, 3, 6}, -0.182008F, 0.983297F);
            const auto c = test::compare(world.load(), technique, small);
            // The room's floor takes the light of the one, the roof that of the other.
            EXPECT_GT(seen_at(c.frame, outwards ? 2.0F : 0.2F), 200U);
            EXPECT_EQ(seen_at(c.frame, outwards ? 0.2F : 2.0F), 0U);
            EXPECT_LT(*c.errors.mismatch, 0.02) << technique << (outwards ? " outwards" : " inwards");
        }
    }
}

TEST(Sides, ASolidCastsAsBefore) {
    // What is closed and shows outwards casts the same shadow with one side or with two.
    const std::vector<vec3> solid = box({-1, 0.5F, -1}, {1, 1.5F, 1});
    for (const char* technique : {"hard", "volumes", "hard,casters=back", "hard,casters=midpoint"}) {
        const auto one = test::compare(under_the_sun(solid, one_side).load(), technique, small);
        const auto both = test::compare(under_the_sun(solid, R"("name":"thing")").load(), technique, small);
        EXPECT_EQ(one.truth.visibility, both.truth.visibility);
        EXPECT_EQ(one.visibility().values, both.visibility().values) << technique;
    }
}

FrameResult drawn(const Scene& scene) {
    const test::ValidationGuard guard;
    SceneGpu gpu = upload_scene(test::device(), scene);
    return render_frame(test::device(), gpu, scene.cameras[0], load_recipe("none"),
                        {.width = 160, .height = 160, .repeat = 0});
}
Image picture_of(const Scene& scene) {
    return drawn(scene).picture;
}

/// Pixels that are not the same in both, of those that show something in the first scene.
std::size_t differing(const Image& a, const Image& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.values.size(); i += 3) {
        const vec3 x(a.values[i], a.values[i + 1], a.values[i + 2]);
        const vec3 y(b.values[i], b.values[i + 1], b.values[i + 2]);
        count += glm::length(x - y) > 0.01F * glm::length(x) ? 1U : 0U;
    }
    return count;
}

/// Two waved sheets back to back: red above, black below. `first` is what the file names first, `turns` moves the corners
/// of the lower triangles on, `other_cut` cuts the flat sheet's squares the other way.
Scene sheets(bool black, bool black_first, std::size_t turns, bool other_cut = false) {
    std::vector<vec3> above;
    std::vector<vec3> below;
    constexpr int n = 9;
    const auto at = [&](int x, int z) {
        const float height =
            other_cut ? 0.03F * static_cast<float>(x) : 0.03F * static_cast<float>((x * 7 + z * 3) % 4);
        return vec3(2.0F * static_cast<float>(x) / n - 1, 0.5F + height, 1 - 2.0F * static_cast<float>(z) / n);
    };
    for (int x = 0; x < n; ++x) {
        for (int z = 0; z < n; ++z) {
            const std::array up{at(x, z), at(x + 1, z), at(x + 1, z + 1), at(x, z + 1)};
            const std::vector<vec3> top = test::quad(up[0], up[1], up[2], up[3]);
            const std::vector<vec3> under = other_cut ? test::quad(up[3], up[2], up[1], up[0])
                                                      : std::vector<vec3>{up[2], up[1], up[0], up[3], up[2], up[0]};
            above.insert(above.end(), top.begin(), top.end());
            for (std::size_t i = 0; i < 6; ++i) {
                below.push_back(under[i / 3 * 3 + (i + turns) % 3]);
            }
        }
    }
    LittleGltf world;
    const int red = world.material(R"("pbrMetallicRoughness":{"baseColorFactor":[0.8,0.1,0.1,1],"metallicFactor":0})");
    const int dark = world.material(R"("pbrMetallicRoughness":{"baseColorFactor":[0,0,0,1],"metallicFactor":0})");
    if (black && black_first) {
        world.add(below, dark);
    }
    world.add(above, red);
    if (black && !black_first) {
        world.add(below, dark);
    }
    world.light("directional", {0, 5, 0}, slanted_sun);
    world.camera({0.3F, 1.7F, 3.1F}, -0.182008F, 0.983297F);
    return world.load();
}

TEST(BackToBack, TheFaceTurnedToTheViewerWins) {
    for (const bool other_cut : {false, true}) {
        const Image red = picture_of(sheets(false, false, 0, other_cut));
        for (const bool black_first : {true, false}) {
            for (std::size_t turns = 0; turns < 3; ++turns) {
                // Beyond the sheet's rim the black side shows by right: a silhouette's pixels at most.
                EXPECT_EQ(differing(red, picture_of(sheets(true, black_first, turns, other_cut))), 0U)
                    << (black_first ? "black first" : "red first") << ", turned " << turns
                    << (other_cut ? ", cut the other way" : "");
            }
        }
    }
}

TEST(BackToBack, AMapHoldsTheIdOfTheFaceTurnedToTheLight) {
    // Without any bias an object that is not its own map's would shadow itself.
    for (const bool black_first : {true, false}) {
        const auto c = test::compare(sheets(true, black_first, 1),
                                     "hard,casters=ids,bias.constant=0,bias.slope=0,bias.normal=0", small);
        EXPECT_EQ(*c.errors.acne, 0) << (black_first ? "black first" : "red first");
    }
}

std::filesystem::path cases(const char* folder) {
    return data_root() / "../shared/cases" / folder;
}

TEST(SidesFiles, DollsHousesAreOpenForTheEyeAndForTheSun) {
    if (!std::filesystem::exists(cases("single_sided"))) {
        GTEST_SKIP() << "the cases are not beside the source tree";
    }
    for (const auto& entry : std::filesystem::directory_iterator(cases("single_sided"))) {
        for (const char* technique : {"hard", "volumes"}) {
            const auto c = test::compare(entry.path().string(), technique, small);
            EXPECT_LT(*c.errors.mismatch, 0.02) << entry.path().filename() << " " << technique;
        }
    }
    const auto room = test::compare((cases("single_sided") / "room_inward.glb").string(), "volumes", small);
    EXPECT_GT(seen_at(room.frame, 0.01F), 300U) << "the room's own floor";
}

TEST(SidesFiles, TheUpperSheetShowsFromAbove) {
    const auto file = cases("coplanar_double_faces") / "sheets.obj";
    if (!std::filesystem::exists(file)) {
        GTEST_SKIP() << "the cases are not beside the source tree";
    }
    // The upper side is red, the lower one black.
    const FrameResult frame = drawn(load_scene(file.string()));
    std::size_t red = 0;
    std::size_t black = 0;
    for (std::size_t i = 0; i < frame.samples.position_ws.size(); ++i) {
        const bool seen = frame.samples.position_ws[i].w > 0;
        const bool reddish = frame.picture.values[3 * i] > 1.5F * frame.picture.values[3 * i + 1];
        red += seen && reddish ? 1U : 0U;
        black += seen && !reddish ? 1U : 0U;
    }
    EXPECT_GT(red, 3000U);
    EXPECT_LT(black, red / 20) << "the lower side, where a wave of the sheet turns it to the camera";
}

}  // namespace
}  // namespace gn::sides_test
