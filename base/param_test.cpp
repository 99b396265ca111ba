// SPDX-License-Identifier: MIT
#include "base/param.h"

#include <gtest/gtest.h>

namespace gn::param_test {
namespace {

struct GnTestParams {
    float radius = 1.5F;
    int taps = 9;
    int kernel = 1;
    int rotate = 0;
};

const ParamTable table = param_table<GnTestParams>({
    GN_PARAM(GnTestParams, radius, real, 0, 64, "texels", "Wider penumbrae."),
    GN_PARAM(GnTestParams, taps, integer, 1, 64, "", "Less noise, more time."),
    GN_CHOICE(GnTestParams, kernel, "What the taps form.", "grid", "poisson"),
    GN_PARAM(GnTestParams, rotate, boolean, 0, 1, "", "Trades bands for noise."),
});

/// The sentence of the error that setting gives, or "".
std::string complaint(std::string_view name, std::string_view value) {
    ParamBlock block(table);
    try {
        block.set(name, value, "-r");
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(Param, DefaultsComeFromTheStruct) {
    const ParamBlock block(table);
    const auto params = block.as<GnTestParams>();
    EXPECT_EQ(params.radius, 1.5F);
    EXPECT_EQ(params.taps, 9);
    EXPECT_EQ(block.get("radius"), "1.5");
    EXPECT_EQ(block.get("kernel"), "poisson");
    EXPECT_EQ(block.get("rotate"), "false");
    EXPECT_EQ(table.names(), "radius, taps, kernel, rotate");
    EXPECT_EQ(table.find("taps")->max, 64);
    EXPECT_EQ(table.find("tap"), nullptr);
}

TEST(Param, SetWritesOneField) {
    ParamBlock block(table);
    block.set("radius", "2.25", "-r");
    block.set("taps", "25", "-r");
    block.set("kernel", "grid", "-r");
    block.set("rotate", "true", "-r");
    const auto params = block.as<GnTestParams>();
    EXPECT_EQ(params.radius, 2.25F);
    EXPECT_EQ(params.taps, 25);
    EXPECT_EQ(params.kernel, 0);
    EXPECT_EQ(params.rotate, 1);
    for (const std::string_view off : {"false", "off", "0"}) {
        block.set("rotate", off, "-r");
        EXPECT_EQ(block.get("rotate"), "false");
    }
}

TEST(Param, GetGivesBackWhatWasSet) {
    ParamBlock block(table);
    for (const auto& [name, value] : std::vector<std::pair<std::string_view, std::string>>{
             {"radius", "0.1"}, {"radius", "64"}, {"taps", "1"}, {"kernel", "grid"}, {"rotate", "true"}}) {
        block.set(name, value, "-r");
        EXPECT_EQ(block.get(name), value);
    }
}

TEST(Param, ErrorsSayWhatWhereAndWhatWouldBeValid) {
    EXPECT_EQ(complaint("radios", "1"),
              "-r: unknown parameter 'radios'; did you mean 'radius'? valid names are radius, taps, kernel, rotate");
    EXPECT_NE(complaint("radius", "wide").find("'wide' is not a number"), std::string::npos);
    EXPECT_NE(complaint("radius", "65").find("0 to 64 texels"), std::string::npos);
    EXPECT_NE(complaint("taps", "2.5").find("a whole number from 1 to 64"), std::string::npos);
    EXPECT_NE(complaint("kernel", "gird").find("did you mean 'grid'"), std::string::npos);
    EXPECT_NE(complaint("rotate", "maybe").find("true and false"), std::string::npos);
    for (const std::string_view bad : {"", "nan", "inf", "1e999", "1x", " 1", "-0.5"}) {
        EXPECT_NE(complaint("radius", bad), "") << "'" << bad << "'";
    }
}

TEST(Param, AFailedSetChangesNothing) {
    ParamBlock block(table);
    EXPECT_THROW(block.set("taps", "1000", "-r"), Error);
    EXPECT_EQ(block.get("taps"), "9");
}

TEST(Param, SuggestOnlyWhatIsNear) {
    const std::vector<std::string_view> known{"hard", "pcf"};
    EXPECT_EQ(suggest("harp", known), "did you mean 'hard'? valid names are hard, pcf");
    EXPECT_EQ(suggest("moments", known), "valid names are hard, pcf");
    EXPECT_EQ(suggest("x", {}), "there are none to choose from");
}

}  // namespace
}  // namespace gn::param_test
