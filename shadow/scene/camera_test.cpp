// SPDX-License-Identifier: MIT
// Cameras whose rays run side by side, and how near a camera's picture begins.
#include "shadow/scene/testing.h"

namespace gn::camera_test {
namespace {

using namespace testing_scene;

Scene load(const GltfText& gltf) {
    const TempFolder folder;
    return load_scene(folder.write("a.gltf", gltf.text()));
}

TEST(Orthographic, EveryDistanceIsSeenAtTheSameSize) {
    Camera camera;
    camera.position_ws = vec3(1, 2, 3);
    camera.half_height = 2;
    camera.near = 0.5F;
    camera.far = 20;
    const mat4 cs_from_ws = cs_from_vs(camera, 1.5F) * vs_from_ws(camera);
    for (const float distance : {0.5F, 4.0F, 20.0F}) {
        // The upper right corner of the picture, 2 m above the axis and 3 m beside it.
        const vec4 p_cs = cs_from_ws * vec4(1 + 3, 2 + 2, 3 - distance, 1);
        EXPECT_EQ(p_cs.w, 1.0F);
        EXPECT_NEAR(p_cs.x, 1.0F, 1e-6F) << distance;
        EXPECT_NEAR(p_cs.y, -1.0F, 1e-6F) << distance;
        EXPECT_NEAR(p_cs.z, (20 - distance) / 19.5F, 1e-6F) << "1 at the near plane, 0 at the far plane";
    }
    // A shift moves the picture right and down, as it does in perspective.
    camera.shift_cs = vec2(0.25F, -0.125F);
    const vec4 moved = cs_from_vs(camera, 1.5F) * vs_from_ws(camera) * vec4(1, 2, -5, 1);
    EXPECT_NEAR(moved.x, 0.25F, 1e-6F);
    EXPECT_NEAR(moved.y, -0.125F, 1e-6F);
}

TEST(Orthographic, IsReadFromGltf) {
    GltfText gltf;
    gltf.add_points(triangle);
    gltf.nodes = R"({"mesh":0},{"name":"plan","camera":0,"translation":[0,1,4]},{"name":"broken","camera":1})";
    gltf.scene = R"("scenes":[{"nodes":[0,1,2]}],)";
    gltf.more = R"("cameras":[{"type":"orthographic","orthographic":{"xmag":3,"ymag":2,"znear":0,"zfar":50}},
        {"type":"orthographic","orthographic":{"xmag":0,"ymag":0,"znear":0.1,"zfar":5}}],)";
    const Scene scene = load(gltf);
    const Camera& plan = scene.camera("plan");
    EXPECT_EQ(plan.half_height, 2.0F);
    EXPECT_EQ(plan.position_ws, vec3(0, 1, 4));
    EXPECT_EQ(plan.far, 50.0F);
    EXPECT_TRUE(plan.near > 0.0F && plan.near < 1e-4F) << "zero is allowed here; depth begins a hair before the camera";
    EXPECT_FALSE(has_note(scene, "'plan'"));
    EXPECT_TRUE(has_note(scene, "Camera 'broken'"));
    EXPECT_TRUE(std::isfinite(scene.camera("broken").half_height));
}

