// SPDX-License-Identifier: MIT
#include "shadow/metrics/metrics.h"

#include "shadow/metrics/few.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gn::metrics_test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Floats = std::vector<float>;

TEST(Metrics, ChannelsOfOneLightArePooledAndCountEachSampleOnce) {
    // Red is right, green is dark by half, blue is leaked into.
    const std::vector<float> technique{1, 0.5F, 1, 0, 0, 0.25F}, reference{1, 1, 1, 0, 0, 0};
    const std::vector<std::uint8_t> counted{1, 1};
    std::vector<Errors> channels;
    for (int c = 0; c < 3; ++c) {
        const std::vector<float> t = channel_of(technique, 3, c), r = channel_of(reference, 3, c);
        EXPECT_EQ(r, (std::vector<float>{1, 0}));
        channels.push_back(visibility_errors(t, r, counted, 2, 1));
    }
    EXPECT_EQ(channel_of(technique, 3, 2), (std::vector<float>{1, 0.25F}));
    const Errors pooled = pool_channels(channels);
    EXPECT_EQ(pooled.samples, 2U);
    EXPECT_EQ(pooled.lit, 1U);
    EXPECT_NEAR(*pooled.mae, (0.5 + 0.25) / 6, 1e-12);
    EXPECT_NEAR(*pooled.acne, 0.5 / 3, 1e-12);
    EXPECT_NEAR(*pooled.leak, 0.25 / 3, 1e-12);
    EXPECT_NEAR(*pooled.rmse, std::sqrt((0.25 + 0.0625) / 6), 1e-12);
}

TEST(Metrics, AFigureThatFewSamplesTellSaysSo) {
    // 1000 samples: two are more than none and not fewer than one in 500.
    Errors errors{.samples = 1000};
    errors.dark = 997;
    errors.lit = 1;
    errors.partial = 2;
    EXPECT_EQ(few_samples(errors, "sun"),
              (std::vector<std::string>{
                  "'acne' of light 'sun' is told by 1 of 1000 samples, those that the truth finds lit"}));
    errors.dark = 999;
    errors.lit = 0;
    errors.partial = 1;
    EXPECT_EQ(few_samples(errors, "sun").size(), 1U);
    EXPECT_EQ(few_samples(Errors{}, "sun"), std::vector<std::string>{});
}

TEST(Metrics, FlickerThatFewChangesTellSaysSo) {
    // Nineteen equal changes among a thousand points, and twenty.
    const Flicker few{.samples = 1000, .squares = 19 * 0.25, .fourths = 19 * 0.0625};
    EXPECT_EQ(
        few_changes(few, "sun"),
        "'flicker' of light 'sun' is told by about 19 of 1000 points that two frames show; larger pictures show more");
    EXPECT_EQ(few_changes({.samples = 1000, .squares = 20 * 0.25, .fourths = 20 * 0.0625}, "sun"), "");
    EXPECT_EQ(few_changes({.samples = 1000}, "sun"), "");
}

TEST(Metrics, HandComputedPicture) {
    // Eight samples, the last two not counted.
    const Floats reference{0, 0, 1, 1, 0.5F, 0.25F, 1, 0};
    const Floats technique{0, 0.75F, 1, 0.5F, 0.75F, 0.25F, 0, 1};
    const Bytes counted{1, 1, 1, 1, 1, 1, 0, 0};
    const Errors e = visibility_errors(technique, reference, counted, 8, 1);
    EXPECT_EQ(e.samples, 6U);
    EXPECT_DOUBLE_EQ(e.rmse.value(), std::sqrt((0.5625 + 0.25 + 0.0625) / 6));
    EXPECT_DOUBLE_EQ(e.mae.value(), (0.75 + 0.5 + 0.25) / 6);
    EXPECT_DOUBLE_EQ(e.max.value(), 0.75);
    EXPECT_DOUBLE_EQ(e.mismatch.value(), 1.0 / 6);  // a difference of exactly one half is no mismatch
    EXPECT_DOUBLE_EQ(e.leak.value(), 0.75 / 2);
    EXPECT_DOUBLE_EQ(e.acne.value(), 0.5 / 2);
    EXPECT_DOUBLE_EQ(e.penumbra.value(), std::sqrt(0.0625 / 2));
    EXPECT_EQ(e.dark, 2U);
    EXPECT_EQ(e.lit, 2U);
    EXPECT_EQ(e.partial, 2U);
    EXPECT_FALSE(e.luma_rms.has_value() || e.flip.has_value() || e.flicker.has_value());
}

