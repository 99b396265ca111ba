// SPDX-License-Identifier: MIT
// Morph targets whose weights are animated: made here, with positions that were worked out by hand.
#include "shadow/scene/bent_column.h"
#include "shadow/scene/rig.h"
#include "shadow/scene/testing.h"

#include <functional>

namespace gn::gltf_weights_test {
namespace {

using namespace testing_scene;

AnimatedScene load(const std::string& text) {
    const TempFolder folder;
    return load_animated_scene(folder.write("a.gltf", text));
}

std::string notes_of(const Scene& scene) {
    return fmt::format("{}", fmt::join(scene.notes, "\n"));
}

void expect_at(vec3 found, vec3 wanted) {
    EXPECT_LT(glm::distance(found, wanted), 1e-5F) << found.x << " " << found.y << " " << found.z;
}

std::string sparse(int indices_view, int values_view) {
    return fmt::format(R"(,"sparse":{{"count":1,"indices":{{"bufferView":{},"componentType":5123}},)"
                       R"("values":{{"bufferView":{}}}}})",
                       indices_view, values_view);
}

/// A unit square in the plane z = 0 at x = 10. Target 0 lifts all of it by 2, target 1, a sparse accessor, pulls the corner
/// (1, 1) by (3, 0, 1). Accessors, each with a view of the same number: 0 corners, 1 and 2 indices and values of the sparse
/// one, 3 and 4 the targets.
GltfText morphing() {
    GltfText gltf;
    gltf.add_points(square);
    gltf.add(std::vector<std::uint16_t>{3}, "SCALAR", 5123, 1);
    gltf.add_points({3, 0, 1});
    gltf.add_points({0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2});
    gltf.add(std::vector<float>(12, 0.0F), "VEC3", 5126, 4, sparse(1, 2).c_str());
    gltf.primitives = R"({"mode":5,"attributes":{"POSITION":0},"targets":[{"POSITION":3},{"POSITION":4}]})";
    gltf.nodes = R"({"mesh":0,"translation":[10,0,0]})";
    return gltf;
}

/// Adds an animation of its weights: times, and all values of a key together. Returns the accessor of the values.
int animate(GltfText& gltf, const std::vector<float>& times, const std::vector<float>& values,
            const char* interpolation = "LINEAR") {
    const int input = gltf.add(times, "SCALAR", 5126, times.size());
    const int output = gltf.add(values, "SCALAR", 5126, values.size());
    gltf.more +=
        fmt::format(R"("animations":[{{"name":"pull","samplers":[{{"input":{},"output":{},"interpolation":"{}"}}],
        "channels":[{{"sampler":0,"target":{{"node":0,"path":"weights"}}}}]}}],)",
                    input, output, interpolation);
    return output;
}

std::string animated(GltfText gltf, const std::vector<float>& times, const std::vector<float>& values,
                     const char* interpolation = "LINEAR") {
    animate(gltf, times, values, interpolation);
    return gltf.text();
}

/// The corners, in the world and in the file's order.
std::vector<vec3> corners(const Scene& scene) {
    std::vector<vec3> found{scene.positions_ws[scene.triangles.at(0).x], scene.positions_ws[scene.triangles[0].y],
                            scene.positions_ws[scene.triangles[0].z], scene.positions_ws[scene.triangles.at(1).z]};
    for (vec3& p : found) {
        p += vec3(scene.origin);
    }
    return found;
}

/// Where they are with two weights.
void expect_weights(const Scene& scene, double w, double v) {
    const auto lift = static_cast<float>(2 * w);
    const auto pull = static_cast<float>(v);
    const std::vector<vec3> found = corners(scene);
    expect_at(found[0], {10, 0, lift});
    expect_at(found[1], {11, 0, lift});
    expect_at(found[2], {10, 1, lift});
    expect_at(found[3], vec3(11, 1, lift) + pull * vec3(3, 0, 1));
}

TEST(GltfWeights, AQuadMovesByItsWeightTimesTheTarget) {
    AnimatedScene loaded = load(animated(morphing(), {1, 3}, {0, 0, 1, 0}));
    Scene& scene = loaded.scene;
    const Scene rest = scene;
    EXPECT_TRUE(has_note(scene, "1 animation ('pull' of 3 s)")) << notes_of(scene);
    for (const double w : {0.0, 0.25, 0.5, 1.0}) {
        EXPECT_TRUE(pose_scene(scene, loaded.rig, 0, 1 + 2 * w).empty());
        expect_weights(scene, w, 0);
        const Object& object = scene.objects.at(0);
        const auto lift = static_cast<float>(2 * w);
        expect_at(object.bounds_ws.min + vec3(scene.origin), {10, 0, lift});
        expect_at(object.bounds_ws.max + vec3(scene.origin), {11, 1, lift});
        EXPECT_EQ(scene.bounds_ws.max, object.bounds_ws.max);
        // All of it goes one way, so that the mean motion is its own.
        expect_at(vec3(object.now_from_first * dvec4(dvec3(rest.positions_ws[0]), 1)),
                  rest.positions_ws[0] + vec3(0, 0, lift));
    }
    EXPECT_EQ(scene.objects[0].version, rest.objects[0].version + 3) << "weights of 0 at first move nothing";
    pose_scene(scene, loaded.rig, std::nullopt, 0);
    EXPECT_EQ(scene.positions_ws, rest.positions_ws);
    EXPECT_EQ(scene.normals_ws, rest.normals_ws);
    EXPECT_EQ(scene.objects[0].bounds_ws.max, rest.objects[0].bounds_ws.max);
}

