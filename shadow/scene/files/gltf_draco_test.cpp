// SPDX-License-Identifier: MIT
// KHR_draco_mesh_compression: what comes out is what went in, and no damage does worse than a sentence.
#include "shadow/scene/testing.h"

#include <draco/compression/encode.h>

namespace gn::gltf_draco_test {
namespace {

using namespace testing_scene;

/// A square whose third corner is white and half there; positions have the unique id 0, colours 1.
std::string packed_square(bool sequential) {
    draco::Mesh mesh;
    mesh.set_num_points(4);
    draco::GeometryAttribute positions;
    positions.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
    const int p = mesh.AddAttribute(positions, true, 4);
    draco::GeometryAttribute colors;
    colors.Init(draco::GeometryAttribute::COLOR, nullptr, 4, draco::DT_UINT8, true, 4, 0);
    const int c = mesh.AddAttribute(colors, true, 4);
    for (unsigned v = 0; v < 4; ++v) {
        mesh.attribute(p)->SetAttributeValue(draco::AttributeValueIndex(v), &square[std::size_t{3} * v]);
        const std::array<std::uint8_t, 4> color{255, 255, 255, static_cast<std::uint8_t>(v == 2 ? 128 : 255)};
        mesh.attribute(c)->SetAttributeValue(draco::AttributeValueIndex(v), color.data());
    }
    for (const std::array<unsigned, 3> f : {std::array{0U, 1U, 2U}, std::array{2U, 1U, 3U}}) {
        mesh.AddFace({draco::PointIndex(f[0]), draco::PointIndex(f[1]), draco::PointIndex(f[2])});
    }
    draco::Encoder encoder;
    encoder.SetEncodingMethod(sequential ? draco::MESH_SEQUENTIAL_ENCODING : draco::MESH_EDGEBREAKER_ENCODING);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
    return {buffer.data(), buffer.size()};
}

std::string with_draco(const std::string& packed, int position_id = 0) {
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],"scenes":[{{"nodes":[0]}}],
        "extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"COLOR_0":2}},"indices":1,"extensions":
          {{"KHR_draco_mesh_compression":{{"bufferView":0,"attributes":{{"POSITION":{},"COLOR_0":1}}}}}}}}]}}],
        "accessors":[{{"componentType":5126,"type":"VEC3","count":4}},
                     {{"componentType":5125,"type":"SCALAR","count":6}},
                     {{"componentType":5121,"normalized":true,"type":"VEC4","count":4}}],
        "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{}}}],
        "buffers":[{{"byteLength":{},"uri":"data:application/octet-stream;base64,{}"}}]}})",
        position_id, packed.size(), packed.size(), base64(packed));
}

TEST(GltfDraco, MeshesAreUnpacked) {
    for (const bool sequential : {false, true}) {
        const TempFolder folder;
        const Scene scene = load_scene(folder.write("a.gltf", with_draco(packed_square(sequential))));
        ASSERT_EQ(scene.triangles.size(), 2U);
        EXPECT_EQ(scene.bounds_ws.min, vec3(0));
        EXPECT_EQ(scene.bounds_ws.max, vec3(1, 1, 0));
        float up = 0;
        for (const uvec3 t : scene.triangles) {
            const vec3 a = scene.positions_ws[t.x];
            up += glm::cross(scene.positions_ws[t.y] - a, scene.positions_ws[t.z] - a).z;
        }
        EXPECT_EQ(up, 2.0F) << "both triangles keep their sides";
        ASSERT_EQ(scene.colors.size(), scene.positions_ws.size());
        for (std::size_t v = 0; v < scene.colors.size(); ++v) {
            EXPECT_FLOAT_EQ(scene.colors[v].a, scene.positions_ws[v] == vec3(0, 1, 0) ? 128.0F / 255 : 1.0F);
        }
        EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
    }
}

std::string refusal(const std::string& packed, int position_id = 0) {
    const TempFolder folder;
    return error_of(folder.write("a.gltf", with_draco(packed, position_id)));
}

bool names(const std::string& sentence) {
    return sentence.find("KHR_draco_mesh_compression of buffer view 0") != std::string::npos;
}

std::string varint(std::uint32_t value) {
    std::string bytes;
    for (; value > 127; value >>= 7U) {
        bytes += static_cast<char>(value | 128U);
    }
    return bytes + static_cast<char>(value);
}

TEST(GltfDraco, DamageEndsInASentence) {
    for (const bool sequential : {false, true}) {
        const std::string good = packed_square(sequential);
        EXPECT_TRUE(names(refusal(good, 5)));
        for (std::size_t length = 1; length < good.size(); length += 3) {
            EXPECT_TRUE(names(refusal(good.substr(0, length)))) << length;
        }
        std::uint32_t state = 11;
        for (int round = 0; round < 100; ++round) {
            std::string bad = good;
            for (int flip = 0; flip < 2; ++flip) {
                state = state * 1664525U + 1013904223U;
                bad[(state >> 8U) % bad.size()] ^= static_cast<char>(1U << (state >> 29U));
            }
            refusal(bad);
        }
        // Metadata may nest without end.
        std::string nested = good;
        nested[10] = static_cast<char>(0x80);
        EXPECT_TRUE(names(refusal(nested)));
    }
}

TEST(GltfDraco, PromisesAreNotBelieved) {
    // Tens of megabytes from a hundred bytes: behind the header of 11 bytes stand the kind of traversal, vertices, triangles, the sets of
    // attributes with seams and the symbols; or triangles and points.
    const std::string edgebreaker = packed_square(false);
    const std::string walked = edgebreaker.substr(0, 11) + std::string(1, '\0') + varint(300'000) + varint(600'000) +
                               '\x01' + varint(600'000) + edgebreaker.substr(15);
    EXPECT_NE(refusal(walked).find("promises more than"), std::string::npos) << refusal(walked);
    const std::string listed =
        packed_square(true).substr(0, 11) + varint(600'000) + varint(300'000) + packed_square(true).substr(13);
    EXPECT_NE(refusal(listed).find("promises more than"), std::string::npos) << refusal(listed);
}

}  // namespace
}  // namespace gn::gltf_draco_test
