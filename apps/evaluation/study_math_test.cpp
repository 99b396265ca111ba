// SPDX-License-Identifier: MIT
// QUEST on simulated observers, stimuli against closed forms, statistics against published examples.
#include "apps/evaluation/csv.h"
#include "apps/evaluation/quest.h"
#include "apps/evaluation/statistics.h"
#include "apps/evaluation/stimulus.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace gn::study_math_test {
namespace {

/// Uniform in [0,1), the same on every machine.
double uniform(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11U) * 0x1p-53;
}

struct Recovered {
    int within = 0, trials = 0, converged = 0;
};

/// A hundred observers whose thresholds lie within a factor of two of the guess.
Recovered recover(const QuestParams& observer) {
    Recovered result;
    std::mt19937_64 random(20171);
    for (int i = 0; i < 100; ++i) {
        const double threshold = QuestParams{}.guess + 0.6 * (uniform(random) - 0.5);
        Quest quest;
        while (!quest.converged() && quest.trials() < 120) {
            const double x = quest.next();
            quest.update(x, uniform(random) < psychometric(observer, x, threshold));
        }
        result.within += std::abs(quest.mean() - threshold) <= 0.1 ? 1 : 0;
        result.trials += quest.trials();
        result.converged += quest.converged() ? 1 : 0;
    }
    return result;
}

TEST(Quest, PutsTheThresholdWhereTheShareIsAsAskedFor) {
    EXPECT_NEAR(quest_offset({}), 0.00484, 5e-6);
    EXPECT_NEAR(psychometric({}, -0.3, -0.3), 0.82, 1e-12);
    // Lapses and guesses are its ends.
    EXPECT_NEAR(psychometric({}, -9, 0), 0.5, 1e-9);
    EXPECT_NEAR(psychometric({}, 9, 0), 0.995, 1e-9);
    // A trial tells most of the threshold a little above it.
    EXPECT_NEAR(best_offset({}), std::log10(1.75 / 1.04) / 3.5, 0.01);
}

TEST(Quest, RecoversTheThresholdsOfItsOwnObservers) {
    const Recovered model = recover({});
    EXPECT_GE(model.within, 95);
    EXPECT_EQ(model.converged, 100);
    // No fewer than Fisher's information allows where the threshold is known: 0.045^-2 at 17.8 a trial. The search adds half.
    EXPECT_GT(model.trials, 100 * 27);
    EXPECT_LT(model.trials, 100 * 50);
    RecordProperty("trials", model.trials);
}

TEST(Quest, IsHardlyMisledByLapsesAndAFlatterSlope) {
    // Twice as many answers in the dark, and a slope of 2.5: the likelihood is not theirs, so that its own doubt is too small.
    QuestParams lapses, flat;
    lapses.delta = 0.02;
    flat.beta = 2.5;
    EXPECT_GE(recover(lapses).within, 90);
    EXPECT_GE(recover(flat).within, 80);
}

TEST(Stimulus, IsTheDisksShareOfTheLight) {
    // A straight edge through a disc at distance d: 1/2 + (t sqrt(1 - t^2) + asin t) / pi.
    Stimulus s;
    s.pattern = Pattern::step;
    s.artifact = 0;
    s.radius = 20;
    for (const double d : {-25.0, -19.0, -7.0, 0.0, 3.0, 13.0, 20.0, 30.0}) {
        const double t = std::clamp(d / s.radius, -1.0, 1.0);
        const double exact = 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / 3.14159265358979;
        EXPECT_NEAR(light_at(s, 5, d), exact, 1e-12) << d;
    }
    // Far from a step its edge lies half a texel off; on it both halves of the disc average.
    s.artifact = 10;
    EXPECT_NEAR(light_at(s, 100, 5), 0.5, 1e-9);
    EXPECT_NEAR(light_at(s, -100, -5), 0.5, 1e-9);
    EXPECT_NEAR(light_at(s, 0, 0), 0.5, 1e-9);
    // Stairs repeat along the diagonal.
    s.pattern = Pattern::stair;
    EXPECT_NEAR(light_at(s, 3.5, 1), light_at(s, 13.5, 11), 1e-9);
}

TEST(Stimulus, IsEncodedForTheScreenInEightBits) {
    Stimulus s;
    s.contrast = 0.5;
    const Image picture = draw(s, 200);
    float least = 1, most = 0;
    for (const float value : picture.values) {
        least = std::min(least, value);
        most = std::max(most, value);
        EXPECT_NEAR(value * 255, std::round(value * 255), 1e-4);
    }
    EXPECT_EQ(most, 1.0F);
    EXPECT_NEAR(least, std::pow(0.5, 1 / 2.2), 0.5 / 255);
    // A quarter turn moves rows to columns and changes nothing else.
    Stimulus turned = s;
    turned.turn = 1;
    const Image other = draw(turned, 200);
    EXPECT_EQ(picture.at(20, 110), other.at(110, 179));
}

