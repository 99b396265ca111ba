// SPDX-License-Identifier: MIT
#include "apps/evaluation/session.h"

#include "base/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace gn {
namespace {

using nlohmann::json;

/// Random numbers of one purpose: the same on every machine.
class Dice {
  public:
    Dice(std::uint64_t seed, std::uint64_t purpose) : random_(seed ^ (0x9E3779B97F4A7C15ULL * (purpose + 1))) {
        random_.discard(8);
    }
    /// 0 to count - 1; the bias of a remainder is 2^-60 here.
    std::size_t below(std::size_t count) { return static_cast<std::size_t>(random_() % count); }
    std::vector<std::size_t> order(std::size_t count) {
        std::vector<std::size_t> places(count);
        std::iota(places.begin(), places.end(), std::size_t{0});
        for (std::size_t i = count; i > 1; --i) {
            std::swap(places[i - 1], places[below(i)]);
        }
        return places;
    }

  private:
    std::mt19937_64 random_;
};

/// A whole number of the answer within bounds.
int whole(const json& sent, const char* key, int low, int high) {
    const auto found = sent.find(key);
    if (found == sent.end() || !found->is_number_integer()) {
        fail("'{}' is missing, or is no whole number", key);
    }
    const auto value = found->get<std::int64_t>();
    if (value < low || value > high) {
        fail("'{}' is {}; valid is {} to {}", key, value, low, high);
    }
    return static_cast<int>(value);
}

double real(const json& sent, const char* key, double low, double high) {
    const auto found = sent.find(key);
    if (found == sent.end() || !found->is_number()) {
        fail("'{}' is missing, or is no number", key);
    }
    const double value = found->get<double>();
    if (!(value >= low && value <= high)) {
        fail("'{}' is {}; valid is {} to {}", key, value, low, high);
    }
    return value;
}

constexpr std::uint64_t for_pages = 1, for_rounds = 2, for_slots = 1000, for_trials = 1'000'000;

/// Finished: enough trials and sure, or too many.
bool ended(const Quest& quest) {
    return quest.converged() || quest.trials() >= most_trials;
}

double radius_of(double artifact, double x) {
    return artifact * std::pow(10.0, -x);
}

}  // namespace

Screen read_screen(const json& sent) {
    if (!sent.is_object()) {
        fail("'screen' is missing");
    }
    return {real(sent, "gamma", 1, 4), real(sent, "pixels_per_cm", 5, 500), real(sent, "distance_cm", 10, 1000),
            real(sent, "device_pixel_ratio", 0.25, 8)};
}

SurveyState survey_state(const StudyPlan& plan, std::uint64_t seed, std::size_t answered) {
    SurveyState state;
    state.answered = answered;
    if (state.done(plan)) {
        return state;
    }
    state.page = Dice(seed, for_pages).order(plan.pages.size())[answered];
    state.slots = Dice(seed, for_slots + state.page).order(plan.pages[state.page].pictures.size());
    return state;
}

std::string survey_answer(const StudyPlan& plan, const SurveyState& state, const json& sent) {
    const SurveyPage& page = plan.pages[state.page];
    const auto ranks = sent.find("ranks");
    if (ranks == sent.end() || !ranks->is_array() || ranks->size() != state.slots.size()) {
        fail("every picture needs a rank");
    }
    nlohmann::ordered_json kept{{"page", page.name}, {"ranks", nlohmann::ordered_json::object()}};
    std::vector<int> values;
    for (std::size_t slot = 0; slot < state.slots.size(); ++slot) {
        const json& rank = (*ranks)[slot];
        if (!rank.is_number_integer() || rank.get<std::int64_t>() < 1 || rank.get<std::int64_t>() > 9) {
            fail("picture {} needs a rank of 1 to 9, where 9 is the most realistic", slot + 1);
        }
        values.push_back(rank.get<int>());
    }
    for (std::size_t i = 0; i < page.pictures.size(); ++i) {
        const auto slot = std::find(state.slots.begin(), state.slots.end(), i) - state.slots.begin();
        kept["ranks"][page.pictures[i].name] = values[static_cast<std::size_t>(slot)];
    }
    kept["difficulty"] = whole(sent, "difficulty", 1, 5);
    // Asked for once more without a number: a rank the wrong way round cannot agree with it.
    const int best = whole(sent, "best", 0, static_cast<int>(values.size()) - 1);
    if (values[static_cast<std::size_t>(best)] != *std::max_element(values.begin(), values.end())) {
        fail("picture {} is said to be the most realistic, but its rank is not the highest; 9 is the most realistic",
             best + 1);
    }
    const auto comment = sent.find("comment");
    if (comment != sent.end() && (!comment->is_string() || comment->get_ref<const std::string&>().size() > 2000)) {
        fail("a comment is a text of at most 2000 bytes");
    }
    kept["comment"] = comment == sent.end() ? "" : comment->get<std::string>();
    return kept.dump();
}

