// SPDX-License-Identifier: MIT
// Memory rows equal the formats' arithmetic: texels x bytes a texel x layers, summed over the levels of a chain.
#include "tests/rig.h"

#include <map>

namespace gn::memory_test {
namespace {

constexpr VkDeviceSize side = 64;

/// Bytes of a square texture.
VkDeviceSize plain(VkDeviceSize bytes_per_texel, VkDeviceSize layers = 1, VkDeviceSize n = side) {
    return n * n * bytes_per_texel * layers;
}

/// The same with all its mip levels.
VkDeviceSize chain(VkDeviceSize bytes_per_texel, VkDeviceSize layers = 1) {
    VkDeviceSize bytes = 0;
    for (VkDeviceSize n = side; n > 0; n /= 2) {
        bytes += plain(bytes_per_texel, layers, n);
    }
    return bytes;
}

struct MemoryCase {
    const char* name;
    const char* recipe;
    std::map<std::string, VkDeviceSize> rows;  ///< textures of the map; the visibility image is the test's own
};

/// A blurred map is drawn at one level, blurred along u, and blurred along v into the chain that is read.
std::map<std::string, VkDeviceSize> blurred(VkDeviceSize bytes_per_texel, VkDeviceSize layers = 1) {
    return {{"map", plain(bytes_per_texel, layers)},
            {"map depth", plain(4, layers)},
            {"map blurred in u", plain(bytes_per_texel, layers)},
            {"map blurred", chain(bytes_per_texel, layers)}};
}

std::map<std::string, VkDeviceSize> with(std::map<std::string, VkDeviceSize> rows, const char* name,
                                         VkDeviceSize bytes) {
    rows[name] = bytes;
    return rows;
}

class Memory : public testing::TestWithParam<MemoryCase> {};

TEST_P(Memory, RowsEqualTheFormatsArithmetic) {
    const test::ValidationGuard guard;
    const Scene scene = load_scene("stack");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const Recipe recipe = load_recipe(fmt::format("{},resolution={}", GetParam().recipe, side));
    const FrameResult frame = render_frame(test::device(), gpu, scene.cameras.front(), recipe,
                                           {.width = 48, .height = 32, .only_light = 0, .picture = false});
    ASSERT_EQ(frame.refused.front(), "");
    std::map<std::string, VkDeviceSize> rows;
    for (const ResourceBytes& resource : frame.statistics.resources) {
        if (resource.group == "shadow") {
            rows[resource.name] += resource.bytes;
        }
    }
    std::map<std::string, VkDeviceSize> expected = GetParam().rows;
    expected["visibility"] = VkDeviceSize{48} * 32 * 4;
    EXPECT_EQ(rows, expected);
}

INSTANTIATE_TEST_SUITE_P(
    Maps, Memory,
    testing::Values(
        MemoryCase{"depth", "hard", {{"map", plain(4)}}},
        MemoryCase{"depth_in_cascades", "pcf,placement=cascades,cascades.count=3", {{"map", plain(4, 3)}}},
        MemoryCase{"vsm", "vsm", blurred(8)},
        MemoryCase{"vsm_unblurred", "vsm,vsm.blur=none", {{"map", chain(8)}, {"map depth", plain(4)}}},
        MemoryCase{"vsm_without_mips", "vsm,vsm.blur=none,vsm.mipmaps=0", {{"map", plain(8)}, {"map depth", plain(4)}}},
        MemoryCase{"vsm_multisampled",
                   "vsm,vsm.blur=none,vsm.samples=4",
                   {{"map samples", 4 * plain(8)}, {"map", chain(8)}, {"map depth", 4 * plain(4)}}},
        MemoryCase{"vsm_in_cascades", "vsm,placement=cascades,cascades.count=2", blurred(8, 2)},
        MemoryCase{"esm", "esm,esm.fallback=0", blurred(4)},
        // The fallback keeps the range of depths under every texel of every level.
        MemoryCase{"esm_with_fallback", "esm", with(blurred(4), "map min max", chain(8))},
        MemoryCase{"evsm2", "evsm2", blurred(8)}, MemoryCase{"evsm4_half", "evsm4,evsm.format=float16", blurred(8)},
        MemoryCase{"evsm4", "evsm4,evsm.format=float32", blurred(16)},
        MemoryCase{"msm", "msm,msm.format=unorm16", blurred(8)},
        MemoryCase{"msm_float", "msm,msm.format=float32", blurred(16)},
        MemoryCase{"sat_float",
                   "sat-vsm,sat-vsm.table=float32",
                   {{"map moments", plain(8)},
                    {"map moments depth", plain(4)},
                    {"map summed along rows", plain(8)},
                    {"map summed", plain(8)}}},
        // Sixteen terms of a cosine and a sine, in four 8-bit channels each: eight layers of four bytes.
        MemoryCase{"convolution",
                   "convolution,convolution.terms=16",
                   {{"map depth", plain(4)},
                    {"map", plain(4, 8)},
                    {"map blurred in u", plain(4, 8)},
                    {"map blurred", chain(4, 8)}}}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace gn::memory_test