TEST(Stimulus, TheReferenceFilterHidesEveryPixelAndGrowsWithTheArtifact) {
    const auto three = reference_radius(Pattern::stair, 3, 1, 400, 200),
               five = reference_radius(Pattern::stair, 5, 1, 400, 200);
    ASSERT_TRUE(three && five);
    // Far more than the three to four artifacts that people ask for.
    EXPECT_GT(*three, 10 * 3);
    EXPECT_GT(*five, *three);
    // Half the contrast has half the steps of brightness to tell apart.
    EXPECT_LE(reference_radius(Pattern::stair, 5, 0.5, 400, 200).value(), *five);
    Stimulus a, b;
    a.pattern = b.pattern = Pattern::stair;
    a.radius = b.radius = 12;
    a.artifact = b.artifact = 5;
    b.line = true;
    EXPECT_NE(draw(a, 100).values, draw(b, 100).values);
}

TEST(Statistics, ReproducePublishedPairedTests) {
    // Student 1908, ten patients under two drugs: t = -4.0621, p = 0.002833, interval -2.4599 to -0.7001.
    const std::array<double, 10> one{0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
    const std::array<double, 10> two{1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
    const PairedT sleep = paired_t(one, two);
    EXPECT_NEAR(sleep.t, -4.0621, 5e-5);
    EXPECT_EQ(sleep.degrees, 9);
    EXPECT_NEAR(sleep.p, 0.002833, 5e-7);
    EXPECT_NEAR(sleep.low, -2.4598858, 5e-7);
    EXPECT_NEAR(sleep.high, -0.7001142, 5e-7);
    // Fisher 1935, Darwin's maize, in eighths of an inch: t = 2.148, p just below 0.05.
    const std::array<double, 15> maize{49, -67, 8, 16, 6, 23, 28, 41, 14, 29, 56, 24, 75, 60, -48}, nothing{};
    const PairedT plants = paired_t(maize, nothing);
    EXPECT_NEAR(plants.t, 2.148, 5e-4);
    EXPECT_NEAR(plants.p, 0.0497, 5e-5);
    // By hand: differences 1, 2, 3: mean 2, deviation 1, t = 2 sqrt 3.
    const std::array<double, 3> hand{1, 2, 3}, zeros{};
    EXPECT_NEAR(paired_t(hand, zeros).t, 2 * std::sqrt(3.0), 1e-12);
    // Equal weights are none; a pair twice as heavy moves the mean there.
    const std::array<double, 3> heavy{5, 5, 5}, tilted{2, 1, 1};
    EXPECT_NEAR(paired_t(hand, zeros, heavy).p, paired_t(hand, zeros).p, 1e-12);
    EXPECT_NEAR(paired_t(hand, zeros, tilted).difference, 1.75, 1e-12);
    EXPECT_EQ(paired_t(zeros, zeros).p, 1);
    EXPECT_EQ(paired_t({}, {}).p, 1);
}

TEST(Statistics, SubsetsAreRunsWithoutADifference) {
    // a and b are alike, c is far off, d between b and c and loose.
    std::vector<std::vector<double>> ranks;
    std::mt19937_64 random(7);
    for (int i = 0; i < 40; ++i) {
        const double noise = uniform(random) - 0.5;
        ranks.push_back({6 + noise, 1 + noise, 1.1 + uniform(random) - 0.5 + noise, 3 + 4 * (uniform(random) - 0.5)});
    }
    const Ranking ranking = rank_techniques({"c", "a", "b", "d"}, ranks, {});
    ASSERT_EQ(ranking.order.size(), 4U);
    EXPECT_EQ(ranking.order[0].name + ranking.order[1].name + ranking.order[2].name + ranking.order[3].name, "abdc");
    EXPECT_NEAR(ranking.level, 0.05 / 6, 1e-12);
    const std::vector<std::pair<std::size_t, std::size_t>> expected{{0, 1}, {2, 2}, {3, 3}};
    EXPECT_EQ(ranking.subsets, expected);
    // Where nothing differs all are one.
    const Ranking same = rank_techniques({"a", "b", "c"}, {{1, 2, 3}, {3, 2, 1}, {2, 1, 3}}, {});
    ASSERT_EQ(same.subsets.size(), 1U);
    EXPECT_EQ(same.subsets[0].second, 2U);
}

TEST(Statistics, TheFitRecoversAPlantedConstant) {
    // Exactly, and through the whole of it: thirty observers of three artifact sizes.
    const std::array<double, 3> a{5, 10, 20}, r{17.35, 34.7, 69.4};
    EXPECT_NEAR(fit_through_zero(a, r).c, 3.47, 1e-12);
    std::mt19937_64 random(99);
    std::vector<double> sizes, radii;
    for (int person = 0; person < 30; ++person) {
        for (const double size : a) {
            Quest quest;
            while (!quest.converged() && quest.trials() < 120) {
                const double x = quest.next();
                quest.update(x, uniform(random) < psychometric({}, x, -std::log10(3.47)));
            }
            sizes.push_back(size);
            radii.push_back(size * std::pow(10.0, -quest.mean()));
        }
    }
    const LineFit fit = fit_through_zero(sizes, radii);
    EXPECT_NEAR(fit.c, 3.47, 0.03 * 3.47);
    EXPECT_LT(fit.low, fit.c);
    EXPECT_GT(fit.high, fit.c);
    EXPECT_LT(fit.high - fit.low, 0.4);
}

TEST(Csv, QuotesWhatItMustAndDisarmsFormulas) {
    EXPECT_EQ(csv_line({"a", "b,c", "say \"x\"", "", "-1.5", "=1+1"}), "a,\"b,c\",\"say \"\"x\"\"\",,-1.5,'=1+1\r\n");
}

}  // namespace
}  // namespace gn::study_math_test
