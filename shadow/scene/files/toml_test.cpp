// SPDX-License-Identifier: MIT
#include "shadow/scene/emission.h"
#include "shadow/scene/testing.h"

namespace gn::toml_test {
namespace {

using namespace testing_scene;

constexpr std::string_view corner = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST(Toml, PlacesFilesLightsAndCameras) {
    const TempFolder folder;
    folder.write("parts/a.obj", corner);
    const Scene scene = load_scene(folder.write("s.toml", R"(
[[file]]
path = "parts/a.obj"
scale = 2
rotate = [0, 0, 90]
translate = [10, 0, 0]
[[file]]
path = "parts/a.obj"
scale = [1, 1, -1]
quaternion = [0, 0, 0, 1]
[[light]]
kind = "rectangle"
name = "window"
position = [0, 3, 0]
look_at = [0, 0, 0]
size = [2, 1]
intensity = 5000
color = [1, 0.9, 0.8]
[[light]]
kind = "spot"
position = [1, 1, 1]
direction = [0, -2, 0]
inner_deg = 20
outer_deg = 30
radius = 0.1
range = 7
[[light]]
kind = "directional"
direction = [1, -1, 0]
angular_radius_deg = 0.2665
[[camera]]
name = "front"
position = [0, 1, 5]
look_at = [0, 1, 0]
yfov_deg = 40
near = 0.5
far = 60
)"));
    // (1,0,0) scaled by 2 and turned by 90 degrees about z lies at (0,2,0), moved to (10,2,0).
    ASSERT_EQ(scene.triangles.size(), 2U);
    EXPECT_LT(glm::distance(scene.positions_ws[scene.triangles[0].y], vec3(10, 2, 0)), 1e-5F);
    ASSERT_EQ(scene.lights.size(), 3U);
    const GnLight& window = scene.lights[0].shape;
    EXPECT_EQ(scene.lights[0].name, "window");
    EXPECT_EQ(window.kind, static_cast<uint>(GN_LIGHT_RECTANGLE));
    EXPECT_EQ(window.half_size, vec2(1.0F, 0.5F));
    EXPECT_EQ(vec3(window.direction_ws), vec3(0, -1, 0));
    EXPECT_FLOAT_EQ(window.intensity, 5000.0F);
    EXPECT_FLOAT_EQ(scene.lights[1].shape.cos_outer, std::cos(30.0F * pi / 180.0F));
    EXPECT_FLOAT_EQ(scene.lights[1].shape.radius, 0.1F);
    EXPECT_FLOAT_EQ(scene.lights[1].shape.range, 7.0F);
    EXPECT_FLOAT_EQ(scene.lights[2].shape.angular_radius, 0.2665F * pi / 180.0F);
    const Camera& front = scene.camera("front");
    EXPECT_EQ(front.forward_ws, vec3(0, 0, -1));
    EXPECT_FLOAT_EQ(front.yfov, 40.0F * pi / 180.0F);
    EXPECT_FLOAT_EQ(front.near, 0.5F);
    EXPECT_FLOAT_EQ(front.far, 60.0F);
}

TEST(Toml, ALightsCookieIsATextureOfItsOwn) {
    const TempFolder folder;
    const auto mistake = [&](const std::string& text) {
        try {
            static_cast<void>(load_scene(folder.write("c.toml", text)));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(mistake("[[light]]\nkind = \"rectangle\"\nsize = [1, 1]\ncookie = \"leaf.png\"\n")
                  .find("rays from a rectangle cross"),
              std::string::npos);
    EXPECT_NE(mistake("[[light]]\nkind = \"spot\"\nouter_deg = 95\ncookie = \"leaf.png\"\n").find("no narrower"),
              std::string::npos);
    EXPECT_NE(mistake("[[light]]\nkind = \"directional\"\ncookie = \"leaf.png\"\n").find("leaf.png"),
              std::string::npos);
    EXPECT_NE(mistake("[[light]]\nkind = \"spot\"\ncookie = \"leaf.png\"\n").find("leaf.png"), std::string::npos);
}

TEST(Toml, ARectangleShowsAPicture) {
    const TempFolder folder;
    const auto mistake = [&](const std::string& text) {
        try {
            static_cast<void>(load_scene(folder.write("t.toml", text)));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(mistake("[[light]]\nkind = \"spot\"\ntexture = \"panel.png\"\n").find("is of rectangles"),
              std::string::npos);
    EXPECT_NE(mistake("[[light]]\nkind = \"rectangle\"\nsize = [1, 1]\ntexture = \"panel.png\"\n").find("panel.png"),
              std::string::npos);

    Image panel(2, 1, 3, 0);
    panel.at(1, 0, 2) = 1;  // black, and blue on the right
    write_png(folder.path() / "panel.png", panel);
    const Scene scene = load_scene(folder.write(
        "good.toml",
        "[[light]]\nkind = \"rectangle\"\nsize = [1, 1]\ntexture = \"panel.png\"\n[[light]]\nkind = \"point\"\n"));
    const Image8* const picture = shown_picture(scene, scene.lights[0].shape);
    ASSERT_NE(picture, nullptr);
    EXPECT_EQ(mean_emission(*picture), vec3(0, 0, 0.5F));
    EXPECT_EQ(emission_at(*picture, vec2(0.9F, 0.5F)), vec3(0, 0, 1));
    EXPECT_EQ(shown_picture(scene, scene.lights[1].shape), nullptr);
}

TEST(Toml, PathsInterpolateTheirKeys) {
    const TempFolder folder;
    const Scene scene = load_scene(folder.write("s.toml", R"(
[[path]]
name = "walk"
[[path.key]]
position = [0, 1, 0]
look_at = [0, 1, -1]
[[path.key]]
frame = 4
position = [4, 1, 0]
look_at = [5, 1, 0]
)"));
    ASSERT_EQ(scene.paths.size(), 1U);
    ASSERT_EQ(scene.paths[0].frames.size(), 5U);
    const Camera& half = scene.paths[0].frames[2];
    EXPECT_FLOAT_EQ(half.position_ws.x, 2.0F);
    EXPECT_NEAR(half.forward_ws.x, std::sqrt(0.5F), 1e-6F);
    EXPECT_NEAR(half.forward_ws.z, -std::sqrt(0.5F), 1e-6F);
    EXPECT_GT(half.far, half.near);
}

TEST(Toml, MistakesAreNamedWithTheirPlace) {
    const TempFolder folder;
    folder.write("a.obj", corner);
    const std::vector<std::pair<std::string, std::string>> cases{
        {"[[lihgt]]\nkind = \"spot\"\n",
         "unknown key 'lihgt'; known are file, object, light, environment, camera, path"},
        {"[[light]]\nkind = \"spot\"\nsize2 = 1\n", "[[light]] 1: unknown key 'size2'; known are kind, name"},
        {"[[light]]\nkind = \"moon\"\n", "key 'kind' must be directional, spot, point or rectangle"},
        {"[[light]]\nkind = \"point\"\nradius = -1\n", "key 'radius' must be 0 or more"},
        {"[[light]]\nkind = \"point\"\nposition = [1, nan, 2]\n", "key 'position' must be a list of 3 finite numbers"},
        {"[[light]]\nkind = \"rectangle\"\n", "a rectangle needs size"},
        {"[[camera]]\nlook_at = [0, 0, 0]\n", "key 'look_at' must be a point other than the position"},
        {"[[camera]]\nyfov_deg = 200\n", "key 'yfov_deg' must be between"},
        {"[light]\nkind = \"spot\"\n", "written [[light]]"},
        {"[[path]]\nname = \"p\"\n", "at least one [[path.key]]"},
        {"[[file]]\npath = \"b.obj\"\n", "no such file"},
        {"[[file]]\npath = \"../b.obj\"\n", "outside the model's folder"},
        {"[[file]]\npath = \"s.toml\"\n", "files of type '.toml' are not read"},
        {"[[file]]\n", "not a file name"},
        {"[[file]\n", "line 1"}};
    for (const auto& [text, expected] : cases) {
        const std::string error = error_of(folder.write("s.toml", text));
        EXPECT_NE(error.find(expected), std::string::npos) << text << "\n" << error;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
}

TEST(Toml, LinksDoNotLeadOutOfTheFolder) {
    const TempFolder folder;
    folder.write("a.obj", corner);
    std::filesystem::create_directory(folder.path() / "scene");
    std::filesystem::create_symlink(folder.path() / "a.obj", folder.path() / "scene/link.obj");
    EXPECT_NE(error_of(folder.write("scene/s.toml", "[[file]]\npath = \"link.obj\"\n")), "");
}

}  // namespace
}  // namespace gn::toml_test
