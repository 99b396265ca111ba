// SPDX-License-Identifier: MIT
#include "shadow/scene/testing.h"

namespace gn::gltf_test {
namespace {

using namespace testing_scene;

Scene load(const GltfText& gltf) {
    const TempFolder folder;
    return load_scene(folder.write("a.gltf", gltf.text()));
}

std::string refusal(const std::string& text) {
    const TempFolder folder;
    return error_of(folder.write("a.gltf", text));
}

GltfText one_triangle() {
    GltfText gltf;
    gltf.add_points(triangle);
    return gltf;
}

TEST(Gltf, TransformsMultiplyDownTheHierarchy) {
    GltfText gltf = one_triangle();
    gltf.nodes = R"({"translation":[10,0,0],"children":[1]},
        {"rotation":[0,0,0.70710678118654752,0.70710678118654752],"scale":[2,2,2],"mesh":0})";
    const Scene scene = load(gltf);
    // (1,0,0) is scaled to (2,0,0), turned to (0,2,0), moved to (10,2,0).
    ASSERT_EQ(scene.triangles.size(), 1U);
    const vec3 moved = scene.positions_ws[scene.triangles[0].y];
    EXPECT_LT(glm::distance(moved, vec3(10, 2, 0)), 1e-5F) << moved.x << " " << moved.y << " " << moved.z;
}

TEST(Gltf, ANodeIsScaledThenTurnedThenMovedAndAMatrixIsReadByColumns) {
    // A quarter turn about z, unequal scales and a move of one node do not commute: (1,0,0) becomes (3,0,0), (0,3,0), (7,3,0).
    GltfText gltf = one_triangle();
    gltf.nodes =
        R"({"translation":[7,0,0],"rotation":[0,0,0.70710678118654752,0.70710678118654752],"scale":[3,1,1],"mesh":0})";
    const Scene parts = load(gltf);
    EXPECT_LT(glm::distance(parts.positions_ws[parts.triangles[0].y], vec3(7, 3, 0)), 1e-5F);

    // The same as a matrix: the images of x, y and z, then where the origin goes.
    gltf.nodes = R"({"matrix":[0,3,0,0, -1,0,0,0, 0,0,1,0, 7,0,0,1],"mesh":0})";
    const Scene whole = load(gltf);
    EXPECT_LT(glm::distance(whole.positions_ws[whole.triangles[0].y], vec3(7, 3, 0)), 1e-5F);
    EXPECT_LT(glm::distance(whole.positions_ws[whole.triangles[0].z], parts.positions_ws[parts.triangles[0].z]), 1e-5F);
}

TEST(Gltf, InstancesShareAMeshAndStandWhereTheirNodesAre) {
    GltfText gltf = one_triangle();
    gltf.nodes = R"({"mesh":0},{"mesh":0,"translation":[0,0,5]},{"mesh":0,"translation":[0,0,9]})";
    gltf.scene = R"("scenes":[{"nodes":[0,1,2]}],)";
    const Scene scene = load(gltf);
    ASSERT_EQ(scene.objects.size(), 3U);
    EXPECT_EQ(scene.triangles.size(), 3U);
    EXPECT_FLOAT_EQ(scene.objects[2].bounds_ws.min.z, 9.0F);
    EXPECT_EQ(scene.objects[2].first_triangle, 2U);
}

TEST(Gltf, MirroringKeepsTheSideThatFacesOut) {
    GltfText gltf = one_triangle();
    const vec3 plain = winding(load(gltf), 0);
    gltf.nodes = R"({"mesh":0,"scale":[-1,1,1]})";
    const vec3 mirrored = winding(load(gltf), 0);
    // Mirroring in x leaves a face that looks along +z looking along +z.
    EXPECT_GT(plain.z, 0.0F);
    EXPECT_GT(mirrored.z, 0.0F);
}

TEST(Gltf, StripsAndFansWindAsListsDo) {
    GltfText gltf;
    gltf.add_points(square);
    gltf.primitives = R"({"attributes":{"POSITION":0},"mode":5})";
    const Scene strip = load(gltf);
    ASSERT_EQ(strip.triangles.size(), 2U);
    EXPECT_GT(winding(strip, 0).z, 0.0F);
    EXPECT_GT(winding(strip, 1).z, 0.0F);

    GltfText fan;
    fan.add_points({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    fan.primitives = R"({"attributes":{"POSITION":0},"mode":6})";
    const Scene fanned = load(fan);
    ASSERT_EQ(fanned.triangles.size(), 2U);
    EXPECT_GT(winding(fanned, 1).z, 0.0F);
}

TEST(Gltf, LinesAndPointsAreSkippedWithANote) {
    GltfText gltf = one_triangle();
    gltf.primitives = R"({"attributes":{"POSITION":0},"mode":1},{"attributes":{"POSITION":0},"mode":0})";
    const Scene scene = load(gltf);
    EXPECT_TRUE(scene.triangles.empty());
    EXPECT_TRUE(has_note(scene, "lines"));
}

TEST(Gltf, IndicesOfAnySizeAndOutOfRangeOnes) {
    for (const int component : {5121, 5123, 5125}) {
        GltfText gltf;
        gltf.add_points(square);
        const std::vector<std::uint32_t> wide{0, 1, 2, 2, 1, 3, 0, 1, 4};
        if (component == 5121) {
            gltf.add(std::vector<std::uint8_t>(wide.begin(), wide.end()), "SCALAR", component, wide.size());
        } else if (component == 5123) {
            gltf.add(std::vector<std::uint16_t>(wide.begin(), wide.end()), "SCALAR", component, wide.size());
        } else {
            gltf.add(wide, "SCALAR", component, wide.size());
        }
        gltf.primitives = R"({"attributes":{"POSITION":0},"indices":1})";
        const Scene scene = load(gltf);
        EXPECT_EQ(scene.triangles.size(), 2U) << component;
        EXPECT_TRUE(has_note(scene, "Dropped 1 triangles with vertices that are not there")) << component;
    }
}

TEST(Gltf, SparseAccessorsOverrideAndAreChecked) {
    const auto sparse = [](std::uint16_t index) {
        GltfText gltf = one_triangle();
        gltf.add(std::vector<std::uint16_t>{index}, "SCALAR", 5123, 1);
        gltf.add(std::vector<float>{7, 8, 9}, "VEC3", 5126, 1);
        gltf.accessors = R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":3,"sparse":{"count":1,
            "indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":2}}})";
        return gltf;
    };
    const Scene scene = load(sparse(1));
    EXPECT_EQ(scene.positions_ws[scene.triangles[0].y], vec3(7, 8, 9));
    EXPECT_NE(refusal(sparse(3).text()).find("overrides element 3 of 3"), std::string::npos);
}