ThresholdState threshold_state(const StudyPlan& plan, std::uint64_t seed, const Screen& screen,
                               const std::vector<std::string>& answers) {
    ThresholdState state;
    state.answered = answers.size();
    // Rounds: both patterns at each contrast, in random order.
    std::vector<ThresholdRound> rounds;
    for (const Pattern pattern : {Pattern::step, Pattern::stair}) {
        for (const double contrast : plan.contrasts) {
            rounds.push_back({pattern, contrast, std::vector<QuestTrace>(plan.artifacts.size())});
        }
    }
    for (const std::size_t i : Dice(seed, for_rounds).order(rounds.size())) {
        state.rounds.push_back(rounds[i]);
    }
    // Go through what was answered.
    static const Quest fresh;
    std::vector<std::vector<Quest>> quests(rounds.size(), std::vector<Quest>(plan.artifacts.size(), fresh));
    for (const std::string& text : answers) {
        const json answer = json::parse(text, nullptr, false);
        if (answer.is_discarded()) {
            fail("an answer that was kept cannot be read: {}", text);
        }
        const std::size_t round = answer.at("round"), quest = answer.at("quest");
        if (round >= quests.size() || quest >= plan.artifacts.size()) {
            fail("an answer that was kept is of another study: {}", text);
        }
        const double radius = answer.at("radius");
        quests[round][quest].update(-std::log10(radius / plan.artifacts[quest]), answer.at("right"));
        state.rounds[round].quests[quest].radii.push_back(radius);
    }
    for (std::size_t r = 0; r < rounds.size(); ++r) {
        std::vector<std::size_t> open;
        for (std::size_t q = 0; q < plan.artifacts.size(); ++q) {
            QuestTrace& trace = state.rounds[r].quests[q];
            trace.radius = radius_of(plan.artifacts[q], quests[r][q].mean());
            trace.deviation = quests[r][q].deviation();
            trace.converged = quests[r][q].converged();
            if (!ended(quests[r][q])) {
                open.push_back(q);
            }
        }
        if (open.empty() || state.next) {
            continue;
        }
        // The first round that is open: one of its quests at random; a line in half of all trials.
        Dice dice(seed, for_trials + state.answered);
        Trial trial;
        trial.round = r;
        trial.quest = open[dice.below(open.size())];
        trial.stimulus = {state.rounds[r].pattern,
                          plan.artifacts[trial.quest],
                          std::clamp(radius_of(plan.artifacts[trial.quest], quests[r][trial.quest].next()), 0.5,
                                     0.5 * plan.picture_size),
                          state.rounds[r].contrast,
                          dice.below(2) == 0,
                          static_cast<int>(dice.below(8)),
                          screen.gamma};
        state.next = trial;
    }
    return state;
}

std::string threshold_answer(const Trial& trial, const json& sent) {
    const auto line = sent.find("line");
    if (line == sent.end() || !line->is_boolean()) {
        fail("'line' is missing: true where the original is a line");
    }
    const bool said = line->get<bool>();
    return nlohmann::ordered_json{{"round", trial.round},
                                  {"quest", trial.quest},
                                  {"pattern", name_of(trial.stimulus.pattern)},
                                  {"contrast", trial.stimulus.contrast},
                                  {"artifact", trial.stimulus.artifact},
                                  {"radius", trial.stimulus.radius},
                                  {"line", trial.stimulus.line},
                                  {"said_line", said},
                                  {"right", said == trial.stimulus.line}}
        .dump();
}

}  // namespace gn
