// SPDX-License-Identifier: MIT
// One participant's way through a study, as a function of their seed and the answers so far: nothing else is remembered, so that
// a server that was killed goes on where it was.
#pragma once

#include "apps/evaluation/quest.h"
#include "apps/evaluation/stimulus.h"
#include "apps/evaluation/study_plan.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gn {

/// What a screen is like, as its user adjusted it.
struct Screen {
    double gamma = 2.2, pixels_per_cm = 0, distance_cm = 0, device_pixel_ratio = 1;
};
/// Throws Error naming the field that makes no sense. `json` is what a participant sent.
Screen read_screen(const nlohmann::json& json);

/// Of a survey: pages in random order, and on each the pictures in random order.
struct SurveyState {
    std::size_t answered = 0, page = 0;  ///< pages; and the plan's index of the one to be shown
    std::vector<std::size_t> slots;      ///< the plan's picture in each place of the page
    [[nodiscard]] bool done(const StudyPlan& plan) const { return answered >= plan.pages.size(); }
};
SurveyState survey_state(const StudyPlan& plan, std::uint64_t seed, std::size_t answered);
/// The answer to be kept, from what was sent: every picture ranked 1 to 9 where 9 is the best, difficulty 1 (hard to see any
/// difference) to 5, and once more the picture that is best, which must have the highest rank: so nobody ranks the wrong way
/// round. Throws Error with a sentence for the participant.
std::string survey_answer(const StudyPlan& plan, const SurveyState& state, const nlohmann::json& sent);

/// A trial of a threshold study.
struct Trial {
    Stimulus stimulus;
    std::size_t round = 0, quest = 0;  ///< of the rounds in this participant's order; which artifact
};

/// One quest as it went, for the administrator's chart.
struct QuestTrace {
    std::vector<double> radii;  ///< of each trial, pixels
    double radius = 0;          ///< the threshold now, pixels
    double deviation = 0;       ///< of its decimal logarithm
    bool converged = false;
};

struct ThresholdRound {
    Pattern pattern = Pattern::step;
    double contrast = 1;
    std::vector<QuestTrace> quests;  ///< one an artifact of the plan
};

struct ThresholdState {
    std::vector<ThresholdRound> rounds;  ///< in this participant's order
    std::optional<Trial> next;           ///< nothing where all rounds have ended
    std::size_t answered = 0;
};

/// A round ends when each of its quests has at least ten trials and has converged, or has this many.
inline constexpr int most_trials = 80;

/// Throws Error where an answer that is kept cannot be read.
ThresholdState threshold_state(const StudyPlan& plan, std::uint64_t seed, const Screen& screen,
                               const std::vector<std::string>& answers);
/// The answer to be kept: "line" or "artifact", as the trial was, and whether that was right. Throws Error.
std::string threshold_answer(const Trial& trial, const nlohmann::json& sent);

}  // namespace gn
