// SPDX-License-Identifier: MIT
#include "gpu/memory.h"

#include "gpu/test_device.h"
#include "gpu/transfer.h"

#include <numeric>
#include <random>

namespace gn::memory_test {
namespace {

TEST(TexelBytes, AreTheFormatsArithmetic) {
    EXPECT_EQ(texel_bytes({.format = VK_FORMAT_D32_SFLOAT, .width = 1024, .height = 1024}), 4U << 20U);
    EXPECT_EQ(texel_bytes({.format = VK_FORMAT_R8_UNORM, .width = 3, .height = 5, .layers = 2}), 30U);
    EXPECT_EQ(texel_bytes({.format = VK_FORMAT_R32G32_SFLOAT, .width = 4, .height = 2, .mips = 3}), (8U + 2 + 1) * 8);
    EXPECT_EQ(texel_bytes({.format = VK_FORMAT_R16G16B16A16_UNORM, .width = 2, .height = 2, .samples = 4}), 128U);
    EXPECT_EQ(texel_bytes({.format = VK_FORMAT_D32_SFLOAT_S8_UINT, .width = 2, .height = 2}), 20U);
    EXPECT_THROW(texel_bytes({.format = VK_FORMAT_BC1_RGB_UNORM_BLOCK}), Error);
}

TEST(FreeLists, NeverGiveTheSameByteTwiceAndMendCompletely) {
    constexpr VkDeviceSize bytes = 4096;
    std::mt19937 random(7);
    FreeList list(bytes);
    std::map<VkDeviceSize, VkDeviceSize> taken;
    for (int step = 0; step < 5000; ++step) {
        if (taken.empty() || random() % 2 == 0) {
            const VkDeviceSize count = 1 + random() % 300;
            const VkDeviceSize alignment = VkDeviceSize{1} << (random() % 8);
            const VkDeviceSize offset = list.take(count, alignment);
            if (offset == ~VkDeviceSize{0}) {
                continue;
            }
            ASSERT_EQ(offset % alignment, 0U);
            ASSERT_LE(offset + count, bytes);
            for (const auto& [begin, length] : taken) {
                ASSERT_TRUE(offset + count <= begin || begin + length <= offset);
            }
            taken[offset] = count;
        } else {
            const auto victim = std::next(taken.begin(), static_cast<std::ptrdiff_t>(random() % taken.size()));
            list.give(victim->first, victim->second);
            taken.erase(victim);
        }
    }
    for (const auto& [offset, count] : taken) {
        list.give(offset, count);
    }
    EXPECT_EQ(list.ranges(), (std::map<VkDeviceSize, VkDeviceSize>{{0, bytes}}));
}

class Memory : public Rendered {};

TEST_F(Memory, BuffersReturnWhatWasUploaded) {
    for (const std::size_t count : {0U, 1U, 1000U, 700'000U}) {
        std::vector<std::uint32_t> values(count);
        std::iota(values.begin(), values.end(), 17U);
        const Buffer buffer = upload_buffer(device, {.name = "values", .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT},
                                            std::as_bytes(std::span(values)));
        auto back = values_of<std::uint32_t>(download(device, buffer));
        ASSERT_GE(back.size(), count);
        back.resize(count);
        EXPECT_EQ(back, values);
    }
}

TEST_F(Memory, DeviceLocalBuffersAreReadByCopy) {
    std::vector<std::uint32_t> values(300);
    std::iota(values.begin(), values.end(), 5U);
    const Buffer local(device, {.name = "local", .bytes = values.size() * 4});
    const Buffer source =
        upload_buffer(device, {.name = "source", .host_visible = true}, std::as_bytes(std::span(values)));
    ASSERT_EQ(local.mapped(), nullptr);
    device.run([&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, values.size() * 4};
        vkCmdCopyBuffer(commands, source.vk(), local.vk(), 1, &region);
    });
    EXPECT_EQ(values_of<std::uint32_t>(download(device, local)), values);
}

TEST_F(Memory, MipsAverageTheLevelAbove) {
    // 4 x 4 texels of value 16 y + x: each mip holds the means of its quads.
    std::vector<float> texels(16);
    for (std::size_t i = 0; i < 16; ++i) {
        texels[i] = static_cast<float>(16 * (i / 4) + i % 4);
    }
    Texture2D texture =
        upload_texture(device, {.name = "mips", .format = VK_FORMAT_R32_SFLOAT, .width = 4, .height = 4, .mips = 3},
                       std::as_bytes(std::span(texels)));
    EXPECT_EQ(values_of<float>(download(device, texture)), texels);
    EXPECT_EQ(values_of<float>(download(device, texture, 1)), (std::vector<float>{8.5F, 10.5F, 40.5F, 42.5F}));
    EXPECT_EQ(values_of<float>(download(device, texture, 2)), (std::vector<float>{25.5F}));
    EXPECT_EQ(texture.layouts[1], VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
}

TEST_F(Memory, MovedValuesLeaveNothingBehind) {
    Buffer a = upload_buffer(device, {.name = "a"}, std::as_bytes(std::span("0123456789abcde")));
    const VkBuffer handle = a.vk();
    Buffer b = std::move(a);
    EXPECT_EQ(b.vk(), handle);
    EXPECT_EQ(a.vk(), VkBuffer{VK_NULL_HANDLE});  // NOLINT: looking at what a move leaves
    b = Buffer(device, {.name = "other", .bytes = 64});
    EXPECT_EQ(b.desc().name, "other");
}

TEST_F(Memory, ImpossibleTexturesAreSentences) {
    const auto error = [&](const TextureDesc& desc) {
        return error_of([&] { const Texture2D texture(device, desc); });
    };
    const VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT;
    const TextureDesc fine{.name = "map", .format = VK_FORMAT_R32_SFLOAT, .width = 64, .height = 64, .usage = sampled};
    EXPECT_EQ(error(fine), "");
    TextureDesc wide = fine;
    wide.width = 1'000'000;
    EXPECT_NE(error(wide).find("limit"), std::string::npos) << error(wide);
    TextureDesc deep = fine;
    deep.mips = 8;
    EXPECT_NE(error(deep).find("at most 7 mips"), std::string::npos) << error(deep);
    TextureDesc odd = fine;
    odd.format = VK_FORMAT_BC1_RGB_SRGB_BLOCK;  // no device draws into compressed blocks
    odd.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    EXPECT_NE(error(odd).find("'map'"), std::string::npos) << error(odd);
    TextureDesc empty = fine;
    empty.layers = 0;
    EXPECT_NE(error(empty).find("at least 1"), std::string::npos) << error(empty);
}

TEST_F(Memory, ImpossibleBuffersAreSentences) {
    const std::string error =
        error_of([&] { const Buffer buffer(device, {.name = "huge", .bytes = VkDeviceSize{1} << 50U}); });
    EXPECT_NE(error.find("'huge'"), std::string::npos) << error;
}

TEST_F(Memory, UploadsOfTheWrongSizeAreSentences) {
    const std::vector<std::byte> bytes(10);
    const std::string error = error_of([&] {
        upload_texture(device, {.name = "leaves", .format = VK_FORMAT_R8G8B8A8_UNORM, .width = 4, .height = 4}, bytes);
    });
    EXPECT_NE(error.find("64 bytes, not 10"), std::string::npos) << error;
}

}  // namespace
}  // namespace gn::memory_test
