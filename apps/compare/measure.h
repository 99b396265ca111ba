// SPDX-License-Identifier: MIT
// One recipe on one view: rendered, timed, and held against the truth.
#pragma once

#include "apps/compare/session.h"
#include "shadow/recipe/recipe.h"

namespace gn {

/// A recipe, and the words that asked for it.
struct AskedRecipe {
    std::string text;  ///< "pcf,resolution=2048"
    Recipe recipe;
};

/// What is known before anything is drawn.
RunResult describe_run(const std::string& scene, const AskedRecipe& asked, const CompareOptions& options);

/// Draws and measures. Writes pictures when there is a report folder. Throws Error, and Stopped.
RunResult measure(ViewSession& view, Bench& bench, const AskedRecipe& asked, const std::string& run_key,
                  const CompareOptions& options);

}  // namespace gn