TEST(Metrics, WhatHasNoSamplesIsAbsent) {
    const Errors none = visibility_errors(Floats{1, 0}, Floats{0, 1}, Bytes{0, 0}, 2, 1);
    EXPECT_EQ(none.samples, 0U);
    for (const MetricInfo& metric : all_metrics()) {
        EXPECT_FALSE((none.*metric.value).has_value()) << metric.name;
    }
    const Errors lit = visibility_errors(Floats{1, 0}, Floats{1, 1}, Bytes{1, 1}, 2, 1);
    EXPECT_FALSE(lit.leak.has_value());
    EXPECT_FALSE(lit.penumbra.has_value());
    EXPECT_DOUBLE_EQ(lit.acne.value(), 0.5);
    EXPECT_DOUBLE_EQ(lit.edge.value(), 0.0);
    EXPECT_EQ(visibility_errors({}, {}, {}, 0, 0).samples, 0U);
}

TEST(Metrics, NotANumberIsWhollyWrong) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const Errors e = visibility_errors(Floats{nan, infinity}, Floats{0, 1}, Bytes{1, 1}, 2, 1);
    EXPECT_DOUBLE_EQ(e.rmse.value(), 1.0);
    EXPECT_DOUBLE_EQ(e.mismatch.value(), 1.0);
    EXPECT_DOUBLE_EQ(e.leak.value(), 1.0);
    EXPECT_DOUBLE_EQ(e.acne.value(), 1.0);
}

TEST(Metrics, NamesAreInOrder) {
    std::vector<std::string_view> names;
    for (const MetricInfo& metric : all_metrics()) {
        names.push_back(metric.name);
        EXPECT_FALSE(metric.sentence.empty());
    }
    EXPECT_EQ(names, (std::vector<std::string_view>{"rmse", "mae", "max", "mismatch", "leak", "acne", "self_shadow",
                                                    "penumbra", "edge", "undersampled", "undersampling", "luma_rms",
                                                    "flip", "flicker", "path_rmse", "against", "against_mean"}));
}

TEST(Metrics, PoolingIsAsIfTheSamplesWereOneList) {
    // Rows far apart in one picture: no neighbourhood joins the two lights' samples.
    const Floats reference_a{0, 0, 1, 0.5F};
    const Floats technique_a{0.25F, 0, 0.5F, 1};
    const Bytes counted_a{1, 1, 1, 0};
    const Floats reference_b{1, 1, 1, 0.75F};
    const Floats technique_b{1, 0, 1, 0.25F};
    const Bytes counted_b{1, 1, 1, 1};
    const Floats other_a{1, 0, 0.5F, 0};
    const Floats other_b{0.5F, 0, 1, 0};
    Errors a = visibility_errors(technique_a, reference_a, counted_a, 4, 1);
    Errors b = visibility_errors(technique_b, reference_b, counted_b, 4, 1);
    hold_against(a, technique_a, other_a, counted_a);
    hold_against(b, technique_b, other_b, counted_b);
    const Bytes beside_a{0, 0, 0, 0};
    const Bytes beside_b{0, 1, 1, 0};
    split_acne(a, technique_a, reference_a, counted_a, beside_a);
    split_acne(b, technique_b, reference_b, counted_b, beside_b);

    Floats reference = reference_a;
    Floats technique = technique_a;
    Bytes counted = counted_a;
    reference.insert(reference.end(), 4, 0.0F);
    technique.insert(technique.end(), 4, 0.0F);
    counted.insert(counted.end(), 4, 0);
    reference.insert(reference.end(), reference_b.begin(), reference_b.end());
    technique.insert(technique.end(), technique_b.begin(), technique_b.end());
    counted.insert(counted.end(), counted_b.begin(), counted_b.end());
    Floats other = other_a;
    other.insert(other.end(), 4, 0.0F);
    other.insert(other.end(), other_b.begin(), other_b.end());
    Errors expected = visibility_errors(technique, reference, counted, 4, 3);
    hold_against(expected, technique, other, counted);
    Bytes beside(8, 0);
    beside.insert(beside.end(), beside_b.begin(), beside_b.end());
    split_acne(expected, technique, reference, counted, beside);

    const std::vector<Errors> lights{a, b, Errors{}};
    const Errors pooled = pool(lights);
    EXPECT_EQ(pooled.samples, expected.samples);
    for (const MetricInfo& metric : all_metrics()) {
        ASSERT_EQ((pooled.*metric.value).has_value(), (expected.*metric.value).has_value()) << metric.name;
        if ((expected.*metric.value).has_value()) {
            EXPECT_NEAR((pooled.*metric.value).value(), (expected.*metric.value).value(), 1e-12) << metric.name;
        }
    }
    EXPECT_EQ(pool({}).samples, 0U);
    EXPECT_FALSE(pool({}).rmse.has_value());
}