TEST(Orthographic, IsReadFromToml) {
    const TempFolder folder;
    const Scene scene = load_scene(folder.write("s.toml", R"(
[[camera]]
name = "plan"
position = [0, 5, 0]
direction = [0, -1, 0]
up = [0, 0, -1]
half_height = 3
[[path]]
name = "over"
[[path.key]]
position = [0, 5, 0]
direction = [0, -1, 0]
half_height = 3
[[path.key]]
frame = 2
position = [2, 5, 0]
half_height = 1
)"));
    EXPECT_EQ(scene.camera("plan").half_height, 3.0F);
    ASSERT_EQ(scene.paths.size(), 1U);
    EXPECT_EQ(scene.paths[0].frames.at(1).half_height, 2.0F);
    const std::vector<std::pair<std::string, std::string>> mistakes{
        {"[[camera]]\nhalf_height = -1\n", "key 'half_height' must be 0 or more"},
        {"[[camera]]\nhalf_height = 1\nyfov_deg = 40\n", "key 'yfov_deg' must be absent where half_height is given"},
        {"[[path]]\n[[path.key]]\nhalf_height = 1\n[[path.key]]\nframe = 3\nhalf_height = 0\n",
         "key 'half_height' must be above 0 in all keys of a path or in none"}};
    for (const auto& [text, expected] : mistakes) {
        const std::string error = error_of(folder.write("m.toml", text));
        EXPECT_NE(error.find(expected), std::string::npos) << error;
    }
}

TEST(Orthographic, AMovedModelTakesItsCameraAlong) {
    const TempFolder folder;
    GltfText gltf;
    gltf.add_points(triangle);
    gltf.nodes = R"({"mesh":0},{"name":"plan","camera":0,"translation":[0,1,4]})";
    gltf.scene = R"("scenes":[{"nodes":[0,1]}],)";
    gltf.more = R"("cameras":[{"type":"orthographic","orthographic":{"xmag":3,"ymag":2,"znear":1,"zfar":50}}],)";
    folder.write("a.gltf", gltf.text());
    const Scene scene = load_scene(folder.write("s.toml", "[[file]]\npath = \"a.gltf\"\nscale = 10\n"));
    EXPECT_FLOAT_EQ(scene.camera("plan").half_height, 20.0F);
    EXPECT_FLOAT_EQ(scene.camera("plan").far, 500.0F);
}

TEST(Orthographic, ARangeIsChosenForAllThatItSees) {
    Scene scene = cube(vec3(0), 1.0F);
    scene.cameras.push_back({.name = "plan", .position_ws = vec3(0, 0, 1.01F), .half_height = 3, .near = 0, .far = 0});
    scene.cameras.push_back(
        {.name = "short", .position_ws = vec3(0, 0, 5), .half_height = 3, .near = 0.1F, .far = 4.5F});
    scene.cameras.push_back(
        {.name = "wide", .position_ws = vec3(6, 0, 5), .half_height = 6, .near = 0.1F, .far = 4.5F});
    scene.cameras.push_back(
        {.name = "beside", .position_ws = vec3(7, 0, 5), .half_height = 3, .near = 0.1F, .far = 4.5F});
    finish_scene(scene);
    EXPECT_LT(scene.cameras[0].near, 0.01F);
    EXPECT_GT(scene.cameras[0].far, 2.01F);
    EXPECT_TRUE(has_note(scene, "Camera 'short' sees to 4.5 m"));
    EXPECT_TRUE(has_note(scene, "Camera 'wide' sees to 4.5 m"));
    EXPECT_FALSE(has_note(scene, "Camera 'beside'")) << "the cube lies beside the picture at every distance";
}

TEST(Camera, AChosenRangeIsThatOfThePicturesOwnShape) {
    // A post at the border of a wide picture, nearer than anything that a square one shows.
    const auto near_plane = [](float aspect) {
        Scene scene = cube(vec3(0, 0, -1000), 500.0F);
        const auto first = static_cast<uint>(scene.positions_ws.size());
        scene.positions_ws.insert(scene.positions_ws.end(),
                                  {vec3(-0.2F, -0.01F, -0.3F), vec3(-0.2F, 0.01F, -0.3F), vec3(-0.22F, 0, -0.3F)});
        scene.triangles.emplace_back(first, first + 1, first + 2);
        scene.cameras.push_back({.position_ws = vec3(0), .near = 0, .far = 0});
        finish_scene(scene, {.aspect = aspect});
        return scene.cameras[0].near;
    };
    EXPECT_LT(near_plane(16.0F / 9), 0.3F);
    EXPECT_EQ(near_plane(1), near_plane(0.5F)) << "a square picture does not show the post";
    EXPECT_GT(near_plane(1), near_plane(16.0F / 9));
}

TEST(Camera, ARangeThatCannotBeIsChosenForAllThatIsSeen) {
    const auto range = [](const char* lines) {
        const TempFolder folder;
        folder.write("a.obj", "v -5 0 5\nv 5 0 5\nv 5 0 -5\nv -5 0 -5\nf 1 2 3 4\n");
        const Scene scene = load_scene(folder.write(
            "s.toml",
            fmt::format("[[file]]\npath = 'a.obj'\n[[camera]]\nposition = [0, 3, 6]\nlook_at = [0, 0, 0]\n{}", lines)));
        EXPECT_EQ(has_note(scene, "had no usable depth range"), std::string_view(lines) != "") << lines;
        return vec2(scene.cameras.at(0).near, scene.cameras.at(0).far);
    };
    const vec2 chosen = range("");
    // The far plane before the near one, and a near plane behind everything: neither may cut the picture.
    EXPECT_EQ(range("near = 100\nfar = 1\n"), chosen);
    EXPECT_EQ(range("near = 100\n"), chosen);
}

}  // namespace
}  // namespace gn::camera_test