TEST(GltfWeights, EveryTargetHasItsCurve) {
    // Those of a key lie together; steps stand.
    AnimatedScene loaded = load(animated(morphing(), {0, 1}, {1, -0.5F, 0.5F, 2}));
    pose_scene(loaded.scene, loaded.rig, 0, 0.5);
    expect_weights(loaded.scene, 0.75, 0.75);
    loaded = load(animated(morphing(), {0, 1}, {1, -0.5F, 0.5F, 2}, "STEP"));
    pose_scene(loaded.scene, loaded.rig, 0, 0.99);
    expect_weights(loaded.scene, 1, -0.5);

    // Of a spline: tangents that arrive of both, values of both, tangents that leave of both. Both are cubics here.
    const auto p = [](double t) { return 2 * t * t * t - t * t + 3 * t + 1; };
    const auto p_slope = [](double t) { return 6 * t * t - 2 * t + 3; };
    const auto q = [](double t) { return t * t - 2; };
    const auto q_slope = [](double t) { return 2 * t; };
    const std::vector<float> times{0.5F, 1, 1.5F};
    std::vector<float> values;
    for (const float t : times) {
        // Another tangent arrives than leaves where nothing reads it.
        const float a = t == times.front() ? 9.0F : 0.0F, b = t == times.back() ? 9.0F : 0.0F;
        for (const double value : {p_slope(t) + a, q_slope(t) + a, p(t), q(t), p_slope(t) + b, q_slope(t) + b}) {
            values.push_back(static_cast<float>(value));
        }
    }
    loaded = load(animated(morphing(), times, values, "CUBICSPLINE"));
    for (const double t : {0.5, 0.6, 0.99, 1.0, 1.3, 1.5}) {
        pose_scene(loaded.scene, loaded.rig, 0, t);
        expect_weights(loaded.scene, p(t), q(t));
    }
}

TEST(GltfWeights, AtRestTheyAreTheNodesOrElseTheMeshes) {
    GltfText gltf = morphing();
    gltf.primitives += R"(],"weights":[0.5,0)";
    gltf.nodes = R"({"mesh":0,"translation":[10,0,0]},{"mesh":0,"weights":[0,1],"translation":[10,0,0]})";
    gltf.scene = R"("scenes":[{"nodes":[0,1]}],)";
    AnimatedScene loaded = load(animated(gltf, {0, 1}, {0, 0, 1, 0}));
    const Scene rest = loaded.scene;
    expect_weights(rest, 0.5, 0);
    pose_scene(loaded.scene, loaded.rig, 0, 1);
    expect_weights(loaded.scene, 1, 0);
    // The other node has no channel: it shows the same mesh by its own weights.
    const auto second = [](const Scene& scene) { return scene.positions_ws[scene.triangles.at(3).z]; };
    expect_at(second(loaded.scene) + vec3(rest.origin), {14, 1, 1});
    EXPECT_EQ(loaded.scene.objects.at(1).version, rest.objects[1].version);
    pose_scene(loaded.scene, loaded.rig, std::nullopt, 0);
    EXPECT_EQ(loaded.scene.positions_ws, rest.positions_ws);
}

/// Every triangle's corners and their normals, in the world.
std::vector<vec3> drawn(const Scene& scene) {
    std::vector<vec3> found;
    for (const uvec3 t : scene.triangles) {
        for (int slot = 0; slot < 3; ++slot) {
            found.push_back(scene.positions_ws[t[slot]] + vec3(scene.origin));
            found.push_back(scene.normals_ws[t[slot]]);
        }
    }
    return found;
}

