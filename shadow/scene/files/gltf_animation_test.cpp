// SPDX-License-Identifier: MIT
// Files that move: made here, with positions that were worked out by hand.
#include "shadow/scene/bent_column.h"
#include "shadow/scene/rig.h"
#include "shadow/scene/testing.h"

#include <functional>

namespace gn::gltf_animation_test {
namespace {

using namespace testing_scene;

AnimatedScene load(const std::string& text) {
    const TempFolder folder;
    return load_animated_scene(folder.write("a.gltf", text));
}

vec3 corner(const Scene& scene, std::size_t triangle, int slot) {
    return scene.positions_ws[scene.triangles.at(triangle)[slot]];
}

void expect_at(vec3 found, vec3 wanted) {
    EXPECT_LT(glm::distance(found, wanted), 1e-5F) << found.x << " " << found.y << " " << found.z;
}

constexpr float s = 0.70710678F;

/// A triangle on a node that stands at x = 10 and turns by a quarter about z within a second.
GltfText turning() {
    GltfText gltf;
    gltf.add_points(triangle);
    gltf.add(std::vector<float>{0, 1}, "SCALAR", 5126, 2);
    gltf.add(std::vector<float>{0, 0, 0, 1, 0, 0, s, s}, "VEC4", 5126, 2);
    gltf.nodes = R"({"mesh":0,"translation":[10,0,0]})";
    gltf.more = R"("animations":[{"name":"turn","samplers":[{"input":1,"output":2}],
        "channels":[{"sampler":0,"target":{"node":0,"path":"rotation"}}]}],)";
    return gltf;
}

TEST(GltfAnimation, ANodeTurnsAQuarter) {
    AnimatedScene loaded = load(turning().text());
    Scene& scene = loaded.scene;
    const Scene rest = scene;
    EXPECT_TRUE(has_note(scene, "1 animation ('turn' of 1 s)"));
    EXPECT_EQ(find_animation(loaded.rig, "turn"), find_animation(loaded.rig, "1"));
    EXPECT_TRUE(pose_scene(scene, loaded.rig, 0, 1).empty());
    const vec3 at = vec3(scene.origin);
    expect_at(corner(scene, 0, 0) + at, {10, 0, 0});
    expect_at(corner(scene, 0, 1) + at, {10, 1, 0});
    expect_at(corner(scene, 0, 2) + at, {9, 0, 0});
    expect_at(scene.objects[0].bounds_ws.min + at, {9, 0, 0});
    EXPECT_NE(scene.objects[0].version, rest.objects[0].version);
    for (int slot = 0; slot < 3; ++slot) {
        const dvec4 from(dvec3(corner(rest, 0, slot)), 1);
        expect_at(vec3(scene.objects[0].now_from_first * from), corner(scene, 0, slot));
    }
    // Half of it is half of the angle; without an animation all is as it was, to the bit.
    pose_scene(scene, loaded.rig, 0, 0.5);
    expect_at(corner(scene, 0, 1) + at, {10 + s, s, 0});
    pose_scene(scene, loaded.rig, std::nullopt, 0.5);
    EXPECT_EQ(scene.positions_ws, rest.positions_ws);
    EXPECT_EQ(scene.objects[0].bounds_ws.max, rest.objects[0].bounds_ws.max);
    EXPECT_EQ(scene.objects[0].now_from_first, dmat4(1));
}

TEST(GltfAnimation, NormalsAndChildrenTurnAlong) {
    GltfText gltf = turning();
    const int normals = gltf.add(std::vector<float>{s, s, 0, s, s, 0, s, s, 0}, "VEC3", 5126, 3);
    gltf.primitives = fmt::format(R"({{"attributes":{{"POSITION":0,"NORMAL":{}}}}})", normals);
    // Flattened to a quarter along x, its oblique normal leans to x, (1, 1/4); the turn brings that to (-1/4, 1).
    gltf.nodes = R"({"translation":[10,0,0],"children":[1]},{"mesh":0,"translation":[1,0,0],"scale":[0.25,1,1]})";
    AnimatedScene loaded = load(gltf.text());
    pose_scene(loaded.scene, loaded.rig, 0, 1);
    expect_at(corner(loaded.scene, 0, 1) + vec3(loaded.scene.origin), {10, 1.25F, 0});
    expect_at(loaded.scene.normals_ws[loaded.scene.triangles[0].y], glm::normalize(vec3(-0.25F, 1, 0)));
}

