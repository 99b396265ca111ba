// SPDX-License-Identifier: MIT
// EXT_texture_webp: the mask is read, and where it is damaged its loss is said.
#include "base/image.h"
#include "shadow/scene/testing.h"

#include <webp/encode.h>

namespace gn::gltf_webp_test {
namespace {

using namespace testing_scene;

// A checkerboard of `alpha` and 200, of one grey.
std::string webp(int side, std::uint8_t alpha, bool lossy = false) {
    std::vector<std::uint8_t> rgba(static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * 4, 200);
    for (std::size_t i = 3; i < rgba.size(); i += 8) {
        rgba[i] = alpha;
    }
    std::uint8_t* packed = nullptr;
    const std::size_t size = lossy ? WebPEncodeRGBA(rgba.data(), side, side, 4 * side, 90, &packed)
                                   : WebPEncodeLosslessRGBA(rgba.data(), side, side, 4 * side, &packed);
    std::string bytes(reinterpret_cast<const char*>(packed), size);
    WebPFree(packed);
    return bytes;
}

GltfText textured(const TempFolder& folder, const std::string& picture) {
    folder.write("leaf.webp", picture);
    GltfText gltf;
    gltf.add_points(triangle);
    gltf.add(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2", 5126, 3);
    gltf.primitives = R"({"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0})";
    gltf.more = R"("extensionsUsed":["EXT_texture_webp"],"images":[{"uri":"leaf.webp"}],
        "textures":[{"extensions":{"EXT_texture_webp":{"source":0}}}],
        "materials":[{"name":"leaf","alphaMode":"MASK","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)";
    return gltf;
}

TEST(GltfWebp, PicturesAndTheirMasksAreRead) {
    for (const bool lossy : {false, true}) {
        const TempFolder folder;
        const Scene scene = load_scene(folder.write("a.gltf", textured(folder, webp(8, 0, lossy)).text()));
        ASSERT_EQ(scene.textures.size(), 1U) << (scene.notes.empty() ? "" : scene.notes[0]);
        EXPECT_EQ(scene.textures[0].image.width, 8);
        EXPECT_EQ(scene.textures[0].image.height, 8);
        EXPECT_EQ(scene.textures[0].image.rgba[3], 0);
        EXPECT_EQ(scene.textures[0].image.rgba[7], 200) << "alpha is stored without loss";
        EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
    }
}

TEST(GltfWebp, DamagedOnesAreSaidAndTheOtherPictureIsTaken) {
    const TempFolder folder;
    const std::string good = webp(8, 0);
    const Scene cut = load_scene(folder.write("a.gltf", textured(folder, good.substr(0, good.size() / 2)).text()));
    EXPECT_TRUE(has_note(cut, "'leaf' has lost its mask"));

    GltfText both = textured(folder, good.substr(0, 20));
    const std::vector<std::byte> png = encode_png(Image(2, 2, 4, 0.5F));
    folder.write("leaf.png", {reinterpret_cast<const char*>(png.data()), png.size()});
    const auto replace = [&](std::string_view from, std::string_view to) {
        both.more.replace(both.more.find(from), from.size(), to);
    };
    replace(R"([{"uri":"leaf.webp"}])", R"([{"uri":"leaf.webp"},{"uri":"leaf.png"}])");
    replace(R"("textures":[{)", R"("textures":[{"source":1,)");
    const Scene scene = load_scene(folder.write("b.gltf", both.text()));
    EXPECT_EQ(scene.textures.size(), 1U);
    EXPECT_TRUE(has_note(scene, "leaf.webp"));
    EXPECT_TRUE(has_note(scene, "'leaf.png' is taken instead"));
    EXPECT_FALSE(has_note(scene, "plain colour"));
    EXPECT_FALSE(has_note(scene, "lost its mask"));
}

TEST(GltfWebp, DamageEndsInASentence) {
    const std::string good = webp(16, 0);
    std::uint32_t state = 3;
    for (int round = 0; round < 200; ++round) {
        std::string bad = good;
        for (int flip = 0; flip < 2; ++flip) {
            state = state * 1664525U + 1013904223U;
            bad[(state >> 8U) % bad.size()] ^= static_cast<char>(1U << (state >> 29U));
        }
        try {
            decode_image(std::as_bytes(std::span(bad)), "leaf");
        } catch (const Error& problem) {
            EXPECT_EQ(std::string(problem.what()).find("leaf: "), 0U);
        }
    }
}

}  // namespace
}  // namespace gn::gltf_webp_test