TEST(Metrics, SelfShadowIsTheAcneThatNoEdgeExplains) {
    const Floats technique{0.5F, 0.25F, 1, 0, 0.5F, std::numeric_limits<float>::quiet_NaN()};
    const Floats reference{1, 1, 1, 1, 0.5F, 1};
    const Bytes counted{1, 1, 1, 0, 1, 1};
    const auto split = [&](const Bytes& beside) {
        Errors e = visibility_errors(technique, reference, counted, 6, 1);
        split_acne(e, technique, reference, counted, beside);
        return e;
    };
    // Four samples are lit and counted: 1/2, 3/4 and 1 of shadow, and none.
    EXPECT_DOUBLE_EQ(split(Bytes(6, 0)).self_shadow.value(), (0.5 + 0.75 + 1) / 4);
    EXPECT_DOUBLE_EQ(split(Bytes(6, 0)).self_shadow.value(), split(Bytes(6, 0)).acne.value());
    EXPECT_DOUBLE_EQ(split({1, 0, 1, 0, 0, 0}).self_shadow.value(), (0.75 + 1) / 4);
    EXPECT_DOUBLE_EQ(split(Bytes(6, 1)).self_shadow.value(), 0);
    // Where nothing is lit there is nothing to say.
    Errors none;
    split_acne(none, Floats{1}, Floats{0}, Bytes{1}, Bytes{0});
    EXPECT_FALSE(none.self_shadow.has_value());
}

TEST(Metrics, TexelsAreJudgedByTheShareAboveOneAndThePercentile) {
    // Twenty-one values by tenths up to 2.1: eleven are above 1, one is 1, and 95 % of the way from first to last is 2.
    Floats m;
    for (int i = 21; i >= 1; --i) {
        m.push_back(i == 10 ? 1.0F : 0.1F * static_cast<float>(i));
    }
    Errors errors;
    judge_texels(errors, m);
    EXPECT_DOUBLE_EQ(errors.undersampled.value(), 11.0 / 21);
    EXPECT_NEAR(errors.undersampling.value(), 2.0, 1e-6);
    Errors without_a_map;
    judge_texels(without_a_map, {});
    EXPECT_FALSE(without_a_map.undersampled.has_value());
    EXPECT_FALSE(without_a_map.undersampling.has_value());
}

