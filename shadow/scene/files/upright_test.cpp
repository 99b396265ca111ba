// SPDX-License-Identifier: MIT
// Models whose up is z: stood up where that is asked for, pointed out where it shows.
#include "shadow/scene/testing.h"

namespace gn::upright_test {
namespace {

using namespace testing_scene;

struct Corner {
    double x, y, z;
};

// The six sides of a box, facing outwards; its first vertex is `first`.
std::string box(Corner low, Corner high, int first = 1) {
    std::string text;
    for (int i = 0; i < 8; ++i) {
        text += fmt::format("v {} {} {}\n", (i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                            (i & 4) != 0 ? high.z : low.z);
    }
    for (const std::array<int, 4>& f : std::initializer_list<std::array<int, 4>>{
             {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
        text += fmt::format("f {} {} {} {}\n", f[0] + first, f[1] + first, f[2] + first, f[3] + first);
    }
    return text;
}

// A floor plate of 8 x 8 with two boxes on it; `up` is the axis that the plate faces.
std::string room(int up) {
    return up == 2
               ? box({-4, -4, -0.1}, {4, 4, 0}, 1) + box({-1, -1, 0}, {1, 1, 2}, 9) + box({2, 2, 0}, {2.5, 2.5, 1}, 17)
               : box({-4, -0.1, -4}, {4, 0, 4}, 1) + box({-1, 0, -1}, {1, 2, 1}, 9) +
                     box({2, 0, -2.5}, {2.5, 1, -2}, 17);
}

// A cone on its flat foot.
std::string cone(int up) {
    std::string text;
    const auto vertex = [&](double east, double north, double height) {
        text += up == 2 ? fmt::format("v {} {} {}\n", east, north, height)
                        : fmt::format("v {} {} {}\n", east, height, -north);
    };
    constexpr int sides = 24;
    for (int i = 0; i < sides; ++i) {
        vertex(std::cos(6.283185307 * i / sides), std::sin(6.283185307 * i / sides), 0);
    }
    vertex(0, 0, 2);
    std::string foot;
    for (int i = 0; i < sides; ++i) {
        text += fmt::format("f {} {} {}\n", i + 1, (i + 1) % sides + 1, sides + 1);
        foot = fmt::format(" {}", i + 1) + foot;
    }
    return text + "f" + foot + "\n";
}

TEST(Upright, AModelOnItsSideIsPointedOut) {
    const TempFolder folder;
    EXPECT_TRUE(has_note(load_scene(folder.write("z.obj", room(2))), "lie on its side"));
    EXPECT_FALSE(has_note(load_scene(folder.write("y.obj", room(1))), "lie on its side"));
    EXPECT_TRUE(has_note(load_scene(folder.write("z.obj", room(2))), "--up z"));
    // A floor is what looks up, whether or not it has an underside.
    std::string open = room(2);
    const std::string underside = "f 1 3 4 2\n";
    open.erase(open.find(underside), underside.size());
    EXPECT_TRUE(has_note(load_scene(folder.write("open.obj", open)), "lie on its side"));
    // A triangle, a wall and a box say nothing about where their up is.
    EXPECT_FALSE(has_note(load_scene(folder.write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")), "side"));
    EXPECT_FALSE(has_note(load_scene(folder.write("wall.obj", box({-2, 0, -0.1}, {2, 3, 0.1}))), "side"));
    EXPECT_FALSE(has_note(load_scene(folder.write("box.obj", box({-1, 0, -1}, {1, 3, 1}))), "side"));
}

TEST(Upright, FeetSayWhereAModelStands) {
    const TempFolder folder;
    // A pyramid on three points.
    EXPECT_TRUE(
        has_note(load_scene(folder.write("p.obj",
                                         "v -1 -0.6 0\nv 1 -0.6 0\nv 0 1 0\nv 0 0 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\nv 0 -1 "
                                         "1\nf 1 5 2\n")),
                 "lie on its side"));
    EXPECT_TRUE(has_note(load_scene(folder.write("z.obj", cone(2))), "lie on its side"));
    EXPECT_FALSE(has_note(load_scene(folder.write("y.obj", cone(1))), "lie on its side"));
}

TEST(Upright, ItIsStoodUpWhereAskedFor) {
    const TempFolder folder;
    const std::string lying = folder.write("z.obj", room(2));
    const Scene stood = load_scene(lying, {.up = UpAxis::z});
    const Scene upright = load_scene(folder.write("y.obj", room(1)));
    EXPECT_EQ(stood.bounds_ws.min, upright.bounds_ws.min);
    EXPECT_EQ(stood.bounds_ws.max, upright.bounds_ws.max);
    EXPECT_FALSE(has_note(stood, "side"));
    const Scene placed = load_scene(folder.write("a.toml", "[[file]]\npath = \"z.obj\"\nup = \"z\"\n"));
    EXPECT_EQ(placed.bounds_ws.max, upright.bounds_ws.max);
    // Whoever has said it is told nothing; a scene as a whole is turned with its lights and cameras.
    EXPECT_FALSE(has_note(placed, "side"));
    const std::string lit = folder.write("lit.toml",
                                         "[[file]]\npath = \"z.obj\"\n[[light]]\nkind = \"directional\"\n"
                                         "direction = [0, 0, -1]\n[[camera]]\nposition = [0, -9, 3]\n"
                                         "direction = [0, 1, 0]\nup = [0, 0, 1]\n");
    const Scene whole = load_scene(lit, {.up = UpAxis::z});
    EXPECT_EQ(vec3(whole.lights.at(0).shape.direction_ws), vec3(0, -1, 0));
    EXPECT_EQ(whole.camera("main").position_ws, vec3(0, 3, 9));
    EXPECT_EQ(whole.camera("main").forward_ws, vec3(0, 0, -1));
    EXPECT_NE(error_of(folder.write("b.toml", "[[file]]\npath = \"z.obj\"\nup = \"w\"\n")).find("'up'"),
              std::string::npos);
}

}  // namespace
}  // namespace gn::upright_test