TEST(GltfAnimation, LampsAndCamerasMoveWithTheirNode) {
    GltfText gltf = turning();
    gltf.nodes = R"({"mesh":0,"children":[1,2]},
        {"translation":[0,2,0],"extensions":{"KHR_lights_punctual":{"light":0}}},{"camera":0,"translation":[3,0,0]})";
    gltf.more += R"("extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[
        {"type":"spot","intensity":5,"spot":{"outerConeAngle":0.5}}]}},
        "cameras":[{"type":"perspective","perspective":{"yfov":0.8,"znear":0.1,"zfar":10}}],)";
    AnimatedScene loaded = load(gltf.text());
    Scene& scene = loaded.scene;
    const Light rest = scene.lights.at(0);
    pose_scene(scene, loaded.rig, 0, 1);
    const vec3 at = vec3(scene.origin);
    expect_at(vec3(scene.lights[0].shape.position_ws) + at, {-2, 0, 0});
    expect_at(vec3(scene.lights[0].shape.direction_ws), {0, 0, -1});
    expect_at(scene.cameras.at(0).position_ws + at, {0, 3, 0});
    expect_at(scene.cameras[0].up_ws, {-1, 0, 0});
    EXPECT_FLOAT_EQ(scene.lights[0].shape.radius, rest.shape.radius);
    pose_scene(scene, loaded.rig, std::nullopt, 0);
    EXPECT_EQ(scene.lights[0].shape.position_ws, rest.shape.position_ws);
}

TEST(GltfAnimation, ASkinBendsByItsJoints) {
    AnimatedScene loaded = load(testing_scene::bent_column());
    Scene& scene = loaded.scene;
    const Scene rest = scene;
    pose_scene(scene, loaded.rig, find_animation(loaded.rig, "bend"), 1);
    // About (0, 1.2) by a quarter: (x, y) becomes (1.2 - y, 1.2 + x); the ring between is the mean of that and of itself.
    std::size_t moved = 0;
    for (std::size_t v = 0; v < rest.positions_ws.size(); ++v) {
        const vec3 p = rest.positions_ws[v] + vec3(rest.origin);
        const vec3 turned(1.2F - p.y, 1.2F + p.x, p.z);
        const bool ground = p.y < 0.1F, lower = p.y<0.3F, upper = p.y> 2.1F;
        const vec3 wanted = ground || lower ? p : upper ? turned : 0.5F * (p + turned);
        expect_at(scene.positions_ws[v] + vec3(scene.origin), wanted);
        moved += wanted != p ? 1 : 0;
    }
    EXPECT_GE(moved, 8U);
    // The top, whose normal was y, now looks along -x: also where vertices were split for their normals.
    std::size_t tops = 0;
    for (std::size_t v = 0; v < rest.positions_ws.size(); ++v) {
        if (rest.positions_ws[v].y + rest.origin.y > 2.1 && rest.normals_ws[v].y > 0.9F) {
            expect_at(scene.normals_ws[v], {-1, 0, 0});
            ++tops;
        }
    }
    EXPECT_GE(tops, 4U);
    EXPECT_EQ(scene.objects.at(0).version, rest.objects[0].version) << "the ground stands still";

    // The other animation moves it whole.
    pose_scene(scene, loaded.rig, find_animation(loaded.rig, "slide"), 1);
    for (const uvec3 t : std::span(scene.triangles).subspan(2)) {
        expect_at(scene.positions_ws[t.x], rest.positions_ws[t.x] + vec3(0.5F, 0, 0));
    }
}

TEST(GltfAnimation, PlacedTwiceBothMoveWhereTheyStand) {
    const TempFolder folder;
    folder.write("a.gltf", turning().text());
    const std::string scene_file = folder.write(
        "two.toml", "[[file]]\npath = \"a.gltf\"\n[[file]]\npath = \"a.gltf\"\ntranslate = [0, 5, 0]\nscale = 2\n");
    AnimatedScene loaded = load_animated_scene(scene_file);
    Scene& scene = loaded.scene;
    ASSERT_EQ(loaded.rig.animations.size(), 1U);
    pose_scene(scene, loaded.rig, 0, 1);
    expect_at(corner(scene, 0, 1) + vec3(scene.origin), {10, 1, 0});
    expect_at(corner(scene, 1, 1) + vec3(scene.origin), {20, 7, 0});
}

