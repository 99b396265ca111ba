// SPDX-License-Identifier: MIT
// EXT_meshopt_compression: what comes out is what went in, and no damage does worse than a sentence.
#include "shadow/scene/testing.h"

#include <meshoptimizer.h>

namespace gn::gltf_meshopt_test {
namespace {

using namespace testing_scene;

const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
const std::vector<std::uint32_t> faces{0, 1, 2, 2, 1, 3};

template <class T>
std::string packed_vertices(const std::vector<T>& values, std::size_t stride) {
    const std::size_t count = values.size() * sizeof(T) / stride;
    std::string bytes(meshopt_encodeVertexBufferBound(count, stride), '\0');
    bytes.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(), values.data(),
                                            count, stride));
    return bytes;
}

std::string packed_indices(const std::vector<std::uint32_t>& indices, bool triangles = true) {
    const std::size_t count = indices.size();
    std::string bytes(meshopt_encodeIndexBufferBound(count, 1000) + meshopt_encodeIndexSequenceBound(count, 1000),
                      '\0');
    auto* out = reinterpret_cast<unsigned char*>(bytes.data());
    bytes.resize(triangles ? meshopt_encodeIndexBuffer(out, bytes.size(), indices.data(), count)
                           : meshopt_encodeIndexSequence(out, bytes.size(), indices.data(), count));
    return bytes;
}

/// A view and the accessor that reads it.
struct PackedView {
    std::string bytes;
    std::size_t stride;
    std::string count;
    const char* mode;
    const char* filter;
    const char* accessor;  ///< without its view
};

PackedView positions(const std::string& bytes, const char* count = "4", const char* filter = "NONE") {
    return {bytes, 12, count, "ATTRIBUTES", filter, R"("componentType":5126,"type":"VEC3","count":4)"};
}
PackedView triangles(const std::string& bytes, const char* count = "6", const char* mode = "TRIANGLES") {
    return {bytes, 4, count, mode, "NONE", R"("componentType":5125,"type":"SCALAR","count":6)"};
}

/// The file's JSON: the second buffer holds nothing, as its extension says.
struct PackedFile {
    std::string data, views, accessors;
    std::string attributes = R"("POSITION":0)", name = "EXT_meshopt_compression", node;
    int indices = 1;

    PackedFile(std::initializer_list<PackedView> list) {
        std::size_t unpacked = 0;
        for (const PackedView& v : list) {
            const char* comma = views.empty() ? "" : ",";
            const std::string stride = v.mode[0] == 'A' ? fmt::format(R"("byteStride":{},)", v.stride) : "";
            views += fmt::format(
                R"({}{{"buffer":1,"byteOffset":{},"byteLength":48,{}"extensions":{{"NAME":{{"buffer":0,
                "byteOffset":{},"byteLength":{},"byteStride":{},"count":{},"mode":"{}","filter":"{}"}}}}}})",
                comma, unpacked, stride, data.size(), v.bytes.size(), v.stride, v.count, v.mode, v.filter);
            accessors += fmt::format(R"({}{{"bufferView":{},{}}})", comma, count++, v.accessor);
            data += v.bytes;
            data.resize((data.size() + 3) / 4 * 4);
            unpacked += 48;
        }
    }

    [[nodiscard]] std::string json(bool embedded) const {
        const std::string uri =
            embedded ? "" : fmt::format(R"(,"uri":"data:application/octet-stream;base64,{}")", base64(data));
        std::string text = fmt::format(
            R"({{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0{}}}],"scenes":[{{"nodes":[0]}}],
            "extensionsUsed":["NAME","KHR_mesh_quantization"],"extensionsRequired":["NAME","KHR_mesh_quantization"],
            "meshes":[{{"primitives":[{{"attributes":{{{}}},"indices":{}}}]}}],"accessors":[{}],"bufferViews":[{}],
            "buffers":[{{"byteLength":{}{}}},{{"byteLength":1000,"extensions":{{"NAME":{{"fallback":true}}}}}}]}})",
            node, attributes, indices, accessors, views, data.size(), uri);
        for (std::size_t at = text.find("\"NAME\""); at != std::string::npos; at = text.find("\"NAME\"")) {
            text.replace(at, 6, "\"" + name + "\"");
        }
        return text;
    }
    /// The same as one binary file.
    [[nodiscard]] std::string glb() const {
        std::string text = json(true);
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const auto word = [](std::size_t value) { return bytes_of(std::vector{static_cast<std::uint32_t>(value)}); };
        return "glTF" + word(2) + word(28 + text.size() + data.size()) + word(text.size()) + "JSON" + text +
               word(data.size()) + std::string("BIN\0", 4) + data;
    }
    int count = 0;
};

Scene load(const PackedFile& file) {
    const TempFolder folder;
    return load_scene(folder.write("a.gltf", file.json(false)));
}

void expect_square(const Scene& scene, float tolerance = 0) {
    ASSERT_EQ(scene.triangles.size(), 2U);
    EXPECT_LE(glm::distance(scene.bounds_ws.min, vec3(0)), tolerance);
    EXPECT_LE(glm::distance(scene.bounds_ws.max, vec3(1, 1, 0)), tolerance);
    EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
}

TEST(GltfMeshopt, VerticesAndIndicesAreUnpacked) {
    expect_square(load({positions(packed_vertices(corners, 12)), triangles(packed_indices(faces))}));
    // As a sequence, as a binary file, and under the later name.
    PackedFile file{positions(packed_vertices(corners, 12)), triangles(packed_indices(faces, false), "6", "INDICES")};
    expect_square(load(file));
    const TempFolder folder;
    expect_square(load_scene(folder.write("a.glb", file.glb())));
    file.name = "KHR_meshopt_compression";
    expect_square(load(file));
}

