// SPDX-License-Identifier: MIT
// Based on: van Sambeek. Real-time Shadow Generation for 3D Simulations Using Modern Hardware. Twente 2007. [Sam07]
// Based on: Kreuzer. Using Perception-Based Filtering to Hide Shadow Artifacts. TU Wien 2017. [Kre17]
// What the answers say: rankings with their tests, thresholds with their fit; and the answers themselves, for other programs.
#pragma once

#include "apps/evaluation/session.h"
#include "apps/evaluation/statistics.h"
#include "apps/evaluation/study_store.h"

#include <nlohmann/json_fwd.hpp>

namespace gn {

/// What the administrator's page shows while a study runs: everybody's progress, trial by trial or page by page.
nlohmann::ordered_json admin_json(const StudyPlan& plan, StudyStore& store);

/// A line a rank or a trial.
std::string study_csv(const StudyPlan& plan, StudyStore& store);

/// All results: of a survey for each page and overall, ranks as 10 - r with 1 = best as in [Sam07]; of a threshold study the
/// thresholds of each pattern, contrast and artifact, and c with its interval of each pattern and contrast, the largest first.
/// Who has not finished a round or a page counts with what is finished.
nlohmann::ordered_json study_results(const StudyPlan& plan, StudyStore& store);
/// The same for a terminal.
std::string study_text(const nlohmann::ordered_json& results);

}  // namespace gn