TEST(GltfAnimation, WhatCannotBePlayedIsSaidAndStandsAtRest) {
    const auto with = [](const std::function<void(GltfText&)>& spoil) {
        GltfText gltf = turning();
        spoil(gltf);
        const AnimatedScene loaded = load(gltf.text());
        EXPECT_FALSE(loaded.rig.moves());
        EXPECT_EQ(loaded.scene.triangles.size(), 1U);
        std::string notes;
        for (const std::string& note : loaded.scene.notes) {
            notes += note + "\n";
        }
        return notes;
    };
    const auto times = [](GltfText& gltf, const std::vector<float>& t) {
        const int accessor = gltf.add(t, "SCALAR", 5126, t.size());
        gltf.more.replace(gltf.more.find("\"input\":1"), 9, fmt::format("\"input\":{}", accessor));
    };
    const auto swap = [](GltfText& gltf, const std::string& from, const std::string& to) {
        gltf.more.replace(gltf.more.find(from), from.size(), to);
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto expect = [&](const char* part, const std::function<void(GltfText&)>& spoil) {
        const std::string notes = with(spoil);
        EXPECT_NE(notes.find(part), std::string::npos) << part << " in " << notes;
        EXPECT_NE(notes.find("is not played"), std::string::npos) << notes;
    };
    expect("times are finite and grow", [&](GltfText& g) { times(g, {0, nan}); });
    expect("times are finite and grow", [&](GltfText& g) { times(g, {1, 1}); });
    expect("times are finite and grow", [&](GltfText& g) { times(g, {1, 0.5F}); });
    expect("2 values", [&](GltfText& g) { times(g, {0, 1, 2}); });
    expect("does not exist", [&](GltfText& g) { swap(g, "\"input\":1", "\"input\":99"); });
    expect("holds no times", [&](GltfText& g) { swap(g, "\"input\":1", "\"input\":2"); });
    expect("values of 3 numbers", [&](GltfText& g) { swap(g, "\"output\":2", "\"output\":0"); });
    expect("6 of 4 are needed",
           [&](GltfText& g) { swap(g, "\"output\":2", R"("output":2,"interpolation":"CUBICSPLINE")"); });
    expect("'WILD' is not known",
           [&](GltfText& g) { swap(g, "\"output\":2", R"("output":2,"interpolation":"WILD")"); });
    expect("'pointer' is not moved", [&](GltfText& g) { swap(g, "rotation", "pointer"); });
    expect("node 7 does not exist", [&](GltfText& g) { swap(g, "\"node\":0", "\"node\":7"); });
    expect("sampler 3 does not exist", [&](GltfText& g) { swap(g, "\"sampler\":0", "\"sampler\":3"); });
    expect("has a matrix", [](GltfText& g) { g.nodes = R"({"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,10,0,0,1]})"; });
    expect("is not finite", [&](GltfText& g) {
        const int accessor = g.add(std::vector<float>{0, 0, 0, 1, 0, nan, s, s}, "VEC4", 5126, 2);
        swap(g, "\"output\":2", fmt::format("\"output\":{}", accessor));
    });
    // Four thousand million zeros take neither memory nor time, and an empty list is none.
    for (const char* count : {"4294967295", "0"}) {
        const std::string notes = with([&](GltfText& g) {
            g.accessors += fmt::format(R"(,{{"componentType":5126,"type":"SCALAR","count":{}}})", count);
            swap(g, "\"input\":1", "\"input\":3");
        });
        EXPECT_NE(notes.find("is not played"), std::string::npos) << notes;
    }
}

TEST(GltfAnimation, JointsThatAreNotThereEndInASentence) {
    const TempFolder folder;
    std::string text = testing_scene::bent_column();
    text.replace(text.find("\"joints\":[2,3]"), 14, "\"joints\":[2,9]");
    EXPECT_NE(error_of(folder.write("a.gltf", text)).find("node 9 does not exist"), std::string::npos);
}

TEST(GltfAnimation, WhatWouldLeaveTheNumbersStays) {
    GltfText gltf = turning();
    const int far = gltf.add(std::vector<float>{0, 0, 0, 3e38F, 0, 0}, "VEC3", 5126, 2);
    gltf.more = fmt::format(R"("animations":[{{"samplers":[{{"input":1,"output":{}}}],
        "channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}]}}],)",
                            far);
    AnimatedScene loaded = load(gltf.text());
    const std::vector<vec3> before = loaded.scene.positions_ws;
    const std::vector<std::string> remarks = pose_scene(loaded.scene, loaded.rig, 0, 1);
    ASSERT_EQ(remarks.size(), 1U);
    EXPECT_NE(remarks[0].find("beyond 1e9 m"), std::string::npos);
    EXPECT_EQ(loaded.scene.positions_ws, before);
    EXPECT_EQ(loaded.scene.objects[0].now_from_first, dmat4(1));
    EXPECT_THROW(find_animation(loaded.rig, "walk"), Error);
    EXPECT_EQ(find_animation(loaded.rig, "animation 1"), 0U);
}

}  // namespace
}  // namespace gn::gltf_animation_test