TEST(Gltf, NormalizedIntegersAndQuantizedPositions) {
    GltfText gltf;
    gltf.add(std::vector<std::int16_t>{0, 0, 0, 0, 300, 0, 0, 0, 0, 300, 0, 0}, "VEC3", 5122, 3);
    gltf.views = R"({"buffer":0,"byteOffset":0,"byteLength":24,"byteStride":8})";
    gltf.add(std::vector<std::uint8_t>{0, 0, 255, 51, 0, 0}, "VEC2", 5121, 3, R"(,"normalized":true)");
    gltf.primitives = R"({"attributes":{"POSITION":0,"TEXCOORD_0":1}})";
    gltf.more = R"("extensionsRequired":["KHR_mesh_quantization"],"extensionsUsed":["KHR_mesh_quantization"],)";
    const Scene scene = load(gltf);
    ASSERT_EQ(scene.triangles.size(), 1U);
    EXPECT_EQ(scene.positions_ws[scene.triangles[0].y], vec3(300, 0, 0));
    EXPECT_EQ(scene.uvs[scene.triangles[0].y], vec2(1.0F, 51.0F / 255.0F));
}

TEST(Gltf, AccessorsThatDoNotFitAreRefused) {
    GltfText gltf = one_triangle();
    gltf.accessors = R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":4})";
    EXPECT_NE(refusal(gltf.text()).find("does not fit"), std::string::npos);
    gltf.accessors = R"({"bufferView":0,"byteOffset":4,"componentType":5126,"type":"VEC3","count":3})";
    EXPECT_NE(refusal(gltf.text()).find("does not fit"), std::string::npos);
    gltf.accessors = R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":1000000000000})";
    EXPECT_NE(refusal(gltf.text()), "");
    // Four thousand million zeros are no reason to reserve memory.
    gltf.accessors = R"({"componentType":5126,"type":"VEC3","count":4000000000})";
    EXPECT_NE(refusal(gltf.text()).find("more than"), std::string::npos);
}

TEST(Gltf, NodesMustFormTrees) {
    GltfText gltf = one_triangle();
    gltf.nodes = R"({"children":[1]},{"children":[0]})";
    EXPECT_NE(refusal(gltf.text()).find("own ancestor"), std::string::npos);
    gltf.nodes = R"({"children":[2]},{"children":[2]},{"mesh":0})";
    EXPECT_NE(refusal(gltf.text()).find("must form trees"), std::string::npos);
    gltf.nodes = R"({"children":[1]},{"mesh":0})";
    gltf.scene = R"("scenes":[{"nodes":[0,1]}],)";
    EXPECT_NE(refusal(gltf.text()).find("reached twice"), std::string::npos);
    gltf.nodes = R"({"children":[5]})";
    EXPECT_NE(refusal(gltf.text()).find("does not exist"), std::string::npos);
}