TEST(GltfMeshopt, QuantizedPositionsGoThroughTheirNode) {
    // Shorts that stand for [0,1] of a node that is scaled by two, then plain ones in units of the node.
    const std::vector<std::uint16_t> half{0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0, 32767, 32767, 0, 0};
    PackedFile file{{packed_vertices(half, 8), 8, "4", "ATTRIBUTES", "NONE",
                     R"("componentType":5123,"normalized":true,"type":"VEC3","count":4)"},
                    triangles(packed_indices(faces))};
    file.node = R"(,"scale":[2,2,2])";
    expect_square(load(file), 3e-5F);
    PackedFile plain{
        {packed_vertices(half, 8), 8, "4", "ATTRIBUTES", "NONE", R"("componentType":5122,"type":"VEC3","count":4)"},
        triangles(packed_indices(faces))};
    plain.node = R"(,"scale":[3.0518509e-5,3.0518509e-5,3.0518509e-5])";
    expect_square(load(plain), 1e-6F);
}

TEST(GltfMeshopt, FiltersAreUndone) {
    // Exponential: a mantissa of 24 bits and an exponent of 8; 1 is 2^22 times 2^-22.
    std::vector<std::uint32_t> words;
    for (const float x : corners) {
        words.push_back(x == 0 ? 0U : 0xEA400000U);
    }
    expect_square(load({positions(packed_vertices(words, 12), "4", "EXPONENTIAL"), triangles(packed_indices(faces))}));

    // Octahedral: (127, 0) with 127 for one is +x, as normalized bytes.
    std::vector<std::int8_t> octahedral;
    for (int i = 0; i < 4; ++i) {
        octahedral.insert(octahedral.end(), {127, 0, 127, 0});
    }
    PackedFile file{positions(packed_vertices(corners, 12)),
                    triangles(packed_indices(faces)),
                    {packed_vertices(octahedral, 4), 4, "4", "ATTRIBUTES", "OCTAHEDRAL",
                     R"("componentType":5120,"normalized":true,"type":"VEC3","count":4)"}};
    file.attributes = R"("POSITION":0,"NORMAL":2)";
    const Scene scene = load(file);
    ASSERT_EQ(scene.triangles.size(), 2U);
    EXPECT_NEAR(scene.normals_ws[scene.triangles[0].x].x, 1.0F, 1e-6F);

    // A turn of no angle for an instance: the largest component, w, is left out.
    const std::vector<std::int16_t> none{0, 0, 0, 3 | 0x7FFC};
    PackedFile turned{positions(packed_vertices(corners, 12)),
                      triangles(packed_indices(faces)),
                      {packed_vertices(none, 8), 8, "1", "ATTRIBUTES", "QUATERNION",
                       R"("componentType":5122,"normalized":true,"type":"VEC4","count":1)"}};
    turned.node = R"(,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"ROTATION":2}}})";
    expect_square(load(turned), 1e-4F);
}

std::string refusal(const PackedFile& file) {
    const TempFolder folder;
    return error_of(folder.write("a.gltf", file.json(false)));
}

TEST(GltfMeshopt, DamageEndsInASentence) {
    const std::string vertices = packed_vertices(corners, 12);
    const std::string indices = packed_indices(faces);
    const auto names = [](const std::string& sentence) {
        return sentence.find("EXT_meshopt_compression of buffer view") != std::string::npos;
    };
    EXPECT_TRUE(names(refusal({positions(vertices.substr(0, vertices.size() / 2)), triangles(indices)})));
    EXPECT_TRUE(names(refusal({positions(vertices), triangles(indices.substr(0, indices.size() / 2))})));
    EXPECT_TRUE(names(refusal({positions(""), triangles(indices)})));
    // What would take gigabytes is refused by the bytes that are there, before anything is allocated.
    const auto refused = [&](const char* vertex_count, const char* index_count, const char* mode) {
        return refusal({positions(vertices, vertex_count), triangles(indices, index_count, mode)}).find("promises");
    };
    EXPECT_NE(refused("300000000", "6", "TRIANGLES"), std::string::npos);
    EXPECT_NE(refused("4", "900000000", "TRIANGLES"), std::string::npos);
    EXPECT_NE(refused("4", "900000000", "INDICES"), std::string::npos);
    for (const char* count : {"-6", "1e300", "7", "6.5", "\"6\""}) {
        EXPECT_TRUE(names(refusal({positions(vertices), triangles(indices, count)}))) << count;
    }
    EXPECT_TRUE(names(refusal({positions(vertices, "4", "QUATERNION"), triangles(indices)})));
    EXPECT_TRUE(names(refusal({positions(vertices, "4", "MAGIC"), triangles(indices)})));
    EXPECT_TRUE(names(refusal({positions(vertices), triangles(indices, "6", "MAGIC")})));
    PackedView odd = positions(vertices);
    odd.stride = 10;
    EXPECT_NE(refusal({odd, triangles(indices)}), "");
    // Fewer elements than the accessor reads.
    EXPECT_NE(refusal({positions(vertices), triangles(packed_indices({0, 1, 2}), "3")}), "");
    // Any flipped bits give a scene or a sentence.
    std::uint32_t state = 7;
    for (int round = 0; round < 100; ++round) {
        std::string bad = round % 2 == 0 ? vertices : indices;
        for (int flip = 0; flip < 3; ++flip) {
            state = state * 1664525U + 1013904223U;
            bad[(state >> 8U) % bad.size()] ^= static_cast<char>(1U << (state >> 29U));
        }
        refusal(round % 2 == 0 ? PackedFile{positions(bad), triangles(indices)}
                               : PackedFile{positions(vertices), triangles(bad)});
    }
}

}  // namespace
}  // namespace gn::gltf_meshopt_test
