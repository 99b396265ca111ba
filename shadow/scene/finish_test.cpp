// SPDX-License-Identifier: MIT
// What every finished scene promises, and the camera's matrices.
#include "shadow/scene/model.h"
#include "shadow/scene/testing.h"

namespace gn::finish_test {
namespace {

using namespace testing_scene;

TEST(Finish, AnEmptySceneIsLegal) {
    Scene scene;
    finish_scene(scene);
    EXPECT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.lights.size(), 1U);
    EXPECT_EQ(scene.cameras.size(), 1U);
    EXPECT_TRUE(scene.bounds_ws.empty());
}

TEST(Finish, BadTrianglesGoAndObjectsStayContiguous) {
    Scene scene = cube(vec3(0), 1.0F);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    scene.positions_ws.insert(scene.positions_ws.end(), {vec3(nan, 0, 0), vec3(1e20F, 0, 0), vec3(0)});
    scene.triangles.insert(scene.triangles.begin(), {uvec3(0, 1, 8), uvec3(0, 1, 9), uvec3(0, 1, 77), uvec3(0, 1, 1)});
    scene.objects = {{.name = "bad", .first_triangle = 0, .triangle_count = 4},
                     {.name = "good", .first_triangle = 4, .triangle_count = 12}};
    finish_scene(scene);
    ASSERT_EQ(scene.triangles.size(), 12U);
    ASSERT_EQ(scene.objects.size(), 1U);
    EXPECT_EQ(scene.objects[0].name, "good");
    EXPECT_EQ(scene.objects[0].first_triangle, 0U);
    EXPECT_EQ(scene.bounds_ws.max, vec3(1));
    EXPECT_TRUE(has_note(scene, "Dropped 2 triangles with corners that are not finite"));
    EXPECT_TRUE(has_note(scene, "Dropped 1 triangle with vertices that are not there"));
    EXPECT_TRUE(has_note(scene, "Dropped 1 triangle without area"));
    for (const vec3& p : scene.positions_ws) {
        EXPECT_TRUE(finite(p));
    }
}

TEST(Finish, NormalsBreakAtCreasesAndBlendAcrossSmoothEdges) {
    Scene scene = cube(vec3(0), 1.0F);
    finish_scene(scene);
    EXPECT_EQ(scene.positions_ws.size(), 24U);
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const vec3 face = glm::normalize(winding(scene, i));
        for (int corner = 0; corner < 3; ++corner) {
            EXPECT_GT(glm::dot(face, scene.normals_ws[scene.triangles[i][corner]]), 0.9999F) << i;
        }
    }

    // Two faces 20 degrees apart share the normal in the middle along their edge, even across split vertices.
    Scene roof;
    const float rise = std::tan(10.0F * pi / 180.0F);
    roof.positions_ws = {{-1, 0, 0}, {0, rise, 0}, {0, rise, 1}, {1, 0, 0}, {0, rise, 1}, {0, rise, 0}};
    roof.triangles = {{0, 2, 1}, {5, 4, 3}};
    finish_scene(roof);
    EXPECT_GT(roof.normals_ws[roof.triangles[0].z].y, 0.99999F);
    EXPECT_EQ(roof.positions_ws.size(), 6U);
}

TEST(Finish, AFanOfManyTrianglesTakesNoQuadraticTime) {
    Scene scene;
    scene.positions_ws.emplace_back(0, 1, 0);
    constexpr unsigned count = 200'000;
    for (unsigned i = 0; i <= count; ++i) {
        const float angle = 2.0F * pi * static_cast<float>(i) / static_cast<float>(count);
        scene.positions_ws.emplace_back(1e4F * std::cos(angle), 0, 1e4F * std::sin(angle));
        if (i > 0) {
            scene.triangles.emplace_back(0, i + 1, i);
        }
    }
    finish_scene(scene);
    EXPECT_GT(scene.normals_ws[0].y, 0.99F);
}

TEST(Finish, FarScenesAreMovedToZeroAndNearOnesAreNot) {
    Scene far = cube(vec3(1000, 0, 0), 1.0F);
    far.cameras.push_back({.position_ws = vec3(1000, 0, 5)});
    Light lamp;
    lamp.shape.kind = GN_LIGHT_POINT;
    lamp.shape.position_ws = vec4(1000, 3, 0, 1);
    far.lights.push_back(lamp);
    finish_scene(far);
    EXPECT_EQ(dvec3(far.bounds_ws.centre()) + far.origin, dvec3(1000, 0, 0));
    EXPECT_LT(glm::length(far.bounds_ws.centre()), 4.0F);
    EXPECT_EQ(dvec3(far.cameras[0].position_ws) + far.origin, dvec3(1000, 0, 5));
    EXPECT_EQ(dvec3(vec3(far.lights[0].shape.position_ws)) + far.origin, dvec3(1000, 3, 0));

    Scene near = cube(vec3(20, 0, 0), 1.0F);
    finish_scene(near);
    EXPECT_EQ(near.origin, dvec3(0.0));
}

