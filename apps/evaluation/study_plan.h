// SPDX-License-Identifier: MIT
// What a study shows: DIR/study.json, written by `gnomon study prepare`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gn {

enum class StudyKind { survey, threshold };

struct SurveyPicture {
    std::string name;  ///< of the technique, or "reference"; never shown to participants
    std::string file;  ///< beside study.json
};

struct SurveyPage {
    std::string name;  ///< of the scene
    std::vector<SurveyPicture> pictures;
};

struct StudyPlan {
    StudyKind kind = StudyKind::survey;
    std::vector<SurveyPage> pages;  ///< of a survey
    std::vector<double> artifacts;  ///< of a threshold study, pixels along a texel's side
    std::vector<double> contrasts;  ///< of its rounds, each with both patterns
    int picture_size = 600;         ///< of its stimuli, pixels along a side
};

/// Throws Error naming the file and what is wrong in it.
StudyPlan read_plan(const std::filesystem::path& folder);
std::string plan_text(const StudyPlan& plan);

}  // namespace gn
