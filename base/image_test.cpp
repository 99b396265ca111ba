// SPDX-License-Identifier: MIT
#include "base/image.h"

#include "base/error.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace gn::image_test {
namespace {

/// A folder that is removed at the end.
class ImageFiles : public testing::Test {
  protected:
    ImageFiles() : folder(std::filesystem::temp_directory_path() / fmt::format("gnomon-image-test-{}", ::getpid())) {
        std::filesystem::create_directories(folder);
    }
    ~ImageFiles() override { std::filesystem::remove_all(folder); }
    [[nodiscard]] std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
    }
    std::filesystem::path folder;
};

Image gradient(int width, int height, int channels) {
    Image image(width, height, channels);
    for (std::size_t i = 0; i < image.values.size(); ++i) {
        image.values[i] = static_cast<float>(i) / static_cast<float>(image.values.size());
    }
    return image;
}

TEST(ImageValues, IndexIsRowsTopToBottomChannelsInterleaved) {
    Image image(3, 2, 2, 0.5F);
    EXPECT_EQ(image.values.size(), 12U);
    image.at(2, 1, 1) = 7;
    EXPECT_EQ(image.values[11], 7.0F);
    EXPECT_EQ(image.at(0, 0), 0.5F);
}

TEST(ImageValues, SrgbCurveIsTheStandardOne) {
    EXPECT_FLOAT_EQ(srgb_from_linear(0.0F), 0.0F);
    EXPECT_NEAR(srgb_from_linear(1.0F), 1.0F, 1e-6F);
    EXPECT_NEAR(srgb_from_linear(0.5F), 0.735357F, 1e-5F);
    EXPECT_NEAR(linear_from_srgb(0.5F), 0.214041F, 1e-6F);
    // The two pieces meet, and the curves are inverse to each other.
    EXPECT_NEAR(srgb_from_linear(0.0031308F), srgb_from_linear(0.0031309F), 2e-6F);
    for (int i = 0; i <= 255; ++i) {
        const float encoded = static_cast<float>(i) / 255.0F;
        EXPECT_NEAR(srgb_from_linear(linear_from_srgb(encoded)), encoded, 1e-6F);
    }
}

TEST_F(ImageFiles, PngComesBackAsBytes) {
    for (const int channels : {1, 3, 4}) {
        Image image = gradient(5, 4, channels);
        image.values[0] = -1;
        image.values[1] = 2;
        image.values[2] = std::numeric_limits<float>::quiet_NaN();
        const std::vector<std::byte> png = encode_png(image);
        const Image8 back = decode_image(png, "test");
        ASSERT_EQ(back.width, 5);
        ASSERT_EQ(back.height, 4);
        for (std::size_t i = 0; i < image.pixels(); ++i) {
            for (int c = 0; c < std::min(channels, 3); ++c) {
                const float value = image.values[i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)];
                const long expected = std::isnan(value) ? 0 : std::lround(std::clamp(value, 0.0F, 1.0F) * 255);
                EXPECT_EQ(back.rgba[4 * i + static_cast<std::size_t>(c)], expected)
                    << "pixel " << i << " of " << channels;
            }
            const long alpha = channels < 4 ? 255 : std::lround(std::clamp(image.values[4 * i + 3], 0.0F, 1.0F) * 255);
            EXPECT_EQ(back.rgba[4 * i + 3], alpha);
        }
        write_png(folder / "a.png", image);
        EXPECT_EQ(std::filesystem::file_size(folder / "a.png"), png.size());
    }
    EXPECT_EQ(files(), 1U) << "no parts remain";
}

TEST_F(ImageFiles, ExrComesBackBitByBit) {
    for (const int channels : {1, 3, 4}) {
        Image image = gradient(37, 21, channels);
        image.values[0] = 1e30F;
        image.values[1] = -1e-30F;
        write_exr(folder / "a.exr", image);
        const Image back = read_exr(folder / "a.exr");
        EXPECT_EQ(back.width, 37);
        EXPECT_EQ(back.height, 21);
        EXPECT_EQ(back.channels, channels);
        EXPECT_EQ(back.values, image.values);
    }
    EXPECT_EQ(files(), 1U);
}

TEST_F(ImageFiles, ExrChannelsMayBeNamed) {
    const Image image = gradient(3, 2, 2);
    const std::vector<std::string> names{"b.V", "a.V"};
    write_exr(folder / "a.exr", image, names);
    const Image back = read_exr(folder / "a.exr");  // files keep channels by name
    ASSERT_EQ(back.channels, 2);
    EXPECT_EQ(back.at(1, 1, 0), image.at(1, 1, 1));
    EXPECT_EQ(back.at(1, 1, 1), image.at(1, 1, 0));
    EXPECT_THROW(write_exr(folder / "b.exr", image), Error) << "two channels have no names of their own";
    const std::vector<std::string> one{"Y"};
    EXPECT_THROW(write_exr(folder / "b.exr", image, one), Error);
}

TEST_F(ImageFiles, FailuresAreSentencesAndLeaveNothing) {
    EXPECT_THROW(write_png(folder / "no" / "such" / "a.png", gradient(2, 2, 3)), Error);
    EXPECT_THROW(write_png(folder / "a.png", Image()), Error);
    EXPECT_THROW(write_png(folder / "a.png", gradient(2, 2, 2)), Error);
    std::filesystem::create_directories(folder / "taken.png");
    EXPECT_THROW(write_png(folder / "taken.png", gradient(2, 2, 3)), Error) << "a folder has the name";
    EXPECT_EQ(files(), 1U);
    EXPECT_THROW((void)read_exr(folder / "absent.exr"), Error);
}

TEST_F(ImageFiles, BrokenExrIsAnError) {
    write_exr(folder / "a.exr", gradient(64, 64, 3));
    std::ifstream in(folder / "a.exr", std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{3}, std::size_t{9}, std::size_t{100}, whole.size() / 2}) {
        std::ofstream(folder / "cut.exr", std::ios::binary) << whole.substr(0, size);
        EXPECT_THROW((void)read_exr(folder / "cut.exr"), Error) << size << " bytes";
    }
}

}  // namespace
}  // namespace gn::image_test