/// A cube of 1 m at `place` as text of an .obj file; `more` stands before it.
std::string cube_text(dvec3 place, const std::string& more) {
    std::string text = more;
    for (unsigned i = 0; i < 8; ++i) {
        text += fmt::format("v {:.3f} {:.3f} {:.3f}\n", place.x + (i & 1U), place.y + (i >> 1U & 1U),
                            place.z + (i >> 2U & 1U));
    }
    for (const char* face :
         {"-8 -6 -5 -7", "-4 -3 -1 -2", "-8 -7 -3 -4", "-6 -2 -1 -5", "-8 -4 -2 -6", "-7 -5 -1 -3"}) {
        text += fmt::format("f {}\n", face);
    }
    return text;
}

TEST(Finish, TheOriginBelongsToTheMainMass) {
    const TempFolder folder;
    const dvec3 place(412'345.125, 87.5, 5'534'210.25);
    for (const char* stray : {"", "v 0 0 0\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                              "v 0 0 0\nv 412345 87 5534210\nv 412345 88 5534210\nf 1 2 3\n"}) {
        const Scene scene = load_scene(folder.write("survey.obj", cube_text(place, stray)));
        EXPECT_LT(glm::length(scene.origin - place), 16.0) << stray;
        const vec3 corner = scene.positions_ws[scene.triangles.back().x];
        EXPECT_LT(glm::length(corner), 32.0F) << stray;
        const dvec3 in_file = dvec3(corner) + scene.origin - place;
        EXPECT_LT(glm::length(in_file - glm::round(in_file)), 1e-5) << stray;
        // What is far away then is the stray, and the view does not care for it.
        EXPECT_LT(glm::length(scene.cameras[0].position_ws), 64.0F) << stray;
        EXPECT_LT(scene.cameras[0].far, 64.0F) << stray;
    }
}

TEST(Finish, TheOriginGoesToTheCameraWhereTheWorldIsWide) {
    // One wide ground and a small thing 40 km from the middle: the camera before it needs the digits.
    const TempFolder folder;
    folder.write("world.obj", cube_text({40'000, 0.05, 7},
                                        "v -50000 0 -50000\nv -50000 0 50000\nv 50000 0 50000\n"
                                        "v 50000 0 -50000\nf 1 2 3 4\n"));
    const Scene scene = load_scene(folder.write(
        "world.toml",
        "[[file]]\npath = 'world.obj'\n[[camera]]\nposition = [40000.5, 2, 12]\ndirection = [0, -0.3, -1]\n"
        "[[light]]\nkind = 'point'\nposition = [40000.5, 6, 7.5]\n"));
    EXPECT_LT(glm::length(scene.origin - dvec3(40'000.5, 2, 12)), 8.0);
    EXPECT_EQ(dvec3(scene.cameras[0].position_ws) + scene.origin, dvec3(40'000.5, 2, 12));
    EXPECT_EQ(dvec3(vec3(scene.lights[0].shape.position_ws)) + scene.origin, dvec3(40'000.5, 6, 7.5));
    EXPECT_FALSE(has_note(scene, "cannot be told"));

    // A camera that stands nowhere takes no scene with it.
    const Scene lost = load_scene(folder.write(
        "lost.toml", "[[file]]\npath = 'world.obj'\n[[camera]]\nposition = [1e12, 0, 0]\nlook_at = [0, 0, 0]\n"));
    EXPECT_EQ(lost.triangles.size(), scene.triangles.size());
    EXPECT_EQ(lost.origin, dvec3(0));
    EXPECT_TRUE(has_note(lost, "Camera 'main' had no usable position")) << lost.cameras[0].name;

    // The same made in memory.
    Scene made = cube(vec3(40'000, 1, 0), 1.0F);
    made.cameras.push_back({.position_ws = vec3(40'000, 1.75F, 4)});
    made.positions_ws.insert(made.positions_ws.end(),
                             {vec3(-5e4F, 0, -5e4F), vec3(-5e4F, 0, 5e4F), vec3(5e4F, 0, 5e4F), vec3(5e4F, 0, -5e4F)});
    made.triangles.insert(made.triangles.end(), {uvec3(8, 9, 10), uvec3(8, 10, 11)});
    finish_scene(made);
    EXPECT_LT(glm::length(made.cameras[0].position_ws), 8.0F);
    EXPECT_EQ(dvec3(made.cameras[0].position_ws) + made.origin, dvec3(40'000, 1.75, 4));
}

TEST(Finish, WhatPrecisionCannotReachIsSaidInOneSentence) {
    // Two cubes of 1 m a thousand kilometres apart: one of them is left with units of 6 cm.
    Scene scene = cube(vec3(0), 0.5F);
    const Scene other = cube(vec3(1e6F, 0, 0), 0.5F);
    scene.positions_ws.insert(scene.positions_ws.end(), other.positions_ws.begin(), other.positions_ws.end());
    for (const uvec3 t : other.triangles) {
        scene.triangles.push_back(t + 8U);
    }
    finish_scene(scene);
    std::size_t sentences = 0;
    for (const std::string& note : scene.notes) {
        sentences += note.find("cannot be told") != std::string::npos ? 1U : 0U;
    }
    EXPECT_EQ(sentences, 1U);
    EXPECT_TRUE(has_note(scene, "12 triangles"));
    for (const float place : {0.0F, 20.0F, 1e4F, 1e6F}) {
        Scene alone = cube(vec3(place, 0, 0), 0.5F);
        finish_scene(alone);
        EXPECT_FALSE(has_note(alone, "cannot be told")) << place;
    }
}

TEST(Finish, TheDefaultCameraSeesTheWholeScene) {
    Scene scene = cube(vec3(3, 1, 2), 0.5F);
    finish_scene(scene);
    const Camera& camera = scene.cameras.at(0);
    const mat4 cs_from_ws = cs_from_vs(camera, 1.0F) * vs_from_ws(camera);
    for (const vec3 corner : scene.bounds_ws.corners()) {
        const vec4 p_cs = cs_from_ws * vec4(corner, 1.0F);
        EXPECT_LE(std::max(std::abs(p_cs.x), std::abs(p_cs.y)), p_cs.w);
        EXPECT_GT(p_cs.z, 0.0F);
        EXPECT_LT(p_cs.z, p_cs.w);
    }
    const GnLight& sun = scene.lights.at(0).shape;
    const float elevation = std::asin(-sun.direction_ws.y) * 180.0F / pi;
    EXPECT_GE(elevation, 45.0F);
    EXPECT_LE(elevation, 55.0F);
    EXPECT_FLOAT_EQ(sun.angular_radius, 0.00465F);
}

TEST(Finish, ACrumbFarAwayDoesNotShrinkThePicture) {
    Scene scene;
    for (int x = 0; x < 20; ++x) {
        for (int z = 0; z < 20; ++z) {
            const auto first = static_cast<std::uint32_t>(scene.positions_ws.size());
            const vec3 p(x, 0, z);
            scene.positions_ws.insert(scene.positions_ws.end(), {p, p + vec3(0, 0, 1), p + vec3(1, 0, 0)});
            scene.triangles.emplace_back(first, first + 1, first + 2);
        }
    }
    const auto first = static_cast<std::uint32_t>(scene.positions_ws.size());
    scene.positions_ws.insert(scene.positions_ws.end(), {vec3(900, 0, 0), vec3(900, 0, 1), vec3(901, 0, 0)});
    scene.triangles.emplace_back(first, first + 1, first + 2);
    finish_scene(scene);
    EXPECT_FLOAT_EQ(scene.bounds_ws.max.x, 901.0F);
    const Box main = main_bounds(scene);
    EXPECT_LT(main.max.x, 25.0F);
    EXPECT_GT(main.max.x, 18.0F);
    EXPECT_LT(glm::length(scene.cameras[0].position_ws), 100.0F);
}

TEST(Finish, OneVastGroundDoesNotDecideWhatThePictureShows) {
    // Eight hundred triangles of a metre stand within 20 m, on a ground of a kilometre in two: by size alone that ground
    // would weigh two thirds of the whole.
    Scene scene;
    for (int i = 0; i < 800; ++i) {
        const auto first = static_cast<std::uint32_t>(scene.positions_ws.size());
        const vec3 p(i % 20, i / 400, (i / 20) % 20);
        scene.positions_ws.insert(scene.positions_ws.end(), {p, p + vec3(0, 0, 1), p + vec3(1, 0, 0)});
        scene.triangles.emplace_back(first, first + 1, first + 2);
    }
    const auto first = static_cast<std::uint32_t>(scene.positions_ws.size());
    for (const vec2 corner : {vec2(-1, -1), vec2(-1, 1), vec2(1, 1), vec2(1, -1)}) {
        scene.positions_ws.emplace_back(500 * corner.x, -1, 500 * corner.y);
    }
    scene.triangles.emplace_back(first, first + 1, first + 2);
    scene.triangles.emplace_back(first, first + 2, first + 3);
    finish_scene(scene);
    const Box main = main_bounds(scene);
    EXPECT_LT(glm::length(main.extent()), 100.0F);
    EXPECT_GT(main.extent().x, 18.0F);
    EXPECT_GT(main.extent().z, 18.0F);
}

TEST(Finish, LightsHaveNoCapAndNamesBecomeUnique) {
    Scene scene = cube(vec3(0), 1.0F);
    scene.lights.resize(1000);
    for (Light& light : scene.lights) {
        light.name = "lamp";
    }
    finish_scene(scene);
    EXPECT_EQ(scene.lights.size(), 1000U);
    EXPECT_EQ(scene.lights[0].name, "lamp");
    EXPECT_EQ(scene.lights[1].name, "lamp 2");
    EXPECT_EQ(scene.lights[999].name, "lamp 1000");
}

TEST(Camera, DepthIsReversedAndYPointsDown) {
    Camera camera;
    camera.position_ws = vec3(1, 2, 3);
    camera.near = 0.1F;
    camera.far = 100.0F;
    camera.yfov = 1.0F;
    const mat4 cs_from_ws = cs_from_vs(camera, 2.0F) * vs_from_ws(camera);
    const vec4 near = cs_from_ws * vec4(1, 2, 3 - 0.1F, 1);
    const vec4 far = cs_from_ws * vec4(1, 2, 3 - 100.0F, 1);
    EXPECT_NEAR(near.z / near.w, 1.0F, 1e-5F);
    EXPECT_NEAR(far.z / far.w, 0.0F, 1e-6F);
    EXPECT_FLOAT_EQ(far.w, 100.0F);

    // The top edge of the picture lies at half the field of view; the right edge at twice that slope.
    const float slope = std::tan(0.5F);
    const vec4 top = cs_from_ws * vec4(1, 2 + 10 * slope, 3 - 10, 1);
    EXPECT_NEAR(top.y / top.w, -1.0F, 1e-5F);
    const vec4 right = cs_from_ws * vec4(1 + 20 * slope, 2, 3 - 10, 1);
    EXPECT_NEAR(right.x / right.w, 1.0F, 1e-5F);
}

TEST(Camera, LooksTheSameWayWhereverItStands) {
    Camera home;
    home.forward_ws = glm::normalize(vec3(0.3F, -0.4F, -0.8F));
    const mat4 at_home = vs_from_ws(home);
    for (const float far : {1e3F, 1e6F, 1e7F, 1e9F}) {
        Camera away = home;
        away.position_ws = vec3(far, 0.5F * far, -far);
        const mat4 there = vs_from_ws(away);
        for (int column = 0; column < 3; ++column) {
            EXPECT_EQ(vec3(there[column]), vec3(at_home[column])) << far;
        }
        // The camera stands at its own zero, but for the rounding of the matrix: half a unit of each of its terms.
        EXPECT_LT(glm::length(dvec3(glm::dmat4(there) * dvec4(dvec3(away.position_ws), 1.0))), 4e-7 * double(far));
    }
}

/// A triangle a million times as far away as the scene is large.
void add_stray(Scene& scene, vec3 at) {
    const auto first = static_cast<uint>(scene.positions_ws.size());
    scene.positions_ws.insert(scene.positions_ws.end(), {at, at + vec3(0, 1, 0), at + vec3(0, 0, 1)});
    scene.triangles.emplace_back(first, first + 1, first + 2);
}

TEST(Camera, ARangeChosenForTheSceneIgnoresStrays) {
    for (const bool given : {false, true}) {
        Scene plain = cube(vec3(3, 1, 2), 0.5F);
        if (given) {
            plain.cameras.push_back({.position_ws = vec3(3, 1, 5), .near = 0, .far = 0});
        }
        Scene with_stray = plain;
        add_stray(with_stray, vec3(3, 1, -1e6F));
        finish_scene(plain);
        finish_scene(with_stray);
        const Camera& expected = plain.cameras[0];
        const Camera& camera = with_stray.cameras[0];
        EXPECT_EQ(camera.position_ws, expected.position_ws);
        EXPECT_EQ(camera.near, expected.near);
        EXPECT_EQ(camera.far, expected.far);
        EXPECT_EQ(with_stray.bounds_ws.min.z, -1e6F);
        // The camera that looks at the stray cannot show it, and says so; the default one looks elsewhere.
        EXPECT_EQ(has_note(with_stray, "1 triangle in its view"), given);
        EXPECT_FALSE(has_note(plain, "in its view"));
    }
}

TEST(Camera, AChosenRangeCutsNothingOffInAWideWorld) {
    // A ground of 100 km; the camera stands 3 m before a box, 40 km from the middle.
    Scene scene = cube(vec3(40'000, 1, 0), 1.0F);
    scene.positions_ws.insert(scene.positions_ws.end(),
                              {vec3(-5e4F, 0, -5e4F), vec3(-5e4F, 0, 5e4F), vec3(5e4F, 0, 5e4F), vec3(5e4F, 0, -5e4F)});
    scene.triangles.insert(scene.triangles.end(), {uvec3(8, 9, 10), uvec3(8, 10, 11)});
    scene.cameras.push_back({.position_ws = vec3(40'000, 1.7F, 4), .near = 0, .far = 0});
    finish_scene(scene);
    const Camera& camera = scene.cameras[0];
    EXPECT_LT(camera.near, 0.8F * 3.0F) << "the box's front; the ground at the picture's lower edge is 3.5 m away";
    EXPECT_GT(camera.far, 1e5F);
    EXPECT_FALSE(has_note(scene, "in its view"));
}

TEST(Camera, AGivenFarPlaneThatCutsTheViewIsSaid) {
    Scene scene = cube(vec3(0), 1.0F);
    scene.cameras.push_back({.name = "short", .position_ws = vec3(0, 0, 5), .near = 0.1F, .far = 4.5F});
    scene.cameras.push_back({.name = "long", .position_ws = vec3(0, 0, 5), .near = 0.1F, .far = 50});
    scene.cameras.push_back(
        {.name = "away", .position_ws = vec3(0, 0, 5), .forward_ws = vec3(0, 0, 1), .near = 0.1F, .far = 4.5F});
    finish_scene(scene);
    EXPECT_TRUE(has_note(scene, "Camera 'short' sees to 4.5 m"));
    EXPECT_FALSE(has_note(scene, "'long'"));
    EXPECT_FALSE(has_note(scene, "'away'"));
}

TEST(Camera, ChosenRangesScaleWithTheScene) {
    const auto range_of = [](float scale) {
        Scene scene = cube(vec3(0), scale);
        scene.cameras.push_back({.position_ws = scale * vec3(0, 0, 3), .near = 0, .far = 0});
        finish_scene(scene);
        return std::array{scene.cameras[0].near / scale, scene.cameras[0].far / scale,
                          glm::length(scene.cameras[1].position_ws) / scale, scene.cameras[1].far / scale};
    };
    for (const float scale : {1e-7F, 1e-4F, 1e4F, 1e7F}) {
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_NEAR(range_of(scale)[i], range_of(1)[i], 1e-4F * range_of(1)[i]) << scale << ", value " << i;
        }
    }
}

TEST(LoadScene, UnknownNamesAndFilesAreOneSentence) {
    EXPECT_NE(error_of("no-such-scene"), "");
    EXPECT_NE(error_of("no/such.glb").find("no such file"), std::string::npos);
    EXPECT_NE(error_of("/dev/zero").find("are not read"), std::string::npos);
    const TempFolder folder;
    EXPECT_NE(error_of(folder.path().string()), "");
    std::filesystem::create_directory(folder.path() / "a.glb");
    EXPECT_NE(error_of((folder.path() / "a.glb").string()).find("not a plain file"), std::string::npos);
    EXPECT_NE(error_of(folder.write("a.xyz", "x")).find("known are .glb"), std::string::npos);
}

TEST(LoadScene, FormatsThroughAssimp) {
    const TempFolder folder;
    const Scene scene = load_scene(folder.write(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    ASSERT_EQ(scene.triangles.size(), 1U);
    EXPECT_GT(winding(scene, 0).z, 0.0F);
    EXPECT_NE(error_of(folder.write("b.ply", "ply\nnonsense")), "");
}

}  // namespace
}  // namespace gn::finish_test
