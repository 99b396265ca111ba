// SPDX-License-Identifier: MIT
// What casts and what receives: by material, by order of the file, by lamp. Every technique and the truth must agree.
#include "base/paths.h"
#include "tests/little_gltf.h"

namespace gn::casting_test {
namespace {

using test::box;
using test::level;
using test::LittleGltf;
using test::on_ground;

constexpr test::ComparisonOptions small{.width = 96, .height = 96, .samples = 1};
constexpr std::array techniques{"hard", "pcf", "silhouette", "volumes", "planar"};

/// A room's floor with a lamp in a shade, or with a sun above it; what the shade is made of is the test's.
LittleGltf shaded_lamp(const std::string& material, const std::string& node = "", const std::string& mesh = "",
                       const std::string& type = "point") {
    LittleGltf world;
    world.add(level({0, 0, 0}, 5), 0);
    world.add(box({0.2F, 1.5F, 0.2F}, {0.8F, 2.1F, 0.8F}), world.material(R"("name":"shade",)" + material),
              R"(,"name":"shade")" + node, mesh);
    world.light(type, {0.5F, 1.8F, 0.5F});
    world.camera({0, 3, 6}, -0.182008F, 0.983297F);
    return world;
}

constexpr const char* grey = R"("pbrMetallicRoughness":{"metallicFactor":0})";

/// A kernel's weights add up to 1 but for the rounding of floats.
constexpr double rounding = 1e-6;

/// The mean of V on the ground must be `expected`, as each technique has it and as the truth has it.
void expect_ground(const Scene& scene, double expected) {
    for (const char* technique : techniques) {
        const auto c = test::compare(scene, technique, small);
        EXPECT_GT(on_ground(c, c.truth.visibility).samples, 1000U);
        EXPECT_EQ(on_ground(c, c.truth.visibility).mean, expected) << technique << ", the truth";
        EXPECT_NEAR(on_ground(c, c.visibility().values).mean, expected, rounding) << technique;
    }
}

TEST(Casting, AnOpaqueShadeTakesAllLight) {
    expect_ground(shaded_lamp(grey).load(), 0);
}

TEST(Casting, GlassCastsNothingAndIsNamed) {
    for (const char* glass : {R"("alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.6]})",
                              R"("alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.4]})",
                              R"("extensions":{"KHR_materials_transmission":{"transmissionFactor":1}})"}) {
        SCOPED_TRACE(glass);
        const Scene scene = shaded_lamp(glass).load();
        EXPECT_TRUE(testing_scene::has_note(scene, "Material 'shade' lets light through"));
        expect_ground(scene, 1);
    }
}

TEST(Casting, NodesMeshesAndMaterialsSayWhatCasts) {
    const std::string no = R"("extras":{"gnomon":{"casts":false}})";
    const std::string yes = R"("extras":{"gnomon":{"casts":true}})";
    expect_ground(shaded_lamp(grey, "," + no).load(), 1);
    expect_ground(shaded_lamp(grey, "", "," + no).load(), 1);
    expect_ground(shaded_lamp(grey + ("," + no)).load(), 1);
    // The node wins over the mesh, the mesh over the material; glass may be told to cast.
    expect_ground(shaded_lamp(grey + ("," + no), "", "," + yes).load(), 0);
    expect_ground(shaded_lamp(grey, "," + yes, "," + no).load(), 0);
    const std::string glass = R"("extensions":{"KHR_materials_transmission":{"transmissionFactor":1}})";
    expect_ground(shaded_lamp(glass, "," + yes).load(), 0);
    EXPECT_TRUE(testing_scene::has_note(shaded_lamp(grey, R"(,"extras":{"gnomon":{"cast":false}})").load(),
                                        "extras.gnomon has no key 'cast'"));
}

TEST(Casting, UnderTheSunEveryPlacementObeys) {
    const Scene scene = shaded_lamp(grey, R"(,"extras":{"gnomon":{"casts":false}})", "", "directional").load();
    for (const char* recipe : {"cascades", "sdsm", "lispsm", "hard,casters=ids", "hard,casters=dual", "evsm4"}) {
        const auto c = test::compare(scene, recipe, small);
        EXPECT_EQ(on_ground(c, c.truth.visibility).mean, 1);
        // What exponential maps store of the ground itself errs by rounding.
        EXPECT_NEAR(on_ground(c, c.visibility().values).mean, 1, 1e-4) << recipe;
    }
}

TEST(Casting, WhatReceivesNoShadowIsLitAndLeftOutOfTheErrors) {
    const std::string no = R"(,"extras":{"gnomon":{"receives":false}})";
    LittleGltf world;
    world.add(level({0, 0, 0}, 5), 0, no);
    world.add(box({-1, 0.5F, -1}, {1, 1.5F, 1}), 0);
    world.light("directional", {0, 5, 0},
                "[-0.4340928834740518,0.4027244822399942,0.22601287402018602,0.7734950165960007]");
    world.camera({0, 3, 6}, -0.182008F, 0.983297F);
    const Scene scene = world.load();
    for (const char* recipe : {"hard", "volumes", "planar", "pcf-bilateral", "forward"}) {
        const auto c = test::compare(scene, recipe, small);
        std::size_t ground = 0;
        for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
            const vec4 p_ws = c.frame.samples.position_ws[i];
            if (p_ws.w > 0 && std::abs(p_ws.y) < 1e-4F) {
                ++ground;
                ASSERT_EQ(c.visibility().values[i], 1) << recipe;
                ASSERT_EQ(c.truth.visibility[i], 1);
                ASSERT_EQ(c.truth.counted[i], 0) << "left out of the errors";
            }
        }
        EXPECT_GT(ground, 1000U);
        EXPECT_GT(c.errors.samples, 100U) << "the box still counts";
    }
}