TEST(Metrics, AgainstIsTheSignedAndTheRootMeanSquareDistance) {
    // Differences .5, -.25, and 1 where one of the two is not a number; the last sample does not count.
    const float broken = std::numeric_limits<float>::quiet_NaN();
    Errors e;
    hold_against(e, Floats{1, 0.25F, 0, 1}, Floats{0.5F, 0.5F, broken, 0}, Bytes{1, 1, 1, 0});
    EXPECT_NEAR(e.against.value(), std::sqrt((0.25 + 0.0625 + 1) / 3), 1e-12);
    EXPECT_NEAR(e.against_mean.value(), (0.5 - 0.25 + 1) / 3, 1e-12);
    // Nothing counts: nothing is said; nor is it where nobody asked.
    Errors none;
    hold_against(none, Floats{1}, Floats{0}, Bytes{0});
    EXPECT_FALSE(none.against.has_value());
    EXPECT_FALSE(visibility_errors(Floats{1}, Floats{0}, Bytes{1}, 1, 1).against.has_value());
}

TEST(Edge, HardBorderMarksBothSides) {
    // A vertical border between columns 2 and 3 of a 6 x 3 picture.
    Floats reference;
    for (int y = 0; y < 3; ++y) {
        reference.insert(reference.end(), {0, 0, 0, 1, 1, 1});
    }
    const Bytes row{0, 0, 1, 1, 0, 0};
    Bytes expected;
    for (int y = 0; y < 3; ++y) {
        expected.insert(expected.end(), row.begin(), row.end());
    }
    EXPECT_EQ(edge_pixels(reference, Bytes(18, 1), 6, 3), expected);
    const Errors e = visibility_errors(reference, reference, Bytes(18, 1), 6, 3);
    EXPECT_DOUBLE_EQ(e.edge.value(), 1.0 / 3);
}

TEST(Edge, DiagonalNeighboursBelong) {
    const Floats reference{1, 0, 0,  //
                           0, 0, 0,  //
                           0, 0, 0};
    EXPECT_EQ(edge_pixels(reference, Bytes(9, 1), 3, 3), (Bytes{1, 1, 0, 1, 1, 0, 0, 0, 0}));
}

TEST(Edge, NarrowPenumbraeAreDiscontinuitiesAndWideOnesAreNot) {
    const Bytes all(5, 1);
    EXPECT_EQ(edge_pixels(Floats{0, 0, 0.5F, 1, 1}, all, 5, 1), (Bytes{0, 1, 1, 1, 0}));
    EXPECT_EQ(edge_pixels(Floats{0, 0.2F, 0.4F, 0.6F, 0.8F}, all, 5, 1), (Bytes{0, 0, 0, 0, 0}));
}

TEST(Edge, UncountedPixelsHaveNoSide) {
    EXPECT_EQ(edge_pixels(Floats{1, 1, 0, 0, 0}, Bytes{1, 1, 0, 0, 0}, 5, 1), (Bytes{0, 0, 0, 0, 0}));
    EXPECT_EQ(edge_pixels(Floats{1, 0, 0, 0, 0}, Bytes{1, 1, 0, 1, 1}, 5, 1), (Bytes{1, 1, 0, 0, 0}));
}

TEST(Luma, HandComputed) {
    Image a(2, 1, 3);
    Image b(2, 1, 3);
    b.at(0, 0, 0) = 1;
    EXPECT_NEAR(luma_rms(a, b), 255 * 0.299 / std::sqrt(2.0), 1e-9);
    b.at(0, 0, 1) = b.at(0, 0, 2) = 1;
    EXPECT_NEAR(luma_rms(a, b), 255 / std::sqrt(2.0), 1e-9);
    EXPECT_EQ(luma_rms(b, b), 0.0);
    // A change of hue with the same luma does not show.
    a.at(1, 0, 0) = 0.587F;
    b.at(1, 0, 1) = 0.299F;
    b.at(0, 0, 0) = b.at(0, 0, 1) = b.at(0, 0, 2) = 0;
    EXPECT_NEAR(luma_rms(a, b), 0.0, 1e-5);
    // The fourth channel is ignored.
    EXPECT_EQ(luma_rms(Image(2, 2, 4, 0.5F), Image(2, 2, 3, 0.5F)), 0.0);
}

}  // namespace
}  // namespace gn::metrics_test