TEST(Gltf, ADeepChainOfNodesIsNoProblem) {
    GltfText gltf = one_triangle();
    gltf.nodes.clear();
    constexpr int depth = 100'000;
    for (int i = 0; i < depth; ++i) {
        gltf.nodes += fmt::format(R"({{"children":[{}]}},)", i + 1);
    }
    gltf.nodes += R"({"mesh":0})";
    EXPECT_EQ(load(gltf).triangles.size(), 1U);
}

TEST(Gltf, NestedJsonAndWrongTypesAreRefused) {
    GltfText gltf = one_triangle();
    gltf.more = R"("extras":)" + std::string(100'000, '[') + std::string(100'000, ']') + ",";
    EXPECT_NE(refusal(gltf.text()).find("nests deeper"), std::string::npos);
    gltf.more.clear();
    gltf.nodes = R"({"mesh":"0"})";
    EXPECT_NE(refusal(gltf.text()).find("'mesh' cannot be a string"), std::string::npos);
    gltf.nodes = R"({"mesh":0.5})";
    EXPECT_NE(refusal(gltf.text()).find("whole number"), std::string::npos);
    EXPECT_NE(refusal("{\"asset\":").find("not valid JSON"), std::string::npos);
    EXPECT_NE(refusal("").find("empty"), std::string::npos);
}

TEST(Gltf, TooManyTrianglesAfterInstancingAreRefusedBeforeTheyAreMade) {
    // 30 000 triangles in 3 000 nodes: 90 million.
    GltfText gltf;
    std::vector<float> points;
    for (int i = 0; i < 30'000; ++i) {
        points.insert(points.end(), triangle.begin(), triangle.end());
    }
    gltf.add_points(points);
    gltf.nodes.clear();
    std::string roots;
    for (int i = 0; i < 3'000; ++i) {
        gltf.nodes += fmt::format(R"({}{{"mesh":0}})", i > 0 ? "," : "");
        roots += fmt::format("{}{}", i > 0 ? "," : "", i);
    }
    gltf.scene = fmt::format(R"("scenes":[{{"nodes":[{}]}}],)", roots);
    EXPECT_NE(refusal(gltf.text()).find("after instancing"), std::string::npos);
}

TEST(Gltf, FilesOutsideTheFolderAreNeverRead) {
    const TempFolder folder;
    folder.write("secret.bin", bytes_of(triangle));
    folder.write("model/inside.bin", bytes_of(triangle));
    std::filesystem::create_symlink(folder.path() / "secret.bin", folder.path() / "model/link.bin");
    const auto file = [&](const std::string& uri) {
        GltfText gltf = one_triangle();
        gltf.buffer.clear();
        gltf.more = fmt::format(R"("buffers":[{{"byteLength":36,"uri":"{}"}}],)", uri);
        return folder.write("model/a.gltf", gltf.text());
    };
    EXPECT_EQ(error_of(file("inside.bin")), "");
    EXPECT_EQ(error_of(file("./inside%2Ebin")), "");
    for (const std::string& uri :
         {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"), std::string("link.bin"),
          (folder.path() / "secret.bin").string(), std::string("..%2fsecret.bin"), std::string("/dev/zero")}) {
        EXPECT_NE(error_of(file(uri)), "") << uri;
    }
}

TEST(Gltf, SkinnedMeshesStandInTheirRestPose) {
    // The joint stands at (0,5,0) and the bind pose had it at (0,3,0): the mesh moves up by 2, whatever its node says.
    GltfText gltf = one_triangle();
    gltf.add(std::vector<std::uint8_t>(12, 0), "VEC4", 5121, 3);
    gltf.add(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 5126, 3);
    gltf.add(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -3, 0, 1}, "MAT4", 5126, 1);
    gltf.primitives = R"({"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}})";
    gltf.nodes = R"({"mesh":0,"skin":0,"translation":[100,0,0]},{"translation":[0,5,0]})";
    gltf.scene = R"("scenes":[{"nodes":[0,1]}],)";
    gltf.more = R"("skins":[{"joints":[1],"inverseBindMatrices":3}],)";
    const Scene scene = load(gltf);
    ASSERT_EQ(scene.triangles.size(), 1U);
    EXPECT_EQ(scene.positions_ws[scene.triangles[0].y], vec3(1, 2, 0));
}

TEST(Gltf, AFileOfAFewBytesIsCutOff) {
    const TempFolder folder;
    EXPECT_NE(error_of(folder.write("a.glb", "glT")).find("cut off"), std::string::npos);
    EXPECT_NE(error_of(folder.write("b.glb", "")).find("empty"), std::string::npos);
}

}  // namespace
}  // namespace gn::gltf_test