TEST(Casting, ABulbDoesNotShadowItsOwnLamp) {
    const std::string glowing = R"("emissiveFactor":[1,0.9,0.7])";
    const Scene scene = shaded_lamp(glowing).load();
    EXPECT_TRUE(testing_scene::has_note(scene, "'shade' glows around the lamp 'lamp'"));
    expect_ground(scene, 1);

    // Other lights meet the bulb as any other thing, and so does a lamp far beside it.
    expect_ground(shaded_lamp(glowing, R"(,"extras":{"gnomon":{"casts":true}})").load(), 0);
    LittleGltf beside;
    beside.add(level({0, 0, 0}, 5), 0);
    beside.add(level({0, 1, 0}, 1), beside.material(glowing));
    beside.light("point", {0, 2, 0});
    beside.camera({0, 3, 6}, -0.182008F, 0.983297F);
    const auto c = test::compare(beside.load(), "volumes", small);
    EXPECT_LT(on_ground(c, c.truth.visibility).mean, 0.95);
    EXPECT_LT(on_ground(c, c.visibility().values).mean, 0.95);
}

TEST(Casting, OneLampSparesItsBulbAndAnotherDoesNot) {
    LittleGltf world = shaded_lamp(R"("emissiveFactor":[1,0.9,0.7])");
    world.light("directional", {0, 9, 0});
    const Scene scene = world.load();
    const test::ValidationGuard guard;
    SceneGpu gpu = upload_scene(test::device(), scene);
    for (const char* technique : {"hard", "volumes", "silhouette"}) {
        const FrameResult frame = render_frame(test::device(), gpu, scene.cameras[0], load_recipe(technique),
                                               {.width = 96, .height = 96, .picture = false});
        std::array<std::size_t, 2> shadowed{};
        for (std::size_t light = 0; light < 2; ++light) {
            for (std::size_t i = 0; i < frame.samples.position_ws.size(); ++i) {
                const vec4 p_ws = frame.samples.position_ws[i];
                const bool ground = p_ws.w > 0 && std::abs(p_ws.y) < 1e-4F;
                shadowed[light] += ground && frame.visibility[light].values[i] < 0.5F ? 1U : 0U;
            }
        }
        EXPECT_EQ(shadowed[0], 0U) << technique;
        EXPECT_GT(shadowed[1], 10U) << technique;
    }
}

TEST(Casting, ForwardRefusesWhatItsMapCannotLight) {
    const Scene scene = shaded_lamp(grey, R"(,"extras":{"gnomon":{"casts":false}})", "", "directional").load();
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameResult frame = render_frame(test::device(), gpu, scene.cameras[0], load_recipe("forward"),
                                           {.width = 32, .height = 32, .picture = false});
    EXPECT_NE(frame.refused[0].find("'shade' casts nothing"), std::string::npos) << frame.refused[0];
}

TEST(CastingFiles, TomlSaysItForFilesAndForObjects) {
    const testing_scene::TempFolder folder;
    folder.write("room.gltf", shaded_lamp(grey).text());
    const auto load = [&](const std::string& more) {
        return load_scene(folder.write("room.toml", "[[file]]\npath = \"room.gltf\"\n" + more));
    };
    const auto lit = [](const Scene& scene) {
        const auto c = test::compare(scene, "volumes", small);
        EXPECT_EQ(on_ground(c, c.truth.visibility).mean, on_ground(c, c.visibility().values).mean);
        return on_ground(c, c.truth.visibility).mean;
    };
    EXPECT_EQ(lit(load("")), 0);
    EXPECT_EQ(lit(load("casts = false\n")), 1);
    EXPECT_EQ(lit(load("[[object]]\nname = \"shade\"\ncasts = false\n")), 1);
    EXPECT_EQ(lit(load("casts = false\n[[object]]\nname = \"shade\"\ncasts = true\n")), 0);
    EXPECT_NE(testing_scene::error_of(
                  folder.write("wrong.toml", "[[file]]\npath = \"room.gltf\"\n[[object]]\nname = \"shed\"\n"))
                  .find("no object is named 'shed'"),
              std::string::npos);
}

TEST(CastingFiles, LampsInGlassOrInTheirBulbsLightTheRoom) {
    const auto folder = data_root() / "../shared/cases/glass_lampshade";
    if (!std::filesystem::exists(folder)) {
        GTEST_SKIP() << "the cases are not beside the source tree";
    }
    const auto bare = test::compare((folder / "none.glb").string(), "volumes", small);
    for (const char* name : {"blend_60.glb", "transmission.glb", "emissive_bulb.glb"}) {
        for (const char* technique : {"hard", "volumes"}) {
            const auto c = test::compare((folder / name).string(), technique, small);
            // The shade hides some of the ground from the camera, so that only where both see it they compare.
            for (std::size_t i = 0; i < c.truth.visibility.size(); ++i) {
                if (c.frame.samples.position_ws[i] == bare.frame.samples.position_ws[i]) {
                    ASSERT_EQ(c.truth.visibility[i], bare.truth.visibility[i]) << name;
                }
            }
            EXPECT_LT(*c.errors.mismatch, 0.01) << name << " " << technique;
        }
    }
}

}  // namespace
}  // namespace gn::casting_test