TEST(GltfWeights, APosedSceneIsTheFileWithTheseWeights) {
    const auto expect_same = [](const std::string& text, const std::string& node, const std::string& name) {
        AnimatedScene posed = load(text);
        pose_scene(posed.scene, posed.rig, find_animation(posed.rig, name), 1);
        std::string weighted = text;
        weighted.replace(weighted.find(node), node.size(), node + R"(,"weights":[1,0.5])");
        const std::vector<vec3> found = drawn(posed.scene), wanted = drawn(load(weighted).scene);
        ASSERT_EQ(found.size(), wanted.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            expect_at(found[i], wanted[i]);
        }
    };
    // Normals of faces, which fold; mirrored, and on bones.
    const std::string node = R"("mesh":0,"translation":[10,0,0])";
    const std::vector<float> pull{0, 0, 1, 0.5F};
    expect_same(animated(morphing(), {0, 1}, pull), node, "pull");
    GltfText mirrored = morphing();
    const std::string mirror = R"("mesh":0,"scale":[-1,2,1])";
    mirrored.nodes = "{" + mirror + "}";
    expect_same(animated(mirrored, {0, 1}, pull), mirror, "pull");
    expect_same(bent_column(true), R"("mesh":1,"skin":0)", "lean");

    // Normals of the file, which target 0 turns towards x.
    for (GltfText given : {morphing(), mirrored}) {
        const int normals = given.add_points({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
        const int turns = given.add_points({1, 0, -1, 1, 0, 0, 0, 0, 0, 1, 0, 0});
        given.primitives = fmt::format(R"({{"mode":5,"attributes":{{"POSITION":0,"NORMAL":{}}},)"
                                       R"("targets":[{{"POSITION":3,"NORMAL":{}}},{{"POSITION":4}}]}})",
                                       normals, turns);
        expect_same(animated(given, {0, 1}, pull), given.nodes.substr(1, given.nodes.size() - 2), "pull");
    }
}

TEST(GltfWeights, BonesMoveWhatTheTargetsHaveMoved) {
    AnimatedScene loaded = load(bent_column(true));
    Scene& scene = loaded.scene;
    const Scene rest = scene;
    // Both at once, as one animation: a quarter about (0, 1.2) takes (x, y) to (1.2 - y, 1.2 + x).
    loaded.rig.animations.at(0).channels.insert(loaded.rig.animations[0].channels.end(),
                                                loaded.rig.animations.at(2).channels.begin(),
                                                loaded.rig.animations[2].channels.end());
    pose_scene(scene, loaded.rig, find_animation(loaded.rig, "bend"), 1);
    std::size_t tops = 0;
    for (std::size_t v = 0; v < rest.positions_ws.size(); ++v) {
        const vec3 p = rest.positions_ws[v] + vec3(rest.origin);
        if (p.y > 2.1F) {
            expect_at(scene.positions_ws[v] + vec3(scene.origin), {1.2F - (p.y + 0.2F), 1.2F + p.x + 0.6F, p.z});
            ++tops;
        }
    }
    EXPECT_GE(tops, 8U);
}

TEST(GltfWeights, PlacedTwiceBothMorphWhereTheyStand) {
    const TempFolder folder;
    folder.write("a.gltf", animated(morphing(), {0, 1}, {0, 0, 1, 0}));
    const std::string file = folder.write(
        "two.toml", "[[file]]\npath = \"a.gltf\"\n[[file]]\npath = \"a.gltf\"\ntranslate = [0, 5, 0]\nscale = 2\n");
    AnimatedScene loaded = load_animated_scene(file);
    pose_scene(loaded.scene, loaded.rig, 0, 1);
    expect_weights(loaded.scene, 1, 0);
    expect_at(loaded.scene.positions_ws[loaded.scene.triangles.at(2).x] + vec3(loaded.scene.origin), {20, 5, 4});
}

TEST(GltfWeights, WhatCannotBePlayedIsSaid) {
    const auto expect = [](const char* part, const std::string& text) {
        const AnimatedScene loaded = load(text);
        EXPECT_FALSE(loaded.rig.moves()) << part;
        EXPECT_NE(notes_of(loaded.scene).find(part), std::string::npos) << part << " in " << notes_of(loaded.scene);
        EXPECT_NE(notes_of(loaded.scene).find("is not played"), std::string::npos);
    };
    expect("2 keys of 2 morph targets take 4 of 1", animated(morphing(), {0, 1}, {0, 0, 1}));
    expect("2 keys of 2 morph targets take 12 of 1", animated(morphing(), {0, 1}, {0, 0, 1, 0}, "CUBICSPLINE"));
    expect("is not finite", animated(morphing(), {0, 1}, {0, 0, std::numeric_limits<float>::infinity(), 0}));
    expect("times are finite and grow", animated(morphing(), {1, 1}, {0, 0, 1, 0}));
    GltfText plain = morphing();
    plain.primitives = R"({"mode":5,"attributes":{"POSITION":0}})";
    expect("node 0 has no mesh with morph targets", animated(plain, {0, 1}, {0, 0, 1, 0}));
    GltfText bare = morphing();
    bare.nodes = R"({"children":[1]},{"mesh":0,"translation":[10,0,0]})";
    expect("node 0 has no mesh with morph targets", animated(bare, {0, 1}, {0, 0, 1, 0}));
}

TEST(GltfWeights, ABrokenTargetIsLeftOutAndSaid) {
    const auto expect = [](const char* part, const std::function<std::string(GltfText&)>& target) {
        GltfText gltf = morphing();
        const std::string broken = target(gltf);
        gltf.primitives =
            fmt::format(R"({{"mode":5,"attributes":{{"POSITION":0}},"targets":[{},{{"POSITION":4}}]}})", broken);
        AnimatedScene loaded = load(animated(gltf, {0, 1}, {0, 0, 1, 1}));
        EXPECT_NE(notes_of(loaded.scene).find(part), std::string::npos) << part << " in " << notes_of(loaded.scene);
        // The other one moves as ever.
        pose_scene(loaded.scene, loaded.rig, 0, 1);
        expect_weights(loaded.scene, 0, 1);
    };
    expect("Morph target 1 of mesh '' is left out: ", [](GltfText&) { return R"({"POSITION":99})"; });
    expect("holds 1 numbers a vertex", [](GltfText&) { return R"({"POSITION":1})"; });
    expect("overrides element 9 of 4", [](GltfText& gltf) {
        const int nine = gltf.add(std::vector<std::uint16_t>{9}, "SCALAR", 5123, 1);
        return fmt::format(R"({{"POSITION":{}}})",
                           gltf.add(std::vector<float>(12, 0.0F), "VEC3", 5126, 4, sparse(nine, 2).c_str()));
    });
    expect("of vertex 2 is not finite", [](GltfText& gltf) {
        const float nan = std::numeric_limits<float>::quiet_NaN();
        return fmt::format(R"({{"POSITION":{}}})", gltf.add_points({0, 0, 2, 0, 0, 2, 0, nan, 2, 0, 0, 2}));
    });
}

TEST(GltfWeights, HostileSizesTakeNeitherMemoryNorTime) {
    // Four thousand million zeros as values: their number is not that of the keys.
    GltfText zeros = morphing();
    const int output = animate(zeros, {0, 1}, {0, 0, 1, 0});
    zeros.accessors += R"(,{"componentType":5126,"type":"SCALAR","count":4294967295})";
    const std::string was = fmt::format("\"output\":{}", output);
    zeros.more.replace(zeros.more.find(was), was.size(), fmt::format("\"output\":{}", output + 1));
    EXPECT_NE(notes_of(load(zeros.text()).scene).find("4294967295 values of 1"), std::string::npos);

    // As many displacements, of which the mesh uses four.
    GltfText many = morphing();
    const int last = animate(many, {0, 1}, {0, 0, 1, 1});
    many.accessors += R"(,{"componentType":5126,"type":"VEC3","count":4294967295})";
    many.primitives = fmt::format(
        R"({{"mode":5,"attributes":{{"POSITION":0}},"targets":[{{"POSITION":{}}},{{"POSITION":4}}]}})", last + 1);
    AnimatedScene still = load(many.text());
    pose_scene(still.scene, still.rig, 0, 1);
    expect_weights(still.scene, 0, 1);

    // More weights than a person could see: 1,100,000 by two channels of one curve.
    std::string targets = R"({"POSITION":3})";
    for (int i = 1; i < 1100; ++i) {
        targets += R"(,{"POSITION":3})";
    }
    GltfText wide = morphing();
    wide.primitives = fmt::format(R"({{"mode":5,"attributes":{{"POSITION":0}},"targets":[{}]}})", targets);
    std::string played = animated(wide, {0}, std::vector<float>(1100, 0.0F));
    const std::string channel = R"({"sampler":0,"target":{"node":0,"path":"weights"}})";
    std::string channels = channel;
    for (int i = 1; i < 1000; ++i) {
        channels += "," + channel;
    }
    played.replace(played.find(channel), channel.size(), channels);
    EXPECT_NE(notes_of(load(played).scene).find("move more than 1048576 weights"), std::string::npos);
}

TEST(GltfWeights, WhatWouldLeaveTheNumbersStays) {
    AnimatedScene loaded = load(animated(morphing(), {0, 1}, {0, 0, 3e38F, 0}));
    const std::vector<vec3> before = loaded.scene.positions_ws;
    const std::vector<std::string> remarks = pose_scene(loaded.scene, loaded.rig, 0, 1);
    ASSERT_EQ(remarks.size(), 1U);
    EXPECT_NE(remarks[0].find("beyond 1e9 m"), std::string::npos);
    EXPECT_EQ(loaded.scene.positions_ws, before);
}

}  // namespace
}  // namespace gn::gltf_weights_test
